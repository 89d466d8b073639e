// The shaders' functions on patches (gpgp/shaders/patches.h), run on the CPU.
#pragma once
#include "vector/shared/layout.h"

#include <span>

namespace gpgp::shader {

class PatchReader {
public:
  explicit PatchReader(std::span<const uvec4> words) : words_(words) {}
  uvec4 load(uint, uint index) const { return words_[index]; }

#define GPGP_PATCH_LOAD(slot, index) load(slot, index)
#define GPGP_PATCH_CONST static constexpr
#include "gpgp/shaders/patches.h"

private:
  std::span<const uvec4> words_;
};

} // namespace gpgp::shader
