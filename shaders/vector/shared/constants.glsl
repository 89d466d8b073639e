// What the host writes for a recording: placements, 3 vec4 each, then sources, 10 each, then the tables of shapes.
layout(set = 0, binding = kBindConstants, std430) readonly buffer From {
  CanvasHeader hostHeader;
  SlotRecord hostSlots[kSlots];
  vec4 from[];
};

ItemRecord sourceOf(uint i) {
  const uint at = hostHeader.itemCount * 3 + i * 10;
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
  item.smallGlyph = item.pad0 = 0;
  return item;
}

PlacementRecord placementOf(uint i) {
  const uint at = i * 3;
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
uint sourceIndex(PlacementRecord p) { return p.source & ((1u << kSlotBit) - 1); }
