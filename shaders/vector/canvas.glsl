// The canvas's bindings, in the order of its resources (src/vector/raster/canvas.cpp).
#include "sample.h"

#define DRAWING(n) layout(set = 0, binding = n, std430) readonly buffer Drawing##n { uint drawing##n[]; };
layout(set = 0, binding = 11, std430) readonly buffer Constants {
  CanvasHeader header;
  SlotRecord slots[kMaxSlots];
  ItemRecord items[];
};
layout(set = 0, binding = 12, std430) buffer Patches { PatchRecord patches[]; };
layout(set = 0, binding = 13, std430) buffer Curves { CurveRecord curves[]; };
layout(set = 0, binding = 14, std430) buffer Paths { PathRecord paths[]; };
layout(set = 0, binding = 15, std430) buffer GroupBoxes { vec4 groupBoxes[]; };
layout(set = 0, binding = 16, std430) buffer CoarseMasks { uint coarseMasks[]; };
layout(set = 0, binding = 17, std430) buffer Tiles { uvec4 tiles[]; }; // first entry, entries, first patch, 0
layout(set = 0, binding = 18, std430) buffer PathCounts { uint pathCounts[]; };
layout(set = 0, binding = 19, std430) buffer Entries { uint entries[]; };
layout(set = 0, binding = 20, std430) buffer Counters { CanvasCounters counters; };
