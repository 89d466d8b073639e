// The list of candidates that each pixel has, and its limit: a key behind which nothing is seen there. Pixels are
// numbered in tiles of 8 x 8, so that a workgroup's lists lie together. Needs `params`.
#include "visibility/candidate.h"

/// Limits, the lists' lengths, then the big candidates: regions of params.slotCapacity words, the last one longer.
layout(std430, set = 0, binding = kBindSlots) buffer SlotBuffer { uint slots[]; };

uint lengthAt(uint slot) { return params.slotCapacity + slot; }
uint bigAt(uint entry) { return params.slotCapacity * 2u + entry * 2u; }

uint tileColumns() { return (params.width + 7u) / 8u; }
uint tileCount() { return tileColumns() * ((params.height * params.cameraCount + 7u) / 8u); }
ivec2 pixelOf(uint slot) {
  uint tile = slot / 64u;
  return ivec2(int(tile % tileColumns() * 8u + (slot & 7u)), int(tile / tileColumns() * 8u + ((slot >> 3u) & 7u)));
}
uint slotOf(ivec2 pixel) {
  return (uint(pixel.y) / 8u * tileColumns() + uint(pixel.x) / 8u) * 64u + (uint(pixel.y) & 7u) * 8u +
         (uint(pixel.x) & 7u);
}
