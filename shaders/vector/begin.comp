#version 460
// A record's constants to the device, as the passes would else wait for host memory at every read, with its items
// placed; and what they begin with: no path in any bin, nothing counted, no tile marked. Software devices clear the
// latter two faster by transfers.
#extension GL_GOOGLE_include_directive : require
#include "placement.h"
layout(local_size_x = 64) in;
// from[]: sources, 10 vec4 each, then placements, 3 each, then the tables of shapes.
layout(set = 0, binding = 11, std430) readonly buffer From {
  CanvasHeader header;
  SlotRecord slots[kSlots];
  vec4 from[];
};
layout(set = 0, binding = 17, std430) writeonly buffer To {
  CanvasHeader copied;
  SlotRecord copiedSlots[kSlots];
  uint firstItems[kFirstItems];
  ItemRecord items[];
};
layout(set = 0, binding = 14, std430) writeonly buffer Bins { uint bins[]; };
layout(set = 0, binding = 28, std430) writeonly buffer Shapes { vec4 shapes[]; };
#if !SOFTWARE
layout(set = 0, binding = 13, std430) writeonly buffer Words { uvec4 words[]; };
layout(set = 0, binding = 16, std430) buffer Counters { uvec4 counters[8]; }; // CanvasCounters
#endif

ItemRecord sourceOf(uint i) {
  const uint at = i * 10;
  ItemRecord item;
  item.inverse = from[at];
  item.transform = from[at + 1];
  item.offsets = from[at + 2];
  item.perspective = from[at + 3];
  item.eye = from[at + 4];
  item.color = from[at + 5];
  item.scissor = from[at + 6];
  const uvec4 first = floatBitsToUint(from[at + 7]), second = floatBitsToUint(from[at + 8]);
  item.side = uintBitsToFloat(first.x);
  item.slot = first.y;
  item.firstSegment = first.z;
  item.firstPath = first.w;
  item.segments = second.x;
  item.paths = second.y;
  item.firstImage = second.z;
  item.whole = second.w;
  const uvec2 around = floatBitsToUint(from[at + 9].xy);
  item.clip = around.x;
  item.layer = around.y;
  item.stamped = item.pad0 = 0;
  return item;
}

PlacementRecord placementOf(uint i) {
  const uint at = header.sourceCount * 10 + i * 3;
  const vec4 place = from[at];
  const uvec4 tables = floatBitsToUint(from[at + 2]);
  PlacementRecord p;
  p.x = place.x;
  p.y = place.y;
  p.size = place.z;
  p.source = floatBitsToUint(place.w);
  p.color = from[at + 1];
  p.firstSegment = tables.x;
  p.firstPath = tables.y;
  p.segments = tables.z;
  p.paths = tables.w;
  return p;
}

void main() {
  const uint lane = gl_GlobalInvocationID.x, lanes = gl_NumWorkGroups.x * 64;
#if !SOFTWARE
  for (uint i = lane; i < words.length(); i += lanes) words[i] = uvec4(0);
  if (lane == 0) {
    const uint before = counters[0].y; // entries of the record before, or anything at all
    for (uint k = 0; k < 8; ++k) counters[k] = uvec4(0, 0, 0, k == 5 ? min(before, header.entryLimit) : 0);
  }
#endif
  if (lane == 0) copied = header;
  if (lane < kSlots) copiedSlots[lane] = slots[lane];
  for (uint i = lane; i < header.itemCount; i += lanes) {
    const PlacementRecord p = placementOf(i);
    items[i] = placed(sourceOf(p.source & ((1u << kSlotBit) - 1)), p);
    if (header.itemCount <= kManyItems) continue;
    const uint step = firstItemsStep(header.segmentCount);
    const uint end = i + 1 < header.itemCount ? placementOf(i + 1).firstSegment : header.segmentCount;
    for (uint k = (p.firstSegment + step - 1) / step; k * step < end; ++k) firstItems[k] = i;
  }
  const uint tables = header.sourceCount * 10 + header.itemCount * 3;
  for (uint i = lane; i < header.shapeTables; i += lanes) shapes[i] = from[tables + i];
  const uint binWords = kFirstBin + header.binCount * header.binWords;
  for (uint i = lane; i < binWords; i += lanes) bins[i] = i < kFirstBin && i % 4 == 2 ? 1 : 0;
}
