// Polygons in a plane: whether they are simple, and their faces' loops as points in the workspace.
#ifndef GPGP_SHADERS_SPAWN_GEOMETRY_POLYGON_H
#define GPGP_SHADERS_SPAWN_GEOMETRY_POLYGON_H
#include "spawn/geometry/build.h"
#include "spawn/geometry/skeleton.h"

GPGP_SHADER_BEGIN

GPGP_FN vec2 pointAt(GPGP_POOL uint points, uint i) {
  return vec2(workFloat(GPGP_P points + kPointWords * i), workFloat(GPGP_P points + kPointWords * i + 1u));
}
/// Above 0: c is to the left of a to b.
GPGP_FN float sideOf(vec2 a, vec2 b, vec2 c) {
  const Wide2 u = wide2(wideSubtract(wide(b.x), wide(a.x)), wideSubtract(wide(b.y), wide(a.y)));
  const Wide2 v = wide2(wideSubtract(wide(c.x), wide(a.x)), wideSubtract(wide(c.y), wide(a.y)));
  return wideCross(u, v).hi;
}
/// Twice the area, positive where the loop is counter-clockwise.
GPGP_FN float loopArea(GPGP_POOL uint points, uint first, uint count) {
  const vec2 origin = pointAt(GPGP_P points, first);
  float sum = 0.0f;
  for (uint i = 1u; i + 1u < count; ++i) {
    GPGP_PRECISE vec2 a = pointAt(GPGP_P points, first + i) - origin;
    GPGP_PRECISE vec2 b = pointAt(GPGP_P points, first + i + 1u) - origin;
    GPGP_PRECISE float next = sum + cross2(a, b);
    sum = next;
  }
  return sum;
}
/// By the number of edges that a ray to the right crosses.
GPGP_FN bool loopContains(GPGP_POOL uint points, uint first, uint count, vec2 p) {
  bool isInside = false;
  for (uint i = 0u; i < count; ++i) {
    const vec2 a = pointAt(GPGP_P points, first + i);
    const vec2 b = pointAt(GPGP_P points, first + (i + 1u == count ? 0u : i + 1u));
    if ((a.y > p.y) == (b.y > p.y)) continue;
    const float side = sideOf(a, b, p);
    if (b.y > a.y ? side > 0.0f : side < 0.0f) isInside = !isInside;
  }
  return isInside;
}
GPGP_FN bool segmentsMeet(vec2 a, vec2 b, vec2 c, vec2 d) {
  if (max(a.x, b.x) < min(c.x, d.x) || max(c.x, d.x) < min(a.x, b.x)) return false;
  if (max(a.y, b.y) < min(c.y, d.y) || max(c.y, d.y) < min(a.y, b.y)) return false;
  const float ofC = sideOf(a, b, c);
  const float ofD = sideOf(a, b, d);
  if ((ofC > 0.0f && ofD > 0.0f) || (ofC < 0.0f && ofD < 0.0f)) return false;
  const float ofA = sideOf(c, d, a);
  const float ofB = sideOf(c, d, b);
  return !((ofA > 0.0f && ofB > 0.0f) || (ofA < 0.0f && ofB < 0.0f));
}

/// kGeometryOk: no two edges meet but at their common point, the first loop is counter-clockwise, the others clockwise
/// and within it.
GPGP_FN uint checkPolygon(GPGP_POOL uint points, uint pointCount, uint loops, uint loopCount) {
  uint first = 0u;
  for (uint l = 0u; l < loopCount; ++l) {
    const uint count = workWord(GPGP_P loops + l);
    if (count < 3u) return kGeometryNotSimple;
    const float twice = loopArea(GPGP_P points, first, count);
    if (l == 0u ? !(twice > 0.0f) : !(twice < 0.0f)) return kGeometryNotSimple;
    if (l > 0u && !loopContains(GPGP_P points, 0u, workWord(GPGP_P loops), pointAt(GPGP_P points, first)))
      return kGeometryNotSimple;
    uint otherFirst = 0u;
    for (uint m = 0u; m <= l; ++m) {
      const uint otherCount = workWord(GPGP_P loops + m);
      if (m > 0u && m < l &&
          (loopContains(GPGP_P points, otherFirst, otherCount, pointAt(GPGP_P points, first)) ||
           loopContains(GPGP_P points, first, count, pointAt(GPGP_P points, otherFirst))))
        return kGeometryNotSimple;
      for (uint i = 0u; i < count; ++i) {
        const uint next = i + 1u == count ? 0u : i + 1u;
        const vec2 a = pointAt(GPGP_P points, first + i);
        const vec2 b = pointAt(GPGP_P points, first + next);
        const uint most = m == l ? i : otherCount;
        for (uint j = 0u; j < most; ++j) {
          const uint otherNext = j + 1u == otherCount ? 0u : j + 1u;
          if (m == l && (otherNext == i || next == j)) continue;
          if (segmentsMeet(a, b, pointAt(GPGP_P points, otherFirst + j),
                           pointAt(GPGP_P points, otherFirst + otherNext)))
            return kGeometryNotSimple;
        }
      }
      otherFirst += otherCount;
    }
    first += count;
  }
  return first == pointCount ? kGeometryOk : kGeometryBadArgument;
}

