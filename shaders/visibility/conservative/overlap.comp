// One invocation a triangle: rejects, visits the pixels of those of at most 8 x 8 pixels, and queues the others: those
// of more than 64 such blocks, and those that are clipped, from the queue's end.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/fetch.glsl"
#include "visibility/shared/chunks.glsl"
#include "visibility/conservative/overlap.glsl"
layout(local_size_x = 64) in; // kChunk

layout(std430, set = 0, binding = kBindQueue) writeonly buffer QueueBuffer { uint queue[]; };

void main() {
  uint kept = keptCount();
  for (uint i = gl_WorkGroupID.x; i < kept; i += gl_NumWorkGroups.x) {
    uint chunk = keptChunk(i);
    uint entry = findChunk(chunk);
    uvec2 start = startOf(entry);
    if (start.x >= params.maxItems) continue;
    uint end = min(entryOf(entry).indexCount / 3u, params.maxItems - start.x);
    uint local = (chunk - start.y) * kChunk + gl_LocalInvocationIndex;
    if (local >= end) continue;
    Fetched f = fetchTriangle(entry, local);
    if (!f.valid || !isAsked(f.id)) continue;
    ScreenTriangle t;
    uint fate = classifyFetched(f, t);
    bool wide = fate == kClipped;
    bool queued = wide;
    if (fate == kWhole) {
      ivec4 bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(f.camera));
      if (bounds.x >= bounds.z || bounds.y >= bounds.w || tooLarge(t)) continue;
      uvec2 blocks = uvec2(bounds.zw - bounds.xy + 7) / 8u;
      queued = blocks.x * blocks.y > 1u;
      wide = blocks.x * blocks.y > kSliceBlocks;
      if (!queued) {
        Visitor v;
        v.id = f.id;
        v.normal = normalOf(f.worldA, f.worldB, f.worldC);
        v.perspective = isPerspective(viewProjection(f.camera));
        vec3 depths = wholeDepths(f.a, f.b, f.c, t, gridOf(f.camera), v.perspective);
        for (int y = bounds.y; y < bounds.w; ++y)
          for (int x = bounds.x; x < bounds.z; ++x) visit(v, t, true, depths, ivec2(x, y));
      }
    }
    if (wide) {
      uint place = atomicAdd(counters.splitCount, 1u);
      queue[params.maxItems - 1u - place] = start.x + local;
      atomicMax(counters.splitArgs[0], min(place + 1u, kMaxGroups));
    } else if (queued) {
      uint place = atomicAdd(counters.overlapCount, 1u);
      queue[place] = start.x + local;
      atomicMax(counters.overlapArgs[0], min(place + 1u, kMaxGroups));
    }
  }
}
