// One invocation a triangle: those that may be seen from nearby become visible.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/fetch.glsl"
#include "visibility/shared/chunks.glsl"
#include "visibility/nearby/nearby.h"
layout(local_size_x = 64) in; // kChunk

layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindTiles) readonly buffer TileBuffer { Tile tiles[]; };

bool isSeen(uint id) { return (bits[id >> 5u] & (1u << (id & 31u))) != 0u; }

/// By what a level's tiles show.
bool isNearby(ScreenTriangle t, ivec4 bounds, uint camera, uint level) {
  vec4 scale = params.depthScales[camera];
  Grid grid = gridOf(camera);
  uint side = tileSide(params.width, params.height, level);
  float own = nearestInverse(scale, t, params.reversedDepth != 0u);
  float occluder = 0.0;
  ivec4 range = tilesAround(bounds, 0, grid, side);
  for (int y = range.y; y <= range.w; ++y)
    for (int x = range.x; x <= range.z; ++x)
      occluder = max(occluder, tiles[tileAt(camera, level, uint(x), uint(y))].nearest);
  range = tilesAround(bounds, reachOf(scale, occluder, own), grid, side);
  for (int y = range.y; y <= range.w; ++y)
    for (int x = range.x; x <= range.z; ++x)
      if (mayShow(own, tiles[tileAt(camera, level, uint(x), uint(y))].farthest)) return true;
  return false;
}

void main() {
  uint chunks = chunkCount();
  for (uint chunk = gl_WorkGroupID.x; chunk < chunks; chunk += gl_NumWorkGroups.x) {
    uint entry = findChunk(chunk);
    uvec2 start = startOf(entry);
    if (start.x >= params.maxItems) break; // and so does all that follows
    uint end = min(entryOf(entry).indexCount / 3u, params.maxItems - start.x);
    uint local = (chunk - start.y) * kChunk + gl_LocalInvocationIndex;
    if (local >= end) continue;
    Fetched f = fetchTriangle(entry, local);
    if (!f.valid || isSeen(f.id)) continue;
    ScreenTriangle t;
    uint fate = classifyFetched(f, t);
    bool shown = false;
    if (fate == kClipped) { // so near that it has no single box
      ScreenPolygon polygon;
      shown = clipTriangle(f.a, f.b, f.c, gridOf(f.camera), f.mirrored, f.twoSided, polygon) == kClipped;
    }
    if (fate == kWhole) {
      ivec4 bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(f.camera));
      shown = bounds.x < bounds.z && bounds.y < bounds.w;
      for (uint level = 0u; level < kTileLevels && shown; ++level) shown = isNearby(t, bounds, f.camera, level);
    }
    if (shown) atomicOr(bits[f.id >> 5u], 1u << (f.id & 31u));
  }
}
