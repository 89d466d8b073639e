// The atlas's buffers, and what several passes ask of a triangle.
#include "visibility/atlas/atlas.h"

layout(std140, set = 0, binding = kAtlasParams) uniform ParamsBuffer { AtlasParams params; };
layout(std430, set = 0, binding = kAtlasHistory) buffer HistoryBuffer { uint history[]; };
layout(std430, set = 0, binding = kAtlasBits) readonly buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kAtlasCounters) buffer CounterBuffer { AtlasCounters counters; };
layout(std430, set = 0, binding = kAtlasCodes) buffer CodeBuffer { uint codes[]; };
layout(std430, set = 0, binding = kAtlasPlans) buffer PlanBuffer { uint plans[]; };
layout(std430, set = 0, binding = kAtlasRows) buffer RowBuffer { uint rows[]; };
layout(std430, set = 0, binding = kAtlasSupers) buffer SuperBuffer { uint supers[]; };
layout(std430, set = 0, binding = kAtlasLists) buffer ListBuffer { uvec2 lists[]; };
layout(std430, set = 0, binding = kAtlasHistogram) buffer HistogramBuffer { uint histogram[]; };

uint stateAt(uint triangle) { return kHeadWords + triangle; }
uint codeAt(uint triangle) { return kHeadWords + params.maxTriangles + triangle / 16u; }
uint rowAt(uint row, uint group) { return kRowCounts + row * params.groupCount + group; }

bool isVisible(uint triangle) {
  return triangle < params.triangleCount && (bits[triangle >> 5u] & (1u << (triangle & 31u))) != 0u;
}

/// Of a superblock: its words are kept blocks, class, bits of used places.
uint superAt(uint super) { return super * kSuperWords; }
