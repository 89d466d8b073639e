// One invocation a triangle: rejects, draws small ones at once and, in the depth phase, queues the others. Medium ones
// go to the queue's front and large or clipped ones to its back; each item takes one place at most, so the queue never
// overflows.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/fetch.glsl"
#include "visibility/pixels.glsl"
layout(local_size_x = 128) in;

layout(std430, set = 0, binding = kBindQueue) writeonly buffer QueueBuffer { uint queue[]; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };

shared uint groupTriangles;
shared uint groupSkipped;

void drawSmall(ScreenTriangle t, uint id) {
  for (int y = t.bounds.y; y < t.bounds.w; ++y)
    for (int x = t.bounds.x; x < t.bounds.z; ++x) {
      float z;
      if (coversCompact(t, ivec2(x, y), z)) coverPixel(ivec2(x, y), z, id);
    }
}

void main() {
  if (gl_LocalInvocationIndex == 0u) {
    groupTriangles = 0u;
    groupSkipped = 0u;
  }
  barrier();
  uint items = min(counters.items, params.maxItems);
  uint stride = gl_NumWorkGroups.x * 128u;
  uint triangles = 0u;
  uint skipped = 0u;
  for (uint item = gl_GlobalInvocationID.x; item < items; item += stride) {
    Fetched f = fetchTriangle(item);
    ScreenTriangle t;
    uint fate = classifyFetched(f, t);
    if (fate == kSkipped) ++skipped;
    if (fate == kWhole) ++triangles;
    if (fate == kWhole && isEmpty(t)) continue;
    if (fate == kWhole && isSmall(t)) drawSmall(t, f.id);
    else if (kPhase == 0u && fate == kWhole && isCompact(t)) queue[atomicAdd(counters.mediumCount, 1u)] = item;
    else if (kPhase == 0u && (fate == kWhole || fate == kClipped))
      queue[params.maxItems - 1u - atomicAdd(counters.largeCount, 1u)] = item;
  }
  if (kPhase != 0u) return;
  if (triangles != 0u) atomicAdd(groupTriangles, triangles);
  if (skipped != 0u) atomicAdd(groupSkipped, skipped);
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    if (groupTriangles != 0u) atomicAdd(counters.triangles, groupTriangles);
    if (groupSkipped != 0u) atomicAdd(counters.skippedTriangles, groupSkipped);
  }
}
