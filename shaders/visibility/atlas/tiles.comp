// A workgroup lists the tiles of its triangles' blocks, all 256 invocations together for each round of triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
layout(local_size_x = 256) in;

layout(std430, set = 0, binding = kAtlasBuckets) readonly buffer BucketBuffer { uint buckets[]; };
layout(std430, set = 0, binding = kAtlasTiles) writeonly buffer TileBuffer { uvec2 tiles[]; };

#define RANKED_ROWS 352u // kMaxBuckets * kClasses
#include "visibility/atlas/ranks.glsl"
#include "visibility/atlas/buckets.glsl"

shared uint ends[256];   // of each invocation's tiles, one behind the other
shared uint starts[256]; // where they lie in the list
shared bool shades[4];   // whether a round has any

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint rowCount = params.bucketCount * kClasses;
  if (lane < 4u) shades[lane] = false;
  for (uint i = lane; i < rowCount; i += 256u) rowStart[i] = rows[rowAt(kRowTiles + i, gl_WorkGroupID.x)];
  barrier();
  for (uint round = 0u; round < 4u; ++round) {
    uint triangle = gl_WorkGroupID.x * kAtlasGroup + round * 256u + lane;
    uint plan = triangle < params.maxTriangles ? plans[triangle] : 0u;
    bool shaded = (plan & kPlanShade) != 0u;
    uint class_ = max(planClass(plan), kMinClass);
    uint row = shaded ? bucketOf(triangle) * kClasses + class_ - kMinClass : 0u;
    clearRanks(rowCount, lane);
    if (shaded) shades[round] = true;
    ends[lane] = shaded ? 1u << tilesLog(class_) : 0u;
    barrier();
    if (!shades[round]) continue;
    if (shaded) enterRank(row, lane);
    for (uint step_ = 1u; step_ < 256u; step_ *= 2u) {
      uint before = lane >= step_ ? ends[lane - step_] : 0u;
      barrier();
      ends[lane] += before;
      barrier();
    }
    if (shaded)
      starts[lane] = rows[kRowBases + kRowTiles + row] + ((rowStart[row] + rankOf(row, lane)) << tilesLog(class_));
    barrier();
    uint total = ends[255];
    for (uint i = lane; i < total; i += 256u) {
      uint low = 0u; // the first one that ends behind it
      for (uint step_ = 128u; step_ != 0u; step_ /= 2u)
        if (ends[low + step_ - 1u] <= i) low += step_;
      uint tile = i - (low == 0u ? 0u : ends[low - 1u]);
      uint at = starts[low] + tile;
      if (at < params.tileCapacity)
        tiles[at] = uvec2(gl_WorkGroupID.x * kAtlasGroup + round * 256u + low, tile);
    }
    barrier();
    advanceRanks(rowCount, lane);
    barrier();
  }
}