/// A face's outline in its plane, in the workspace.
struct Outline {
  uint status;
  uint points; // kPointWords each
  uint count;
  uint loops; // the number of points of each
  uint loopCount;
  uint corners;     // for each point the corner of the mesh that it was
  PlaneBasis basis; // in the scope's axes
};
/// Points at one place become one. All edges have speed 1.
GPGP_FN Outline outlineOf(GPGP_POOL Form form, uint face) {
  Outline o;
  const Face found = faceOf(GPGP_P form.mesh, face);
  const Loop all = faceCorners(GPGP_P form.mesh, face);
  const Loop outer = loopOf(GPGP_P form.mesh, found.firstLoop);
  const vec3 origin = localPosition(GPGP_P form, outer.firstCorner);
  const vec3 normal = localNormal(GPGP_P form, face);
  const vec3 second = localPosition(GPGP_P form, nextCorner(outer, outer.firstCorner));
  o.basis = planeBasis(origin, normal, minus3(second, origin));
  o.count = 0u;
  o.loopCount = 0u;
  o.status = kGeometryOk;
  o.points = takeWork(GPGP_P(kPointWords + 1u) * all.corners + found.loops);
  o.corners = o.points + kPointWords * all.corners;
  o.loops = o.corners + all.corners;
  if (o.points == kNoWork) {
    o.status = kGeometryTooLarge;
    return o;
  }
  float extent = 0.0f;
  for (uint c = 0u; c < all.corners; ++c) {
    const vec2 p = inPlane(o.basis, localPosition(GPGP_P form, all.firstCorner + c));
    extent = max(extent, max(abs(p.x), abs(p.y)));
  }
  const float apart = multiply(extent, 1.0e-6f);
  for (uint l = 0u; l < found.loops; ++l) {
    const Loop loop = loopOf(GPGP_P form.mesh, found.firstLoop + l);
    const uint first = o.count;
    for (uint c = 0u; c < loop.corners; ++c) {
      const vec2 p = inPlane(o.basis, localPosition(GPGP_P form, loop.firstCorner + c));
      const uint at = o.points + kPointWords * o.count;
      setWorkFloat(GPGP_P at, settle(p.x));
      setWorkFloat(GPGP_P at + 1u, settle(p.y));
      setWorkFloat(GPGP_P at + 2u, 1.0f);
      setWorkWord(GPGP_P o.corners + o.count, loop.firstCorner + c);
      o.count += 1u;
      if (o.count - first < 2u) continue;
      const vec2 before = pointAt(GPGP_P o.points, o.count - 2u);
      const bool isLast = c + 1u == loop.corners;
      const vec2 start = pointAt(GPGP_P o.points, first);
      const vec2 here = pointAt(GPGP_P o.points, o.count - 1u);
      const bool repeats = abs(subtract(before.x, here.x)) <= apart && abs(subtract(before.y, here.y)) <= apart;
      const bool closes = isLast && abs(subtract(start.x, here.x)) <= apart && abs(subtract(start.y, here.y)) <= apart;
      if (repeats || closes) o.count -= 1u;
    }
    if (o.count - first < 3u && l > 0u) {
      o.count = first; // a hole without area
      continue;
    }
    setWorkWord(GPGP_P o.loops + o.loopCount, o.count - first);
    o.loopCount += 1u;
  }
  o.status = checkPolygon(GPGP_P o.points, o.count, o.loops, o.loopCount);
  return o;
}

GPGP_SHADER_END
#endif
