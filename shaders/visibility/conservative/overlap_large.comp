// The queued triangles, clipped where needed: a workgroup each, or kLargeSplit that share a wide one. They look at 64
// blocks of 8 x 8 pixels at a time, a block an invocation, and then at those that the triangle may touch, a pixel an
// invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/fetch.glsl"
layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };
#include "visibility/conservative/overlap.glsl"
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = kBindQueue) readonly buffer QueueBuffer { uint queue[]; };

layout(constant_id = 1) const bool kSplit = false;

shared Visitor visitor;
shared ScreenPolygon polygon;
shared ScreenTriangle triangle;
shared vec3 corners; // depths there
shared uint camera;
shared int pieces; // 0: none; -1: one triangle, made already
shared bool pieceValid;
shared uint blockCount;
shared ivec2 blockCorner[64];

/// Invocation 0: what the queued item is.
void makeAgain(uint item) {
  Fetched f = fetchItem(item);
  ScreenTriangle made;
  uint fate = classifyFetched(f, made);
  visitor.id = f.id;
  visitor.normal = normalOf(f.worldA, f.worldB, f.worldC);
  visitor.perspective = isPerspective(viewProjection(f.camera));
  camera = f.camera;
  pieces = 0;
  if (fate == kWhole) {
    pieces = -1;
    corners = wholeDepths(f.a, f.b, f.c, made, gridOf(f.camera), visitor.perspective);
    triangle = made;
  }
  if (fate != kClipped) return;
  ScreenPolygon cut;
  if (clipTriangle(f.a, f.b, f.c, gridOf(f.camera), f.mirrored, f.twoSided, cut) != kClipped) return;
  for (int k = 0; k + 2 < cut.count; ++k)
    if (fanPiece(cut, k, gridOf(f.camera), made) && tooLarge(made)) return;
  polygon = cut;
  pieces = cut.count - 2;
}

/// Whether a block of 8 x 8 pixels may hold points inside an edge.
bool blockInside(ivec2 u, ivec2 slope, ivec2 corner) {
  ivec2 best = ivec2(corner.x * 256 + (slope.x > 0 ? 2047 : 0), corner.y * 256 + (slope.y > 0 ? 2047 : 0));
  return insideWide(u, slope, best);
}

/// All invocations, with the shared triangle.
void visitAll() {
  ScreenTriangle t = triangle;
  bool compact = isCompact(t);
  ivec4 bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(camera));
  if (bounds.x >= bounds.z || bounds.y >= bounds.w) return;
  ivec2 inBlock = ivec2(int(gl_LocalInvocationIndex & 7u), int(gl_LocalInvocationIndex >> 3u));
  uint columns = uint(bounds.z - bounds.x + 7) / 8u;
  uint blocks = columns * (uint(bounds.w - bounds.y + 7) / 8u);
  for (uint first = gl_WorkGroupID.y * 64u; first < blocks; first += gl_NumWorkGroups.y * 64u) {
    if (gl_LocalInvocationIndex == 0u) blockCount = 0u;
    barrier();
    uint block = first + gl_LocalInvocationIndex;
    if (block < blocks) {
      ivec2 corner = bounds.xy + 8 * ivec2(int(block % columns), int(block / columns));
      if (blockInside(t.p1, edgeSlope(t.p1, t.p2), corner) && blockInside(t.p2, edgeSlope(t.p2, t.p0), corner) &&
          blockInside(t.p0, edgeSlope(t.p0, t.p1), corner))
        blockCorner[atomicAdd(blockCount, 1u)] = corner;
    }
    barrier();
    uint touched = blockCount;
    for (uint i = 0u; i < touched; ++i) {
      ivec2 pixel = blockCorner[i] + inBlock;
      if (pixel.x < bounds.z && pixel.y < bounds.w) visit(visitor, t, compact, corners, pixel);
    }
    barrier();
  }
}

void main() {
  uint count = kSplit ? counters.splitCount : counters.overlapCount;
  for (uint entry = gl_WorkGroupID.x; entry < count; entry += gl_NumWorkGroups.x) {
    barrier();
    if (gl_LocalInvocationIndex == 0u) makeAgain(queue[kSplit ? params.maxItems - 1u - entry : entry]);
    barrier();
    int parts = pieces;
    if (parts < 0) visitAll();
    for (int k = 0; k < parts; ++k) {
      barrier();
      if (gl_LocalInvocationIndex == 0u) {
        ScreenTriangle made;
        pieceValid = fanPiece(polygon, k, gridOf(camera), made);
        corners = pieceDepths(polygon, k, made, visitor.perspective);
        triangle = made;
      }
      barrier();
      if (pieceValid) visitAll();
    }
  }
}
