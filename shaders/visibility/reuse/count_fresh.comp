// How many triangles are at pixel centres, and how many of them were not visible in the history's previous recording.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindBits) readonly buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindView) readonly buffer ViewBuffer { uint viewBits[]; };

shared uint sums[2];

void main() {
  uint lane = gl_LocalInvocationIndex;
  if (lane < 2u) sums[lane] = 0u;
  barrier();
  uvec2 own = uvec2(0u);
  uint words = (params.triangleCount + 31u) / 32u;
  for (uint word = gl_GlobalInvocationID.x; word < words; word += gl_NumWorkGroups.x * 256u) {
    uint seen = bits[word];
    own += uvec2(bitCount(seen), bitCount(seen & ~viewBits[word]));
  }
  for (int i = 0; i < 2; ++i)
    if (own[i] != 0u) atomicAdd(sums[i], own[i]);
  barrier();
  if (lane == 0u && sums[0] != 0u) atomicAdd(counters.reuseSeen, sums[0]);
  if (lane == 1u && sums[1] != 0u) atomicAdd(counters.reuseFresh, sums[1]);
}
