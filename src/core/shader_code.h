// SPIR-V of the library's shaders. It is most of the library: packed, the modules of one source together, because they
// differ little (src/cmake/shaders.cmake).
#pragma once
#include "core/result.h"
#include "core/shader_pack.h"

#include <memory_resource>
#include <span>
#include <vector>

namespace gpgp::core {

/// One module: words at hand, which must outlive it, or a part of a pack.
struct ShaderCode {
  constexpr ShaderCode() = default;
  constexpr ShaderCode(std::span<const uint32_t> code)
      : words(code.data()), count(static_cast<uint32_t>(code.size())) {}
  template <size_t N> constexpr ShaderCode(const uint32_t (&code)[N]) : words(code), count(N) {}
  constexpr ShaderCode(const ShaderPack& from, uint32_t firstWord, uint32_t wordCount)
      : pack(&from), first(firstWord), count(wordCount) {}

  const ShaderPack* pack = nullptr;
  const uint32_t* words = nullptr; ///< where there is no pack
  uint32_t first = 0;              ///< word of the pack
  uint32_t count = 0;              ///< words
};

/// The words of a module, unpacked for as long as this lives.
class ShaderWords {
public:
  /// Throws std::bad_alloc.
  static Result<ShaderWords> of(const ShaderCode& code, std::pmr::memory_resource* memory);
  std::span<const uint32_t> words() const { return words_; }

private:
  explicit ShaderWords(std::pmr::memory_resource* memory) : unpacked_(memory) {}
  std::pmr::vector<uint32_t> unpacked_;
  std::span<const uint32_t> words_;
};

/// The bindings of descriptor set 0 that a module's functions use, a bit each: they are below 64, and at most 64
/// variables.
uint64_t bindingsOf(std::span<const uint32_t> words);

} // namespace gpgp::core
