// A workgroup a tile of 8 x 8 pixels: makes the lists of its pixels. First those are entered that are not seen yet, in
// the pixels that they touch in front of their limits, then those already seen where others are, which they may hide.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 64) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/shared/loops_ended.glsl"
#include "visibility/exact/lists.glsl"
#include "visibility/shared/grid.glsl"
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
#include "visibility/exact/candidates.glsl"
layout(std430, set = 0, binding = kBindPairs) buffer PairBuffer { uint pairs[]; };
layout(std430, set = 0, binding = kBindEntries) writeonly buffer EntryBuffer { uint entries[]; };
layout(std430, set = 0, binding = kBindOpen) writeonly buffer OpenBuffer { uint open[]; };

shared uint limits[64];
shared uint lengths[64];
shared uint ends[64];
shared uvec2 limited; // bits: pixels that have a limit
shared uvec2 unseen;  // pixels in which some are entered that are not seen yet
shared uvec3 sums[64]; // entries, pixels with short lists, with long ones
shared uvec3 first;

/// Pixels of those that a triangle touches where it comes in front of the limit.
uvec2 inFront(Candidate c, uvec2 touched, ivec2 corner) {
  bool reversed = params.reversedDepth != 0u;
  uint nearest = depthKey(reversed ? c.zMax : c.zMin, reversed);
  uint farthest = depthKey(reversed ? c.zMin : c.zMax, reversed);
  for (uvec2 left = touched & limited; (left.x | left.y) != 0u;) {
    int bit = lowestBit(left);
    uvec2 one = bit < 32 ? uvec2(1u << bit, 0u) : uvec2(0u, 1u << (bit - 32));
    left &= ~one;
    uint limit = limits[bit];
    bool hidden = nearest > limit;
    if (!hidden && farthest > limit)
      hidden = nearestKey(c, corner + ivec2(bit & 7, bit >> 3), reversed) > limit;
    if (hidden) touched &= ~one;
  }
  return touched;
}

/// Keeps the pixels that a candidate is entered in, for the invocation itself, and counts it there.
void keep(uint i, uvec2 mask) {
  pairs[i * 2u] = mask.x;
  pairs[i * 2u + 1u] = mask.y;
  for (uint left = mask.x; left != 0u; left &= left - 1u) atomicAdd(lengths[findLSB(left)], 1u);
  for (uint left = mask.y; left != 0u; left &= left - 1u) atomicAdd(lengths[32 + findLSB(left)], 1u);
}

/// Sums up to each pixel.
void sumUp() {
  uint lane = gl_LocalInvocationIndex;
  for (uint step = 1u; step < 64u; step *= 2u) {
    uvec3 before = lane >= step ? sums[lane - step] : uvec3(0u);
    barrier();
    sums[lane] += before;
    barrier();
  }
}

void enterTile(uint tile, uint begin, uint middle, uint end) {
  uint lane = gl_LocalInvocationIndex;
  ivec2 corner = cornerOf(tile);
  Grid grid = gridOf(tile / (tileColumns() * tileRows()));
  if (lane == 0u) {
    limited = uvec2(0u);
    unseen = uvec2(0u);
  }
  barrier();
  uint limit = slots[tile * 64u + lane];
  limits[lane] = limit;
  lengths[lane] = 0u;
  if (limit != kFarthest) {
    if (lane < 32u) atomicOr(limited.x, 1u << lane);
    else atomicOr(limited.y, 1u << (lane - 32u));
  }
  barrier();
  for (uint i = begin + lane; i < end; i += 64u) {
    Candidate c = readCandidate(pairs[placedAt(i)]);
    ScreenTriangle t = triangleOf(c);
    uvec2 mask = touchedPixels(t, pixelBounds(t.p0, t.p1, t.p2, grid), corner);
    if (i < middle) {
      mask = inFront(c, mask, corner);
      if ((mask.x & ~unseen.x) != 0u) atomicOr(unseen.x, mask.x);
      if ((mask.y & ~unseen.y) != 0u) atomicOr(unseen.y, mask.y);
      keep(i, mask);
    } else {
      pairs[i * 2u] = mask.x;
      pairs[i * 2u + 1u] = mask.y;
    }
  }
  barrier();
  if ((unseen.x | unseen.y) == 0u) return;
  for (uint i = begin + lane; i < end; i += 64u) {
    if (i < middle) continue;
    uvec2 mask = uvec2(pairs[i * 2u], pairs[i * 2u + 1u]) & unseen;
    uvec2 asked = mask & limited;
    if ((asked.x | asked.y) != 0u) mask = inFront(readCandidate(pairs[placedAt(i)]), mask, corner);
    keep(i, mask);
  }
  barrier();
  uint n = lengths[lane];
  uvec3 own = uvec3(n, n != 0u && n <= kBatch ? 1u : 0u, n > kBatch ? 1u : 0u);
  sums[lane] = own;
  barrier();
  sumUp();
  uvec3 all_ = sums[63];
  if (lane == 0u) first.x = atomicAdd(counters.pairs, all_.x);
  barrier();
  bool fits = first.x <= params.maxPairs && all_.x <= params.maxPairs - first.x;
  if (lane == 0u && fits) {
    first.y = atomicAdd(counters.openCount, all_.y);
    first.z = atomicAdd(counters.longCount, all_.z);
    uint runs = (first.y + all_.y + kListRun - 1u) / kListRun, lists = first.z + all_.z;
    atomicMax(counters.openArgs[0], min(runs, kMaxGroups));
    if (runs > kMaxGroups) atomicMax(counters.openArgs[1], (runs + kMaxGroups - 1u) / kMaxGroups);
    atomicMax(counters.longArgs[0], min(lists, kMaxGroups));
    if (lists > kMaxGroups) atomicMax(counters.longArgs[1], (lists + kMaxGroups - 1u) / kMaxGroups);
  }
  barrier();
  if (n != 0u && fits) {
    uvec3 place = first + sums[lane] - own;
    uint slot = tile * 64u + lane;
    ends[lane] = place.x;
    slots[slot] = place.x + n;
    slots[lengthAt(slot)] = n;
    open[n <= kBatch ? place.y : params.pixelCapacity - 1u - place.z] = slot;
  }
  barrier();
  for (uint i = begin + lane; i < end; i += 64u) {
    uint candidate = pairs[placedAt(i)];
    uvec2 mask = uvec2(pairs[i * 2u], pairs[i * 2u + 1u]);
    if (fits) {
      for (; mask.x != 0u; mask.x &= mask.x - 1u) entries[atomicAdd(ends[findLSB(mask.x)], 1u)] = candidate;
      for (; mask.y != 0u; mask.y &= mask.y - 1u) entries[atomicAdd(ends[32 + findLSB(mask.y)], 1u)] = candidate;
    } else if (i < middle && (mask.x | mask.y) != 0u) { // what finds no room counts as visible
      uint id = candidateId(candidate);
      atomicOr(bits[id >> 5u], 1u << (id & 31u));
      atomicAdd(counters.unresolved, 1u);
    }
  }
}

void main() {
  for (uint tile = gl_WorkGroupID.x; tile < tileCount(); tile += gl_NumWorkGroups.x) {
    uint begin = slots[tileWord(tile) + 2u];
    uint middle = begin + slots[tileWord(tile)];
    if (begin != kNoTile) enterTile(tile, begin, middle, middle + slots[tileWord(tile) + 1u]);
    barrier();
  }
  sayIfEnded();
}
