#version 460
#extension GL_GOOGLE_include_directive : require
// After derivation, one workgroup: what each bucket got and where it begins, the engine's draw commands, the dispatch
// of emission, and the rest of the report.
#include "spawn/shared/bindings.glsl"

#include "spawn/outputs/regions.glsl"
layout(local_size_x = 64) in;                 // kSpawnGroupSize
layout(constant_id = 0) const bool quads = false; // terminals are quads of vertices, not instances

shared uint sums[kSpawnGroupSize];
shared uint allWritten;

void writeDraw(uint bucket, uint start, uint count, bool setStart) {
  if (bucket >= record.drawCapacity) return;
  const uint draw = bucket * kDrawWords;
  if (quads) {
    draws[draw] = count * 6;
    if (setStart) draws[draw + 2] = start * 6;
    draws[draw + 3] = start * 4;
  } else {
    draws[draw + 1] = count;
    if (setStart) draws[draw + 4] = start + record.firstInstance;
  }
}

/// Instances, or quads, that were made room for.
uint placedIn(uint bucket) {
  const uint count = bucketCounts[bucket];
  if (!quads || record.terminalsTo != kToKeyedRecords) return count;
  const uint first = bucketCounts[kBucketPlaces + bucket];
  return order[quadsBefore(first + count)] - order[quadsBefore(first)];
}

void main() {
  const uint lane = gl_LocalInvocationIndex;
  const bool regions = record.regions != 0;
  const bool measured = !quads && record.instanceCapacity == 0 && record.terminalsTo == kToKeyedRecords;
  const bool counted = record.terminalsTo == kToCounts || measured; // its records are for nothing else
  const bool keyed = record.terminalsTo == kToKeyedRecords;
  const bool sorted = !quads && keyed && !counted;
  const uint kept = sorted ? min(state.terminals, record.maxTerminals) : state.terminals;
  const bool lost = quads && !counted; // some may be, whose quads nobody made room for
  const uint fitting = record.byAxiom != 0 ? kept - state.instancesWritten : min(kept, record.instanceCapacity);
  const uint buckets = graphWords[kHeaderBuckets];
  if (lane == 0) allWritten = 0;
  uint needed = 0;
  if (sorted || regions || counted) {
    const uint each = kMaxBuckets / kSpawnGroupSize;
    for (uint i = 0; i < each; ++i)
      needed += placedIn(lane * each + i) + (lost ? bucketCounts[kBucketLost + lane * each + i] : 0);
    sums[lane] = needed;
    barrier();
    for (uint step = 1; step < kSpawnGroupSize; step *= 2) {
      const uint before = lane >= step ? sums[lane - step] : 0;
      barrier();
      sums[lane] += before;
      barrier();
    }
    uint start = sums[lane] - needed;
    needed = sums[kSpawnGroupSize - 1];
    uint written = 0;
    for (uint i = 0; i < each; ++i) {
      const uint bucket = lane * each + i;
      if (bucket >= buckets) break;
      const uint placed = placedIn(bucket);
      const uint count = placed + (lost ? bucketCounts[kBucketLost + bucket] : 0);
      uint begin = start;
      uint got = placed;
      if (sorted) bucketCounts[kBucketPlaces + bucket] = start;
      if (regions) {
        begin = regionStart(bucket, quads);
        got = min(placed, regionCapacity(bucket, quads)) - bucketCounts[kBucketGaps + bucket];
      } else if (sorted) {
        begin = min(start, fitting);
        got = min(start + count, fitting) - begin;
      }
      writeDraw(bucket, begin, got, !regions);
      if (record.writeNeeded != 0) neededCounts[bucket] = quads ? count * 6 : count;
      written += counted ? 0 : got;
      start += count;
    }
    atomicAdd(allWritten, written);
    barrier();
  } else if (lane == 0) {
    const uint placed = keyed ? order[quadsBefore(min(kept, record.maxTerminals))] : bucketCounts[0];
    needed = quads ? placed + bucketCounts[kBucketLost] : state.terminals;
    allWritten = quads ? min(placed, record.quadCapacity) - bucketCounts[kBucketGaps] : fitting;
    if (record.drawCapacity > 0 && buckets > 0) {
      if (quads)
        draws[0] = allWritten * 6;
      else
        writeDraw(0, 0, allWritten, true);
    }
  }
  if (lane == 0) {
    const uint left = rounds[record.rounds].shapes;
    state.peakShapes = max(state.peakShapes, left);
    state.droppedShapes += left;
    if (quads) {
      state.quads = needed;
      state.quadsWritten = allWritten;
    } else {
      state.instancesWritten = allWritten;
      if (sorted) needed = state.terminals;
    }
    const bool lacksRecords = measured && state.terminals > record.maxTerminals;
    state.exceeded = (!counted && allWritten < needed) || lacksRecords ? 1 : 0;
    dispatchRecords(kept);
    if (record.writeCount != 0) instanceCount = quads ? allWritten * 6 : allWritten;
  }
}
