#version 460
// A recording's constants to the device, as the passes would else wait for host memory at every read, with its items
// placed; and what they begin with: no path in any bin, nothing counted, no tile marked. Software devices clear the
// latter two faster by transfers. ALONE: where there are small glyphs alone, the small glyphs pass places them, and
// tiles have lists.
#extension GL_GOOGLE_include_directive : require
#include "vector/place/placement.h"
#include "vector/shared/constants.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = kBindItems, std430) writeonly buffer To {
  CanvasHeader copied;
  SlotRecord copiedSlots[kSlots];
  uint firstItems[kFirstItems];
  ItemRecord items[]; // ALONE: sources
};
layout(set = 0, binding = kBindBins, std430) writeonly buffer Bins { uint bins[]; };
#if ALONE
layout(set = 0, binding = kBindCounters, std430) writeonly buffer Counters { CanvasCounters counters; };
#else
layout(set = 0, binding = kBindShapes, std430) writeonly buffer Shapes { vec4 shapes[]; };
#if !SOFTWARE
layout(set = 0, binding = kBindWords, std430) writeonly buffer Words { uvec4 words[]; };
layout(set = 0, binding = kBindCounters, std430) buffer Counters { uvec4 counters[10]; }; // CanvasCounters
#endif
#endif

void copyDamage(CanvasHeader header, uint lane, uint lanes) {
  const uint tables = header.sourceCount * 10 + header.itemCount * 3 + header.shapeTables;
  const uint count = header.damage == 0 ? 0 : (header.tilesX + 31) / 32 * header.tilesY;
  for (uint i = lane; i < count; i += lanes) bins[header.damage + i] = floatBitsToUint(from[tables + i / 4][i % 4]);
}

void main() {
  const uint lane = gl_GlobalInvocationID.x, lanes = gl_NumWorkGroups.x * 64;
  const CanvasHeader header = hostHeader;
  if (lane == 0) copied = header;
  if (lane < kSlots) copiedSlots[lane] = hostSlots[lane];
  copyDamage(header, lane, lanes);
#if ALONE
  if (lane == 0)
    counters = CanvasCounters(0, 0, header.pathCount, header.pathsDropped, header.wordLimit, header.entryLimit, 0, 0,
                              header.pathsNeeded, 0, 0, 0, 0, header.glyphs, header.glyphLimit, header.shapes,
                              header.shapeLimit, header.sources, header.sourceLimit, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                              0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
  for (uint i = lane; i < header.sourceCount; i += lanes) items[i] = sourceOf(i);
  for (uint i = lane; i < header.tilesX * header.tilesY; i += lanes) bins[kFirstBin + i * kTileListWords] = 0;
#else
#if !SOFTWARE
  for (uint i = lane; i < words.length(); i += lanes) words[i] = uvec4(0);
  if (lane == 0) {
    const uint before = counters[0].y; // entries of the recording before, or anything at all
    for (uint k = 0; k < 10; ++k) counters[k] = uvec4(0, 0, 0, k == 5 ? min(before, header.entryLimit) : 0);
  }
#endif
  for (uint i = lane; i < header.itemCount; i += lanes) {
    const PlacementRecord p = placementOf(i);
    items[i] = placed(sourceOf(sourceIndex(p)), p);
    if (header.itemCount <= kManyItems) continue;
    const uint step = firstItemsStep(header.segmentCount);
    const uint end = i + 1 < header.itemCount ? placementOf(i + 1).firstSegment : header.segmentCount;
    for (uint k = (p.firstSegment + step - 1) / step; k * step < end; ++k) firstItems[k] = i;
  }
  const uint tables = header.sourceCount * 10 + header.itemCount * 3;
  for (uint i = lane; i < header.shapeTables; i += lanes) shapes[i] = from[tables + i];
  const uint binWords = kFirstBin + header.binCount * header.binWords;
  for (uint i = lane; i < binWords; i += lanes) bins[i] = i < kFirstBin && i % 4 == 2 ? 1 : 0;
#endif
}
