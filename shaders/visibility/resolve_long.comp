// Decides a pixel's list of more than kBatch: the nearest kBatch first, and so on until all samples are covered.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
#include "visibility/layout.h"
#include "visibility/planes.glsl"
#include "visibility/turns.h"

#include "visibility/ended.glsl"

/// Keys lie as the entries do. Each invocation reads only those that it wrote.
layout(std430, set = 0, binding = kBindKeys) buffer KeyBuffer { uint depths[]; };

const uint kBins = kBatch * 2u;

shared uint bins[kBins]; // of the ranges that keys are divided into, how many entries each holds
shared uint count;

/// The part of a list that is not decided yet.
struct Rest {
  uint begin;
  uint end;
  uint low; // what is nearer is decided
  uint before; // how many that are
  uint nearest;
  uint farthest;
  uint turns; // of loops, so far
  bool byNumber; // of one depth, divided by their triangles' numbers: low and farthest are such
  uint depth;    // that one
};
uint sizeOf(Rest rest) { return rest.end - rest.begin; } // of the whole list

/// Whether an entry lies in a range of the keys by which the rest is divided just now.
bool isWithin(Rest rest, uint i, uint low, uint high) {
  uint key = depths[i];
  if (rest.byNumber) {
    if (key != rest.depth) return false;
    key = candidateId(entries[i]);
  }
  return key >= low && key <= high;
}
uint keyOf(Rest rest, uint i) { return rest.byNumber ? candidateId(entries[i]) : depths[i]; }

/// How many of the first bins hold at most kBatch entries together.
uint binsOfBatch() {
  uint lane = laneOf();
  uvec2 held = uvec2(bins[lane * 2u], bins[lane * 2u + 1u]);
  uint second = sumUpTo(held.x + held.y);
  uint first = second - held.y;
  // The sums grow, so those that fit come first.
  return maxAll(second <= kBatch ? lane * 2u + 2u : first <= kBatch ? lane * 2u + 1u : 0u);
}

/// The farthest key up to which entries are decided next: at most kBatch, or those that have one and the same key.
uint lastKey(inout Rest rest) {
  uint lane = laneOf();
  uint high = rest.farthest;
  while (true) {
    uint shift = uint(max(findMSB(high - rest.low) - 5, 0));
    rest.turns += turnsThrough(sizeOf(rest));
    bins[lane] = 0u;
    bins[lane + kBatch] = 0u;
    sync();
    for (uint i = rest.begin + lane; i < rest.end; i += kBatch) {
      if (isWithin(rest, i, rest.low, high)) atomicAdd(bins[(keyOf(rest, i) - rest.low) >> shift], 1u);
    }
    sync();
    uint fitting = binsOfBatch();
    if (fitting == kBins) return high;
    uint span = max(fitting, 1u) << shift;
    if (span <= high - rest.low) high = rest.low + span - 1u;
    if (fitting != 0u || shift == 0u) return high;
    sync();
  }
}

/// Gets the entries up to a key, if they are not more than kBatch; returns how many there are.
uint takeEntries(Rest rest, uint high) {
  if (laneOf() == 0u) count = 0u;
  setKey(laneOf(), kFarthest);
  sync();
  for (uint i = rest.begin + laneOf(); i < rest.end; i += kBatch) {
    if (!isWithin(rest, i, rest.low, high)) continue;
    uint at = atomicAdd(count, 1u);
    if (at >= kBatch) continue;
    items[at] = entries[i];
    setKey(at, depths[i]);
  }
  sync();
  return count;
}

/// Whether an entry's box may hold one of the open samples.
bool reachesOpen(Facet f, uvec4 uncovered) {
  uvec2 columns = uvec2(orAll(uncovered.x | uncovered.z), orAll(uncovered.y | uncovered.w));
  uvec2 rows = uvec2(lanesWith((uncovered.x | uncovered.y) != 0u), lanesWith((uncovered.z | uncovered.w) != 0u));
  return reaches(f, columns, rows);
}

