// Ids of small triangles, one invocation each: only those that were the nearest in a pixel when they were drawn.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/fetch.glsl"
#include "visibility/standard/pixels.glsl"
#include "visibility/standard/draw_small.glsl"
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = kBindQueue) readonly buffer QueueBuffer { uint queue[]; };
layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };

void main() {
  uint count = counters.winnerCount;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) {
    uint item;
    Fetched f = fetchNumber(queue[params.maxItems - 1u - i], item);
    ScreenTriangle t;
    if (classifyFetched(f, t) == kWhole) drawSmall(t, drawnId(f.id, item));
  }
}
