// Decides pixels' lists of at most kBatch, as many together as have kBatch entries. What the order by one depth each
// may have wrong is decided by planes.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
#include "visibility/facet.h"
#include "visibility/layout.h"
#include "visibility/resolve.glsl"

/// An entry, which an invocation holds, of one of the lists. These lie one behind the other, from multiples of four on.
struct Entry {
  uint list;   // bits: its list's entries, by invocation or by place; 0: there is none
  bool isSeen; // by the order
  uint place;  // in the order
  uint id;
  vec3 plane; // of its facet, whose box is packed
  float nearest;
  float farthest;
  uint box;
};

/// The plane and the box of an entry.
Facet facetOf(vec3 plane, uint box) {
  Facet f;
  f.plane = plane;
  f.nearest = 0.0;
  f.farthest = 0.0;
  f.box = ivec4(box & 255u, box >> 8u & 255u, box >> 16u & 255u, box >> 24u);
  return f;
}
Facet facetOfLane(Entry own, uint lane) {
  uvec4 told = fromLane(uvec4(floatBitsToUint(own.plane), own.box), lane);
  return facetOf(uintBitsToFloat(told.xyz), told.w);
}

/// Whether an entry may be wrong that is not shown already; reach: the order of the farthest that its list shows. One
/// that is seen, unless it is the last, and a hidden one that is not behind all that is seen: few are left.
bool isAsked(Entry own, uint reach) {
  return own.isSeen ? own.list >> own.place != 1u : orderOf(own.nearest) < reach;
}