/// Goes through a batch, whose items and keys are there; false once all samples are covered.
bool resolveBatch(Rest rest, uint n, uint place, ivec2 pixel, inout uvec4 uncovered) {
  Entry own = noEntry();
  own.place = place;
  bool isThere = laneOf() < n;
  bool isKnown = true;
  bool isWide = false;
  Facet f = facetOf(vec3(0.0), 0u);
  if (isThere) {
    Candidate c = readCandidate(items[laneOf()]);
    own.id = c.id;
    isKnown = isShown(c.id);
    isWide = !isCompact(triangleOf(c));
    putCorners(cornersOf(c), pixel * 256);
    put(place, outlineOf(c, pixel), parallaxIn(pixel, rest.nearest, keyAt(laneOf()), rest.before + place));
    f = facetOf(c, footingIn(c, pixel), pixel, params.reversedDepth != 0u);
    setFacet(own, f);
  }
  uvec4 open_ = uncovered;
  bool decides = reachesOpen(f, open_);
  if (isThere && decides) own.list = bitsFrom(0, int(n));
  Looked looked = lookAtBatch(0u, n, movesIn(pixel), uncovered);
  own.isSeen = isThere && (looked.seen & (1u << place)) != 0u;
  uint reach = maxAll(own.isSeen ? orderOf(own.farthest) : 0u);
  bool asks = own.list != 0u && !isKnown && isAsked(own, reach);
  if (decide(own, asks, isWide, open_) && !isKnown) show(own.id);
  sync();
  return looked.holes;
}

/// Divides entries of one and the same depth by their triangles' numbers.
void goByNumber(inout Rest rest) {
  uint least = 0xffffffffu;
  uint most = 0u;
  for (uint i = rest.begin + laneOf(); i < rest.end; i += kBatch) {
    if (depths[i] != rest.low) continue;
    uint id = candidateId(entries[i]);
    least = min(least, id);
    most = max(most, id);
  }
  rest.turns += turnsThrough(sizeOf(rest));
  rest.byNumber = true;
  rest.depth = rest.low;
  rest.low = minAll(least);
  rest.farthest = maxAll(most);
}

/// A pixel that would take too long shows those that are left.
void showRest(Rest rest) {
  for (uint i = rest.begin + laneOf(); i < rest.end; i += kBatch) {
    uint id = candidateId(entries[i]);
    bool isLeft = rest.byNumber ? depths[i] > rest.depth || isWithin(rest, i, rest.low, rest.farthest)
                                : depths[i] >= rest.low;
    if (!isLeft) continue;
    atomicAdd(counters.unresolved, 1u); // whoever else shows it, in whatever order
    show(id);
  }
}

void resolveLong(uint begin, uint end, ivec2 pixel) {
  uint least = kFarthest;
  uint most = 0u;
  for (uint i = begin + laneOf(); i < end; i += kBatch) {
    Candidate c = readCandidate(entries[i]);
    uint key = middleKey(c, outlineOf(c, pixel), footingIn(c, pixel), pixel, params.reversedDepth != 0u);
    depths[i] = key;
    least = min(least, key);
    most = max(most, key);
  }
  Rest rest;
  rest.begin = begin;
  rest.end = end;
  rest.before = 0u;
  rest.nearest = minAll(least);
  rest.low = rest.nearest;
  uint farthest = maxAll(most);
  rest.farthest = farthest;
  rest.turns = turnsThrough(sizeOf(rest));
  rest.byNumber = false;
  rest.depth = 0u;
  uvec4 uncovered = uvec4(0xffffffffu);
  bool more = !takesTooLong(rest.turns, sizeOf(rest));
  if (!more) showRest(rest);
  while (more) {
    uint high = lastKey(rest);
    sync();
    uint n = takeEntries(rest, high);
    rest.turns += turnsThrough(sizeOf(rest));
    if (n > kBatch && !rest.byNumber) {
      goByNumber(rest);
      continue;
    }
    rest.turns += turnsOfBatch(min(n, kBatch));
    if (n > kBatch || takesTooLong(rest.turns, sizeOf(rest))) {
      showRest(rest);
      break;
    }
    more = resolveBatch(rest, n, placeAmong(laneOf() < n, 0u, n), pixel, uncovered);
    rest.before += n;
    rest.low = high + 1u;
    if (high != rest.farthest) continue;
    more = more && rest.byNumber && rest.depth != farthest;
    rest.low = rest.depth + 1u;
    rest.farthest = farthest;
    rest.byNumber = false;
  }
}

/// Which of all long lists is decided as the i-th. Pixels beside each other, whose lists lie so, too, have triangles in
/// common: where they are decided long after one another, the later one need not ask about what the earlier one shows.
uint turnOf(uint i, uint lists) {
  const uint phases = 64u;
  uint each = lists / phases;
  return i < each * phases ? (i % each) * phases + i / each : i;
}

void main() {
  makeColumns();
  uint pixels = counters.longCount;
  uint i = gl_WorkGroupID.y * kMaxGroups + gl_WorkGroupID.x; // each has turns of its own
  if (i >= pixels) return;
  uint slot = open[params.pixelCapacity - 1u - turnOf(i, pixels)];
  uint end = slots[slot];
  uint begin = end - slots[lengthAt(slot)];
  ivec2 pixel = pixelOf(slot);
  sync();
  resolveLong(begin, end, pixel);
  sayIfEnded();
}
