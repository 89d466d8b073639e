// Blobs as the compilers return them.
#pragma once
#include <gpgp/core.h>

#include <cstdlib>
#include <cstring>
#include <span>

namespace gpgp::core {

/// Bytes that gpgpFreeBlob frees; without data where there is no memory for them.
inline GpgpBlob newBlob(size_t size) { return {std::malloc(size), size}; }
inline std::span<std::byte> bytesOf(const GpgpBlob& blob) { return {static_cast<std::byte*>(blob.data), blob.size}; }

/// A copy in a new blob.
inline GpgpBlob copyToBlob(std::span<const std::byte> bytes) {
  const GpgpBlob blob = newBlob(bytes.size());
  if (blob.data) std::memcpy(blob.data, bytes.data(), blob.size);
  return blob;
}

} // namespace gpgp::core
