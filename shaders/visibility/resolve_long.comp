// A workgroup decides a pixel's list of more than kBatch.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 32) in; // kBatch

const uint kRanked = kSorted;
const uint kTeams = 1u;
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

/// The farthest key up to which entries from `low` on are sorted together: at most kBatch, or those of a range of keys
/// that holds more, at most kSorted; false where more have one and the same key.
bool lastKey(uint begin, uint end, uint low, out uint high) {
  high = farthest;
  while (true) {
    uint shift = uint(max(findMSB(high - low) - 6, 0));
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < kBins; i += kBatch) bins[i] = 0u;
    barrier();
    for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kBatch) {
      uint key = keyOf(begin, end, i);
      if (key >= low && key <= high) atomicAdd(bins[(key - low) >> shift], 1u);
    }
    barrier();
    uint fitting = binsOfBatch();
    if (fitting == kBins) return true;
    uint span = max(fitting, 1u) << shift;
    if (span <= high - low) high = low + span - 1u;
    if (fitting != 0u || bins[0] <= kSorted) return true;
    if (shift == 0u) return false;
  }
}

/// Goes through entries whose items and keys are there; false once all samples are covered.
bool resolveSorted(uint n, ivec2 pixel, inout uvec4 covered) {
  uint lane = gl_LocalInvocationIndex;
  uint ranks[kSorted / kBatch];
  for (uint j = 0u; j < kSorted / kBatch; ++j) {
    ranks[j] = kNoTriangle;
    if (j * kBatch + lane < n) ranks[j] = rankOf(j * kBatch + lane, n);
  }
  barrier();
  if (ties[0] != 0u)
    for (uint j = 0u; j < kSorted / kBatch; ++j)
      if (j * kBatch + lane < n) ranks[j] += rankAmongSame(j * kBatch + lane, n);
  for (uint first = 0u; first < n; first += kBatch) {
    for (uint j = 0u; j < kSorted / kBatch; ++j) {
      uint place = ranks[j] - first;
      if (place >= kBatch) continue;
      Candidate c = readCandidate(items[0][j * kBatch + lane]);
      put(place, outlineOf(c, pixel), c.id);
    }
    if (!resolveBatch(min(n - first, kBatch), covered)) return false;
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
    items[0][place] = entries[i];
    keys[0][place >> 2u][place & 3u] = key;
  }
  barrier();
  return count;
}

/// A pixel with more than kSorted entries of one and the same depth shows those that are left.
void showRest(uint begin, uint end, uint low) {
  for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kBatch) {
    uint id = candidateId(entries[i]);
    if (keyOf(begin, end, i) < low || (bits[id >> 5u] & (1u << (id & 31u))) != 0u) continue;
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
    uint key = middleKey(c, outlineOf(c, pixel), pixel, params.reversedDepth != 0u);
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
