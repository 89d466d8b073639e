// A workgroup decides a pixel's list of more than kBatch.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 32) in; // kBatch

const uint kRanked = kSorted;
const uint kTeams = 1u;
#include "visibility/resolve.glsl"

shared uint count;

/// Where a long list keeps its keys. Each invocation reads only those that it wrote.
uint keyAt(uint i) { return params.maxPairs + i; }

/// How many entries' keys lie in a range, both ends included.
uint countKeys(uint begin, uint end, uint low, uint high) {
  if (gl_LocalInvocationIndex == 0u) count = 0u;
  barrier();
  uint own = 0u;
  for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kBatch) {
    uint key = entries[keyAt(i)];
    if (key >= low && key <= high) ++own;
  }
  if (own != 0u) atomicAdd(count, own);
  barrier();
  uint all_ = count;
  barrier();
  return all_;
}

/// The farthest key up to which there are at most kSorted entries from `low` on; false where its own are more.
bool lastKey(uint begin, uint end, uint low, out uint high) {
  high = 0u;
  for (int bit = 31; bit >= 0; --bit) {
    uint tried = high | (1u << uint(bit));
    if (tried < low || countKeys(begin, end, low, tried) <= kSorted) high = tried;
  }
  return high >= low && countKeys(begin, end, low, high) <= kSorted;
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

/// A list whose entries are sorted together.
void resolveMedium(uint begin, uint n, ivec2 pixel) {
  clearRanks();
  for (uint i = gl_LocalInvocationIndex; i < n; i += kBatch) {
    items[0][i] = entries[begin + i];
    Candidate c = readCandidate(items[0][i]);
    keys[0][i >> 2u][i & 3u] = middleKey(c, outlineOf(c, pixel), pixel, params.reversedDepth != 0u);
  }
  barrier();
  uvec4 covered = uvec4(0u);
  resolveSorted(n, pixel, covered);
}

/// Gets the entries whose keys lie in a range; returns how many.
uint takeEntries(uint begin, uint end, uint low, uint high) {
  if (gl_LocalInvocationIndex == 0u) count = 0u;
  clearRanks();
  barrier();
  for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kBatch) {
    uint key = entries[keyAt(i)];
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
    if (entries[keyAt(i)] < low || (bits[id >> 5u] & (1u << (id & 31u))) != 0u) continue;
    show(id);
    atomicAdd(counters.unresolved, 1u);
  }
}

void resolveLong(uint begin, uint end, ivec2 pixel) {
  for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kBatch) {
    Candidate c = readCandidate(entries[i]);
    entries[keyAt(i)] = middleKey(c, outlineOf(c, pixel), pixel, params.reversedDepth != 0u);
  }
  uvec4 covered = uvec4(0u);
  uint low = 0u;
  bool more = true;
  while (more) {
    uint high;
    if (!lastKey(begin, end, low, high)) {
      showRest(begin, end, low);
      break;
    }
    more = resolveSorted(takeEntries(begin, end, low, high), pixel, covered) && high != kFarthest;
    low = high + 1u;
    barrier();
  }
}

void main() {
  uint pixels = counters.longCount;
  for (uint i = gl_WorkGroupID.x; i < pixels; i += gl_NumWorkGroups.x) {
    uint slot = open[params.pixelCapacity - 1u - i];
    uint end = slots[slot];
    uint n = slots[lengthAt(slot)];
    if (n <= kSorted) resolveMedium(end - n, n, pixelOf(slot));
    else resolveLong(end - n, end, pixelOf(slot));
    barrier();
  }
}
