// One invocation a triangle of at most 8 x 8 pixels on the screen: makes candidates of those that are seen at a pixel's
// centre, which may hide others, and of those that may be seen elsewhere, and enters them in the tiles that they reach
// over.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/fetch.glsl"
#include "visibility/exact/lists.glsl"
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/exact/tile_pairs.glsl"
#include "visibility/reuse/reuse.glsl"
#include "visibility/shared/texture.glsl"
layout(constant_id = 3) const bool kNonOpaque = true; // some recordings have triangles that are not opaque
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = kBindQueue) readonly buffer QueueBuffer { uint queue[]; };

shared uint groupCandidates;
shared uint groupPairs;
shared uint groupDecided;
shared uint groupReused;
shared uint firstCandidate;
shared uint firstPair;

/// Whether a triangle comes in front of a limit of the pixels in its bounds.
bool mayShow(ScreenTriangle t, ivec4 bounds, uint camera) {
  bool reversed = params.reversedDepth != 0u;
  uint nearest = depthKey(reversed ? t.zMax : t.zMin, reversed);
  for (int y = bounds.y; y < bounds.w; ++y)
    for (int x = bounds.x; x < bounds.z; ++x)
      if (nearest <= slots[slotOf(ivec2(x, y), camera)]) return true;
  return false;
}

const uint kMostTiles = 4u; // of at most 8 x 8 pixels

/// One of a triangle's tiles, of which one or two lie beside each other.
uint tileAmong(uvec3 tiles, uint i) {
  return tiles.x + (tiles.y == 1u ? i * tileColumns() : (i >> 1u) * tileColumns() + (i & 1u));
}

/// What lies behind a candidate that is not opaque: of a triangle's number among all chunks.
NonOpaque makeNonOpaque(uint number) {
  uint item;
  Fetched f = fetchNumber(number, item);
  ScreenTriangle t;
  uint fate = classifyFetched(f, t);
  uvec2 place = placeOfNumber(number);
  NonOpaque r;
  r.flags = f.flags;
  r.plane = fetchTexturePlane(f, place.x, place.y, textureOrigin(t, fate, f.camera));
  return r;
}

void main() {
  uint count = counters.onScreenCount;
  for (uint first = gl_WorkGroupID.x * 64u; first < count; first += gl_NumWorkGroups.x * 64u) {
    if (gl_LocalInvocationIndex == 0u) {
      groupCandidates = 0u;
      groupPairs = 0u;
      groupDecided = 0u;
      groupReused = 0u;
    }
    barrier();
    ScreenTriangle t;
    Corners fine;
    uint id = 0u;
    bool seen = false;
    uvec3 tiles = uvec3(0u);
    uint candidate = 0u;
    uint pair = 0u;
    uint places = 1u; // that the candidate takes
    if (first + gl_LocalInvocationIndex < count) {
      uint item;
      Fetched f = fetchNumber(queue[params.maxItems + first + gl_LocalInvocationIndex], item);
      id = f.id;
      if (classifyCandidate(f, t, fine) != kClipped) {
        ivec4 bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(f.camera));
        meet(id);
        seen = isSeen(id);
        bool reused = !seen && isReused(id);
        bool open = kNonOpaque && isNonOpaque(f.flags);
        bool hides = !(open && (seen || reused) && isSeeThrough(f.flags)); // or is asked about
        if (open) places = 2u;
        bool isCandidate = seen || mayShow(t, bounds, f.camera);
        if (!seen && isCandidate) {
          if (reused) atomicAdd(groupReused, 1u);
          else atomicAdd(groupDecided, 1u);
        }
        if (reused && isCandidate && wasVisible(id)) retain(id); // unless limits hide it
        seen = seen || reused;                                  // is not asked about
        if (hides && isCandidate) {
          tiles = tilesOf(bounds, f.camera);
          candidate = atomicAdd(groupCandidates, places);
          pair = atomicAdd(groupPairs, tiles.z);
        }
      }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && groupCandidates != 0u) {
      firstCandidate = atomicAdd(counters.candidates, groupCandidates);
      firstPair = atomicAdd(counters.tilePairs, groupPairs);
    }
    if (gl_LocalInvocationIndex == 0u && groupDecided != 0u) atomicAdd(counters.decided, groupDecided);
    if (gl_LocalInvocationIndex == 0u && groupReused != 0u) atomicAdd(counters.reused, groupReused);
    barrier();
    if (tiles.z != 0u) {
      candidate += firstCandidate;
      pair += firstPair;
      uint room = maxTilePairs() - min(pair, maxTilePairs());
      if (candidate + places <= params.maxCandidates && tiles.z <= room) {
        uint order[kMostTiles]; // all counted first: what that says is waited for once, after the candidate is written
        for (uint i = 0u; i < kMostTiles; ++i)
          if (i < tiles.z) order[i] = countIn(tileAmong(tiles, i), seen);
        writeCandidate(candidate, makeCandidate(t, fine, id));
        if (places == 2u)
          writeNonOpaque(candidate, makeNonOpaque(queue[params.maxItems + first + gl_LocalInvocationIndex]));
        for (uint i = 0u; i < kMostTiles; ++i)
          if (i < tiles.z) enter(candidate, seen, tileAmong(tiles, i), order[i], pair + i);
      } else {
        show(id);
        for (uint i = 0u; i < min(tiles.z, room); ++i) pairs[(pair + i) * kTilePairWords] = kNoTile;
      }
    }
    barrier();
  }
}
