// What the passes over patches share: their bindings, and how a shader reads patches and the items that they draw.
// GPGP_PATCH_LOAD: where the pass reads patches and curves; otherwise the drawings' buffers.
#ifndef GPGP_PATCH_LOAD
#define GPGP_PATCH_LOAD(slot, index) floatBitsToUint(fetch(slot, index))
#endif
#include "gpgp/shaders/patches.h"
#include "vector/patches/tile.h"
#if ONE_DRAWING
layout(set = 0, binding = kBindShapes, std430) readonly buffer Shapes { vec4 shapes[]; };
#endif
layout(set = 0, binding = kBindPatchBlocks, std430) buffer PatchBlocks { PatchPlaceRecord patchBlocks[]; };
layout(set = 0, binding = kBindTilePatches, std430) buffer TilePatches { PatchPlaceRecord tilePatches[]; };

PatchTableRecord patchTable() {
  const uvec4 counts = floatBitsToUint(shapes[header.patchTable]);
  return PatchTableRecord(counts.x, counts.y, counts.z, counts.w, 0, 0, 0, 0);
}
uint patchItemAt(uint i) { return header.patchTable + 2 + i * 7; } // its vec4
PatchItemRecord patchItem(uint i) {
  const uint at = patchItemAt(i);
  PatchItemRecord m;
  m.inverse0 = shapes[at];
  m.inverse1 = shapes[at + 1];
  m.inverse2 = shapes[at + 2];
  m.forward0 = shapes[at + 3];
  m.forward1 = shapes[at + 4];
  m.forward2 = shapes[at + 5];
  const uvec4 rest = floatBitsToUint(shapes[at + 6]);
  m.item = rest.x;
  m.firstPatch = rest.y;
  m.patches = rest.z;
  m.curves = rest.w;
  return m;
}
uint patchItemOf(uint patch_, uint count) { // of `count` the last one that begins at or before it
  uint low = 0, high = count;
  while (low + 1 < high) {
    const uint middle = (low + high) / 2;
    if (floatBitsToUint(shapes[patchItemAt(middle) + 6].y) <= patch_) low = middle;
    else high = middle;
  }
  return low;
}
TilePatch fetchTilePatch(uint slot, uint place) {
  const uvec4 rest = floatBitsToUint(fetch(slot, place + 3));
  return TilePatch(fetch(slot, place), rest.x, rest.y, rest.z, place);
}
