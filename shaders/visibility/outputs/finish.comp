// The numbers that are known last: how many were listed, and the engine's indirect dispatch over the list.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 1) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/reuse/reuse.glsl"
layout(std430, set = 0, binding = kBindChanged) writeonly buffer ChangedBuffer { uint changed[]; };
layout(std430, set = 0, binding = kBindCount) writeonly buffer CountBuffer { uint countAndArgs[]; };

/// What the next recording of the history compares with.
void rememberState() {
  uint share = counters.reuseShare;
  bool wasValid = viewBits[stateAt(kStateIsValid)] != 0u && viewBits[stateAt(kStateKey)] == params.reuseKey;
  viewBits[stateAt(kStateIsValid)] = params.reuse;
  if (params.reuse == 0u) return;
  viewBits[stateAt(kStateKey)] = params.reuseKey;
  viewBits[stateAt(kStateChecksum)] = counters.checksum[0];
  viewBits[stateAt(kStateChecksum) + 1u] = counters.checksum[1];
  viewBits[stateAt(kStateFirst)] = endOfArc(viewBits[stateAt(kStateFirst)], share);
  float rate = uintBitsToFloat(viewBits[stateAt(kStateRate)]);
  rate = rateAfter(rate, share, max(counters.dueLate, counters.dueStale), counters.dueVisible, wasValid);
  viewBits[stateAt(kStateRate)] = floatBitsToUint(rate);
  if (share == 0u) return;
  viewBits[stateAt(kStateIsSettled)] = share == kReuseAll ? 1u : 0u;
  viewBits[stateAt(kStateTriangles)] = counters.decided + counters.reused;
  viewBits[stateAt(kStateUnresolved)] = counters.unresolved;
}

void main() {
  counters.decidedPixels = counters.openCount + counters.longCount;
  if (params.keepsDecisions != 0u) rememberState();
  uint listed = min(counters.visible, params.listCapacity);
  counters.listed = listed;
  // Pairs of tiles that found no room were not looked at: so many would have.
  if (counters.tilePairs > params.maxPairs / 2u)
    counters.pairs = max(counters.pairs, min(counters.tilePairs, 0x7fffffffu) * 2u);
  if ((params.hasList & 2u) != 0u) {
    changed[0] = counters.appeared;
    changed[1] = counters.disappeared;
    changed[2] = 0u;
    changed[3] = 0u;
    counters.changed = min(counters.appeared + counters.disappeared, params.changedCapacity);
  }
  if (params.writeCount == 0u) return;
  countAndArgs[0] = counters.visible;
  uvec3 groups = listGroups(listed);
  countAndArgs[1] = groups.x;
  countAndArgs[2] = groups.y;
  countAndArgs[3] = groups.z;
  if (params.writeCount > 1u) countAndArgs[4] = counters.drawsGiven;
}
