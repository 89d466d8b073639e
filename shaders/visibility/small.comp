// One invocation a triangle: rejects, draws small ones at once and, in the depth phase, queues the others. Each item
// takes one place at most, so the queue never overflows.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/fetch.glsl"
#include "visibility/chunks.glsl"
#include "visibility/pixels.glsl"
layout(local_size_x = 64) in; // kChunk

layout(std430, set = 0, binding = kBindQueue) writeonly buffer QueueBuffer { uint queue[]; };

shared uint groupTriangles;
shared uint groupSkipped;

void drawSmall(ScreenTriangle t, uint id) {
  for (int y = t.bounds.y; y < t.bounds.w; ++y)
    for (int x = t.bounds.x; x < t.bounds.z; ++x) {
      float z;
      if (coversCompact(t, samplePoint(ivec2(x, y), grid()), z)) coverPixel(t, ivec2(x, y), z, id);
    }
}

void main() {
  if (gl_LocalInvocationIndex == 0u) {
    groupTriangles = 0u;
    groupSkipped = 0u;
  }
  barrier();
  uint chunks = counters.chunks;
  uint triangles = 0u;
  uint skipped = 0u;
  for (uint chunk = gl_WorkGroupID.x; chunk < chunks; chunk += gl_NumWorkGroups.x) {
    uint drawIndex = findChunk(chunk);
    uvec2 start = startOf(drawIndex);
    if (start.x >= params.maxItems) break; // and so does all that follows
    uint end = min(entryOf(drawIndex).indexCount / 3u, params.maxItems - start.x);
    uint local = (chunk - start.y) * kChunk + gl_LocalInvocationIndex;
    if (local >= end) continue;
    Fetched f = fetchTriangle(drawIndex, local);
    ScreenTriangle t;
    uint fate = classifyFetched(f, t);
    if (fate == kSkipped) ++skipped;
    if (fate == kWhole) ++triangles;
    if (fate == kWhole && isEmpty(t)) continue;
    if (fate == kWhole && isSmall(t)) {
      drawSmall(t, drawnId(f.id, start.x + local));
    } else if (kPhase == 0u && (fate == kWhole || fate == kClipped)) {
      uint entry = atomicAdd(counters.queueCount, 1u);
      queue[entry] = start.x + local;
      atomicMax(counters.unfoldArgs[0], min(entry / 64u + 1u, kMaxGroups));
    }
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
