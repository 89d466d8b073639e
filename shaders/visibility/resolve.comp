// Decides pixels' lists of at most kBatch, as many together as have kBatch entries. What the order by one depth each
// may have wrong is decided by planes.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
#include "visibility/facet.h"
#include "visibility/layout.h"
#include "visibility/resolve.glsl"

/// Of compact triangles, by invocation: corners from the pixel's first unit on, a word each. They are less than 66
/// pixels away.
shared uint corners[3][kBatch];

uint wordOf(ivec2 corner) { return uint(corner.x & 0xffff) | uint(corner.y) << 16u; }
void putCorners(Corners c, ivec2 first) {
  corners[0][laneOf()] = wordOf(c.p0 - first);
  corners[1][laneOf()] = wordOf(c.p1 - first);
  corners[2][laneOf()] = wordOf(c.p2 - first);
}
ivec2 cornerAt(uint i, uint lane) {
  int both = int(corners[i][lane]);
  return ivec2((both << 16) >> 16, both >> 16);
}
Corners cornersAt(uint lane) {
  Corners c;
  c.p0 = cornerAt(0u, lane);
  c.p1 = cornerAt(1u, lane);
  c.p2 = cornerAt(2u, lane);
  return c;
}

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

/// Pairs of entries, by invocation: by their depths alone the first may be nearer somewhere, although the order says
/// the reverse; and which of them asks.
shared uint pairs[kBatch * 2u];

/// Bits, by invocation: of the entries that ask in `count` pairs from `first` on, those that have one whose first is
/// nearer. wide: those that are not compact.
uint askersIn(uint first, uint count, Entry own, uint wide) {
  sync();
  bool any = laneOf() < count;
  uint pair = any ? pairs[first + laneOf()] : 0u;
  uint a = pair & 31u;
  uint b = pair >> 5u & 31u;
  Facet nearer = facetOfLane(own, a);
  Facet farther = facetOfLane(own, b);
  any = any && isNearerWithin(nearer, farther);
  if (any) {
    if ((wide & (1u << a | 1u << b)) == 0u) any = overlap(cornersAt(a), cornersAt(b), true);
    else any = overlap(cornersOf(readCandidate(items[a])), cornersOf(readCandidate(items[b])), false);
  }
  uint askers = orAll(any ? 1u << (pair >> 10u) : 0u);
  sync();
  return askers;
}

/// Bits, by invocation: of the entries that ask, those that the order has wrong: a seen one, with one behind it in the
/// order that is nearer somewhere; a hidden one, with one that is seen, before it, and farther somewhere.
uint doubtfulOf(Entry own, bool asks, uint wide) {
  uint seen = lanesWith(own.isSeen);
  uint left = lanesWith(asks) & own.list;
  uint doubtful = 0u;
  uint count = 0u;
  for (uint turns = maxAll(uint(bitCount(left))); turns != 0u; --turns) {
    bool any = left != 0u;
    uint asker = any ? uint(findLSB(left)) : laneOf();
    left &= left - 1u;
    bool isSeen = (seen & (1u << asker)) != 0u;
    uvec2 told = fromLane(uvec2(own.place, floatBitsToUint(own.isSeen ? own.farthest : own.nearest)), asker);
    float bound = uintBitsToFloat(told.y);
    bool may = any && (isSeen ? own.place > told.x && own.nearest < bound
                              : own.isSeen && own.place < told.x && bound < own.farthest);
    uint which = lanesWith(may);
    if (may) {
      uint at = count + uint(bitCount(which & ((1u << laneOf()) - 1u)));
      pairs[at] = (isSeen ? laneOf() | asker << 5u : asker | laneOf() << 5u) | asker << 10u;
    }
    count += uint(bitCount(which));
    if (count >= kBatch) {
      count -= kBatch;
      doubtful |= askersIn(count, kBatch, own, wide);
    }
  }
  if (count != 0u) doubtful |= askersIn(0u, count, own, wide);
  return doubtful;
}

