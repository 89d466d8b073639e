#include "vector/passes/sizes.h"

#include "vector/passes/names.h"

#include <algorithm>

namespace gpgp::vector {

uint64_t CanvasSizes::tiles() const {
  return std::max(uint64_t(divide(maxWidth, shader::kTileSize)) * divide(maxHeight, shader::kTileSize),
                  uint64_t(layers.pixels) / (shader::kTileSize * shader::kTileSize));
}
uint32_t CanvasSizes::maxBins() const { // rows of bins that are not full, too
  constexpr uint32_t kLargest = shader::kTileSize << shader::kMaxBinShift;
  return layers.pixels / (kLargest * kLargest) + divide(maxWidth, kLargest) + 1;
}
uint32_t CanvasSizes::listWords() const { // 31 paths a tile, fewer where that would take more than 64 MiB
  return static_cast<uint32_t>(std::clamp<uint64_t>((uint64_t(16) << 20) / tiles(), 12, 64) & ~uint64_t(3));
}

uint64_t
CanvasSizes::binWords() const { // enough for any recording with the largest bins, or for most with the smallest
  constexpr uint32_t kLargest = shader::kTileSize << shader::kMaxBinShift;
  const uint64_t bins = std::max<uint64_t>(uint64_t(divide(maxWidth, kLargest)) * divide(maxHeight, kLargest),
                                           layers.pixels ? maxBins() : 0);
  const uint64_t least = bins * (divide(items.paths, 32) + shader::kBinHead);
  return software ? least : std::max(least, std::min<uint64_t>(least * 6, 16 << 20));
}
// Paths in the lists of all bins: most paths are in one or two.
uint32_t CanvasSizes::binLists() const { return software ? 0 : 2 * items.paths + 65536; }

uint64_t CanvasSizes::damageWords() const {
  return KeptRecording::damageWords(divide(maxWidth, shader::kTileSize), divide(maxHeight, shader::kTileSize));
}
uint64_t CanvasSizes::binsEnd() const {
  const uint64_t lists = tiles() * (software ? listWords() + 3 : 2) + binLists();
  // Of small glyphs alone the tiles have lists in place of bins and theirs, and some are left over.
  const uint64_t ofTiles = tiles() * shader::kTileListWords + uint64_t(smallGlyphRoom()) * 3;
  return shader::kFirstBin + std::max(binWords() + 3 + lists, software ? 0 : std::min<uint64_t>(ofTiles, 16 << 20));
}

} // namespace gpgp::vector
