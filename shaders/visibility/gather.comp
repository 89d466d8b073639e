// From ids per pixel to a bit per triangle (6.1.1: "gathering the ids").
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 256) in;

layout(std430, set = 0, binding = kBindParams) readonly buffer ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindIds) readonly buffer IdBuffer { uint ids[]; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };

shared uint groupCovered;

void main() {
  if (gl_LocalInvocationIndex == 0u) groupCovered = 0u;
  barrier();
  uint pixels = params.width * params.height;
  uint stride = gl_NumWorkGroups.x * 256u;
  uint covered = 0u;
  for (uint i = gl_GlobalInvocationID.x; i < pixels; i += stride) {
    uint id = ids[i];
    if (id == kNoTriangle) continue;
    ++covered;
    // A pixel whose neighbour has the same triangle leaves the bit to it; the first of the row's run sets it.
    if (i % params.width == 0u || ids[i - 1u] != id) atomicOr(bits[id >> 5u], 1u << (id & 31u));
  }
  if (covered != 0u) atomicAdd(groupCovered, covered);
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupCovered != 0u) atomicAdd(counters.coveredPixels, groupCovered);
}
