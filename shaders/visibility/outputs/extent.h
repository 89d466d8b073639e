// How large a triangle is on the screen: its area and its box, for choosing a shading rate or a place in an atlas.
//
// Guarantees: one result on every device. What the near and far planes or the guard band cut off does not count.
#ifndef GPGP_SHADERS_VISIBILITY_EXTENT_H
#define GPGP_SHADERS_VISIBILITY_EXTENT_H
#include "visibility/shared/raster.h"

GPGP_SHADER_BEGIN

struct Extent {
  float area; ///< pixels
  ivec2 low;  ///< units
  ivec2 high;
};

GPGP_FN Extent noExtent() {
  Extent e;
  e.area = 0.0f;
  e.low = ivec2(0x7fffffff, 0x7fffffff);
  e.high = ivec2(-0x7fffffff, -0x7fffffff);
  return e;
}

/// With one more piece.
GPGP_FN Extent withPiece(Extent e, ScreenTriangle t) {
  GPGP_PRECISE float area = e.area + wideToFloat(twiceArea(t.p0, t.p1, t.p2)) * (1.0f / 131072.0f);
  Extent r;
  r.area = area;
  r.low = min(e.low, min(t.p0, min(t.p1, t.p2)));
  r.high = max(e.high, max(t.p0, max(t.p1, t.p2)));
  return r;
}

/// Area, width and height in pixels. Bits of floats that are not negative have their order.
GPGP_FN uvec3 extentBits(Extent e) {
  if (e.area == 0.0f) return uvec3(0u, 0u, 0u);
  return uvec3(floatBitsToUint(e.area), floatBitsToUint(float(e.high.x - e.low.x) * (1.0f / 256.0f)),
               floatBitsToUint(float(e.high.y - e.low.y) * (1.0f / 256.0f)));
}

GPGP_SHADER_END
#endif
