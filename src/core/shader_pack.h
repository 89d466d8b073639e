// Several modules of SPIR-V, packed. On its own, because the build compiles one source for each pack.
#pragma once
#include <cstdint>

namespace gpgp::core {

struct ShaderPack {
  const unsigned char* bytes; ///< one frame of zstd
  uint32_t size;              ///< bytes
  uint32_t words;             ///< when unpacked
};

} // namespace gpgp::core
