#version 460
#extension GL_GOOGLE_include_directive : require
// Terminal records in order of bucket and path key, so that it does not depend on execution where an instance or a
// vertex lies, or which ones a buffer that is too small leaves out.
//
// Path keys are hashes, so a key says about where its record belongs: each bucket's records go to as many bins as there
// are of them, by their key's share of the range. Bins are counted, summed and filled; within a bin, which holds one
// record on average, each finds its place by comparing. Only axioms that share seed and id make keys that are equal;
// those lie in the order of the axioms, and where they fill a bin with more than kMaxInBin, in no stated order.
//
// For vertices, the quads of records in order are summed by the same two stages that sum the bins.
#include "spawn/shared/bindings.glsl"
layout(local_size_x = 64) in; // kSpawnGroupSize
layout(constant_id = 0) const uint stage = 0;
const uint kMaxInBin = 1024;
#include "spawn/outputs/mesh.h"

shared uint sums[kSpawnGroupSize];

uint keptRecords() { return min(state.terminals, record.maxTerminals); }
uvec2 keyOf(uint i) { return records[5 * record.maxTerminals + i].xy; }

// Where in order[]: counts of bins, which become their starts; which of its bin's a record is; records by bin; records
// in order; sums over the parts of the bins. Quads of records in order, and their sums, then lie from arrivalAt(0) on.
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

/// Where the counts begin that are summed.
uint summedAt() { return stage == kOrderSum || stage == kOrderStarts ? binAt(0) : quadsBefore(0); }

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

/// The bins, or records, of a workgroup of the two stages that sum, a multiple of the workgroup's size.
uint partSize(uint kept) {
  const uint tiles = (kept + kSpawnGroupSize - 1) / kSpawnGroupSize;
  return (tiles + kOrderParts - 1) / kOrderParts * kSpawnGroupSize;
}

void sumPart(uint kept) {
  const uint first = gl_WorkGroupID.x * partSize(kept);
  const uint last = min(first + partSize(kept), kept);
  uint sum = 0;
  for (uint i = first + gl_LocalInvocationIndex; i < last; i += kSpawnGroupSize) sum += order[summedAt() + i];
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
    const uint at = summedAt() + tile + lane;
    const bool own = tile + lane < last;
    const uint count = own ? order[at] : 0;
    barrier();
    const uint upTo = sumUpTo(count);
    if (own) order[at] = before + upTo - count;
    before += sums[kSpawnGroupSize - 1];
  }
  if (stage == kOrderQuadStarts && gl_WorkGroupID.x == kOrderParts - 1 && lane == 0) order[quadsBefore(kept)] = before;
}

/// One workgroup: buckets' places, and how many workgroups take the records.
void placeBuckets(uint kept) {
  const uint lane = gl_LocalInvocationIndex;
  const uint each = kMaxBuckets / kSpawnGroupSize;
  uint count = 0;
  for (uint i = 0; i < each; ++i) count += bucketCounts[lane * each + i];
  uint start = sumUpTo(count) - count;
  for (uint i = 0; i < each; ++i) {
    bucketCounts[kBucketPlaces + lane * each + i] = start;
    start += bucketCounts[lane * each + i];
  }
  if (lane == 0) dispatchRecords(kept);
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
  if (stage == kOrderBuckets) {
    placeBuckets(kept);
  } else if (stage == kOrderSum || stage == kOrderQuadSum) {
    sumPart(kept);
  } else if (stage == kOrderStarts || stage == kOrderQuadStarts) {
    startsOfPart(kept);
  } else {
    for (uint i = gl_GlobalInvocationID.x; i < kept; i += gl_NumWorkGroups.x * kSpawnGroupSize) {
      if (stage == kOrderCount) order[arrivalAt(i)] = atomicAdd(order[binAt(binOf(i))], 1);
      if (stage == kOrderFill) order[binnedAt(order[binAt(binOf(i))] + order[arrivalAt(i)])] = i;
      if (stage == kOrderRank) {
        const uint place = ranked(i, kept);
        const uint own = order[binnedAt(i)];
        order[orderedAt(place)] = own;
        if (record.quads != 0) order[quadsBefore(place)] = meshQuads(records[own].w);
      }
    }
  }
}
