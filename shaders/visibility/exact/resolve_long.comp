// Decides a pixel's list of more than kBatch: those that come nearest first, up to kBatch together, until all samples
// are covered and what is left begins behind all that covers them.
//
// Of what a batch shows, that which reaches behind where the next one begins is carried over to it, so that planes
// decide between both. Where too many do, those that reach least far are not: what they leave in doubt is shown.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
#include "visibility/shared/layout.h"
#include "visibility/exact/planes.glsl"
#include "visibility/shared/turns.h"

#include "visibility/shared/loops_ended.glsl"

/// Keys lie as the entries do. Each invocation reads only those that it wrote.
layout(std430, set = 0, binding = kBindKeys) buffer KeyBuffer { uint depths[]; };

const uint kBins = kBatch * 2u;

shared uint bins[kBins]; // of the ranges that keys are divided into, how many entries each holds
shared uint count;

/// The part of a list that is not decided yet.
struct Rest {
  uint begin;
  uint end;
  uint low;     // what begins nearer is decided
  uint last;    // what begins farther is hidden
  uint carried; // items that lie there already
  uint before;  // how many were decided, but for those
  uint nearest;
  uint farthest;
  bool hasDoubt; // some samples are doubted
  uint doubt;    // where what is behind them begins
  uint turns;    // of loops, so far
  bool byNumber; // of one depth, divided by their triangles' numbers: low and last are such
  uint depth;    // that one
};
uint sizeOf(Rest rest) { return rest.end - rest.begin; } // of the whole list
uint roomOf(Rest rest) { return kBatch - rest.carried; }

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

/// How many of the first bins hold at most so many entries together.
uint binsOf(uint most) {
  uint lane = laneOf();
  uvec2 held = uvec2(bins[lane * 2u], bins[lane * 2u + 1u]);
  uint second = sumUpTo(held.x + held.y);
  uint first = second - held.y;
  // The sums grow, so those that fit come first.
  return maxAll(second <= most ? lane * 2u + 2u : first <= most ? lane * 2u + 1u : 0u);
}

/// The farthest key up to which entries are decided next: at most roomOf(rest), or those that have one and the same.
uint lastKey(inout Rest rest) {
  uint lane = laneOf();
  uint high = rest.last;
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
    uint fitting = binsOf(roomOf(rest));
    if (fitting == kBins) return high;
    uint span = max(fitting, 1u) << shift;
    if (span <= high - rest.low) high = rest.low + span - 1u;
    if (fitting != 0u || shift == 0u) return high;
    sync();
  }
}

/// Gets the entries up to a key, behind the carried ones, if there is room for them; returns how many there are. next:
/// where those that are left begin, at least.
uint takeEntries(Rest rest, uint high, out uint next) {
  if (laneOf() == 0u) count = rest.carried;
  sync();
  uint least = kFarthest;
  for (uint i = rest.begin + laneOf(); i < rest.end; i += kBatch) {
    uint key = depths[i];
    if (key > (rest.byNumber ? rest.depth : high)) least = min(least, key);
    if (!isWithin(rest, i, rest.low, high)) continue;
    uint at = atomicAdd(count, 1u);
    if (at < kBatch) items[at] = entries[i];
  }
  next = minAll(least);
  sync();
  return count - rest.carried;
}

/// Whether an entry's box may hold one of the open samples.
bool reachesOpen(Facet f, uvec4 uncovered) {
  uvec2 columns = uvec2(orAll(uncovered.x | uncovered.z), orAll(uncovered.y | uncovered.w));
  uvec2 rows = uvec2(lanesWith((uncovered.x | uncovered.y) != 0u), lanesWith((uncovered.z | uncovered.w) != 0u));
  return reaches(f, columns, rows);
}

/// Whoever else shows it, in whatever order.
void showUndecided(uint id) {
  atomicAdd(counters.unresolved, 1u);
  show(id);
}

/// A pixel that would take too long shows those that are left.
void showRest(Rest rest) {
  for (uint i = rest.begin + laneOf(); i < rest.end; i += kBatch) {
    bool isLeft = rest.byNumber ? depths[i] > rest.depth || isWithin(rest, i, rest.low, rest.last)
                                : depths[i] >= rest.low;
    if (isLeft) showUndecided(candidateId(entries[i]));
  }
}

/// The samples that are left, in the rows of each invocation.
struct Left {
  uvec4 uncovered;
  uvec4 doubted; // only such cover them as were not carried for want of room: what begins up to rest.doubt is undecided
};

/// Bits: places of those, of the given ones, that have a doubted sample.
uint doubtedAmong(uint places, uvec4 doubted) {
  uint found = 0u;
  for (; places != 0u; places &= places - 1u) {
    uint place = uint(findLSB(places));
    if (!isNone(ownAmong(place, doubted))) found |= 1u << place;
  }
  return orAll(found);
}

