// Blobs as the compilers return them.
#pragma once
#include <gpgp/core.h>

#include <cstdlib>
#include <cstring>
#include <span>

namespace gpgp::core {

/// A copy, which gpgpFreeBlob frees; without data where there is no memory for it.
inline GpgpBlob copyToBlob(std::span<const std::byte> bytes) {
  const GpgpBlob blob{std::malloc(bytes.size()), bytes.size()};
  if (blob.data) std::memcpy(blob.data, bytes.data(), blob.size);
  return blob;
}

} // namespace gpgp::core
