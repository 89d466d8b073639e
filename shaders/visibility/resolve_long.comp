// A workgroup decides a pixel's list of more than kBatch.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"

const uint kRanked = kSorted;
#include "visibility/resolve.glsl"

const uint kBins = kBatch * 4u;

shared uint bins[kBins]; // how many entries' keys lie in each of the ranges that the keys are divided into
shared uint sums[kBatch];
shared uint count;
shared uint nearest; // keys of a list
shared uint farthest;
shared uint listKeys[kSorted]; // of a list that is not longer

/// Where a longer list keeps its keys. Each invocation reads only those that it wrote.
uint keyAt(uint i) { return params.maxPairs + i; }
uint keyOf(uint begin, uint end, uint i) {
  if (end - begin <= kSorted) return listKeys[i - begin];
  return entries[keyAt(i)];
}

/// How many of the first bins hold at most kBatch entries together.
uint binsOfBatch() {
  uint lane = gl_LocalInvocationIndex;
  uvec4 own = uvec4(bins[lane * 4u], bins[lane * 4u + 1u], bins[lane * 4u + 2u], bins[lane * 4u + 3u]);
  own.y += own.x;
  own.z += own.y;
  own.w += own.z;
  sums[lane] = own.w;
  if (lane == 0u) count = 0u;
  barrier();
  for (uint step = 1u; step < kBatch; step *= 2u) {
    uint before = lane >= step ? sums[lane - step] : 0u;
    barrier();
    sums[lane] += before;
    barrier();
  }
  own += sums[lane] - own.w;
  uint fitting =
      uint(own.x <= kBatch) + uint(own.y <= kBatch) + uint(own.z <= kBatch) + uint(own.w <= kBatch);
  if (fitting != 0u) atomicAdd(count, fitting);
  barrier();
  fitting = count;
  barrier();
  return fitting;
}

/// The farthest key up to which entries from `low` on are sorted together: at most kBatch, or at most kSorted that have
/// one and the same key; false where more have it.
bool lastKey(uint begin, uint end, uint low, out uint high) {
  high = farthest;
  while (true) {
    uint shift = uint(max(findMSB(high - low) - 6, 0));
    for (uint i = gl_LocalInvocationIndex; i < kBins; i += kBatch) bins[i] = 0u;
    barrier();
    for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kBatch) {
      uint key = keyOf(begin, end, i);
      if (key >= low && key <= high) atomicAdd(bins[(key - low) >> shift], 1u);
    }
    barrier();
    uint first = bins[0];
    uint fitting = binsOfBatch();
    if (fitting == kBins) return true;
    uint span = max(fitting, 1u) << shift;
    if (span <= high - low) high = low + span - 1u;
    if (fitting != 0u) return true;
    if (shift == 0u) return first <= kSorted;
  }
}

/// Goes through entries whose items and keys are there; false once all samples are covered.
bool resolveSorted(uint n, ivec2 pixel, inout uvec4 covered) {
  uint lane = laneOf();
  for (uint i = lane; i < n; i += kBatch) takeRank(rankOf(i, n));
  barrier();
  for (uint first = 0u; first < n; first += kBatch) { // more than one batch where all have the same key
    for (uint i = lane; i < n; i += kBatch) {
      uint place = rankOf(i, n);
      if (ties != 0u) place += rankAmongSame(i, n);
      place -= first;
      if (place >= kBatch) continue;
      Candidate c = readCandidate(items[i]);
      put(place, outlineOf(c, pixel), c.id);
    }
    uint batch = min(n - first, kBatch);
    lookAtBatch(batch, covered);
    if ((seen & (1u << lane)) != 0u) show(ids[lane]);
    bool more = holes != 0u;
    barrier();
    if (!more) return false;
  }
  return true;
}

/// Gets the entries whose keys lie in a range; returns how many.
uint takeEntries(uint begin, uint end, uint low, uint high) {
  if (gl_LocalInvocationIndex == 0u) count = 0u;
  clearRanks();
  barrier();
  for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kBatch) {
    uint key = keyOf(begin, end, i);
    if (key < low || key > high) continue;
    uint place = atomicAdd(count, 1u);
    items[place] = entries[i];
    keys[place >> 2u][place & 3u] = key;
  }
  barrier();
  return count;
}

/// A pixel with more than kSorted entries of one and the same depth shows those that are left.
void showRest(uint begin, uint end, uint low) {
  for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kBatch) {
    uint id = candidateId(entries[i]);
    if (keyOf(begin, end, i) < low || isShown(id)) continue;
    show(id);
    atomicAdd(counters.unresolved, 1u);
  }
}

void resolveLong(uint begin, uint end, ivec2 pixel) {
  if (gl_LocalInvocationIndex == 0u) {
    nearest = kFarthest;
    farthest = 0u;
  }
  barrier();
  uint least = kFarthest;
  uint most = 0u;
  for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kBatch) {
    Candidate c = readCandidate(entries[i]);
    ScreenTriangle t = triangleOf(c);
    Footing footing = footingOf(t, isCompact(t), pixel);
    uint key = middleKey(c, outlineOf(c, pixel), footing, pixel, params.reversedDepth != 0u);
    if (end - begin <= kSorted) listKeys[i - begin] = key;
    else entries[keyAt(i)] = key;
    least = min(least, key);
    most = max(most, key);
  }
  atomicMin(nearest, least);
  atomicMax(farthest, most);
  barrier();
  uvec4 covered = uvec4(0u);
  uint low = nearest;
  bool more = true;
  while (more) {
    uint high;
    if (!lastKey(begin, end, low, high)) {
      showRest(begin, end, low);
      break;
    }
    more = resolveSorted(takeEntries(begin, end, low, high), pixel, covered) && high != farthest;
    low = high + 1u;
    barrier();
  }
}

void main() {
  uint pixels = counters.longCount;
  for (uint i = gl_WorkGroupID.x; i < pixels; i += gl_NumWorkGroups.x) {
    uint slot = open[params.pixelCapacity - 1u - i];
    uint end = slots[slot];
    resolveLong(end - slots[lengthAt(slot)], end, pixelOf(slot));
    barrier();
  }
}
