// One invocation a pair of a candidate and a tile: puts it where the tile's candidates lie. Tiles of which all are
// seen get none.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };
#include "visibility/lists.glsl"
layout(std430, set = 0, binding = kBindPairs) buffer PairBuffer { uint pairs[]; };

void main() {
  uint count = min(counters.tilePairs, maxTilePairs());
  for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 256u) {
    uint pair = i * kTilePairWords;
    if (pairs[pair] == kNoTile) continue;
    uint begin = slots[tileWord(pairs[pair]) + 1u];
    if (begin != kNoTile) pairs[placedAt(begin + pairs[pair + 2u])] = pairs[pair + 1u];
  }
}
