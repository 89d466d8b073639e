// Candidates of many pixels, in slices: enters each in the tiles that it may touch, a tile an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 64) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/exact/lists.glsl"
#include "visibility/shared/grid.glsl"
#include "visibility/exact/tile_pairs.glsl"
#include "visibility/reuse/reuse.glsl"

shared uint groupPairs;
shared uint firstPair;

void main() {
  uint count = min(counters.largeCandidateCount, params.maxLargeCandidates);
  for (uint entry = gl_WorkGroupID.x; entry < count; entry += gl_NumWorkGroups.x) {
    uint index = slots[largeCandidateAt(entry)];
    uint place = slots[largeCandidateAt(entry) + 1u];
    uint slice = place & 0xfffu;
    uint slices = (place >> 12u) & 0xfffu;
    uint camera = place >> 24u;
    Candidate c = readCandidate(index);
    bool seen = isSeen(c.id);
    bool reused = !seen && isReused(c.id);
    if (slice == 0u && gl_LocalInvocationIndex == 0u && !seen) {
      if (reused) atomicAdd(counters.reused, 1u);
      else atomicAdd(counters.decided, 1u);
    }
    if (reused && wasVisible(c.id)) retain(c.id);
    seen = seen || reused; // is not asked about
    ScreenTriangle t = triangleOf(c);
    ivec2 s0 = edgeSlope(t.p1, t.p2);
    ivec2 s1 = edgeSlope(t.p2, t.p0);
    ivec2 s2 = edgeSlope(t.p0, t.p1);
    uvec3 tiles = tilesOf(pixelBounds(t.p0, t.p1, t.p2, gridOf(camera)), camera);
    for (uint first = slice * kSliceTiles; first < tiles.z; first += slices * kSliceTiles) {
      if (gl_LocalInvocationIndex == 0u) groupPairs = 0u;
      barrier();
      uint i = first + gl_LocalInvocationIndex;
      uint tile = tiles.x + i / tiles.y * tileColumns() + i % tiles.y;
      bool touched = false;
      if (i < tiles.z) {
        ivec2 corner = cornerOf(tile);
        touched = !blockOutside(innermostBlock(t.p1, s0, corner), s0, 8) &&
                  !blockOutside(innermostBlock(t.p2, s1, corner), s1, 8) &&
                  !blockOutside(innermostBlock(t.p0, s2, corner), s2, 8);
      }
      uint pair = touched ? atomicAdd(groupPairs, 1u) : 0u;
      barrier();
      if (gl_LocalInvocationIndex == 0u && groupPairs != 0u) firstPair = atomicAdd(counters.tilePairs, groupPairs);
      barrier();
      pair += firstPair;
      if (touched) {
        if (pair < maxTilePairs()) enter(index, seen, tile, countIn(tile, seen), pair);
        else show(c.id);
      }
      barrier();
    }
  }
}
