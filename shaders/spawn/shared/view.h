// What the camera of a recording sees of a shape: the values by which a grammar chooses how much of it to derive.
//
// All of it is settled arithmetic on the shape, the axiom's transform and what the host worked out of the camera, so
// that the CPU and every GPU choose the same.
#ifndef GPGP_SHADERS_SPAWN_VIEW_H
#define GPGP_SHADERS_SPAWN_VIEW_H
#include "spawn/shared/layout.h"
#include "spawn/shared/shape.h"

GPGP_SHADER_BEGIN

/// What kCodeView and the codes behind it leave.
struct Seen {
  float distance; // from the camera to the shape's centre, in metres
  float size;     // pixels that the sphere around the shape is wide
  float outside;  // metres that the sphere lies outside of the frustum; 0 where it touches it
};

/// Without a camera everything is near and large: the finest level.
GPGP_FN Seen seenFromNowhere() {
  Seen seen;
  seen.distance = 0.0f;
  seen.size = kLargest;
  seen.outside = 0.0f;
  return seen;
}

/// Of an axiom that the engine calls hidden (GpgpAxiom::hidden).
GPGP_FN Seen hiddenFrom(Seen seen, uint hidden) {
  if (hidden != 0u) seen.outside = kLargest;
  return seen;
}

GPGP_CONST float kShortest = 9.5367432e-7f, kLongest = 1.0737418e9f;
/// 0, or from 2^-20 to 2^30: sums of products of two of these neither under- nor overflow, so that they need not be
/// settled.
#ifdef __cplusplus
inline float nearbyLength(float settled) {
  return abs(settled) < kShortest ? 0.0f : clamp(settled, -kLongest, kLongest);
}
inline vec3 nearbyLengths(vec3 settled) {
  return vec3(nearbyLength(settled.x), nearbyLength(settled.y), nearbyLength(settled.z));
}
#else
vec3 nearbyLengths(vec3 settled) {
  return mix(clamp(settled, -kLongest, kLongest), vec3(0.0), lessThan(abs(settled), vec3(kShortest)));
}
#endif
GPGP_FN float sumOfProducts(vec3 a, vec3 b) {
  GPGP_PRECISE float sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}

/// How far a point is inside a plane of the view.
GPGP_FN float insideOf(vec4 plane, vec3 p) {
  GPGP_PRECISE float distance = sumOfProducts(vec3(plane.x, plane.y, plane.z), p) + plane.w;
  return distance;
}

/// Of a shape under the rows of its axiom's transform. The sphere's radius is half the shape's diagonal, times the
/// largest scale of the transform's three axes.
GPGP_FN Seen seenBy(View view, Shape s, vec4 rowX, vec4 rowY, vec4 rowZ) {
  if (view.camera.w == 0.0f) return seenFromNowhere();
  const vec3 x = nearbyLengths(settle3(vec3(rowX.x, rowX.y, rowX.z)));
  const vec3 y = nearbyLengths(settle3(vec3(rowY.x, rowY.y, rowY.z)));
  const vec3 z = nearbyLengths(settle3(vec3(rowZ.x, rowZ.y, rowZ.z)));
  const vec3 place = nearbyLengths(s.position);
  const vec3 size = nearbyLengths(s.size);
  // Seen from the camera, which keeps its digits far from the origin.
  const vec3 origin =
      nearbyLengths(vec3(subtract(settle(rowX.w), view.camera.x), subtract(settle(rowY.w), view.camera.y),
                         subtract(settle(rowZ.w), view.camera.z)));
  const vec3 within = vec3(sumOfProducts(x, place), sumOfProducts(y, place), sumOfProducts(z, place));
  GPGP_PRECISE vec3 sum = origin + within;
  const vec3 centre = nearbyLengths(sum);
  const float scaleX = sumOfProducts(vec3(x.x, y.x, z.x), vec3(x.x, y.x, z.x));
  const float scaleY = sumOfProducts(vec3(x.y, y.y, z.y), vec3(x.y, y.y, z.y));
  const float scaleZ = sumOfProducts(vec3(x.z, y.z, z.z), vec3(x.z, y.z, z.z));
  const float scale = max(scaleX, max(scaleY, scaleZ));
  const float radius = multiply(0.5f, squareRoot(multiply(scale, sumOfProducts(size, size))));
  Seen seen;
  seen.distance = squareRoot(sumOfProducts(centre, centre));
  const float wide = multiply(2.0f, multiply(radius, abs(view.camera.w)));
  seen.size = view.camera.w < 0.0f || radius == 0.0f ? wide : divide(wide, max(seen.distance, radius));
  const float sides = min(min(insideOf(view.left, centre), insideOf(view.right, centre)),
                          min(insideOf(view.bottom, centre), insideOf(view.top, centre)));
  const float inside = min(sides, min(insideOf(view.front, centre), insideOf(view.back, centre)));
  seen.outside = max(0.0f, subtract(-radius, settle(inside)));
  return seen;
}

/// The value of a code from kCodeView on.
GPGP_FN float seenValue(Seen seen, uint code) {
#define GPGP_SEEN(name, number, spelling, value, member)                                                               \
  if (code == kCode##name) return seen.member;
  GPGP_VIEW_TABLE(GPGP_SEEN)
#undef GPGP_SEEN
  return 0.0f;
}

GPGP_SHADER_END
#endif