/// Bits, by place: of the entries that ask, those that the order has wrong: a seen one, with one behind it in the order
/// that is nearer somewhere; a hidden one, with one that is seen, before it, and farther somewhere.
uint doubtfulOf(Entry own, bool asks) {
  uint seen = orAll(own.isSeen ? 1u << laneOf() : 0u);
  uint left = orAll(asks ? 1u << laneOf() : 0u) & own.list;
  uint suspects = 0u; // by place
  for (uint turns = maxAll(uint(bitCount(left))); turns != 0u; --turns) {
    bool any = left != 0u;
    uint lane = any ? uint(findLSB(left)) : laneOf();
    left &= left - 1u;
    bool isSeen = (seen & (1u << lane)) != 0u;
    uvec2 told = fromLane(uvec2(own.place, floatBitsToUint(own.isSeen ? own.farthest : own.nearest)), lane);
    float bound = uintBitsToFloat(told.y);
    bool may = any && (isSeen ? own.place > told.x && own.nearest < bound
                              : own.isSeen && own.place < told.x && bound < own.farthest);
    if (orAll(uint(may)) == 0u) continue;
    Facet other = facetOfLane(own, lane);
    Facet f = facetOf(own.plane, own.box);
    if (may && (isSeen ? isNearerWithin(f, other) : isNearerWithin(other, f))) suspects |= 1u << told.x;
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
  uint lane = uint(findLSB(orAll(own.list != 0u && own.place == place ? 1u << laneOf() : 0u)));
  uvec2 told = fromLane(uvec2(own.id, floatBitsToUint(own.farthest)), lane);
  Facet f = facetOfLane(own, lane);
  bool isRival = (own.list & (1u << lane)) != 0u && own.place != place && own.nearest <= uintBitsToFloat(told.y);
  int row = int(laneOf());
  Outline o = outlineAt(place);
  uvec4 rest = uvec4(samplesIn(o, row), samplesIn(o, row + 32));
  for (uint left = orAll(isRival ? 1u << laneOf() : 0u); left != 0u; left &= left - 1u) {
    uint j = uint(findLSB(left));
    uvec2 rival = fromLane(uvec2(own.id, own.place), j);
    Crossing crossing = crossingOf(facetOfLane(own, j), f, rival.x < told.x);
    Outline other = outlineAt(rival.y);
    rest &= ~uvec4(samplesAhead(other, crossing, row), samplesAhead(other, crossing, row + 32));
  }
  return orAll(rest.x | rest.y | rest.z | rest.w) != 0u;
}

/// Decides lists from one on: as many of `count` as fit, which it returns.
uint resolveSome(uint first, uint count) {
  uint lane = laneOf();
  uvec4 list = uvec4(0u); // slot, length, end
  if (lane < count) {
    list.x = open[first + lane];
    list.y = slots[lengthAt(list.x)];
    list.z = slots[list.x];
  }
  uint room = (list.y + 3u) & ~3u;
  uint end = sumUpTo(room);
  uint begins = orAll(lane < count && end <= kBatch ? 1u << (end - room) : 0u);
  uint upTo = begins & (0xffffffffu >> (31u - lane));
  list = fromLane(list, uint(bitCount(upTo)) - 1u);
  uint begin = uint(findMSB(upTo));
  uint n = list.y;
  bool isThere = lane - begin < n;
  ivec2 pixel = pixelOf(list.x);
  bool reversed = params.reversedDepth != 0u;
  Entry own;
  own.list = isThere ? bitsFrom(int(begin), int(n)) : 0u;
  own.isSeen = false;
  own.id = 0u;
  Outline o;
  uint item = 0u;
  uint key = kFarthest;
  if (isThere) {
    item = entries[list.z - n + (lane - begin)];
    items[lane] = item;
    Candidate c = readCandidate(item);
    Footing footing = footingIn(c, pixel);
    o = outlineOf(c, pixel);
    own.id = c.id;
    key = middleKey(c, o, footing, pixel, reversed);
    setKey(lane, key);
    Facet f = facetOf(c, footing, pixel, reversed);
    own.plane = f.plane;
    own.nearest = f.nearest;
    own.farthest = f.farthest;
    own.box = uint(f.box.x) | uint(f.box.y) << 8u | uint(f.box.z) << 16u | uint(f.box.w) << 24u;
  }
  own.place = placeAmong(isThere, begin, n, uint(bitCount(orAll(isThere ? 1u << lane : 0u))));
  bool moves = orAll(uint(movesIn(pixel))) != 0u;
  uint nearest = kFarthest;
  if (moves)
    for (uint i = begin; i < begin + n; ++i) nearest = min(nearest, keyAt(i));
  bool isKnown = true;
  if (isThere) {
    items[own.place] = item;
    put(own.place, o, parallaxIn(pixel, nearest, key, own.place - begin));
    isKnown = isShown(own.id);
  }
  bool asks = false;
  for (uint left = begins; left != 0u; left &= left - 1u) {
    uint at = uint(findLSB(left));
    uvec4 covered = uvec4(0u);
    Looked looked = lookAtBatch(at, fromLane(uvec2(n), at).x, moves, covered);
    bool isOwn = (own.list & (1u << at)) != 0u;
    if (isOwn) own.isSeen = (looked.seen & (1u << own.place)) != 0u;
    uint reach = maxAll(isOwn && own.isSeen ? orderOf(own.farthest) : 0u);
    if (isOwn) asks = !isKnown && isAsked(own, reach);
  }
  // What the order has proposed, corrected.
  uint doubtful = doubtfulOf(own, asks);
  bool isVisible = own.isSeen;
  for (uint left = doubtful; left != 0u; left &= left - 1u) {
    uint place = uint(findLSB(left));
    bool isAhead_ = isAhead(own, place);
    if (own.place == place) isVisible = isAhead_;
  }
  if (isVisible && !isKnown) show(own.id);
  sync();
  return uint(bitCount(begins));
}

void main() {
  uint lists = counters.openCount;
  for (uint first = gl_WorkGroupID.x * kListRun; first < lists; first += gl_NumWorkGroups.x * kListRun)
    for (uint done = 0u; done < min(lists - first, kListRun);)
      done += resolveSome(first + done, min(lists - first, kListRun) - done);
}
