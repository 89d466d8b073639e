// From ids per sample to a bit per triangle (6.1.1: "gathering the ids"), and how many samples show it. An invocation
// takes eight neighbours, which mostly show the same triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindSamples) readonly buffer SampleBuffer { uint samples[]; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindSizes) buffer SizeBuffer { uint sizes[]; };

shared uint groupCovered;

void note(uint id, uint count, bool known) {
  if (id == kNoTriangle) return;
  // A triangle has many pixels, and more from several cameras: most find that it is known.
  uint bit = 1u << (id & 31u);
  if (!known && (bits[id >> 5u] & bit) == 0u) atomicOr(bits[id >> 5u], bit);
  if (params.hasSizes == 0u) return;
  if (params.method != kReference)
    atomicAdd(sizes[id], count);
  else if (atomicAdd(sizes[id], count) > 0xffffffffu - count) // many samples a pixel: stays at the largest number
    atomicMax(sizes[id], 0xffffffffu);
}

void main() {
  if (gl_LocalInvocationIndex == 0u) groupCovered = 0u;
  barrier();
  uint sampleCount = params.width * params.height * params.cameraCount * (1u << (16u - 2u * params.gridShift));
  uint stride = gl_NumWorkGroups.x * 256u;
  uint covered = 0u;
  for (uint first = gl_GlobalInvocationID.x * 8u; first < sampleCount; first += stride * 8u) {
    uint end = min(first + 8u, sampleCount);
    uint before = kNoTriangle;
    uint count = 0u;
    bool known = false; // the neighbour to the left sets the bit
    for (uint i = first; i < end; ++i) {
      uint id = samples[idAt(i)];
      if (id != kNoTriangle) ++covered;
      if (i != first && id == before) {
        ++count;
        continue;
      }
      note(before, count, known);
      known = i == first && first != 0u && samples[idAt(first - 1u)] == id;
      before = id;
      count = 1u;
    }
    note(before, count, known);
  }
  if (covered != 0u) atomicAdd(groupCovered, covered);
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupCovered != 0u) atomicAdd(counters.coveredPixels, groupCovered);
}
