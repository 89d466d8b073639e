// One invocation a small triangle that is seen at a pixel's centre: enters it where others are entered, which it may
// hide.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/fetch.glsl"
#include "visibility/lists.glsl"
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/enter.glsl"
#include "visibility/small_pairs.glsl"
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = kBindQueue) readonly buffer QueueBuffer { uint queue[]; };

void main() {
  uint count = counters.seenCount;
  for (uint first = gl_WorkGroupID.x * 64u; first < count; first += gl_NumWorkGroups.x * 64u) {
    uvec2 mask = uvec2(0u);
    ScreenTriangle t;
    uint id = 0u;
    ivec4 bounds = ivec4(0);
    uint entry = first + gl_LocalInvocationIndex;
    if (entry < count) {
      uint item;
      Fetched f = fetchNumber(queue[entry], item);
      id = f.id;
      if (classifyFetched(f, t) == kWhole) {
        bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(f.camera));
        mask = wantedPixels(t, bounds, true);
      }
    }
    enterSmall(t, id, bounds.xy, mask);
  }
}
