// From bits to a compact list, and the change since the last recording. One invocation a word of 32 triangles;
// a workgroup takes its places in the list with one atomic.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindBits) readonly buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindList) writeonly buffer ListBuffer { uint list[]; };
layout(std430, set = 0, binding = kBindView) buffer ViewBuffer { uint viewBits[]; };

shared uint groupVisible;
shared uint groupFirst;
shared uint groupAppeared;
shared uint groupDisappeared;

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint words = (params.triangleCount + 31u) / 32u;
  uint all_ = max(words, params.viewWords);
  uint stride = gl_NumWorkGroups.x * 256u;
  for (uint base = gl_WorkGroupID.x * 256u; base < all_; base += stride) {
    if (lane == 0u) {
      groupVisible = 0u;
      groupAppeared = 0u;
      groupDisappeared = 0u;
    }
    barrier();
    uint word = base + lane;
    uint now = word < words ? bits[word] : 0u;
    if (word + 1u == words) now &= 0xffffffffu >> (words * 32u - params.triangleCount); // what was there may have more
    uint place = now != 0u ? atomicAdd(groupVisible, uint(bitCount(now))) : 0u;
    if (word < params.viewWords) {
      uint before = viewBits[word];
      if (before != now) viewBits[word] = now;
      uint appeared = now & ~before;
      uint disappeared = before & ~now;
      if (appeared != 0u) atomicAdd(groupAppeared, uint(bitCount(appeared)));
      if (disappeared != 0u) atomicAdd(groupDisappeared, uint(bitCount(disappeared)));
    }
    barrier();
    if (lane == 0u) {
      groupFirst = groupVisible != 0u ? atomicAdd(counters.visible, groupVisible) : 0u;
      if (groupAppeared != 0u) atomicAdd(counters.appeared, groupAppeared);
      if (groupDisappeared != 0u) atomicAdd(counters.disappeared, groupDisappeared);
    }
    barrier();
    place += groupFirst;
    while (now != 0u && place < params.listCapacity) {
      list[place++] = word * 32u + uint(findLSB(now));
      now &= now - 1u;
    }
    barrier();
  }
}
