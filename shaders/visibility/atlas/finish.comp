// One invocation: where the tiles of each bucket and class begin, the engine's dispatches over them, and the counts.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
layout(local_size_x = 1) in;

layout(std430, set = 0, binding = kAtlasArguments) writeonly buffer ArgumentBuffer { uint arguments[]; };
layout(std430, set = 0, binding = kAtlasCounts) writeonly buffer CountBuffer { uint countsOut[]; };

bool exceeds(uint count, uint capacity) { return capacity != 0u && count > capacity; }

void main() {
  uint tiles = 0u;
  for (uint bucket = 0u; bucket < params.bucketCount; ++bucket) {
    uint first = tiles;
    for (uint i = 0u; i < kClasses; ++i) {
      uint row = kRowTiles + bucket * kClasses + i;
      rows[kRowBases + row] = tiles;
      tiles += rows[row] << tilesLog(kMinClass + i);
    }
    if (params.hasArguments == 0u) continue;
    uint start = min(first, params.tileCapacity);
    uint given = min(tiles, params.tileCapacity) - start;
    uint groups = (given + kTilesPerGroup - 1u) / kTilesPerGroup;
    uint at = bucket * kArgumentWords;
    arguments[at] = min(groups, 65535u);
    arguments[at + 1u] = (groups + 65534u) / 65535u;
    arguments[at + 2u] = 1u;
    arguments[at + 3u] = start;
    arguments[at + 4u] = given;
  }
  counters.tiles = tiles;
  counters.maxSupers = params.superCount;
  counters.listsExceeded = uint(exceeds(tiles, params.tileCapacity) || exceeds(counters.added, params.newCapacity) ||
                                exceeds(counters.changed, params.changedCapacity) ||
                                exceeds(counters.gone, params.goneCapacity));
  if (params.hasCounts != 0u) {
    countsOut[0] = counters.added;
    countsOut[1] = counters.changed;
    countsOut[2] = counters.gone;
    countsOut[3] = tiles;
  }
}
