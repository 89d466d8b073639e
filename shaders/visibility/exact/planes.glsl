// What planes decide of a batch of a list, or of several short ones, once the order by one depth each has proposed what
// is seen: what that may have wrong. Each invocation holds an entry.
#include "visibility/exact/facet.h"
#include "visibility/exact/resolve.glsl"

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
  uint list;   // bits: its list's entries, by invocation or by place; 0: it is none that planes decide
  bool isSeen; // by the order
  uint place;  // in the order
  uint id;
  vec3 plane; // of its facet, whose box is packed
  float nearest;
  float farthest;
  uint box;
};

Entry noEntry() {
  Entry e;
  e.list = 0u;
  e.isSeen = false;
  e.place = 0u;
  e.id = 0u;
  return e;
}

void setFacet(inout Entry own, Facet f) {
  own.plane = f.plane;
  own.nearest = f.nearest;
  own.farthest = f.farthest;
  own.box = uint(f.box.x) | uint(f.box.y) << 8u | uint(f.box.z) << 16u | uint(f.box.w) << 24u;
}
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
  any = any && leadWithin(nearer, farther) > 0.0;
  if (any && (wide & (1u << a | 1u << b)) == 0u) any = overlap(cornersAt(a), cornersAt(b));
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

/// Whether the entry of an invocation has a sample at which none of the others is nearer. wide: those that are not
/// compact; open: the samples that count, in the rows of each invocation.
bool isAhead(Entry own, uint lane, uint wide, uvec4 open_) {
  uvec4 told = fromLane(uvec4(own.id, floatBitsToUint(own.farthest), own.place, 0u), lane);
  Facet its = facetOfLane(own, lane);
  Facet mine = facetOf(own.plane, own.box);
  bool isRival = (own.list & (1u << lane)) != 0u && laneOf() != lane && own.nearest <= uintBitsToFloat(told.y);
  if (isRival) isRival = !hidesNothing(own.place);
  if (isRival) isRival = leadWithin(mine, its) >= 0.0;
  if (isRival && (wide & (1u << laneOf() | 1u << lane)) == 0u)
    isRival = overlap(cornersAt(laneOf()), cornersAt(lane));
  Crossing c = crossingOf(mine, its, own.id < told.x); // each works out its own entry's
  uvec4 hides = uvec4(floatBitsToUint(c.start), floatBitsToUint(c.step), uint(c.side), own.place);
  int row = int(laneOf());
  uvec4 rest = ownAmong(told.z, open_);
  bool any = true;
  for (uint left = lanesWith(isRival); left != 0u && any; left &= left - 1u) {
    uvec4 rival = fromLane(hides, uint(findLSB(left)));
    c.start = uintBitsToFloat(rival.x);
    c.step = uintBitsToFloat(rival.y);
    c.side = int(rival.z);
    Outline other = outlineAt(rival.w);
    uvec4 ahead = uvec4(samplesOf(spanAhead(other, c, row)), samplesOf(spanAhead(other, c, row + 32)));
    rest &= ~tested(rival.w, ahead & rest);
    any = lanesWith(!isNone(rest)) != 0u;
  }
  return lanesWith(!isNone(rest)) != 0u;
}

/// Whether this invocation's entry is visible: as the order says, corrected. asks: it may be wrong; open: the samples
/// that nothing before these entries covers.
bool decide(Entry own, bool asks, bool isWide, uvec4 open_) {
  uint wide = lanesWith(isWide);
  bool isVisible = own.isSeen;
  for (uint doubtful = doubtfulOf(own, asks, wide); doubtful != 0u; doubtful &= doubtful - 1u) {
    uint doubted = uint(findLSB(doubtful));
    bool ahead = isAhead(own, doubted, wide, open_);
    if (laneOf() == doubted) isVisible = ahead;
  }
  return isVisible;
}
