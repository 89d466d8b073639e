// One invocation a triangle on the screen that is clipped or reaches over more than 8 x 8 pixels: makes it, or the
// pieces that clipping leaves, candidates that workgroups share.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/fetch.glsl"
#include "visibility/exact/lists.glsl"
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = kBindQueue) readonly buffer QueueBuffer { uint queue[]; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
#include "visibility/reuse/reuse.glsl"
#include "visibility/exact/candidates.glsl"
#include "visibility/shared/texture.glsl"
layout(constant_id = 3) const bool kNonOpaque = true; // some recordings have triangles that are not opaque

// Of the triangle.
bool open;
NonOpaque nonOpaque;

void add(ScreenTriangle t, Corners fine, uint id, uint camera) {
  ivec4 bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(camera));
  if (bounds.x >= bounds.z || bounds.y >= bounds.w) return;
  uint places = open ? 2u : 1u;
  uint place = atomicAdd(counters.candidates, places);
  if (place + places <= params.maxCandidates) {
    writeCandidate(place, makeCandidate(t, fine, id));
    if (open) writeNonOpaque(place, nonOpaque);
    uint slices = clamp(tilesOf(bounds, camera).z / kSliceTiles, 1u, kMaxSlices);
    uint first = atomicAdd(counters.largeCandidateCount, slices);
    // What is counted below the capacity is written, so that no entry lies unwritten among the others.
    uint end = min(first + slices, params.maxLargeCandidates);
    for (uint i = first; i < end; ++i) {
      slots[largeCandidateAt(i)] = place;
      slots[largeCandidateAt(i) + 1u] = (i - first) | (slices << 12u) | (camera << 24u);
    }
    if (first < end) atomicMax(counters.binLargeArgs[0], min(end, kMaxGroups));
    if (first + slices <= params.maxLargeCandidates) return;
  }
  atomicOr(bits[id >> 5u], 1u << (id & 31u));
  atomicAdd(counters.unresolved, 1u);
}

void main() {
  uint count = counters.largeQueueCount;
  for (uint entry = gl_GlobalInvocationID.x; entry < count; entry += gl_NumWorkGroups.x * 64u) {
    uint item;
    uint number = queue[params.maxItems * 2u - 1u - entry];
    Fetched f = fetchNumber(number, item);
    meet(f.id);
    ScreenTriangle t;
    Corners fine;
    uint fate = classifyCandidate(f, t, fine);
    open = kNonOpaque && isNonOpaque(f.flags);
    if (open) {
      uvec2 at = placeOfNumber(number);
      nonOpaque.flags = f.flags;
      nonOpaque.plane = fetchTexturePlane(f, at.x, at.y, textureOrigin(t, fate, f.camera));
    }
    if (fate != kClipped) {
      add(t, fine, f.id, f.camera);
      continue;
    }
    ScreenPolygon polygon;
    if (clipTriangle(f.a, f.b, f.c, gridOf(f.camera), f.mirrored, f.twoSided, polygon) != kClipped) continue;
    for (int k = 0; k + 2 < polygon.count; ++k)
      if (fanPiece(polygon, k, gridOf(f.camera), t)) add(t, unitCorners(t), f.id, f.camera);
  }
}
