// Gives the candidates of each tile that has some which are not seen yet their place: a workgroup sums how many 256
// tiles have and takes that much room. Also adds what is kept of the previous recording to the visible bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/exact/lists.glsl"
#include "visibility/reuse/reuse.glsl"
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };

shared uint sums[256];
shared uint first;

void addRetained() {
  uint words = (params.triangleCount + 31u) / 32u;
  for (uint word = gl_GlobalInvocationID.x; word < words; word += gl_NumWorkGroups.x * 256u) {
    uint retained = viewBits[retainedAt(word)];
    if (retained == 0u) continue;
    bits[word] |= retained;
    viewBits[retainedAt(word)] = 0u;
  }
}

void main() {
  if (params.reuse != 0u) addRetained();
  uint lane = gl_LocalInvocationIndex;
  if (gl_WorkGroupID.x == 0u && lane == 0u) {
    counters.placeArgs[0] = min((min(counters.tilePairs, maxTilePairs()) + 255u) / 256u, kMaxGroups);
    counters.placeArgs[1] = 1u;
    counters.placeArgs[2] = 1u;
  }
  for (uint begin = gl_WorkGroupID.x * 256u; begin < tileCount(); begin += gl_NumWorkGroups.x * 256u) {
    uint tile = begin + lane;
    bool open = tile < tileCount() && slots[tileWord(tile)] != 0u;
    uint n = open ? slots[tileWord(tile)] + slots[tileWord(tile) + 1u] : 0u;
    sums[lane] = n;
    barrier();
    for (uint step = 1u; step < 256u; step *= 2u) {
      uint before = lane >= step ? sums[lane - step] : 0u;
      barrier();
      sums[lane] += before;
      barrier();
    }
    if (lane == 0u) first = atomicAdd(counters.placedCount, sums[255]);
    barrier();
    if (tile < tileCount()) slots[tileWord(tile) + 2u] = open ? first + sums[lane] - n : kNoTile;
    barrier();
  }
}
