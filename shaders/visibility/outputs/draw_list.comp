// Writes the lists by draw: a workgroup takes its chunk's places with one atomic.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TABLE_ACCESS
#include "visibility/outputs/draw_chunks.glsl"

layout(std430, set = 0, binding = kBindDrawIndices) writeonly buffer DrawIndexBuffer { uint drawIndices[]; };
layout(std430, set = 0, binding = kBindDrawTriangles) writeonly buffer DrawTriangleBuffer { uint drawTriangles[]; };

shared uint groupCount;
shared uint groupFirst;

void main() {
  uint chunks = counters.drawChunks;
  for (uint chunk = gl_WorkGroupID.x; chunk < chunks; chunk += gl_NumWorkGroups.x) {
    if (gl_LocalInvocationIndex == 0u) groupCount = 0u;
    barrier();
    Listed l = listedOf(chunk);
    uint place = 0u;
    if (l.listed) place = atomicAdd(groupCount, 1u);
    barrier();
    if (gl_LocalInvocationIndex == 0u && groupCount != 0u)
      groupFirst = atomicAdd(table[params.maxEntries * kTablePlaces + l.entry], groupCount);
    barrier();
    if (l.listed) {
      place += groupFirst;
      if (place < params.drawListCapacity) {
        if (params.hasDrawTriangles != 0u) drawTriangles[place] = l.id;
        if (params.hasDrawIndices != 0u)
          for (uint k = 0u; k < 3u; ++k) drawIndices[place * 3u + k] = fetchIndex(l.index + k);
      }
    }
    barrier();
  }
}
