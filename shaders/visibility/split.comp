// Sizes the dispatches over the two queues.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 1) in;

layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };

void main() {
  counters.mediumArgs[0] = min(counters.mediumCount, kMaxGroups); // medium.comp and large.comp stride beyond that
  counters.mediumArgs[1] = 1u;
  counters.mediumArgs[2] = 1u;
  counters.largeArgs[0] = min(counters.largeCount, kMaxGroups);
  counters.largeArgs[1] = kLargeSplit;
  counters.largeArgs[2] = 1u;
}
