// zstd, and a checksum.
#pragma once
#include "bytes.h"

#include <optional>

namespace streaming {

Bytes compress(ByteSpan bytes);
/// Nothing where the bytes do not decompress to exactly `size` bytes.
std::optional<Bytes> decompress(ByteSpan bytes, size_t size);
/// CRC 32.
uint32_t checksum(ByteSpan bytes);

} // namespace streaming
