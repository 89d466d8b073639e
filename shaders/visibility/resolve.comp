// Two teams of a workgroup decide a pixel's list each, of at most kBatch.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 64) in; // kTeams * kBatch

const uint kRanked = kBatch;
const uint kTeams = 2u;
#include "visibility/resolve.glsl"

/// A list that is one batch.
void resolveShort(uint begin, uint n, ivec2 pixel) {
  uint lane = laneOf();
  Outline o;
  uint id = 0u;
  uint place = 0u;
  clearRanks();
  if (lane < n) {
    items[team()][lane] = entries[begin + lane];
    Candidate c = readCandidate(items[team()][lane]);
    o = outlineOf(c, pixel);
    id = c.id;
    keys[team()][lane >> 2u][lane & 3u] = middleKey(c, o, pixel, params.reversedDepth != 0u);
  }
  barrier();
  if (lane < n) place = rankOf(lane, n);
  barrier();
  if (ties[team()] != 0u && lane < n) place += rankAmongSame(lane, n);
  if (lane < n) put(place, o, id);
  uvec4 covered = uvec4(0u);
  resolveBatch(n, covered);
}

void main() {
  uint pixels = counters.openCount;
  for (uint first = gl_WorkGroupID.x * kTeams; first < pixels; first += gl_NumWorkGroups.x * kTeams) {
    uint i = min(first + team(), pixels - 1u); // the last one may be decided twice
    uint slot = open[i];
    uint n = slots[lengthAt(slot)];
    resolveShort(slots[slot] - n, n, pixelOf(slot));
    barrier();
  }
}
