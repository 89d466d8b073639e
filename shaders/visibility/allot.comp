// Gives each pixel's list its place: a workgroup sums the lengths of four tiles of 8 x 8 pixels and takes that much
// room, and notes the pixels that have one: short lists from one end, long ones from the other.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindOpen) writeonly buffer OpenBuffer { uint open[]; };
#include "visibility/lists.glsl"

shared uvec3 sums[256]; // entries, pixels with short lists, with long ones
shared uvec3 first;

void main() {
  uint lane = gl_LocalInvocationIndex;
  if (gl_WorkGroupID.x == 0u && lane == 0u) {
    counters.placeArgs[0] = min((min(counters.pairs, params.maxPairs) + 255u) / 256u, kMaxGroups);
    counters.placeArgs[1] = 1u;
    counters.placeArgs[2] = 1u;
  }
  uint all_ = tileCount() * 64u;
  for (uint begin = gl_WorkGroupID.x * 256u; begin < all_; begin += gl_NumWorkGroups.x * 256u) {
    uint slot = begin + lane;
    uint n = slot < all_ ? slots[lengthAt(slot)] : 0u;
    uvec3 own = uvec3(n, n != 0u && n <= kBatch ? 1u : 0u, n > kBatch ? 1u : 0u);
    sums[lane] = own;
    barrier();
    for (uint step = 1u; step < 256u; step *= 2u) {
      uvec3 before = lane >= step ? sums[lane - step] : uvec3(0u);
      barrier();
      sums[lane] += before;
      barrier();
    }
    if (lane == 0u && sums[255].x != 0u) {
      first = uvec3(atomicAdd(counters.entryCount, sums[255].x), atomicAdd(counters.openCount, sums[255].y),
                    atomicAdd(counters.longCount, sums[255].z));
      atomicMax(counters.openArgs[0], min(first.y + sums[255].y, kMaxGroups));
      atomicMax(counters.longArgs[0], min(first.z + sums[255].z, kMaxGroups));
    }
    barrier();
    if (n != 0u) {
      uvec3 place = first + sums[lane] - own;
      slots[slot] = place.x;
      open[n <= kBatch ? place.y : params.pixelCapacity - 1u - place.z] = slot;
    }
    barrier();
  }
}
