// One invocation a chunk: finds the draw that it belongs to, once for all passes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
#define TABLE_ACCESS
#include "visibility/table.glsl"
#include "visibility/chunks.glsl"

void main() {
  uint chunks = chunkCount();
  for (uint chunk = gl_GlobalInvocationID.x; chunk < chunks; chunk += gl_NumWorkGroups.x * 256u) {
    uint low = 0u;
    uint high = params.entryCount - 1u;
    while (low < high) {
      uint middle = low + (high - low + 1u) / 2u;
      if (chunkStart(middle) <= chunk) low = middle;
      else high = middle - 1u;
    }
    table[chunkAt(chunk)] = low;
  }
}
