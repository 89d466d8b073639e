// The numbers that are known last: how many were listed, and the engine's indirect dispatch over the list.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 1) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindChanged) writeonly buffer ChangedBuffer { uint changed[]; };
layout(std430, set = 0, binding = kBindCount) writeonly buffer CountBuffer { uint countAndArgs[]; };

void main() {
  uint listed = min(counters.visible, params.listCapacity);
  counters.listed = listed;
  // Pairs of tiles that found no room were not looked at: so many would have.
  if (counters.tilePairs > params.maxPairs / 2u)
    counters.pairs = max(counters.pairs, min(counters.tilePairs, 0x7fffffffu) * 2u);
  if ((params.hasList & 2u) != 0u) {
    changed[0] = counters.appeared;
    changed[1] = counters.disappeared;
    changed[2] = 0u;
    changed[3] = 0u;
    counters.changed = min(counters.appeared + counters.disappeared, params.changedCapacity);
  }
  if (params.writeCount == 0u) return;
  countAndArgs[0] = counters.visible;
  uvec3 groups = listGroups(listed);
  countAndArgs[1] = groups.x;
  countAndArgs[2] = groups.y;
  countAndArgs[3] = groups.z;
  if (params.writeCount > 1u) countAndArgs[4] = counters.drawsGiven;
}
