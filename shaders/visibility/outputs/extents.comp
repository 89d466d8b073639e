// One invocation a triangle: the projected size of each visible one, the largest of all cameras and draws.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/outputs/extent.h"
#include "visibility/shared/fetch.glsl"
#include "visibility/shared/chunks.glsl"
layout(local_size_x = 64) in; // kChunk

layout(std430, set = 0, binding = kBindBits) readonly buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindExtents) buffer ExtentBuffer { uint extents[]; };

void main() {
  uint chunks = chunkCount();
  for (uint chunk = gl_WorkGroupID.x; chunk < chunks; chunk += gl_NumWorkGroups.x) {
    uint entry = findChunk(chunk);
    uvec2 start = startOf(entry);
    if (start.x >= params.maxItems) break; // and so does all that follows
    uint end = min(entryOf(entry).indexCount / 3u, params.maxItems - start.x);
    uint local = (chunk - start.y) * kChunk + gl_LocalInvocationIndex;
    if (local >= end) continue;
    DrawEntry e = entryOf(entry);
    uint id;
    if (!fetchId(e, draws[e.draw].firstTriangle, local, id) || (bits[id >> 5u] & (1u << (id & 31u))) == 0u) continue;
    Fetched f = fetchTriangle(entry, local);
    Extent extent = noExtent();
    ScreenTriangle t;
    uint fate = classifyFetched(f, t);
    if (fate == kWhole) extent = withPiece(extent, t);
    if (fate == kClipped) {
      ScreenPolygon polygon;
      if (clipTriangle(f.a, f.b, f.c, gridOf(f.camera), f.mirrored, f.twoSided, polygon) != kClipped) continue;
      for (int k = 0; k + 2 < polygon.count; ++k)
        if (fanPiece(polygon, k, gridOf(f.camera), t)) extent = withPiece(extent, t);
    }
    uvec3 size = extentBits(extent);
    if (size.x == 0u) continue;
    atomicMax(extents[id * 3u], size.x);
    atomicMax(extents[id * 3u + 1u], size.y);
    atomicMax(extents[id * 3u + 2u], size.z);
  }
}
