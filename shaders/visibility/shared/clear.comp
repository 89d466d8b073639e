// Empties what the other passes accumulate into: samples, limits and counts of tiles, visible bits, counters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindSamples) writeonly buffer SampleBuffer { uvec2 samples[]; };
layout(std430, set = 0, binding = kBindCounters) writeonly buffer CounterBuffer { uint counters[]; };
layout(std430, set = 0, binding = kBindBits) writeonly buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindSizes) writeonly buffer SizeBuffer { uint sizes[]; };
layout(std430, set = 0, binding = kBindSlots) writeonly buffer SlotBuffer { uint slots[]; };
layout(std430, set = 0, binding = kBindExtents) writeonly buffer ExtentBuffer { uint extents[]; };

void main() {
  uint perPixel = 1u << (16u - 2u * params.gridShift);
  uint rows = params.height * params.cameraCount;
  uint sampleCount = params.width * rows * perPixel;
  uint words = (params.triangleCount + 31u) / 32u;
  uint tiles = (params.width + 7u) / 8u * ((params.height + 7u) / 8u) * params.cameraCount;
  uint limits = params.method == kExact ? tiles * 64u : 0u;
  uint tileWords = params.slotCapacity * 2u; // of exact sampling: no candidates
  bool perTriangle = params.hasSizes != 0u || params.hasExtents != 0u;
  uint count = max(max(sampleCount, limits), max(words, perTriangle ? params.triangleCount : 0u));
  uint stride = gl_NumWorkGroups.x * 256u;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += stride) {
    if (i < sampleCount) samples[i] = uvec2(kNoTriangle, kFarthest);
    if (i < limits) slots[i] = kFarthest;
    if (i < limits / 64u * kTileWords) slots[tileWords + i] = 0u;
    if (i < words && params.accumulate == 0u) bits[i] = 0u;
    if (i < params.triangleCount && params.accumulate == 0u && params.hasSizes != 0u) sizes[i] = 0u;
    if (i < params.triangleCount && params.accumulate == 0u && params.hasExtents != 0u) {
      extents[i * 3u] = 0u;
      extents[i * 3u + 1u] = 0u;
      extents[i * 3u + 2u] = 0u;
    }
  }
  if (gl_GlobalInvocationID.x < kCounterWords) counters[gl_GlobalInvocationID.x] = 0u;
}
