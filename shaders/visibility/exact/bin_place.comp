// One invocation a pair of a candidate and a tile: puts it where the tile's candidates lie, those that are not seen yet
// first. Tiles of which all are seen get none.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };
#include "visibility/exact/lists.glsl"
layout(std430, set = 0, binding = kBindPairs) buffer PairBuffer { uint pairs[]; };

void main() {
  uint count = min(counters.tilePairs, maxTilePairs());
  for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 256u) {
    uint pair = i * kTilePairWords;
    if (pairs[pair] == kNoTile) continue;
    uint tile = tileWord(pairs[pair]);
    uint begin = slots[tile + 2u];
    if (begin == kNoTile) continue;
    uint candidate = pairs[pair + 1u];
    if (candidate >= kIsSeen) begin += slots[tile];
    pairs[placedAt(begin + pairs[pair + 2u])] = candidate & ~kIsSeen;
  }
}
