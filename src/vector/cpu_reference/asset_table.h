// What the CPU reference reads of an asset in place of the buffer in which it lies.
#pragma once
#include "vector/shared/layout.h"

#include <span>

namespace gpgp::vector {

struct AssetTable {
  shader::SlotRecord slots{};
  std::span<const shader::vec4> records; ///< the asset's own
  size_t first = 0;                      ///< where they begin in the buffer
  const shader::vec4& operator[](size_t i) const { return records[i - first]; }
};

/// By asset: kAssetBit.
inline const AssetTable& tableOf(std::span<const AssetTable> assets, uint32_t slot) {
  return assets[slot >> shader::kAssetBit];
}

} // namespace gpgp::vector