/// Goes through a batch, whose items are there: the carried ones and n others. next: where those that are left begin.
/// False once nothing that is left can be seen.
bool resolveBatch(inout Rest rest, uint n, uint next, ivec2 pixel, inout Left samples) {
  bool reversed = params.reversedDepth != 0u;
  n += rest.carried;
  Entry own = noEntry();
  bool isThere = laneOf() < n;
  bool isKnown = true;
  bool isWide = false;
  uint item = 0u;
  uint begin = 0u;
  uint end = 0u;
  uint key = kFarthest;
  Facet f = facetOf(vec3(0.0), 0u);
  Outline outline;
  if (isThere) {
    item = items[laneOf()];
    Candidate c = readCandidate(item);
    ScreenTriangle t = triangleOf(c);
    own.id = c.id;
    isKnown = isShown(c.id);
    isWide = !isCompact(t);
    putCorners(cornersOf(c), pixel * 256);
    Footing footing = footingOf(c, pixel);
    outline = outlineIn(c, pixel);
    key = middleKey(c, outline, footing, pixel, reversed);
    begin = nearestKey(t, footing, reversed);
    end = farthestKey(t, footing, reversed);
    f = facetOf(c, footing, pixel, reversed);
    setFacet(own, f);
  }
  setKey(laneOf(), key);
  own.place = placeAmong(isThere, 0u, n);
  if (isThere) putOpen(own.place, item, pixel);
  if (isThere) put(own.place, outline, parallaxIn(pixel, rest.nearest, key, rest.before + own.place));
  uvec4 open_ = samples.uncovered;
  bool decides = reachesOpen(f, open_);
  if (isThere && decides) own.list = bitsFrom(0, int(n));
  uvec4 left = samples.uncovered;
  Looked looked = lookAtBatch(0u, n, movesIn(pixel), left);
  uint bit = isThere ? 1u << own.place : 0u;
  own.isSeen = (looked.seen & bit) != 0u;
  uint reach = maxAll(own.isSeen ? orderOf(own.farthest) : 0u);
  bool ends = end < next;
  bool isDoubted = rest.hasDoubt && begin <= rest.doubt;
  bool asks = own.list != 0u && !isKnown && isAsked(own, reach);
  if (decide(own, asks, isWide, open_) && !isKnown) show(own.id);
  // What follows goes by the order alone: others show in whatever order, and what is known is not asked.
  if (rest.hasDoubt) {
    uint undecided = doubtedAmong(orAll(isThere && isDoubted && !own.isSeen ? bit : 0u), samples.doubted);
    if ((undecided & bit) != 0u) showUndecided(own.id);
  }
  bool goesOn = own.isSeen && !ends && !hidesNothing(own.place);
  uint going = lanesWith(goesOn);
  uint forced = 0u;
  if (uint(bitCount(going)) > kMostCarried) {
    sync();
    setKey(laneOf(), goesOn ? end : kFarthest);
    sync();
    bool isForced = goesOn && rankOf(laneOf(), 0u, kBatch) < uint(bitCount(going)) - kKeptCarried;
    rest.doubt = max(rest.doubt, maxAll(isForced ? end : 1u) - 1u);
    forced = orAll(isForced ? bit : 0u);
    goesOn = goesOn && !isForced;
    going = lanesWith(goesOn);
  }
  // What ends is behind nothing that is left.
  if (going != 0u || forced != 0u || rest.hasDoubt) {
    for (uint ending = orAll(ends ? bit : 0u); ending != 0u; ending &= ending - 1u) {
      uint place = uint(findLSB(ending));
      samples.uncovered = openBehind(place, samples.uncovered);
      samples.doubted = openBehind(place, samples.doubted);
    }
    for (; forced != 0u; forced &= forced - 1u) {
      uvec4 left_ = openBehind(uint(findLSB(forced)), samples.uncovered);
      samples.doubted |= samples.uncovered & ~left_;
      samples.uncovered = left_;
    }
    rest.hasDoubt = lanesWith(!isNone(samples.doubted)) != 0u;
  }
  if (going == 0u) samples.uncovered = left;
  rest.before += n;
  rest.carried = uint(bitCount(going));
  rest.before -= rest.carried;
  uint farthest = max(maxAll(goesOn ? end : 0u), rest.hasDoubt ? rest.doubt : 0u);
  sync();
  if (goesOn) items[bitCount(going & ((1u << laneOf()) - 1u))] = item;
  if (looked.holes) return true;
  rest.farthest = min(rest.farthest, farthest);
  return (going != 0u || rest.hasDoubt) && (rest.byNumber || next <= rest.farthest);
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
  rest.last = maxAll(most);
}

void resolveLong(uint begin, uint end, ivec2 pixel) {
  uint least = kFarthest;
  uint most = 0u;
  for (uint i = begin + laneOf(); i < end; i += kBatch) {
    Candidate c = readCandidate(entries[i]);
    uint key = nearestKey(c, pixel, params.reversedDepth != 0u);
    depths[i] = key;
    least = min(least, key);
    most = max(most, key);
  }
  Rest rest;
  rest.begin = begin;
  rest.end = end;
  rest.carried = 0u;
  rest.before = 0u;
  rest.nearest = minAll(least);
  rest.low = rest.nearest;
  rest.farthest = maxAll(most);
  rest.last = rest.farthest;
  rest.hasDoubt = false;
  rest.doubt = 0u;
  rest.turns = turnsThrough(sizeOf(rest));
  rest.byNumber = false;
  rest.depth = 0u;
  Left samples;
  samples.uncovered = uvec4(0xffffffffu);
  samples.doubted = uvec4(0u);
  bool more = !takesTooLong(rest.turns, sizeOf(rest));
  if (!more) showRest(rest);
  while (more) {
    uint high = lastKey(rest);
    sync();
    uint next;
    uint n = takeEntries(rest, high, next);
    rest.turns += turnsThrough(sizeOf(rest));
    if (n > roomOf(rest) && !rest.byNumber) {
      goByNumber(rest);
      continue;
    }
    rest.turns += turnsOfBatch(min(n + rest.carried, kBatch));
    if (n > roomOf(rest) || takesTooLong(rest.turns, sizeOf(rest))) {
      showRest(rest);
      break;
    }
    bool isLast = high == rest.last;
    rest.low = high + 1u;
    if (rest.byNumber && isLast) rest.byNumber = false;
    if (!rest.byNumber) rest.low = next;
    more = resolveBatch(rest, n, rest.byNumber ? rest.depth + 1u : next, pixel, samples);
    if (rest.byNumber) continue;
    more = more && next <= rest.farthest && next != kFarthest;
    rest.last = rest.farthest;
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
