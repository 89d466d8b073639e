// Numbers the work items: each draw's first item is the sum of the triangles of the draws before it. One workgroup: each
// invocation sums a run of draws, the sums are scanned, and the runs are written.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 256) in;

layout(std430, set = 0, binding = kBindParams) readonly buffer ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindDraws) readonly buffer DrawBuffer { Draw draws[]; };
layout(std430, set = 0, binding = kBindMeshes) readonly buffer MeshBuffer { Mesh meshes[]; };
layout(std430, set = 0, binding = kBindStarts) writeonly buffer StartBuffer { uint starts[]; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };

shared uint sums[256];
shared uint skipped;

/// Sums stay at 2^32 - 1: more is beyond every budget.
uint saturatedSum(uint a, uint b) { return a + b < a ? 0xffffffffu : a + b; }

uint trianglesOf(uint draw, inout uint bad) {
  uint mesh = draws[draw].mesh;
  if (mesh >= params.meshCount) {
    ++bad;
    return 0u;
  }
  return meshes[mesh].indexCount / 3u;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  if (lane == 0u) skipped = 0u;
  barrier();
  uint run = (params.drawCount + 255u) / 256u;
  uint first = min(lane * run, params.drawCount);
  uint end = min(first + run, params.drawCount);
  uint own = 0u;
  uint bad = 0u;
  for (uint i = first; i < end; ++i) own = saturatedSum(own, trianglesOf(i, bad));
  if (bad != 0u) atomicAdd(skipped, bad);
  sums[lane] = own;
  barrier();
  for (uint step = 1u; step < 256u; step *= 2u) {
    uint before = lane >= step ? sums[lane - step] : 0u;
    barrier();
    sums[lane] = saturatedSum(sums[lane], before);
    barrier();
  }
  uint start = lane == 0u ? 0u : sums[lane - 1u];
  uint ignored = 0u;
  for (uint i = first; i < end; ++i) {
    starts[i] = start;
    start = saturatedSum(start, trianglesOf(i, ignored));
  }
  if (lane == 255u) {
    uint items = sums[255];
    counters.items = items;
    counters.skippedDraws = skipped;
    counters.hasList = params.hasList;
    uint groups = (min(items, params.maxItems) + 127u) / 128u; // small.comp strides beyond the limit
    counters.smallArgs[0] = min(groups, kMaxGroups);
    counters.smallArgs[1] = 1u;
    counters.smallArgs[2] = 1u;
  }
}
