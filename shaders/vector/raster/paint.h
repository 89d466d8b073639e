// Where on its ramp a gradient paints a point, and where on its image a nine-slice does.
#ifndef GPGP_SHADERS_VECTOR_PAINT_H
#define GPGP_SHADERS_VECTOR_PAINT_H
#include "vector/shared/layout.h"

#ifdef __cplusplus
namespace gpgp::shader {
using std::sqrt;
}
#endif

GPGP_SHADER_BEGIN

// A point of the drawing in the paint's space.
GPGP_FN vec2 paintPoint(vec4 matrix, vec4 origin, vec2 at) {
  return vec2(matrix.x * at.x + matrix.z * at.y + origin.x, matrix.y * at.x + matrix.w * at.y + origin.y);
}

// The ramp's place, 0 to 1, of a point in gradient space; negative: nothing is painted there.
GPGP_FN float rampAt(PaintRecord g, vec2 p) {
  float t = p.x;
  bool painted = true;
  if (g.kind == kPaintRadial) {
    // a t^2 - 2 b t + c = 0, whose discriminant b^2 - a c is taken so that nothing large cancels.
    const float radius = g.startRadius, distance = g.origin.z, growth = g.origin.w;
    const float a = g.tangent, b = distance * p.x + radius * growth, c = dot(p, p) - radius * radius;
    const float k = growth * p.x + distance * radius, inner = k * k - a * p.y * p.y;
    const float root = sqrt(max(inner, 0.0f)), w = b < 0.0f ? b - root : b + root;
    const float u = w == 0.0f ? 0.0f : c / w, v = a == 0.0f ? u : w / a;
    t = max(u, v);
    if (radius + t * growth < 0.0f) t = min(u, v);
    painted = inner >= 0.0f && (a != 0.0f || b != 0.0f) && radius + t * growth >= 0.0f;
  }
  if (g.spread == kSpreadRepeat)
    t -= floor(t);
  else if (g.spread == kSpreadReflect)
    t = abs(t - 2.0f * floor(t * 0.5f + 0.5f));
  return painted ? clamp(t, 0.0f, 1.0f) : -1.0f;
}

// Along an axis of a nine-slice: the texture coordinate at a place, and how fast it grows there. slopes: before, in and
// after the middle; w: the period of a middle that repeats. Filters reach half a texel: no further than the middle.
GPGP_FN vec2 sliceAt(float place, vec2 places, vec2 there, vec4 slopes, float texels) {
  if (place < places.x) return vec2(there.x + (place - places.x) * slopes.x, slopes.x);
  if (place >= places.y) return vec2(there.y + (place - places.y) * slopes.z, slopes.z);
  float along = place - places.x;
  if (slopes.w == 0.0f) return vec2(there.x + along * slopes.y, slopes.y);
  along -= floor(along / slopes.w) * slopes.w;
  const float middle = 0.5f * (there.x + there.y), reach = max(0.5f * abs(there.y - there.x) - 0.5f / texels, 0.0f);
  return vec2(clamp(there.x + along * slopes.y, middle - reach, middle + reach), slopes.y);
}

// Between which four texels a point lies that is given in texels: the first one's place, and how much the next ones
// weigh along both axes.
GPGP_FN vec4 texelsAround(vec2 at) {
  const vec2 first = floor(at - 0.5f);
  return vec4(first, at - 0.5f - first);
}
GPGP_FN float texelWeight(vec4 around, uint k) {
  return ((k & 1u) != 0u ? around.z : 1.0f - around.z) * ((k & 2u) != 0u ? around.w : 1.0f - around.w);
}

GPGP_SHADER_END
#endif
