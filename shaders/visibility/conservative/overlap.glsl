// What conservative sampling does with a triangle and a pixel that it may touch, in each of its phases. Needs
// fetch.glsl and `counters`.
#include "visibility/conservative/conservative.h"
layout(constant_id = 0) const uint kPhase = 0u;
const uint kAccept = 0u;  // what the heuristics accept becomes visible
const uint kCover = 1u;   // visible triangles cover samples
const uint kNearest = 2u; // how near those that are not visible come where they cover samples that nothing covers, in
                          // each quarter of a pixel
const uint kTake = 3u;    // the nearest of them in a quarter becomes visible

layout(std430, set = 0, binding = kBindSamples) readonly buffer SampleBuffer { uint samples[]; };
layout(std430, set = 0, binding = kBindSurfaces) readonly buffer SurfaceBuffer { Surface surfaces[]; };
layout(std430, set = 0, binding = kBindGaps) buffer GapBuffer { uint gaps[]; }; // pixels' samples, then nearest depths
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };

bool isSeen(uint id) { return (bits[id >> 5u] & (1u << (id & 31u))) != 0u; }
void show(uint id) { atomicOr(bits[id >> 5u], 1u << (id & 31u)); }

/// Whether a phase is about triangles that are visible already, or about the others.
bool isAsked(uint id) { return isSeen(id) == (kPhase == kCover); }
bool tooLarge(ScreenTriangle t) {
  return kPhase == kAccept && (params.heuristics & kInCircle) != 0u && isLarge(t);
}

/// Of all that does not depend on the pixel.
struct Visitor {
  uint id;
  vec3 normal;
  bool perspective;
};

void visit(Visitor v, ScreenTriangle t, bool compact, vec3 depths, ivec2 pixel) {
  uint at = uint(pixel.y) * params.width + uint(pixel.x);
  bool reversed = params.reversedDepth != 0u;
  float nearest;
  float farthest;
  if (kPhase == kAccept) {
    if (!touches(t, compact, pixel)) return;
    if ((params.heuristics & kDepths) != 0u) {
      if (samples[idAt(at)] == kNoTriangle) {
        if ((params.heuristics & kKeepFront) == 0u) return;
      } else {
        if (!depthsInPixel(t, depths, pixel, v.perspective, reversed, nearest, farthest)) return;
        if (!acceptsDepths(surfaces[at], nearest, farthest, v.normal, params.heuristics, params.epsilonStatic,
                           params.epsilonDynamic))
          return;
      }
    }
    show(v.id);
    return;
  }
  uvec2 open = ~uvec2(gaps[at * 2u], gaps[at * 2u + 1u]);
  if ((open.x | open.y) == 0u) return;
  uvec2 own = coverageOf(t, pixel) & open;
  if ((own.x | own.y) == 0u) return;
  if (kPhase == kCover) {
    if (own.x != 0u) atomicOr(gaps[at * 2u], own.x);
    if (own.y != 0u) atomicOr(gaps[at * 2u + 1u], own.y);
    return;
  }
  if (!depthsInPixel(t, depths, pixel, v.perspective, reversed, nearest, farthest)) return;
  uint first = params.pixelCapacity * 2u + at * kQuarters;
  for (uint quarter = 0u; quarter < kQuarters; ++quarter) {
    if (!inQuarter(own, quarter)) continue;
    if (kPhase == kNearest) atomicMin(gaps[first + quarter], floatBitsToUint(nearest));
    else if (gaps[first + quarter] == floatBitsToUint(nearest)) show(v.id);
  }
}
