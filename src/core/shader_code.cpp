#include "core/shader_code.h"

#include <zstd.h>

namespace gpgp::core {

Result<ShaderWords> ShaderWords::of(const ShaderCode& code, std::pmr::memory_resource* memory) {
  ShaderWords result(memory);
  result.words_ = {code.words, code.count};
  if (!code.pack) return result;
  result.unpacked_.resize(code.pack->words);
  const size_t bytes = result.unpacked_.size() * sizeof(uint32_t);
  const size_t written = ZSTD_decompress(result.unpacked_.data(), bytes, code.pack->bytes, code.pack->size);
  if (written != bytes) // the pack is a part of the library, so what fails is zstd's own allocation
    return makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "a shader could not be unpacked: %s",
                     ZSTD_isError(written) ? ZSTD_getErrorName(written) : "it is incomplete");
  result.words_ = std::span<const uint32_t>(result.unpacked_).subspan(code.first, code.count);
  return result;
}

} // namespace gpgp::core
