// One workgroup a triangle of up to 64 pixels' extent: its pixels are shared out.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/fetch.glsl"
#include "visibility/pixels.glsl"
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = kBindQueue) readonly buffer QueueBuffer { uint queue[]; };
layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };

shared ScreenTriangle triangle;
shared uint id;

void main() {
  uint count = counters.mediumCount;
  for (uint entry = gl_WorkGroupID.x; entry < count; entry += gl_NumWorkGroups.x) {
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
      Fetched f = fetchTriangle(queue[entry]);
      ScreenTriangle made;
      classifyFetched(f, made);
      triangle = made;
      id = f.id;
    }
    barrier();
    ScreenTriangle t = triangle;
    int width = t.bounds.z - t.bounds.x;
    int pixels = width * (t.bounds.w - t.bounds.y);
    for (int i = int(gl_LocalInvocationIndex); i < pixels; i += 64) {
      ivec2 pixel = t.bounds.xy + ivec2(i % width, i / width);
      float z;
      if (coversCompact(t, pixel, z)) coverPixel(pixel, z, id);
    }
  }
}
