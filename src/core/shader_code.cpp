#include "core/shader_code.h"

// For the state of the decoder in our own memory: host memory comes from the engine's callbacks, all of it.
#define ZSTD_STATIC_LINKING_ONLY
#include <zstd.h>

namespace gpgp::core {

Result<ShaderWords> ShaderWords::of(const ShaderCode& code, std::pmr::memory_resource* memory) {
  ShaderWords result(memory);
  result.words_ = {code.words, code.count};
  if (!code.pack) return result;
  std::pmr::vector<uint64_t> state((ZSTD_estimateDCtxSize() + 7) / 8, memory);
  result.unpacked_.resize(code.pack->words);
  const size_t bytes = result.unpacked_.size() * sizeof(uint32_t);
  const size_t written = ZSTD_decompressDCtx(ZSTD_initStaticDCtx(state.data(), state.size() * sizeof(uint64_t)),
                                             result.unpacked_.data(), bytes, code.pack->bytes, code.pack->size);
  if (written != bytes)
    return makeError(GPGP_ERROR_UNSUPPORTED, "a shader of the library cannot be unpacked: %s",
                     ZSTD_isError(written) ? ZSTD_getErrorName(written) : "it is incomplete");
  result.words_ = std::span<const uint32_t>(result.unpacked_).subspan(code.first, code.count);
  return result;
}

} // namespace gpgp::core
