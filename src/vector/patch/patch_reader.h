// The shaders' functions on patches (gpgp/shaders/patches.h), run on the CPU.
#pragma once
#include "core/math.h"
#include "vector/shared/sample.h"

#include <span>

namespace gpgp::shader {

class PatchReader {
public:
  explicit PatchReader(std::span<const uvec4> words) : words_(words) {}
  uvec4 load(uint, uint index) const { return words_[index]; }

  /// The work of calls since they were last set: what curves were asked, by the cost of the question.
  struct Counts {
    uint64_t box = 0, sign = 0, line = 0, solve = 0, newton = 0;
  };
  Counts counts;

#define GPGP_PATCH_LOAD(slot, index) load(slot, index)
#define GPGP_PATCH_CONST static constexpr
#define GPGP_PATCH_COUNT(what) ++counts.what;
#include "gpgp/shaders/patches.h"
// The second reads the first.
#include "gpgp/shaders/patch_quads.h"
#include "vector/patches/tile.h"

private:
  std::span<const uvec4> words_;
};

} // namespace gpgp::shader