/// Whether the entry of an invocation has a sample at which none that may hide a part of it is nearer.
bool isAhead(Entry own, uint lane) {
  uvec4 told = fromLane(uvec4(own.id, floatBitsToUint(own.farthest), own.place, 0u), lane);
  Facet f = facetOfLane(own, lane);
  bool isRival = (own.list & (1u << lane)) != 0u && laneOf() != lane && own.nearest <= uintBitsToFloat(told.y);
  Crossing c = crossingOf(facetOf(own.plane, own.box), f, own.id < told.x); // each works out its own entry's
  uvec4 hides = uvec4(floatBitsToUint(c.start), floatBitsToUint(c.step), uint(c.side), own.place);
  int row = int(laneOf());
  Outline o = outlineAt(told.z);
  uvec4 rest = samplesOf(o);
  for (uint left = lanesWith(isRival); left != 0u; left &= left - 1u) {
    uint j = uint(findLSB(left));
    uvec4 rival = fromLane(hides, j);
    c.start = uintBitsToFloat(rival.x);
    c.step = uintBitsToFloat(rival.y);
    c.side = int(rival.z);
    Outline other = outlineAt(rival.w);
    rest &= ~uvec4(samplesOf(spanAhead(other, c, row)), samplesOf(spanAhead(other, c, row + 32)));
  }
  return lanesWith(!isNone(rest)) != 0u;
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
  uint key = kFarthest;
  bool isWide = false;
  if (isThere) {
    uint item = entries[list.z - n + (lane - begin)];
    items[lane] = item;
    Candidate c = readCandidate(item);
    isWide = !isCompact(triangleOf(c));
    putCorners(cornersOf(c), pixel * 256);
    Footing footing = footingIn(c, pixel);
    o = outlineOf(c, pixel);
    own.id = c.id;
    key = middleKey(c, o, footing, pixel, reversed);
    Facet f = facetOf(c, footing, pixel, reversed);
    own.plane = f.plane;
    own.nearest = f.nearest;
    own.farthest = f.farthest;
    own.box = uint(f.box.x) | uint(f.box.y) << 8u | uint(f.box.z) << 16u | uint(f.box.w) << 24u;
  }
  setKey(lane, key);
  own.place = placeAmong(isThere, begin, n);
  bool moves = lanesWith(movesIn(pixel)) != 0u;
  uint nearest = kFarthest;
  if (moves)
    for (uint i = begin; i < begin + n; ++i) nearest = min(nearest, keyAt(i));
  bool isKnown = true;
  if (isThere) {
    put(own.place, o, moves ? parallaxIn(pixel, nearest, key, own.place - begin) : 0);
    isKnown = isShown(own.id);
  }
  bool asks = false;
  for (uint left = begins; left != 0u; left &= left - 1u) {
    uint at = uint(findLSB(left));
    uvec4 uncovered = uvec4(0xffffffffu);
    Looked looked = lookAtBatch(at, fromLane(uvec2(n), at).x, moves, uncovered);
    bool isOwn = (own.list & (1u << at)) != 0u;
    if (isOwn) own.isSeen = (looked.seen & (1u << own.place)) != 0u;
    uint reach = maxAll(isOwn && own.isSeen ? orderOf(own.farthest) : 0u);
    if (isOwn) asks = !isKnown && isAsked(own, reach);
  }
  // What the order has proposed, corrected.
  uint doubtful = doubtfulOf(own, asks, lanesWith(isWide));
  bool isVisible = own.isSeen;
  for (; doubtful != 0u; doubtful &= doubtful - 1u) {
    uint doubted = uint(findLSB(doubtful));
    bool isAhead_ = isAhead(own, doubted);
    if (lane == doubted) isVisible = isAhead_;
  }
  if (isVisible && !isKnown) show(own.id);
  sync();
  return uint(bitCount(begins));
}

void main() {
  makeColumns();
  uint lists = counters.openCount;
  for (uint first = gl_WorkGroupID.x * kListRun; first < lists; first += gl_NumWorkGroups.x * kListRun)
    for (uint done = 0u; done < min(lists - first, kListRun);)
      done += resolveSome(first + done, min(lists - first, kListRun) - done);
}
