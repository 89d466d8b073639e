// Compares visible bits with a reference: masks of false positives and false negatives, and their numbers. One
// invocation a word of 32 triangles. Areas are sums of 64 bits: two words, the high one counts the low one's carries.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/metrics/metrics.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindBits) readonly buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindReference) readonly buffer ReferenceBuffer { uint referenceBits[]; };
layout(std430, set = 0, binding = kBindReferenceCounts) readonly buffer ReferenceCountBuffer {
  uint referenceCounts[];
};
layout(std430, set = 0, binding = kBindRecheck) readonly buffer RecheckBuffer { uint recheckBits[]; };
layout(std430, set = 0, binding = kBindFalsePositives) writeonly buffer PositiveBuffer { uint positives[]; };
layout(std430, set = 0, binding = kBindFalseNegatives) writeonly buffer NegativeBuffer { uint negatives[]; };

shared uint groupReference, groupFound, groupPositives;
shared uint groupArea[4]; // referenceArea, foundArea

bool has(uint buffer_) { return (params.metricBuffers & buffer_) != 0u; }
bool carries(uint before, uint added) { return before > 0xffffffffu - added; }
void addWide(inout uint low, inout uint high, uint value) {
  if (carries(low, value)) ++high;
  low += value;
}
void addToGroup(uint first, uint low, uint high) {
  if (carries(atomicAdd(groupArea[first], low), low)) ++high;
  if (high != 0u) atomicAdd(groupArea[first + 1u], high);
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  if (lane < 4u) groupArea[lane] = 0u;
  if (lane == 0u) {
    groupReference = 0u;
    groupFound = 0u;
    groupPositives = 0u;
  }
  barrier();
  uint words = (params.triangleCount + 31u) / 32u;
  uint trueCount = 0u, foundCount = 0u, positiveCount = 0u;
  uint area[4] = uint[](0u, 0u, 0u, 0u);
  for (uint word = gl_GlobalInvocationID.x; word < words; word += gl_NumWorkGroups.x * 256u) {
    uint visible = bits[word];
    uint reference = referenceWith(visible, referenceBits[word], has(kHasRecheck) ? recheckBits[word] : 0u);
    uint rest = params.triangleCount - word * 32u;
    if (rest < 32u) { // the engine's bits behind the last triangle mean nothing
      visible &= (1u << rest) - 1u;
      reference &= (1u << rest) - 1u;
    }
    uint more = falsePositives(visible, reference);
    trueCount += uint(bitCount(reference));
    foundCount += uint(bitCount(reference & visible));
    positiveCount += uint(bitCount(more));
    if (has(kHasFalsePositives)) positives[word] = more;
    if (has(kHasFalseNegatives)) negatives[word] = falseNegatives(visible, reference);
    if (!has(kHasReferenceCounts)) continue;
    for (uint left = reference; left != 0u; left &= left - 1u) {
      uint bit = uint(findLSB(left));
      uint samples = referenceCounts[word * 32u + bit];
      addWide(area[0], area[1], samples);
      if ((visible >> bit & 1u) != 0u) addWide(area[2], area[3], samples);
    }
  }
  if (trueCount != 0u) atomicAdd(groupReference, trueCount);
  if (foundCount != 0u) atomicAdd(groupFound, foundCount);
  if (positiveCount != 0u) atomicAdd(groupPositives, positiveCount);
  addToGroup(0u, area[0], area[1]);
  addToGroup(2u, area[2], area[3]);
  barrier();
  if (lane != 0u) return;
  if (groupReference != 0u) atomicAdd(counters.reference, groupReference);
  if (groupFound != 0u) atomicAdd(counters.found, groupFound);
  if (groupPositives != 0u) atomicAdd(counters.falsePositives, groupPositives);
  uint high = groupArea[1];
  if (carries(atomicAdd(counters.referenceArea[0], groupArea[0]), groupArea[0])) ++high;
  if (high != 0u) atomicAdd(counters.referenceArea[1], high);
  high = groupArea[3];
  if (carries(atomicAdd(counters.foundArea[0], groupArea[2]), groupArea[2])) ++high;
  if (high != 0u) atomicAdd(counters.foundArea[1], high);
}
