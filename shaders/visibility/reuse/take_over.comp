// Chooses which triangles this recording decides. Where what is on the screen is exactly what the previous recording
// had there, it takes over all bits, and the passes that decide have nothing to do.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/reuse/reuse.glsl"
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };

/// Reads nothing that this pass writes, so that all workgroups choose alike.
uint chosenShare() {
  ReuseEvidence e;
  e.isValid = viewBits[stateAt(kStateIsValid)] != 0u && viewBits[stateAt(kStateKey)] == params.reuseKey;
  e.isSame = viewBits[stateAt(kStateChecksum)] == counters.checksum[0] &&
             viewBits[stateAt(kStateChecksum) + 1u] == counters.checksum[1];
  e.isSettled = viewBits[stateAt(kStateIsSettled)] != 0u;
  e.mayDiffer = params.alphaTestCount != 0u;
  e.rate = uintBitsToFloat(viewBits[stateAt(kStateRate)]);
  e.seen = counters.reuseSeen;
  e.fresh = counters.reuseFresh;
  return shareOf(e, params.maxLate);
}

void main() {
  uint share = chosenShare();
  if (gl_GlobalInvocationID.x == 0u) {
    counters.reuseFirst = viewBits[stateAt(kStateFirst)];
    counters.reuseShare = share;
    if (share == 0u) {
      counters.onScreenArgs[0] = 0u;
      counters.binLargeArgs[0] = 0u;
      counters.reused = viewBits[stateAt(kStateTriangles)];
      counters.unresolved = viewBits[stateAt(kStateUnresolved)];
    }
  }
  if (share != 0u) return;
  uint words = (params.triangleCount + 31u) / 32u;
  for (uint word = gl_GlobalInvocationID.x; word < words; word += gl_NumWorkGroups.x * 256u)
    bits[word] |= viewBits[word];
}
