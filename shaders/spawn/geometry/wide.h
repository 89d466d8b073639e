// Numbers of two floats, 46 bits and more: for what must not be decided by the rounding of one.
//
// Sums and products keep their error in the second float (Dekker 1971). Magnitudes are meant to be between 1e-12 and
// 1e12; products below 1e-20 are 0, so that no denormal decides.
#ifndef GPGP_SHADERS_SPAWN_GEOMETRY_WIDE_H
#define GPGP_SHADERS_SPAWN_GEOMETRY_WIDE_H
#include "core/math.h"

GPGP_SHADER_BEGIN

struct Wide {
  float hi;
  float lo;
};
GPGP_FN Wide wide(float v) {
  Wide r;
  r.hi = v;
  r.lo = 0.0f;
  return r;
}
GPGP_FN float narrow(Wide a) { return a.hi; }
/// |lo| is at most half a unit in hi's last place.
GPGP_FN Wide renormalised(float hi, float lo) {
  GPGP_PRECISE float s = hi + lo;
  GPGP_PRECISE float e = lo - (s - hi);
  Wide r;
  r.hi = s;
  r.lo = abs(e) < 1.0e-30f ? 0.0f : e;
  return r;
}
GPGP_FN Wide sumOf(float a, float b) {
  GPGP_PRECISE float s = a + b;
  GPGP_PRECISE float v = s - a;
  GPGP_PRECISE float e = (a - (s - v)) + (b - v);
  Wide r;
  r.hi = s;
  r.lo = e;
  return r;
}
GPGP_FN Wide productOf(float a, float b) {
  GPGP_PRECISE float p = a * b;
  GPGP_PRECISE float ca = 4097.0f * a;
  GPGP_PRECISE float ah = ca - (ca - a);
  GPGP_PRECISE float al = a - ah;
  GPGP_PRECISE float cb = 4097.0f * b;
  GPGP_PRECISE float bh = cb - (cb - b);
  GPGP_PRECISE float bl = b - bh;
  GPGP_PRECISE float e = ((ah * bh - p) + ah * bl + al * bh) + al * bl;
  const bool tiny = abs(p) < 1.0e-20f;
  Wide r;
  r.hi = tiny ? 0.0f : p;
  r.lo = tiny ? 0.0f : e;
  return r;
}
GPGP_FN Wide wideNegate(Wide a) {
  Wide r;
  r.hi = -a.hi;
  r.lo = -a.lo;
  return r;
}
GPGP_FN Wide wideAdd(Wide a, Wide b) {
  const Wide s = sumOf(a.hi, b.hi);
  const Wide t = sumOf(a.lo, b.lo);
  GPGP_PRECISE float low = s.lo + t.hi;
  const Wide u = renormalised(s.hi, low);
  GPGP_PRECISE float rest = u.lo + t.lo;
  return renormalised(u.hi, rest);
}
GPGP_FN Wide wideSubtract(Wide a, Wide b) { return wideAdd(a, wideNegate(b)); }
GPGP_FN Wide wideMultiply(Wide a, Wide b) {
  const Wide p = productOf(a.hi, b.hi);
  GPGP_PRECISE float low = p.lo + (a.hi * b.lo + a.lo * b.hi);
  return renormalised(p.hi, p.hi == 0.0f ? 0.0f : low);
}
/// 0 where b is.
GPGP_FN Wide wideDivide(Wide a, Wide b) {
  if (b.hi == 0.0f) return wide(0.0f);
  const float first = divide(a.hi, b.hi);
  const Wide rest = wideSubtract(a, wideMultiply(b, wide(first)));
  const float second = divide(rest.hi, b.hi);
  const Wide last = wideSubtract(rest, wideMultiply(b, wide(second)));
  const Wide sum = renormalised(first, second);
  GPGP_PRECISE float low = sum.lo + divide(last.hi, b.hi);
  return renormalised(sum.hi, low);
}
GPGP_FN Wide wideSquareRoot(Wide a) {
  if (!(a.hi > 0.0f)) return wide(0.0f);
  const float root = squareRoot(a.hi);
  const Wide rest = wideSubtract(a, productOf(root, root));
  GPGP_PRECISE float twice = root + root;
  return renormalised(root, divide(rest.hi, twice));
}
GPGP_FN bool wideLess(Wide a, Wide b) { return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo); }

struct Wide2 {
  Wide x;
  Wide y;
};
GPGP_FN Wide2 wide2(Wide x, Wide y) {
  Wide2 r;
  r.x = x;
  r.y = y;
  return r;
}
GPGP_FN Wide2 wideAdd2(Wide2 a, Wide2 b) { return wide2(wideAdd(a.x, b.x), wideAdd(a.y, b.y)); }
GPGP_FN Wide2 wideSubtract2(Wide2 a, Wide2 b) { return wide2(wideSubtract(a.x, b.x), wideSubtract(a.y, b.y)); }
GPGP_FN Wide2 wideScale2(Wide2 a, Wide b) { return wide2(wideMultiply(a.x, b), wideMultiply(a.y, b)); }
GPGP_FN Wide wideDot(Wide2 a, Wide2 b) { return wideAdd(wideMultiply(a.x, b.x), wideMultiply(a.y, b.y)); }
GPGP_FN Wide wideCross(Wide2 a, Wide2 b) { return wideSubtract(wideMultiply(a.x, b.y), wideMultiply(a.y, b.x)); }

GPGP_SHADER_END
#endif
