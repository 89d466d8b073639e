// Triangles of lists: what a shape's record holds of one, its edges as segments, and its colour at a point.
//
// In a ShapeRecord with kShapeTriangle, box and radii.x, radii.y are the corners; radii.z and .w, frame.x and .y, and
// frame.z and .w are the bits of the corners' colours as they mix, 16 bits a channel; the bits of ratio are
// kTriangle...; paint is that of its image, whose matrix and origin are the texture coordinates of the corners in turn.
//
// An edge is cut into flattened segments from its upper corner on, whichever triangle asks, so triangles that share two
// corners share their edge bit for bit: each sample lies in one of them. A pixel's colour is that of the middle of the
// samples that the triangle covers, which is the mean of their colours and never lies outside of the triangle.
#ifndef GPGP_SHADERS_VECTOR_TRIANGLE_H
#define GPGP_SHADERS_VECTOR_TRIANGLE_H
#include "vector/shared/sample.h"

#ifdef __cplusplus
#include <glm/packing.hpp>
namespace gpgp::shader {
using glm::unpackUnorm2x16;
}
#endif

GPGP_SHADER_BEGIN

GPGP_FN bool isTriangle(ShapeRecord s) { return (s.kind & kShapeTriangle) != 0u; }

GPGP_FN vec2 triangleCorner(ShapeRecord s, uint k) {
  return k == 0u ? vec2(s.box.x, s.box.y) : (k == 1u ? vec2(s.box.z, s.box.w) : vec2(s.radii.x, s.radii.y));
}

GPGP_FN vec4 triangleBox(ShapeRecord s) {
  const vec2 a = triangleCorner(s, 0u), b = triangleCorner(s, 1u), c = triangleCorner(s, 2u);
  return vec4(min(a.x, min(b.x, c.x)), min(a.y, min(b.y, c.y)), max(a.x, max(b.x, c.x)), max(a.y, max(b.y, c.y)));
}

// Segment k of three: from the upper corner to the lower one, from the left one where they are level.
GPGP_FN SegmentRecord triangleSegment(ShapeRecord s, uint k) {
  const vec2 o = triangleCorner(s, 0u), u = triangleCorner(s, 1u), v = triangleCorner(s, 2u);
  GPGP_PRECISE float ux = u.x - o.x;
  GPGP_PRECISE float uy = u.y - o.y;
  GPGP_PRECISE float vx = v.x - o.x;
  GPGP_PRECISE float vy = v.y - o.y;
  GPGP_PRECISE float turn = ux * vy - uy * vx;
  vec2 a = triangleCorner(s, k), b = triangleCorner(s, k == 2u ? 0u : k + 1u);
  float side = turn < 0.0f ? 1.0f : -1.0f;
  if (b.y < a.y || (b.y == a.y && b.x < a.x)) {
    const vec2 upper = b;
    b = a;
    a = upper;
    side = -side;
  }
  SegmentRecord segment;
  segment.first = vec4(a.x, a.y, a.x, a.y);
  segment.second = vec4(b.x, b.y, b.x, b.y);
  segment.ends = vec4(a.x, a.y, b.x, b.y);
  segment.path = 0u;
  segment.side = side;
  segment.line = 1u;
  segment.pad0 = 0u;
  return segment;
}

// The middle of the samples in a mask that is not 0, from the pixel's left upper corner.
GPGP_FN vec2 middleOf(uint mask, uint samples) {
  if (mask == (1u << samples) - 1u) return vec2(0.5f);
  uint x = 0u, y = 0u, count = 0u;
  for (uint row = 0u; row < samples; ++row) {
    if ((mask >> row & 1u) == 0u) continue;
    x += 2u * sampleColumn(row, samples) + 1u;
    y += 2u * row + 1u;
    ++count;
  }
  const float whole = float(2u * samples * count);
  return vec2(float(x) / whole, float(y) / whole);
}

// How much of each corner there is at a point; `across` and `down`: how that grows with the point's x and y.
struct TriangleWeights {
  vec3 at, across, down;
};
GPGP_FN TriangleWeights triangleWeights(ShapeRecord s, vec2 at) {
  const vec2 o = triangleCorner(s, 0u), u = triangleCorner(s, 1u) - o, v = triangleCorner(s, 2u) - o, d = at - o;
  const float area = u.x * v.y - u.y * v.x, unit = area == 0.0f ? 0.0f : 1.0f / area;
  const float second = (d.x * v.y - d.y * v.x) * unit, third = (u.x * d.y - u.y * d.x) * unit;
  TriangleWeights w;
  // Rounding may lead a little outside.
  const vec3 inside = max(vec3(1.0f - second - third, second, third), vec3(0.0f));
  w.at = inside / (inside.x + inside.y + inside.z);
  w.across = vec3((u.y - v.y) * unit, v.y * unit, -u.y * unit);
  w.down = vec3((v.x - u.x) * unit, -v.x * unit, u.x * unit);
  return w;
}

// Premultiplied, as colours mix.
GPGP_FN vec4 triangleColor(ShapeRecord s, vec3 weights) {
  const vec2 ar = unpackUnorm2x16(floatBitsToUint(s.radii.z)), ab = unpackUnorm2x16(floatBitsToUint(s.radii.w));
  const vec2 br = unpackUnorm2x16(floatBitsToUint(s.frame.x)), bb = unpackUnorm2x16(floatBitsToUint(s.frame.y));
  const vec2 cr = unpackUnorm2x16(floatBitsToUint(s.frame.z)), cb = unpackUnorm2x16(floatBitsToUint(s.frame.w));
  // What is the same in all corners stays as it is, and what is opaque but for rounding is opaque.
  const vec4 first = vec4(ar.x, ar.y, ab.x, ab.y);
  vec4 color =
      first + ((vec4(br.x, br.y, bb.x, bb.y) - first) * weights.y + (vec4(cr.x, cr.y, cb.x, cb.y) - first) * weights.z);
  if (color.w > 0.99999f) color.w = 1.0f;
  const bool straight = (floatBitsToUint(s.ratio) & kTriangleStraight) != 0u;
  return straight ? vec4(color.x * color.w, color.y * color.w, color.z * color.w, color.w) : color;
}

// Of three texture coordinates that weights say how much of.
GPGP_FN vec2 triangleTexture(vec4 matrix, vec4 origin, vec3 weights) {
  return vec2(matrix.x * weights.x + matrix.z * weights.y + origin.x * weights.z,
              matrix.y * weights.x + matrix.w * weights.y + origin.y * weights.z);
}

GPGP_SHADER_END
#endif
