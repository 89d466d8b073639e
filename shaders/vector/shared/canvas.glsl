// The canvas's bindings, in the order of its resources (src/vector/passes/builder.cpp), and what passes share.
#ifndef SCISSORS // only recordings of several drawings have any
#if ONE_DRAWING
#define SCISSORS 0
#else
#define SCISSORS 1
#endif
#endif
#include "vector/shared/edge.h"
#include "vector/shared/shape.h"
#include "vector/shared/tiles.h"

#ifndef SHARING // coherent, in passes whose last workgroup reads what the others wrote
#define SHARING
#endif
#define DRAWING(n) layout(set = 0, binding = n, std430) readonly buffer Drawing##n { vec4 drawing##n[]; };
#if ONE_DRAWING
DRAWING(0)
#else
DRAWING(0) DRAWING(1) DRAWING(2) DRAWING(3) DRAWING(4) DRAWING(5) DRAWING(6) DRAWING(7)
layout(set = 0, binding = kBindShapes, std430) readonly buffer Shapes { vec4 shapes[]; };
#endif
#if SOFTWARE // read where all invocations are, at the beginning of main, as elsewhere each reads for itself
#define HEADER headerOfRecord
#else
#define HEADER header
#endif
layout(set = 0, binding = kBindItems, std430) readonly buffer Constants {
  CanvasHeader HEADER;
  SlotRecord slots[kSlots];
  uint firstItems[kFirstItems]; // that segment 0, step, 2 step ... belong to; only of many items
  ItemRecord items[];
};
#if SOFTWARE
CanvasHeader header = headerOfRecord;
#endif
layout(set = 0, binding = kBindPaths, std430) SHARING buffer Paths { PlacedPath paths[]; };
layout(set = 0, binding = kBindWords, std430) SHARING buffer Words { TileWord words[]; };
layout(set = 0, binding = kBindBins, std430) buffer Bins { uint bins[]; };
layout(set = 0, binding = kBindCounters, std430) SHARING buffer Counters { CanvasCounters counters; };
#if SOFTWARE // to which four words cost little more than one
layout(set = 0, binding = kBindPaths, std430) SHARING buffer PathVectors { uvec4 pathVectors[]; };
layout(set = 0, binding = kBindWords, std430) SHARING buffer WordVectors { uvec4 wordVectors[]; };
layout(set = 0, binding = kBindBins, std430) buffer BinPairs { uvec2 binPairs[]; };
layout(set = 0, binding = kBindBins, std430) buffer BinVectors { uvec4 binVectors[]; };
#endif

#if ONE_DRAWING // a recording of one drawing need not choose at each access
vec4 fetch(uint slot, uint i) { return drawing0[i]; }
#else
#if SOFTWARE // one after another: a compiler that walks all paths through a loop takes nine times as long a switch
vec4 fetch(uint slot, uint i) {
  vec4 v = vec4(0);
  const uint from = slot & kBufferMask;
  if (from == 0) v = drawing0[i];
  if (from == 1) v = drawing1[i];
  if (from == 2) v = drawing2[i];
  if (from == 3) v = drawing3[i];
  if (from == 4) v = drawing4[i];
  if (from == 5) v = drawing5[i];
  if (from == 6) v = drawing6[i];
  if (from == 7) v = drawing7[i];
  if (from > 7) v = shapes[i];
  return v;
}
#else
vec4 fetch(uint slot, uint i) {
  switch (slot & kBufferMask) {
  case 0: return drawing0[i];
  case 1: return drawing1[i];
  case 2: return drawing2[i];
  case 3: return drawing3[i];
  case 4: return drawing4[i];
  case 5: return drawing5[i];
  case 6: return drawing6[i];
  case 7: return drawing7[i];
  default: return shapes[i];
  }
}
#endif
#endif

SlotRecord tablesOf(uint slot) {
#if ONE_DRAWING
  return slots[1];
#else
  const uvec4 tables = floatBitsToUint(shapes[header.assets + (slot >> kAssetBit)]);
  return SlotRecord(tables.x, tables.y, tables.z, tables.w);
#endif
}

#if !ONE_DRAWING
ShapeRecord shapeOf(ItemRecord item) {
  ShapeRecord s;
  s.box = shapes[item.paths];
  s.radii = shapes[item.paths + 1];
  s.frame = shapes[item.paths + 2];
  const vec4 rest = shapes[item.paths + 3];
  s.border = rest.x;
  s.ratio = rest.y;
  s.paint = floatBitsToUint(rest.z);
  s.kind = floatBitsToUint(rest.w);
  return s;
}
#endif

