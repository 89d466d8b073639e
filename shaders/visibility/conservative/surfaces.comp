// One invocation a pixel: depths and normal of the triangle that its centre shows, once for each pixel instead of for
// each triangle that was drawn there (6.1.3). The ids hold work items until then, and triangle numbers afterwards.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/fetch.glsl"
#include "visibility/conservative/conservative.h"
layout(local_size_x = 256) in;

layout(std430, set = 0, binding = kBindSamples) buffer SampleBuffer { uint samples[]; };
layout(std430, set = 0, binding = kBindSurfaces) writeonly buffer SurfaceBuffer { Surface surfaces[]; };

void main() {
  uint pixels = params.width * params.height * params.cameraCount;
  for (uint at = gl_GlobalInvocationID.x; at < pixels; at += gl_NumWorkGroups.x * 256u) {
    uint item = samples[idAt(at)];
    if (item == kNoTriangle) continue;
    Fetched f = fetchItem(item);
    samples[idAt(at)] = f.id;
    ivec2 pixel = ivec2(int(at % params.width), int(at / params.width));
    bool perspective = isPerspective(viewProjection(f.camera));
    bool reversed = params.reversedDepth != 0u;
    ScreenTriangle t;
    uint fate = classifyFetched(f, t);
    ScreenPolygon polygon;
    int pieces = 1;
    if (fate == kClipped) {
      if (clipTriangle(f.a, f.b, f.c, gridOf(f.camera), f.mirrored, f.twoSided, polygon) != kClipped) continue;
      pieces = polygon.count - 2;
    }
    float nearest = 0.0;
    float farthest = 0.0;
    bool any_ = false;
    for (int k = 0; k < pieces; ++k) {
      vec3 depths;
      if (fate == kClipped) {
        if (!fanPiece(polygon, k, gridOf(f.camera), t)) continue;
        depths = pieceDepths(polygon, k, t, perspective);
      } else {
        depths = wholeDepths(f.a, f.b, f.c, t, gridOf(f.camera), perspective);
      }
      float near_;
      float far_;
      if (!touches(t, false, pixel) || !depthsInPixel(t, depths, pixel, perspective, reversed, near_, far_)) continue;
      nearest = any_ ? min(nearest, near_) : near_;
      farthest = any_ ? max(farthest, far_) : far_;
      any_ = true;
    }
    vec3 normal = normalOf(f.worldA, f.worldB, f.worldC);
    Surface s;
    s.nearest = nearest;
    s.farthest = farthest;
    s.normalX = normal.x;
    s.normalY = normal.y;
    s.normalZ = normal.z;
    surfaces[at] = s;
  }
}
