// One invocation a pair: puts it into its pixel's list. Where the list begins becomes where it ends.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindSlots) buffer SlotBuffer { uint slots[]; };
layout(std430, set = 0, binding = kBindPairs) readonly buffer PairBuffer { uvec2 pairs[]; };
layout(std430, set = 0, binding = kBindEntries) writeonly buffer EntryBuffer { uint entries[]; };

void main() {
  uint count = min(counters.pairs, params.maxPairs);
  for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 256u) {
    uvec2 p = pairs[i];
    entries[atomicAdd(slots[p.x], 1u)] = p.y;
  }
}
