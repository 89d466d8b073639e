// Numbers the work: each draw's first item (triangle) and first chunk are the sums over the draws before it. A chunk
// holds triangles of one draw only, so that a workgroup reads one transform. One workgroup: each invocation sums a run
// of draws, the sums are scanned, and the runs are written.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 256) in;

layout(std430, set = 0, binding = kBindParams) readonly buffer ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindDraws) readonly buffer DrawBuffer { Draw draws[]; };
layout(std430, set = 0, binding = kBindMeshes) readonly buffer MeshBuffer { Mesh meshes[]; };
layout(std430, set = 0, binding = kBindStarts) writeonly buffer StartBuffer { uvec2 starts[]; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };

shared uvec2 sums[256];
shared uint skipped;

/// Sums stay at 2^32 - 1: more is beyond every budget.
uvec2 saturatedSum(uvec2 a, uvec2 b) {
  uvec2 sum = a + b;
  return uvec2(sum.x < a.x ? 0xffffffffu : sum.x, sum.y < a.y ? 0xffffffffu : sum.y);
}

/// Triangles and chunks of a draw; none where there is no such mesh.
uvec2 sizeOf(uint draw, inout uint bad) {
  uint mesh = draws[draw].mesh;
  if (mesh >= params.meshCount) {
    ++bad;
    return uvec2(0u);
  }
  uint triangles = meshes[mesh].indexCount / 3u;
  return uvec2(triangles, (triangles + kChunk - 1u) / kChunk);
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  if (lane == 0u) skipped = 0u;
  barrier();
  uint run = (params.drawCount + 255u) / 256u;
  uint first = min(lane * run, params.drawCount);
  uint end = min(first + run, params.drawCount);
  uvec2 own = uvec2(0u);
  uint bad = 0u;
  for (uint i = first; i < end; ++i) own = saturatedSum(own, sizeOf(i, bad));
  if (bad != 0u) atomicAdd(skipped, bad);
  sums[lane] = own;
  barrier();
  for (uint step = 1u; step < 256u; step *= 2u) {
    uvec2 before = lane >= step ? sums[lane - step] : uvec2(0u);
    barrier();
    sums[lane] = saturatedSum(sums[lane], before);
    barrier();
  }
  uvec2 start = lane == 0u ? uvec2(0u) : sums[lane - 1u];
  uint ignored = 0u;
  for (uint i = first; i < end; ++i) {
    starts[i] = start;
    start = saturatedSum(start, sizeOf(i, ignored));
  }
  if (lane == 255u) {
    counters.items = sums[255].x;
    counters.chunks = sums[255].y;
    counters.skippedDraws = skipped;
    counters.hasList = params.hasList;
    // The shaders stride beyond kMaxGroups. Later passes raise the x of the other dispatches.
    counters.smallArgs[0] = min(sums[255].y, kMaxGroups);
    counters.smallArgs[1] = 1u;
    counters.smallArgs[2] = 1u;
    counters.unfoldArgs[1] = 1u;
    counters.unfoldArgs[2] = 1u;
    counters.mediumArgs[1] = 1u;
    counters.mediumArgs[2] = 1u;
    counters.largeArgs[1] = 1u;
    counters.largeArgs[2] = 1u;
    counters.bigUnfoldArgs[1] = 1u;
    counters.bigUnfoldArgs[2] = 1u;
    counters.bigArgs[1] = 1u;
    counters.bigArgs[2] = 1u;
    counters.seenArgs[1] = 1u;
    counters.seenArgs[2] = 1u;
    counters.openArgs[1] = 1u;
    counters.openArgs[2] = 1u;
    counters.leftArgs[1] = kLargeSplit;
    counters.leftArgs[2] = 1u;
  }
}
