// How many triangles of each draw are listed.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TABLE_ACCESS
#include "visibility/outputs/draw_chunks.glsl"

shared uint groupCount;

void main() {
  uint chunks = counters.drawChunks;
  for (uint chunk = gl_WorkGroupID.x; chunk < chunks; chunk += gl_NumWorkGroups.x) {
    if (gl_LocalInvocationIndex == 0u) groupCount = 0u;
    barrier();
    Listed l = listedOf(chunk);
    if (l.listed) atomicAdd(groupCount, 1u);
    barrier();
    if (gl_LocalInvocationIndex == 0u && groupCount != 0u)
      atomicAdd(table[params.maxEntries * kTableCounts + l.entry], groupCount);
    barrier();
  }
}
