#version 460
#extension GL_GOOGLE_include_directive : require
// Between derivation and emission, one workgroup: where each bucket starts among the instances, the engine's draw
// commands, the dispatch of emission, and the rest of the report.
#include "spawn/bindings.glsl"

shared uint sums[kSpawnGroupSize];

void main() {
  const uint lane = gl_LocalInvocationIndex;
  const uint kept = min(state.terminals, maxTerminals);
  const uint written = min(kept, record.instanceCapacity);
  if (record.drawCapacity > 0) {
    const uint each = kMaxBuckets / kSpawnGroupSize;
    uint own = 0;
    for (uint i = 0; i < each; ++i) own += bucketCounts[lane * each + i];
    sums[lane] = own;
    barrier();
    for (uint step = 1; step < kSpawnGroupSize; step *= 2) {
      const uint before = lane >= step ? sums[lane - step] : 0;
      barrier();
      sums[lane] += before;
      barrier();
    }
    uint start = sums[lane] - own;
    for (uint i = 0; i < each; ++i) {
      const uint bucket = lane * each + i;
      const uint count = bucketCounts[bucket];
      bucketCounts[kMaxBuckets + bucket] = start;
      if (bucket < graphWords[kHeaderBuckets] && bucket < record.drawCapacity) {
        draws[bucket * kDrawWords + 1] = min(start + count, written) - min(start, written);
        draws[bucket * kDrawWords + 4] = min(start, written);
      }
      start += count;
    }
  }
  if (lane == 0) {
    const uint left = rounds[record.rounds].shapes;
    state.peakShapes = max(state.peakShapes, left);
    state.droppedShapes += left - min(left, maxShapes);
    state.unfinishedShapes = min(left, maxShapes);
    state.instancesWritten = written;
    rounds[rounds.length() - 1].groupsX = min((kept + kSpawnGroupSize - 1) / kSpawnGroupSize, record.maxGroups);
    rounds[rounds.length() - 1].groupsY = 1;
    rounds[rounds.length() - 1].groupsZ = 1;
    if (record.writeCount != 0) instanceCount = written;
  }
}
