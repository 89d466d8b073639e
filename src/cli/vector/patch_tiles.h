// How a drawing's CPatches spread over the tiles of a picture: the thesis's table 5.1.
#pragma once
#include "vector/patch/drawing.h"

#include <span>

namespace gpgp::cli {

struct PatchTiles {
  size_t patches = 0;
  double curvesPerPatch = 0; ///< that bound a patch: its sides, and the lines above and below where they have length
  double patchesPerTile = 0; ///< patches that reach into a tile, over all tiles of the picture
  double curvesPerPatchTiled = 0; ///< of those that bound a patch, how many pass through a tile that it reaches into
};

/// Tiles are 8 x 8 pixels. The transform (drawing to pixel, x' = t0 x + t4, y' = t3 y + t5) scales and shifts only.
/// `next`, where it is given, has for each patch the one below that counts as the same patch; UINT32_MAX: none.
PatchTiles countPatchTiles(const vector::Drawing& drawing, const float (&transform)[6], uint32_t width, uint32_t height,
                           std::span<const uint32_t> next = {});

} // namespace gpgp::cli
