#version 460
#extension GL_GOOGLE_include_directive : require
// Terminal records in order of bucket and path key, so that it does not depend on execution where an instance lies or
// which ones a buffer that is too small leaves out.
//
// Path keys are hashes, so a key says about where its record belongs: each bucket's records go to as many bins as there
// are of them, by their key's share of the range. Bins are counted, summed and filled; within a bin, which holds one
// record on average, each finds its place by comparing. Only axioms that share seed and id make keys that are equal;
// those lie in the order of the axioms, and where they fill a bin with more than kMaxInBin, in no stated order.
#include "spawn/bindings.glsl"
layout(local_size_x = 64) in; // kSpawnGroupSize
layout(constant_id = 0) const uint stage = 0;
const uint kMaxInBin = 1024;

shared uint sums[kSpawnGroupSize];

uint keptRecords() { return min(state.terminals, record.maxTerminals); }
uvec2 keyOf(uint i) { return records[5 * record.maxTerminals + i].xy; }

// Where in order[]: counts of bins, which become their starts; which of its bin's a record is; records by bin; records
// in order; sums over the parts of the bins.
uint binAt(uint bin) { return bin; }
uint arrivalAt(uint i) { return record.maxTerminals + i; }
uint binnedAt(uint place) { return 2 * record.maxTerminals + place; }
uint partAt(uint part) { return 4 * record.maxTerminals + part; }

uint binOf(uint i) {
  const uint bucket = graphWords[records[4 * record.maxTerminals + i].w + kNodeArgument2];
  uint share;
  uint rest;
  umulExtended(keyOf(i).x, bucketCounts[bucket], share, rest);
  return bucketCounts[kBucketPlaces + bucket] + share;
}

/// The sum of values of lanes up to this one; the last one's is over all.
uint sumUpTo(uint value) {
  const uint lane = gl_LocalInvocationIndex;
  sums[lane] = value;
  barrier();
  for (uint step = 1; step < kSpawnGroupSize; step *= 2) {
    const uint before = lane >= step ? sums[lane - step] : 0;
    barrier();
    sums[lane] += before;
    barrier();
  }
  return sums[lane];
}

/// The bins of a workgroup of the two stages that sum, a multiple of the workgroup's size.
uint partSize(uint kept) {
  const uint tiles = (kept + kSpawnGroupSize - 1) / kSpawnGroupSize;
  return (tiles + kOrderParts - 1) / kOrderParts * kSpawnGroupSize;
}

void sumPart(uint kept) {
  const uint first = gl_WorkGroupID.x * partSize(kept);
  const uint last = min(first + partSize(kept), kept);
  uint sum = 0;
  for (uint i = first + gl_LocalInvocationIndex; i < last; i += kSpawnGroupSize) sum += order[binAt(i)];
  sumUpTo(sum);
  if (gl_LocalInvocationIndex == 0) order[partAt(gl_WorkGroupID.x)] = sums[kSpawnGroupSize - 1];
}

void startsOfPart(uint kept) {
  const uint lane = gl_LocalInvocationIndex;
  uint before = 0;
  for (uint part = lane; part < gl_WorkGroupID.x; part += kSpawnGroupSize) before += order[partAt(part)];
  sumUpTo(before);
  before = sums[kSpawnGroupSize - 1];
  const uint first = gl_WorkGroupID.x * partSize(kept);
  const uint last = min(first + partSize(kept), kept);
  for (uint tile = first; tile < last; tile += kSpawnGroupSize) {
    const uint bin = tile + lane;
    const uint count = bin < last ? order[binAt(bin)] : 0;
    barrier();
    const uint upTo = sumUpTo(count);
    if (bin < last) order[binAt(bin)] = before + upTo - count;
    before += sums[kSpawnGroupSize - 1];
  }
}

/// The place of what lies at `place` among the bins.
uint ranked(uint place, uint kept) {
  const uint i = order[binnedAt(place)];
  const uint bin = binOf(i);
  const uint first = order[binAt(bin)];
  const uint last = bin + 1 < kept ? order[binAt(bin + 1)] : kept;
  if (last - first > kMaxInBin) return place;
  const uvec2 key = keyOf(i);
  const uint axiom = records[3 * record.maxTerminals + i].w;
  uint rank = first;
  for (uint other = first; other < last; ++other) {
    if (other == place) continue;
    const uint o = order[binnedAt(other)];
    const uvec2 otherKey = keyOf(o);
    if (otherKey.x != key.x ? otherKey.x < key.x : otherKey.y != key.y ? otherKey.y < key.y
        : records[3 * record.maxTerminals + o].w != axiom ? records[3 * record.maxTerminals + o].w < axiom
                                                          : other < place)
      rank += 1;
  }
  return rank;
}

void main() {
  const uint kept = keptRecords();
  if (stage == kOrderSum) {
    sumPart(kept);
  } else if (stage == kOrderStarts) {
    startsOfPart(kept);
  } else {
    for (uint i = gl_GlobalInvocationID.x; i < kept; i += gl_NumWorkGroups.x * kSpawnGroupSize) {
      if (stage == kOrderCount) order[arrivalAt(i)] = atomicAdd(order[binAt(binOf(i))], 1);
      if (stage == kOrderFill) order[binnedAt(order[binAt(binOf(i))] + order[arrivalAt(i)])] = i;
      if (stage == kOrderRank) order[orderedAt(ranked(i, kept))] = order[binnedAt(i)];
    }
  }
}
