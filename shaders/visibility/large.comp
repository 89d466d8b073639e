// Large triangles and those that must be clipped: kLargeSplit workgroups each. A workgroup tests 64 blocks of 8 x 8 pixels
// at a time, a block an invocation, and then draws the blocks that the triangle may touch, a pixel an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/fetch.glsl"
#include "visibility/pixels.glsl"
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = kBindQueue) readonly buffer QueueBuffer { uint queue[]; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };

shared ScreenPolygon polygon;
shared ScreenTriangle triangle;
shared uint id;
shared int pieces; // 0: nothing to draw, -1: one triangle, made already
shared bool pieceValid;
shared uint blockCount;
shared ivec2 blockCorner[64];
shared ivec3 blockEdges[64];

/// Invocation 0: what the queued item is.
void open_(uint entry) {
  Fetched f = fetchTriangle(queue[params.maxItems - 1u - entry]);
  ScreenTriangle made;
  uint fate = classifyFetched(f, made);
  id = f.id;
  triangle = made;
  pieces = fate == kWhole ? -1 : 0;
  if (fate != kClipped) return;
  ScreenPolygon cut;
  fate = clipTriangle(f.a, f.b, f.c, viewport(), f.mirrored, f.twoSided, cut);
  if (fate == kClipped) {
    polygon = cut;
    pieces = cut.count - 2;
  }
  if (kPhase == 0u && gl_WorkGroupID.y == 0u) {
    if (fate == kClipped) atomicAdd(counters.triangles, 1u);
    if (fate == kSkipped) atomicAdd(counters.skippedTriangles, 1u);
  }
}

/// All invocations: draws `triangle`.
void drawLarge() {
  ScreenTriangle t = triangle;
  if (isEmpty(t)) return;
  ivec2 s0 = edgeSlope(t.p1, t.p2);
  ivec2 s1 = edgeSlope(t.p2, t.p0);
  ivec2 s2 = edgeSlope(t.p0, t.p1);
  uint columns = uint(t.bounds.z - t.bounds.x + 7) / 8u;
  uint blocks = columns * (uint(t.bounds.w - t.bounds.y + 7) / 8u);
  ivec2 inBlock = ivec2(int(gl_LocalInvocationIndex) & 7, int(gl_LocalInvocationIndex) >> 3);
  for (uint first = gl_WorkGroupID.y * 64u; first < blocks; first += kLargeSplit * 64u) {
    if (gl_LocalInvocationIndex == 0u) blockCount = 0u;
    barrier();
    uint block = first + gl_LocalInvocationIndex;
    if (block < blocks) {
      ivec2 corner = t.bounds.xy + 8 * ivec2(int(block % columns), int(block / columns));
      ivec3 edges = ivec3(edgeBlock(t.p1, s0, corner), edgeBlock(t.p2, s1, corner), edgeBlock(t.p0, s2, corner));
      if (!blockOutside(edges.x, s0, 8) && !blockOutside(edges.y, s1, 8) && !blockOutside(edges.z, s2, 8)) {
        uint place = atomicAdd(blockCount, 1u);
        blockCorner[place] = corner;
        blockEdges[place] = edges;
      }
    }
    barrier();
    uint touched = blockCount;
    for (uint i = 0u; i < touched; ++i) {
      ivec2 pixel = blockCorner[i] + inBlock;
      ivec3 edges = blockEdges[i] + ivec3(s0.x, s1.x, s2.x) * inBlock.x + ivec3(s0.y, s1.y, s2.y) * inBlock.y;
      bool inside = edges.x >= 0 && edges.y >= 0 && edges.z >= 0;
      if (inside && pixel.x < t.bounds.z && pixel.y < t.bounds.w) coverPixel(pixel, depthWide(t, pixel), id);
    }
    barrier();
  }
}

void main() {
  uint count = counters.largeCount;
  for (uint entry = gl_WorkGroupID.x; entry < count; entry += gl_NumWorkGroups.x) {
    barrier();
    if (gl_LocalInvocationIndex == 0u) open_(entry);
    barrier();
    int parts = pieces;
    if (parts < 0) drawLarge();
    for (int k = 0; k < parts; ++k) {
      barrier();
      if (gl_LocalInvocationIndex == 0u) {
        ScreenTriangle made;
        pieceValid = fanPiece(polygon, k, viewport(), made);
        triangle = made;
      }
      barrier();
      if (pieceValid) drawLarge();
    }
  }
}
