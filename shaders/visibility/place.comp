// One invocation a pair: puts it where its pixel's list has it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 256) in;

layout(std430, set = 0, binding = kBindParams) readonly buffer ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindSlots) readonly buffer SlotBuffer { uint slots[]; };
layout(std430, set = 0, binding = kBindPairs) readonly buffer PairBuffer { Pair pairs[]; };
layout(std430, set = 0, binding = kBindEntries) writeonly buffer EntryBuffer { Entry entries[]; };

void main() {
  uint count = min(counters.pairs, params.maxPairs);
  for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 256u) {
    Pair p = pairs[i];
    Entry e;
    e.candidate = p.candidate;
    e.key = p.key;
    entries[slots[p.slot] + p.place] = e;
  }
}
