// Vectors and forms in arithmetic that is equal on all devices.
#ifndef GPGP_SHADERS_SPAWN_GEOMETRY_VECTORS_H
#define GPGP_SHADERS_SPAWN_GEOMETRY_VECTORS_H
#include "spawn/geometry/pool.h"

GPGP_SHADER_BEGIN

GPGP_FN vec3 plus3(vec3 a, vec3 b) {
  GPGP_PRECISE vec3 r = a + b;
  return r;
}
GPGP_FN vec3 minus3(vec3 a, vec3 b) {
  GPGP_PRECISE vec3 r = a - b;
  return r;
}
GPGP_FN vec3 times3(vec3 a, float b) {
  GPGP_PRECISE vec3 r = a * b;
  return r;
}
/// a + b * t
GPGP_FN vec3 along3(vec3 a, vec3 b, float t) {
  GPGP_PRECISE vec3 r = a + b * t;
  return r;
}
GPGP_FN float inner3(vec3 a, vec3 b) {
  GPGP_PRECISE float r = a.x * b.x + a.y * b.y + a.z * b.z;
  return r;
}
GPGP_FN vec3 outer3(vec3 a, vec3 b) {
  GPGP_PRECISE float x = a.y * b.z - a.z * b.y;
  GPGP_PRECISE float y = a.z * b.x - a.x * b.z;
  GPGP_PRECISE float z = a.x * b.y - a.y * b.x;
  return vec3(x, y, z);
}
GPGP_FN float length3(vec3 a) { return squareRoot(inner3(a, a)); }
/// 0 stays 0. Scaled first, so that squares neither vanish nor overflow.
GPGP_FN vec3 unit3(vec3 a) {
  const float most = max(abs(a.x), max(abs(a.y), abs(a.z)));
  if (!(most > 0.0f)) return vec3(0.0f);
  const vec3 b = vec3(divide(a.x, most), divide(a.y, most), divide(a.z, most));
  const float l = length3(b);
  return vec3(divide(b.x, l), divide(b.y, l), divide(b.z, l));
}
GPGP_FN float axisOf3(vec3 v, uint axis) { return axis == 0u ? v.x : (axis == 1u ? v.y : v.z); }
GPGP_FN vec3 withAxis3(vec3 v, uint axis, float value) {
  return vec3(axis == 0u ? value : v.x, axis == 1u ? value : v.y, axis == 2u ? value : v.z);
}
GPGP_FN vec3 scaled3(vec3 a, vec3 b) {
  GPGP_PRECISE vec3 r = a * b;
  return r;
}

// ---------------------------------------------------------------- scopes

GPGP_FN vec3 scopeDirection(Scope s, vec3 v) {
  GPGP_PRECISE vec3 r = s.axisX * v.x + s.axisY * v.y + s.axisZ * v.z;
  return r;
}
GPGP_FN vec3 scopePoint(Scope s, vec3 v) { return plus3(s.origin, scopeDirection(s, v)); }
/// The inverse of scopeDirection.
GPGP_FN vec3 inScope(Scope s, vec3 d) { return vec3(inner3(s.axisX, d), inner3(s.axisY, d), inner3(s.axisZ, d)); }

/// Metres along the scope's axes, from its origin.
GPGP_FN vec3 localPosition(GPGP_POOL Form f, uint corner) {
  return scaled3(cornerPosition(GPGP_P f.mesh, corner), f.scale);
}
/// In the frame.
GPGP_FN vec3 framePosition(GPGP_POOL Form f, uint corner) {
  return scopePoint(f.scope, localPosition(GPGP_P f, corner));
}

/// Twice the area of a face times its normal, in the scope's axes (Newell 1972): all loops.
GPGP_FN vec3 faceAreaVector(GPGP_POOL Form f, uint face) {
  const Face found = faceOf(GPGP_P f.mesh, face);
  vec3 sum = vec3(0.0f);
  vec3 origin = vec3(0.0f);
  for (uint l = 0u; l < found.loops; ++l) {
    const Loop loop = loopOf(GPGP_P f.mesh, found.firstLoop + l);
    if (l == 0u) origin = localPosition(GPGP_P f, loop.firstCorner);
    vec3 a = minus3(localPosition(GPGP_P f, loop.firstCorner + loop.corners - 1u), origin);
    for (uint c = 0u; c < loop.corners; ++c) {
      const vec3 b = minus3(localPosition(GPGP_P f, loop.firstCorner + c), origin);
      sum = plus3(sum, outer3(a, b));
      a = b;
    }
  }
  return sum;
}
/// In the scope's axes, unit length.
GPGP_FN vec3 localNormal(GPGP_POOL Form f, uint face) { return unit3(faceAreaVector(GPGP_P f, face)); }

/// An orthonormal basis (right, up, normal) of a plane: right is the direction of `along` within it.
struct PlaneBasis {
  vec3 origin;
  vec3 right;
  vec3 up;
  vec3 normal;
};
GPGP_FN PlaneBasis planeBasis(vec3 origin, vec3 normal, vec3 along) {
  PlaneBasis b;
  b.origin = origin;
  b.normal = normal;
  vec3 right = along3(along, normal, -inner3(along, normal));
  if (!(inner3(right, right) > 1.0e-12f * inner3(along, along))) {
    // any direction within the plane
    const vec3 other = abs(normal.x) < 0.6f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 0.0f, 1.0f);
    right = along3(other, normal, -inner3(other, normal));
  }
  b.right = unit3(right);
  b.up = outer3(normal, b.right);
  return b;
}
GPGP_FN vec2 inPlane(PlaneBasis b, vec3 p) {
  const vec3 d = minus3(p, b.origin);
  return vec2(inner3(d, b.right), inner3(d, b.up));
}
/// A point of the plane, raised along its normal.
GPGP_FN vec3 fromPlane(PlaneBasis b, vec2 p, float height) {
  GPGP_PRECISE vec3 r = b.origin + b.right * p.x + b.up * p.y + b.normal * height;
  return r;
}
GPGP_FN float cross2(vec2 a, vec2 b) {
  GPGP_PRECISE float r = a.x * b.y - a.y * b.x;
  return r;
}

GPGP_SHADER_END
#endif
