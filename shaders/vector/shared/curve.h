// On which side of a curve a point lies: the test that bounds a CPatch.
//
// The curve is a cubic that never turns in x or y. Its box decides first: left of the box is left, right of it is
// right. Inside, the curve is halved until it is a parabola within the tolerance, each time keeping the half at the
// point's height and asking its box again. A parabola's implicit form decides the rest: with A, B the control and end
// point relative to the start and w the point, f(w) = cross(w, B - 2A)^2 + 4 cross(A, B) cross(w, A) is zero on it,
// positive outside, negative inside (Salmon; Loop and Blinn 2005 use the same form with interpolated coordinates).
// Outside the segment's hull that sign means nothing, so the flattened segment guards it: a line meets a parabola at
// most twice, hence on the bulge's side of the flattened segment f decides, and on the other side the flattened segment
// does.
//
// Guarantee: only + - * on precise floats, so CPU and GPU agree on every bit; wrong only within tolerance plus a few
// units of the last place of the curve's box.
#ifndef GPGP_SHADERS_VECTOR_CURVE_H
#define GPGP_SHADERS_VECTOR_CURVE_H
#include "vector/shared/layout.h"

GPGP_SHADER_BEGIN

// One halving of the cubic p0 p1 p2 p3, with the decision of the box that is left.
#define GPGP_VECTOR_HALVE                                                                                              \
  if (bend > tolerance) {                                                                                              \
    bend *= 0.125f;                                                                                                    \
    GPGP_PRECISE float sx = (p0x + p1x) * 0.5f;                                                                        \
    GPGP_PRECISE float sy = (p0y + p1y) * 0.5f;                                                                        \
    GPGP_PRECISE float tx = (p1x + p2x) * 0.5f;                                                                        \
    GPGP_PRECISE float ty = (p1y + p2y) * 0.5f;                                                                        \
    GPGP_PRECISE float dx = (p2x + p3x) * 0.5f;                                                                        \
    GPGP_PRECISE float dy = (p2y + p3y) * 0.5f;                                                                        \
    GPGP_PRECISE float ex = (sx + tx) * 0.5f;                                                                          \
    GPGP_PRECISE float ey = (sy + ty) * 0.5f;                                                                          \
    GPGP_PRECISE float fx = (tx + dx) * 0.5f;                                                                          \
    GPGP_PRECISE float fy = (ty + dy) * 0.5f;                                                                          \
    GPGP_PRECISE float mx = (ex + fx) * 0.5f;                                                                          \
    GPGP_PRECISE float my = (ey + fy) * 0.5f;                                                                          \
    if (v < my) {                                                                                                      \
      p1x = sx;                                                                                                        \
      p1y = sy;                                                                                                        \
      p2x = ex;                                                                                                        \
      p2y = ey;                                                                                                        \
      p3x = mx;                                                                                                        \
      p3y = my;                                                                                                        \
    } else {                                                                                                           \
      p0x = mx;                                                                                                        \
      p0y = my;                                                                                                        \
      p1x = fx;                                                                                                        \
      p1y = fy;                                                                                                        \
      p2x = dx;                                                                                                        \
      p2y = dy;                                                                                                        \
    }                                                                                                                  \
    if (u < min(p0x, p3x)) return false;                                                                               \
    if (u >= max(p0x, p3x)) return true;                                                                               \
  }

// Whether (x, y) lies right of the curve or on it. y is clamped to the curve's range.
GPGP_FN bool rightOfCurve(CurveRecord c, float x, float y, float tolerance) {
  GPGP_PRECISE float u = x - c.ends.x;
  GPGP_PRECISE float v = y - c.ends.y;
  GPGP_PRECISE float p3x = c.ends.z;
  GPGP_PRECISE float p3y = c.ends.w;
  if (u < min(0.0f, p3x)) return false;
  if (u >= max(0.0f, p3x)) return true;
  v = clamp(v, 0.0f, p3y);
  if (c.bend < 0.0f) return p3x * v <= p3y * u;
  GPGP_PRECISE float p0x = 0.0f;
  GPGP_PRECISE float p0y = 0.0f;
  GPGP_PRECISE float p1x = c.controls.x;
  GPGP_PRECISE float p1y = c.controls.y;
  GPGP_PRECISE float p2x = c.controls.z;
  GPGP_PRECISE float p2y = c.controls.w;
  float bend = c.bend;
  // Written out three times, because lavapipe ends a shader's loops after 65535 rounds in all; more than three
  // halvings are rare.
  GPGP_VECTOR_HALVE
  GPGP_VECTOR_HALVE
  GPGP_VECTOR_HALVE
  for (uint i = 3u; i < 8u && bend > tolerance; ++i) {
    GPGP_VECTOR_HALVE
  }
  GPGP_PRECISE float wx = u - p0x;
  GPGP_PRECISE float wy = v - p0y;
  GPGP_PRECISE float bx = p3x - p0x;
  GPGP_PRECISE float by = p3y - p0y;
  GPGP_PRECISE float ax = (p1x + p2x) * 0.75f - (p3x + p0x) * 0.25f - p0x;
  GPGP_PRECISE float ay = (p1y + p2y) * 0.75f - (p3y + p0y) * 0.25f - p0y;
  bool right = bx * wy <= by * wx; // of the flattened segment
  GPGP_PRECISE float bulge = ax * by - ay * bx;
  GPGP_PRECISE float cx = bx - 2.0f * ax;
  GPGP_PRECISE float cy = by - 2.0f * ay;
  GPGP_PRECISE float k = wx * cy - wy * cx;
  GPGP_PRECISE float l = wx * ay - wy * ax;
  GPGP_PRECISE float f = k * k + 4.0f * (bulge * l);
  if (bulge > 0.0f) return right && f >= 0.0f;
  if (bulge < 0.0f) return right || f <= 0.0f;
  return right;
}

GPGP_SHADER_END
#endif
