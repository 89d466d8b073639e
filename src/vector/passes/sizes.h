// How much a canvas has room for, and what its lists take of that.
#pragma once
#include "vector/raster/gather.h"

namespace gpgp::vector {

struct CanvasSizes {
  uint32_t maxWidth, maxHeight; ///< pixels
  uint32_t maxEntries;          ///< tiles with edges, summed over paths
  uint32_t maxWords;            ///< tile words: 32 tiles of a row of a path each
  GpgpCanvasTargets targets;    ///< bits in the order of kNoImage, kHasImage8, kHasImage16
  ItemBudgets items;
  bool software; ///< the device has shaders without barriers
  LayerBudgets layers{};
  uint32_t maxTilePatches = 0;             ///< patches in tiles that their curves pass; 0: the canvas draws no patches
  uint32_t imagePages = 1, imageTiles = 0; ///< tiles: of colours that are found before the raster

  uint64_t tiles() const;     ///< of the canvas, or of pictures of layers
  uint32_t listWords() const; ///< of a tile's list on software devices
  uint64_t binWords() const;
  uint32_t binLists() const;    ///< paths in the lists of all bins
  uint64_t binsEnd() const;     ///< words that bins and all lists take
  uint64_t damageWords() const; ///< behind those (KeptRecording::damage)
  /// Tile entries that small glyphs may take.
  uint32_t smallGlyphRoom() const { return software ? 0 : maxEntries / 2; }
  /// Of the lists between mark and fill: rows of flattened segments, or pieces of them on software devices.
  uint32_t maxRows() const { return maxEntries * (software ? 4 : 8); }
  bool writes(uint32_t target) const { return targets >> target & 1; }
  /// Layers are rasterised as a history is.
  bool rasters(uint32_t target) const { return writes(target) || (target == 0 && layers.pixels); }
  uint32_t maxBins() const; ///< of the largest size, in pictures of layers
};

} // namespace gpgp::vector
