// Empties what the other passes accumulate into: depth, ids, visible bits, counters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 256) in;

layout(std430, set = 0, binding = kBindParams) readonly buffer ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindDepth) writeonly buffer DepthBuffer { uint depths[]; };
layout(std430, set = 0, binding = kBindIds) writeonly buffer IdBuffer { uint ids[]; };
layout(std430, set = 0, binding = kBindCounters) writeonly buffer CounterBuffer { uint counters[]; };
layout(std430, set = 0, binding = kBindBits) writeonly buffer BitBuffer { uint bits[]; };

void main() {
  uint pixels = params.width * params.height;
  uint words = (params.triangleCount + 31u) / 32u;
  uint stride = gl_NumWorkGroups.x * 256u;
  for (uint i = gl_GlobalInvocationID.x; i < max(pixels, words); i += stride) {
    if (i < pixels) {
      depths[i] = kFarthest;
      ids[i] = kNoTriangle;
    }
    if (i < words) bits[i] = 0u;
  }
  if (gl_GlobalInvocationID.x < kCounterWords) counters[gl_GlobalInvocationID.x] = 0u;
}
