// What found no record: each workgroup makes the triangle again, piece by piece. Slower, and rare.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_INT64_ATOMICS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#endif
#include "visibility/shared/fetch.glsl"
#include "visibility/standard/pixels.glsl"
layout(local_size_x = 64) in;
#include "visibility/standard/blocks.glsl"

layout(std430, set = 0, binding = kBindQueue) readonly buffer QueueBuffer { uint queue[]; };
layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };

shared ScreenPolygon polygon;
shared ScreenTriangle triangle;
shared uint id;
shared uint camera;
shared int pieces; // 0: nothing to draw, -1: one triangle, made already
shared bool pieceValid;

/// Invocation 0: what the queued item is.
void makeAgain(uint item) {
  Fetched f = fetchItem(item);
  ScreenTriangle made;
  uint fate = classifyFetched(f, made);
  id = drawnId(f.id, item);
  camera = f.camera;
  triangle = made;
  pieces = fate == kWhole ? -1 : 0;
  if (fate != kClipped) return;
  ScreenPolygon cut;
  if (clipTriangle(f.a, f.b, f.c, gridOf(f.camera), f.mirrored, f.twoSided, cut) != kClipped) return;
  polygon = cut;
  pieces = cut.count - 2;
}

void main() {
  uint count = counters.queueCount;
  for (uint entry = gl_WorkGroupID.x; entry < count; entry += gl_NumWorkGroups.x) {
    uint item = queue[entry];
    if ((item & kNoRecord) == 0u) continue;
    barrier();
    if (gl_LocalInvocationIndex == 0u) makeAgain(item & ~kNoRecord);
    barrier();
    int parts = pieces;
    if (parts < 0) drawLarge(triangle, id, gl_WorkGroupID.y, kLargeSplit);
    for (int k = 0; k < parts; ++k) {
      barrier();
      if (gl_LocalInvocationIndex == 0u) {
        ScreenTriangle made;
        pieceValid = fanPiece(polygon, k, gridOf(camera), made);
        triangle = made;
      }
      barrier();
      if (pieceValid) drawLarge(triangle, id, gl_WorkGroupID.y, kLargeSplit);
    }
  }
}