// Segment i of the recording, which is one of the item's.
SegmentRecord fetchSegment(ItemRecord item, uint i) {
#if !ONE_DRAWING
  if (item.slot == kShapeSlot) return shapeSegment(shapeOf(item), i - item.firstSegment);
#endif
  const uint at = item.segments + (i - item.firstSegment) * 4;
  SegmentRecord s;
  s.first = fetch(item.slot, at);
  s.second = fetch(item.slot, at + 1);
  s.ends = fetch(item.slot, at + 2);
  const vec4 rest = fetch(item.slot, at + 3);
  s.path = floatBitsToUint(rest.x);
  s.side = rest.y;
  s.line = floatBitsToUint(rest.z);
  s.pad0 = 0;
  return s;
}

// The item that path i of the recording belongs to: the last one that begins at or before it.
uint itemOfPath(uint i) {
  // In a text most have one path, so what lies as far along is tried first.
  const uint guess = uint(float(i) * (float(header.itemCount) / float(header.pathCount)));
  const bool last = guess + 1 >= header.itemCount;
  if (guess < header.itemCount && items[guess].firstPath <= i && (last || items[guess + 1].firstPath > i)) return guess;
  uint low = 0, high = header.itemCount;
  while (low + 1 < high) {
    const uint middle = (low + high) / 2;
    if (items[middle].firstPath <= i) low = middle;
    else high = middle;
  }
  return low;
}
// Where paths from `cut` on are left out, that or the begin of the item which must not be cut.
uint wholeItems(uint cut) {
  if (cut >= header.pathCount) return cut;
  const uint item = itemOfPath(cut);
  return items[item].whole != 0 ? items[item].firstPath : cut;
}

#if SOFTWARE
PlacedPath fetchPath(uint i) {
  const uvec4 box = pathVectors[i * 3], rest = pathVectors[i * 3 + 1];
  return PlacedPath(box.x, box.y, box.z, box.w, rest.x, rest.y, rest.z, rest.w,
                    uintBitsToFloat(pathVectors[i * 3 + 2]));
}
TileWord fetchTileWord(uint i) {
  const uvec4 word = wordVectors[i];
  return TileWord(word.x, word.y, word.z, word.w);
}
#endif
uint groupIndex() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
#if SOFTWARE // whose threads take a run of workgroups each: neighbours, which are alike, lie in different ones
uint spreadIndex() { return gl_WorkGroupID.x * gl_NumWorkGroups.y + gl_WorkGroupID.y; }
#endif
uint wordsInRow(PlacedPath p) { return (p.right - p.left + 31) / 32; }
#ifndef SAMPLES // of the recordings that a shader is for
#define SAMPLES header.samples
#endif
Grid canvasGrid() { return Grid(SAMPLES, int(header.height * SAMPLES), int(header.width)); }
// The bits of a bin begin there; and a tile's bin.
uint bitsOf(uint bin) { return kFirstBin + bin * header.binWords + kBinHead; }
uint binOf(uvec2 tile) { return (tile.y >> header.binShift) * header.binsX + (tile.x >> header.binShift); }
uint clipRecord(uint clip) { return slots[0].clips + clip - 1; } // its vec4
vec2 canvasTiles() { return vec2(header.tilesX, header.tilesY); }

// Whether a tile is drawn: others keep what a recording before has left. A bit for each, by rows of whole words.
uint damageInRow() { return (header.tilesX + 31) / 32; }
bool damaged(uvec2 tile) {
  return header.damage == 0 ||
         (bins[header.damage + tile.y * damageInRow() + tile.x / 32] >> (tile.x & 31) & 1) != 0;
}
const uint kManyDamageWords = 1024;
// Whether one of a box of tiles is drawn, or the box is large; left, top, right, bottom, exclusive.
bool damagedBox(uvec4 box) {
  if (header.damage == 0) return true;
  if (box.x >= box.z || box.y >= box.w) return false;
  const uint first = box.x / 32, last = (box.z - 1) / 32;
  if ((last - first + 1) * (box.w - box.y) > kManyDamageWords) return true;
  for (uint row = box.y; row < box.w; ++row)
    for (uint word = first; word <= last; ++word) {
      uint bits = bins[header.damage + row * damageInRow() + word];
      if (word == first) bits &= ~0u << (box.x & 31);
      if (word == last) bits &= ~0u >> (31 - (box.z - 1 & 31));
      if (bits != 0) return true;
    }
  return false;
}

// What a path does to a tile: 0 nothing, 1 it covers all, 2 + entry * 4 + inside: it has edges there.
uint coverageOf(PlacedPath p, uvec2 tile) {
  if (tile.x < p.left || tile.x >= p.right || tile.y < p.top || tile.y >= p.bottom) return 0;
  const uint bit = tile.x - p.left;
  const TileWord w = words[p.firstWord + (tile.y - p.top) * wordsInRow(p) + bit / 32];
  const uint inside = w.inside >> (bit & 31) & 1, mask = 1u << (bit & 31);
  return (w.edges & mask) == 0 ? inside : (w.firstEntry + bitCount(w.edges & (mask - 1))) * 4 + 2 + inside;
}
