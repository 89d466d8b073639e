// Decides a pixel's list of at most kBatch. What the order by one depth each may have wrong is decided by planes.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
#include "visibility/facet.h"
#include "visibility/layout.h"
#include "visibility/resolve.glsl"

/// An entry of the list, which an invocation holds.
struct Entry {
  bool isThere;
  bool isSeen; // by the order
  uint place;  // in the order
  uint id;
  Facet facet;
};

uint packedBox(ivec4 b) { return uint(b.x) | uint(b.y) << 8u | uint(b.z) << 16u | uint(b.w) << 24u; }

/// The plane and the box of an invocation's entry.
Facet facetOfLane(Facet own, uint lane) {
  uvec4 told = fromLane(uvec4(floatBitsToUint(own.plane), packedBox(own.box)), lane);
  Facet f;
  f.plane = uintBitsToFloat(told.xyz);
  f.nearest = 0.0;
  f.farthest = 0.0;
  f.box = ivec4(told.w & 255u, told.w >> 8u & 255u, told.w >> 16u & 255u, told.w >> 24u);
  return f;
}

/// Bits, by place: entries that the order may have wrong. One that is seen, with one behind it in the order that is
/// nearer somewhere; one that is hidden, with one that is seen, before it, and farther somewhere. Those that are shown
/// already need no answer, nor do hidden ones behind all that is seen: few are left.
uint doubtfulOf(Entry own, uint n, bool isShown_) {
  uint reach = maxAll(own.isSeen ? orderOf(own.facet.farthest) : 0u);
  bool asks = own.isThere && !isShown_ &&
              (own.isSeen ? own.place + 1u < n : orderOf(own.facet.nearest) < reach);
  uint seen = orAll(own.isSeen ? 1u << laneOf() : 0u);
  uint suspects = 0u; // by place
  for (uint left = orAll(asks ? 1u << laneOf() : 0u); left != 0u; left &= left - 1u) {
    uint lane = uint(findLSB(left));
    bool isSeen = (seen & (1u << lane)) != 0u;
    uvec2 told = fromLane(uvec2(own.place, floatBitsToUint(own.isSeen ? own.facet.farthest : own.facet.nearest)), lane);
    float bound = uintBitsToFloat(told.y);
    bool may = isSeen ? own.isThere && own.place > told.x && own.facet.nearest < bound
                      : own.isSeen && own.place < told.x && bound < own.facet.farthest;
    if (orAll(uint(may)) == 0u) continue;
    Facet other = facetOfLane(own.facet, lane);
    if (may && (isSeen ? isNearerWithin(own.facet, other) : isNearerWithin(other, own.facet))) suspects |= 1u << told.x;
  }
  uint doubtful = 0u;
  while (orAll(suspects) != 0u) {
    uint wrong = 0u;
    if (suspects != 0u) {
      uint place = uint(findLSB(suspects));
      if (overlap(readCandidate(items[place]), readCandidate(items[own.place]))) wrong = 1u << place;
    }
    doubtful |= orAll(wrong);
    suspects &= (suspects - 1u) & ~doubtful;
  }
  return doubtful;
}

/// Whether the entry at a place has a sample at which none that may hide a part of it is nearer.
bool isAhead(Entry own, uint place) {
  uint lane = uint(findLSB(orAll(own.isThere && own.place == place ? 1u << laneOf() : 0u)));
  uvec2 told = fromLane(uvec2(own.id, floatBitsToUint(own.facet.farthest)), lane);
  Facet f = facetOfLane(own.facet, lane);
  bool isRival = own.isThere && own.place != place && own.facet.nearest <= uintBitsToFloat(told.y);
  int row = int(laneOf());
  Outline o = outlineAt(place);
  uvec4 rest = uvec4(samplesIn(o, row), samplesIn(o, row + 32));
  for (uint left = orAll(isRival ? 1u << laneOf() : 0u); left != 0u; left &= left - 1u) {
    uint j = uint(findLSB(left));
    uvec2 rival = fromLane(uvec2(own.id, own.place), j);
    Crossing crossing = crossingOf(facetOfLane(own.facet, j), f, rival.x < told.x);
    Outline other = outlineAt(rival.y);
    rest &= ~uvec4(samplesAhead(other, crossing, row), samplesAhead(other, crossing, row + 32));
  }
  return orAll(rest.x | rest.y | rest.z | rest.w) != 0u;
}

/// A pixel's list, and the entry of it that this invocation reads.
struct List {
  uint slot;
  uint n;
  uint item;
};

List listAt(uint i) {
  List list;
  list.slot = open[i];
  list.n = slots[lengthAt(list.slot)];
  uint end = slots[list.slot];
  list.item = laneOf() < list.n ? entries[end - list.n + laneOf()] : 0u;
  return list;
}

void resolveShort(List list) {
  uint lane = laneOf();
  uint n = list.n;
  ivec2 pixel = pixelOf(list.slot);
  bool reversed = params.reversedDepth != 0u;
  Outline o;
  Facet f;
  uint id = 0u;
  uint key = kFarthest;
  if (lane < n) {
    items[lane] = list.item;
    Candidate c = readCandidate(list.item);
    Footing footing = footingIn(c, pixel);
    o = outlineOf(c, pixel);
    id = c.id;
    key = middleKey(c, o, footing, pixel, reversed);
    setKey(lane, key);
    f = facetOf(c, footing, pixel, reversed);
  }
  Entry own;
  own.isThere = lane < n;
  own.place = placeAmong(n);
  own.id = id;
  own.facet = f;
  bool moves = movesIn(pixel);
  uint first = moves ? minAll(key) : 0u;
  bool isKnown = false;
  if (own.isThere) {
    items[own.place] = list.item;
    put(own.place, o, parallaxIn(pixel, first, key, own.place));
    isKnown = isShown(id);
  }
  uvec4 covered = uvec4(0u);
  Looked looked = lookAtBatch(n, moves, covered);
  uint bit = 1u << own.place;
  own.isSeen = own.isThere && (looked.seen & bit) != 0u;
  // What the order has proposed, corrected.
  uint doubtful = doubtfulOf(own, n, isKnown);
  bool isVisible = own.isSeen;
  for (uint left = doubtful; left != 0u; left &= left - 1u) {
    uint place = uint(findLSB(left));
    bool isAhead_ = isAhead(own, place);
    if (own.place == place) isVisible = isAhead_;
  }
  if (own.isThere && isVisible && !isKnown) show(id);
}

void main() {
  uint pixels = counters.openCount;
  uint i = gl_WorkGroupID.x;
  if (i >= pixels) return;
  List next = listAt(i);
  while (i < pixels) {
    List list = next;
    i += gl_NumWorkGroups.x;
    if (i < pixels) next = listAt(i); // reads that depend on each other: they arrive while this list is decided
    resolveShort(list);
    sync();
  }
}
