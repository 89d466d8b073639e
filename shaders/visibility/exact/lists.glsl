// The list of candidates that each pixel has, and its limit: a key behind which nothing is seen there. Pixels are
// numbered in tiles of 8 x 8 of one camera, so that a tile's lists lie together. Needs `params`.
#include "visibility/shared/candidate.h"

/// Limits (then where lists end), the lists' lengths, three words a tile (how many candidates reach over it that are
/// not seen yet, and that are; where they lie, in this order), the large candidates.
layout(std430, set = 0, binding = kBindSlots) buffer SlotBuffer { uint slots[]; };

uint lengthAt(uint slot) { return params.slotCapacity + slot; }
uint tileWord(uint tile) { return params.slotCapacity * 2u + tile * kTileWords; }
uint largeCandidateAt(uint entry) { return tileWord(params.slotCapacity / 64u) + entry * 2u; }

/// Of candidates and tiles there is room for half as many pairs as of candidates and pixels.
uint maxTilePairs() { return params.maxPairs / 2u; }
uint placedAt(uint i) { return maxTilePairs() * kTilePairWords + i; } // among the words of pairs

uint tileColumns() { return (params.width + 7u) / 8u; }
uint tileRows() { return (params.height + 7u) / 8u; } // of a camera
uint tileCount() { return tileColumns() * tileRows() * params.cameraCount; }
/// A tile's first pixel.
ivec2 cornerOf(uint tile) {
  uint row = tile / tileColumns();
  uint camera = params.cameraCount == 1u ? 0u : row / tileRows();
  return ivec2(int(tile % tileColumns() * 8u), int(camera * params.height + (row - camera * tileRows()) * 8u));
}
/// The tile of a camera's pixel.
uint tileOf(ivec2 pixel, uint camera) {
  uint row = uint(pixel.y) - camera * params.height;
  return (camera * tileRows() + row / 8u) * tileColumns() + uint(pixel.x) / 8u;
}
/// The tiles of a camera's pixels: the first, how many lie beside each other, how many there are.
uvec3 tilesOf(ivec4 bounds, uint camera) {
  uint top = camera * params.height;
  uint columns = uint(bounds.z - 1) / 8u - uint(bounds.x) / 8u + 1u;
  uint rows = (uint(bounds.w - 1) - top) / 8u - (uint(bounds.y) - top) / 8u + 1u;
  return uvec3(tileOf(bounds.xy, camera), columns, columns * rows);
}
ivec2 pixelOf(uint slot) { return cornerOf(slot / 64u) + ivec2(int(slot & 7u), int((slot >> 3u) & 7u)); }
uint slotOf(ivec2 pixel, uint camera) {
  uint row = uint(pixel.y) - camera * params.height;
  return tileOf(pixel, camera) * 64u + (row & 7u) * 8u + (uint(pixel.x) & 7u);
}
uint slotOf(ivec2 pixel) { return slotOf(pixel, uint(pixel.y) / params.height); }
