// Where on its ramp a gradient paints a point: the records of paints, and the same definition for every way of drawing.
#ifndef GPGP_SHADERS_RAMP_H
#define GPGP_SHADERS_RAMP_H
#include "gpgp/shaders/language.h"

#ifdef __cplusplus
namespace gpgp::shader {
using std::sqrt;
}
#endif

GPGP_SHADER_BEGIN

// A gradient. A point of the drawing is taken to gradient space (x = matrix.x dx + matrix.z dy + origin.x, y = matrix.y
// dx + matrix.w dy + origin.y), where the ramp's place t is, for kPaintLinear, x itself; for kPaintRadial, the largest
// t at which the point lies on the circle around (t distance, 0) with the radius startRadius + t growth, not negative.
// Where there is no such t, nothing is painted. For kPaintImage, matrix and origin lead to texture coordinates, and
// firstStop is the image, from the item's first one on; stopCount is 0. For kPaintSlices they lead to
// the destination (place p along x, say), and `slices` is the first of two stops: between two places p and q the
// texture coordinate is that of p plus (p - place) times a slope, before p and after q with slopes of their own; or it
// begins anew at p after each period.
struct PaintRecord {
  vec4 matrix;
  vec4 origin; // x, y; of a radial one, distance and growth
  float startRadius;
  uint kind;                 // kPaint...
  uint spread;               // kSpread...
  uint flags;                // kInterpolateSrgb
  uint firstStop, stopCount; // at least one for gradients
  uint slices;
  float tangent; // of the circles at t = 0 and 1 that both touch, its length squared: distance^2 - growth^2
};

GPGP_CONST uint kPaintLinear = 0u;
GPGP_CONST uint kPaintRadial = 1u;
GPGP_CONST uint kPaintImage = 2u;
GPGP_CONST uint kPaintSlices = 3u; // an image whose middle is stretched more than its borders
GPGP_CONST uint kSpreadPad = 0u;
GPGP_CONST uint kSpreadRepeat = 1u;
GPGP_CONST uint kSpreadReflect = 2u;
GPGP_CONST uint kInterpolateSrgb = 1u;

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

GPGP_SHADER_END
#endif
