// One workgroup: where the tiles of each bucket and class begin, the engine's dispatches over them, and the counts.
// Each invocation has two rows.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
layout(local_size_x = 256) in;

layout(std430, set = 0, binding = kAtlasArguments) writeonly buffer ArgumentBuffer { uint arguments[]; };
layout(std430, set = 0, binding = kAtlasCounts) writeonly buffer CountBuffer { uint countsOut[]; };

shared uint ends[512]; // of each row's tiles, one behind the other
shared uint sums[256];

uint tilesOf(uint i) {
  return i < params.bucketCount * kClasses ? rows[kRowTiles + i] << tilesLog(kMinClass + i % kClasses) : 0u;
}
bool exceeds(uint count, uint capacity) { return capacity != 0u && count > capacity; }

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint first = tilesOf(lane * 2u);
  uint second = tilesOf(lane * 2u + 1u);
  sums[lane] = first + second;
  barrier();
  for (uint step_ = 1u; step_ < 256u; step_ *= 2u) {
    uint before = lane >= step_ ? sums[lane - step_] : 0u;
    barrier();
    sums[lane] += before;
    barrier();
  }
  uint start = sums[lane] - first - second;
  if (lane * 2u < kMaxBuckets * kClasses) rows[kRowBases + kRowTiles + lane * 2u] = start;
  ends[lane * 2u] = start + first;
  ends[lane * 2u + 1u] = sums[lane];
  barrier();
  if (lane * 2u + 1u < kMaxBuckets * kClasses) rows[kRowBases + kRowTiles + lane * 2u + 1u] = start + first;
  uint tiles = sums[255];
  if (lane < params.bucketCount && params.hasArguments != 0u) {
    uint begin = min(lane == 0u ? 0u : ends[lane * kClasses - 1u], params.tileCapacity);
    uint given = min(ends[lane * kClasses + kClasses - 1u], params.tileCapacity) - begin;
    uint groups = (given + kTilesPerGroup - 1u) / kTilesPerGroup;
    uint at = lane * kArgumentWords;
    arguments[at] = min(groups, 65535u);
    arguments[at + 1u] = (groups + 65534u) / 65535u;
    arguments[at + 2u] = 1u;
    arguments[at + 3u] = begin;
    arguments[at + 4u] = given;
  }
  if (lane != 0u) return;
  counters.tiles = tiles;
  counters.maxSupers = params.superCount;
  counters.listsExceeded =
      uint(exceeds(tiles, params.tileCapacity) || exceeds(counters.added, params.newCapacity) ||
           exceeds(counters.changed, params.changedCapacity) || exceeds(counters.gone, params.goneCapacity));
  if (params.hasCounts != 0u) {
    countsOut[0] = counters.added;
    countsOut[1] = counters.changed;
    countsOut[2] = counters.gone;
    countsOut[3] = tiles;
  }
}
