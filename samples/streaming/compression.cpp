#include "compression.h"

#include <enet/enet.h>
#include <zstd.h>

#include <stdexcept>

namespace streaming {

Bytes compress(ByteSpan bytes) {
  Bytes packed(ZSTD_compressBound(bytes.size()));
  const size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1);
  if (ZSTD_isError(size)) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  packed.resize(size);
  return packed;
}

std::optional<Bytes> decompress(ByteSpan bytes, size_t size) {
  Bytes plain(size);
  if (ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size()) != size) return {};
  return plain;
}

uint32_t checksum(ByteSpan bytes) {
  ENetBuffer buffer{};
  buffer.data = const_cast<uint8_t*>(bytes.data());
  buffer.dataLength = bytes.size();
  return enet_crc32(&buffer, 1);
}

} // namespace streaming
