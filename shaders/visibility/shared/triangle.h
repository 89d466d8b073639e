// From object space to the pixel grid: transform, reject, clip, project.
//
// Where a recording has origins, "world" is what is relative to the camera's.
//
// Guarantees: a triangle in front of the near plane is never lost, however far it reaches: what leaves the guard band
// or crosses the near or far plane is clipped (Sutherland-Hodgman), always from the inner to the outer vertex, so that
// triangles with a common edge cut it at the same point. Coordinates that are not finite or reach 2^100 are told apart,
// never computed with. A draw whose transform mirrors keeps its front faces.
#ifndef GPGP_SHADERS_VISIBILITY_TRIANGLE_H
#define GPGP_SHADERS_VISIBILITY_TRIANGLE_H
#include "visibility/shared/layout.h"
#include "visibility/shared/raster.h"

GPGP_SHADER_BEGIN

/// Where one origin lies as seen from another. Each is what floats hold of it and the rest, so that what is near is
/// exact however far away both are.
GPGP_FN vec3 originFrom(vec3 high, vec3 low, vec3 fromHigh, vec3 fromLow) {
  GPGP_PRECISE vec3 far = high - fromHigh;
  GPGP_PRECISE vec3 near = low - fromLow;
  GPGP_PRECISE vec3 sum = far + near;
  return sum;
}

/// Makes a draw's transform relative to a camera's origin, where its own one lies as given.
GPGP_FN void moveDraw(GPGP_INOUT(Draw) draw, vec3 origin) {
  for (int row = 0; row < 3; ++row) {
    GPGP_PRECISE float moved = draw.transform[row * 4 + 3] + origin[row];
    draw.transform[row * 4 + 3] = moved;
  }
}

GPGP_FN vec3 transformToWorld(Draw draw, vec3 p) {
  float w[3];
  for (int r = 0; r < 3; ++r) {
    GPGP_PRECISE float sum =
        ((draw.transform[r * 4] * p.x + draw.transform[r * 4 + 1] * p.y) + draw.transform[r * 4 + 2] * p.z) +
        draw.transform[r * 4 + 3];
    w[r] = sum;
  }
  return vec3(w[0], w[1], w[2]);
}

GPGP_FN vec4 transformToClip(mat4 viewProjection, vec3 w) {
  float c[4];
  for (int r = 0; r < 4; ++r) {
    GPGP_PRECISE float sum =
        ((viewProjection[0][r] * w.x + viewProjection[1][r] * w.y) + viewProjection[2][r] * w.z) + viewProjection[3][r];
    c[r] = withoutTiny(sum);
  }
  return vec4(c[0], c[1], c[2], c[3]);
}

/// Whether a draw's transform turns counter-clockwise into clockwise.
GPGP_FN bool mirrors(Draw draw) {
  GPGP_PRECISE float a =
      draw.transform[0] * (draw.transform[5] * draw.transform[10] - draw.transform[6] * draw.transform[9]);
  GPGP_PRECISE float b =
      draw.transform[1] * (draw.transform[4] * draw.transform[10] - draw.transform[6] * draw.transform[8]);
  GPGP_PRECISE float c =
      draw.transform[2] * (draw.transform[4] * draw.transform[9] - draw.transform[5] * draw.transform[8]);
  GPGP_PRECISE float determinant = a - b + c;
  return determinant < 0.0f;
}

GPGP_FN bool isModerateVector(vec4 v) {
  return isModerate(v.x) && isModerate(v.y) && isModerate(v.z) && isModerate(v.w);
}

GPGP_CONST int kClipPlanes = 6;

/// Signed distance, positive inside: near, far, then the guard band's left, right, top, bottom.
GPGP_FN float planeDistance(int plane, vec4 c) {
  if (plane == 0) return c.z;
  GPGP_PRECISE float guard = c.w * float(kGuard);
  GPGP_PRECISE float d = c.w - c.z;
  if (plane == 2) d = c.x + guard;
  if (plane == 3) d = guard - c.x;
  if (plane == 4) d = c.y + guard;
  if (plane == 5) d = guard - c.y;
  return d;
}

GPGP_FN bool needsClip(vec4 c) {
  for (int plane = 0; plane < kClipPlanes; ++plane)
    if (planeDistance(plane, c) < 0.0f) return true;
  return false;
}

/// Whether a draw's front faces are clockwise as seen.
GPGP_FN bool turnsFaces(Draw draw) { return mirrors(draw) != ((draw.flags & kClockwise) != 0u); }

/// Which of the view volume's six planes a point lies outside of.
GPGP_FN uint outCode(vec4 c) {
  return (c.x < -c.w ? 1u : 0u) | (c.x > c.w ? 2u : 0u) | (c.y < -c.w ? 4u : 0u) | (c.y > c.w ? 8u : 0u) |
         (c.z < 0.0f ? 16u : 0u) | (c.z > c.w ? 32u : 0u);
}

/// A triangle cut by at most six planes.
struct ClipPolygon {
  vec4 v[9];
  int count;
};

/// Where the plane cuts the edge from a vertex inside it to one outside.
GPGP_FN vec4 cutEdge(int plane, vec4 inner, vec4 outer) {
  GPGP_PRECISE float di = planeDistance(plane, inner);
  GPGP_PRECISE float span = di - planeDistance(plane, outer);
  GPGP_PRECISE float t = 0.0f; // a span too short to divide by: both ends are the plane
  if (isDivisor(span)) t = divide(di, span);
  GPGP_PRECISE float x = inner.x + (outer.x - inner.x) * t;
  GPGP_PRECISE float y = inner.y + (outer.y - inner.y) * t;
  GPGP_PRECISE float z = inner.z + (outer.z - inner.z) * t;
  GPGP_PRECISE float w = inner.w + (outer.w - inner.w) * t;
  if (plane == 0) z = 0.0f;
  if (plane == 1) z = w;
  return vec4(x, y, z, w);
}

GPGP_FN void clipBy(int plane, GPGP_INOUT(ClipPolygon) polygon) {
  ClipPolygon cut;
  cut.count = 0;
  for (int i = 0; i < polygon.count; ++i) {
    vec4 a = polygon.v[i];
    vec4 b = polygon.v[i + 1 == polygon.count ? 0 : i + 1];
    bool insideA = planeDistance(plane, a) >= 0.0f;
    bool insideB = planeDistance(plane, b) >= 0.0f;
    // A polygon that rounding made concave could be cut more often than a convex one; it never holds more than nine.
    if (insideA && cut.count < 9) cut.v[cut.count++] = a;
    if (insideA != insideB && cut.count < 9) {
      if (insideA)
        cut.v[cut.count] = cutEdge(plane, a, b);
      else
        cut.v[cut.count] = cutEdge(plane, b, a);
      ++cut.count;
    }
  }
  polygon = cut;
}

/// What became of a triangle.
GPGP_CONST uint kOutside = 0u;    ///< not in the view volume
GPGP_CONST uint kBackFacing = 1u; ///< or without area on the grid: nothing to see
GPGP_CONST uint kSkipped = 2u;    ///< coordinates that cannot be computed with
GPGP_CONST uint kWhole = 3u;      ///< one ScreenTriangle
GPGP_CONST uint kClipped = 4u;    ///< a fan of up to seven

/// A triangle on the grid before it is cut into a fan; vertices in the order that gives positive area.
struct ScreenPolygon {
  ivec2 p[9];
  float z[9];
  float q[9]; ///< 1 / w
  int count;
  bool reversedOrder;
};

/// The depth of a clip-space point, whose w can be divided by.
GPGP_FN float depthAt(vec4 c) {
  GPGP_PRECISE float depth = c.z * reciprocal(c.w);
  return clamp(withoutTiny(depth), 0.0f, 1.0f);
}

/// Projects a clip-space point; false where its w cannot be divided by.
GPGP_FN bool project(vec4 c, Grid grid, GPGP_OUT(ivec2) p, GPGP_OUT(float) z) {
  p = ivec2(0, 0);
  z = 0.0f;
  if (!isDivisor(c.w)) return false;
  GPGP_PRECISE float inverse = reciprocal(c.w);
  GPGP_PRECISE float x = c.x * inverse;
  GPGP_PRECISE float y = c.y * inverse;
  p = ivec2(snap(x, grid.pixels.x), snap(y, grid.pixels.y) + grid.top * 256);
  z = depthAt(c);
  return true;
}

/// Where a clip-space point lies on the grid, in parts of kFine to a unit.
GPGP_FN ivec2 projectFinely(vec4 c, Grid grid) {
  GPGP_PRECISE float inverse = reciprocal(c.w);
  GPGP_PRECISE float x = c.x * inverse;
  GPGP_PRECISE float y = c.y * inverse;
  return ivec2(snapFinely(x, grid.pixels.x), snapFinely(y, grid.pixels.y) + grid.top * 256 * kFine);
}

/// The one of three points that lies in a unit; the last one if the others do not.
GPGP_FN ivec2 pointIn(ivec2 unit, ivec2 a, ivec2 b, ivec2 c) {
  if (nearestUnit(a) == unit) return a;
  if (nearestUnit(b) == unit) return b;
  return c;
}

/// The corners of a whole triangle, in its order, in parts of kFine to a unit: to a sixteenth, unless that turns it
/// over.
GPGP_FN Corners fineCorners(ScreenTriangle t, vec4 a, vec4 b, vec4 c, Grid grid) {
  ivec2 fineA = projectFinely(a, grid);
  ivec2 fineB = projectFinely(b, grid);
  ivec2 fineC = projectFinely(c, grid);
  Corners r;
  r.p0 = pointIn(t.p0, fineA, fineB, fineC);
  r.p1 = pointIn(t.p1, fineA, fineB, fineC);
  r.p2 = pointIn(t.p2, fineA, fineB, fineC);
  if (wideSign(twiceArea(r.p0, r.p1, r.p2)) <= 0) r = unitCorners(t);
  return r;
}

/// Whether fine corners span more than rounding may make of three that lie on a line: each is off by a part, and by
/// what floats round off in so large a viewport.
GPGP_FN bool spansArea(Corners c, Wide area, Grid grid) {
  ivec2 low = min(c.p0, min(c.p1, c.p2));
  ivec2 high = max(c.p0, max(c.p1, c.p2));
  int most = 4 + max(grid.pixels.x, grid.pixels.y) / 1024; // parts of height
  GPGP_PRECISE float least = float(max(high.x - low.x, high.y - low.y)) * float(most);
  return abs(widerToFloat(area)) > least;
}

/// Whether a triangle that is kBackFacing on the grid faces the viewer with fine corners, which are told in the order
/// that gives positive area. So thin a one is nowhere a unit from what the grid makes of it.
GPGP_FN bool facesFinely(vec4 a, vec4 b, vec4 c, Grid grid, bool mirrored, bool twoSided, GPGP_OUT(Corners) fine,
                         GPGP_OUT(bool) swaps) {
  fine.p0 = projectFinely(a, grid);
  fine.p1 = projectFinely(b, grid);
  fine.p2 = projectFinely(c, grid);
  Wide area = twiceArea(fine.p0, fine.p1, fine.p2);
  int turn = spansArea(fine, area, grid) ? wideSign(area) : 0;
  swaps = turn < 0;
  if (swaps) {
    ivec2 second = fine.p1;
    fine.p1 = fine.p2;
    fine.p2 = second;
  }
  return turn != 0 && (twoSided || (turn > 0) == mirrored);
}

/// Such a triangle on the grid, where it has no area. fine: its corners, in its order.
GPGP_FN ScreenTriangle makeSliver(vec4 a, vec4 b, vec4 c, bool swaps, GPGP_INOUT(Corners) fine) {
  vec4 second = swaps ? c : b;
  vec4 third = swaps ? b : c;
  float z0 = depthAt(a);
  float z1 = depthAt(second);
  float z2 = depthAt(third);
  ScreenTriangle t = noTriangle();
  // As in makeTriangle().
  bool isSecond = liesBefore(fine.p1, fine.p0);
  bool isThird = liesBefore(fine.p2, isSecond ? fine.p1 : fine.p0);
  Corners turned = fine;
  turned.p0 = isThird ? fine.p2 : isSecond ? fine.p1 : fine.p0;
  turned.p1 = isThird ? fine.p0 : isSecond ? fine.p2 : fine.p1;
  turned.p2 = isThird ? fine.p1 : isSecond ? fine.p0 : fine.p2;
  fine = turned;
  t.z0 = isThird ? z2 : isSecond ? z1 : z0;
  GPGP_PRECISE float dz1 = (isThird ? z0 : isSecond ? z2 : z1) - t.z0;
  GPGP_PRECISE float dz2 = (isThird ? z1 : isSecond ? z0 : z2) - t.z0;
  t.dz1 = dz1;
  t.dz2 = dz2;
  t.zMin = min(z0, min(z1, z2));
  t.zMax = max(z0, max(z1, z2));
  t.p0 = nearestUnit(fine.p0);
  t.p1 = nearestUnit(fine.p1);
  t.p2 = nearestUnit(fine.p2);
  return t;
}

/// Sorts a triangle's clip coordinates into one of the cases above; for kWhole makes it, unless it is turned away.
GPGP_FN uint classify(vec4 a, vec4 b, vec4 c, Grid grid, bool mirrored, bool twoSided,
                      GPGP_OUT(ScreenTriangle) triangle) {
  triangle = noTriangle();
  if (!isModerateVector(a) || !isModerateVector(b) || !isModerateVector(c)) return kSkipped;
  if ((outCode(a) & outCode(b) & outCode(c)) != 0u) return kOutside;
  if (needsClip(a) || needsClip(b) || needsClip(c)) return kClipped;
  ivec2 p0;
  ivec2 p1;
  ivec2 p2;
  float z0;
  float z1;
  float z2;
  bool ok0 = project(a, grid, p0, z0);
  bool ok1 = project(b, grid, p1, z1);
  bool ok2 = project(c, grid, p2, z2);
  if (!ok0 || !ok1 || !ok2) return kSkipped;
  int turn = wideSign(twiceArea(p0, p1, p2));
  // Counter-clockwise as seen is negative with y down.
  if (turn == 0 || (!twoSided && (turn > 0) != mirrored)) return kBackFacing;
  bool swaps = turn < 0;
  triangle = makeTriangle(p0, swaps ? p2 : p1, swaps ? p1 : p2, z0, swaps ? z2 : z1, swaps ? z1 : z2, grid);
  return kWhole;
}

GPGP_FN bool liesBefore(vec4 a, vec4 b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  if (a.z != b.z) return a.z < b.z;
  return a.w < b.w;
}

/// Swaps two corners if the second one lies before the first, which turns the triangle over.
GPGP_FN void sortCorners(GPGP_INOUT(vec4) a, GPGP_INOUT(vec4) b, GPGP_INOUT(bool) mirrored) {
  if (!liesBefore(b, a)) return;
  vec4 first = b;
  b = a;
  a = first;
  mirrored = !mirrored;
}

/// For kClipped: the polygon that is left. The same one whichever corner the mesh names first. Returns kOutside,
/// kBackFacing, kSkipped or kClipped.
GPGP_FN uint clipTriangle(vec4 a, vec4 b, vec4 c, Grid grid, bool mirrored, bool twoSided,
                          GPGP_OUT(ScreenPolygon) screen) {
  screen.count = 0;
  screen.reversedOrder = false;
  sortCorners(a, b, mirrored);
  sortCorners(b, c, mirrored);
  sortCorners(a, b, mirrored);
  ClipPolygon polygon;
  polygon.v[0] = a;
  polygon.v[1] = b;
  polygon.v[2] = c;
  polygon.count = 3;
  for (int plane = 0; plane < kClipPlanes; ++plane) clipBy(plane, polygon);
  if (polygon.count < 3) return kOutside;
  for (int i = 0; i < polygon.count; ++i) {
    ivec2 p;
    float z;
    if (!project(polygon.v[i], grid, p, z)) return kSkipped;
    screen.p[i] = p;
    screen.z[i] = z;
    screen.q[i] = reciprocal(polygon.v[i].w);
  }
  screen.count = polygon.count;
  Wide area;
  area.high = 0;
  area.low = 0u;
  for (int i = 2; i < screen.count; ++i) area = wideSum(area, twiceArea(screen.p[0], screen.p[i - 1], screen.p[i]));
  int turn = wideSign(area);
  if (turn == 0 || (!twoSided && (turn > 0) != mirrored)) return kBackFacing;
  screen.reversedOrder = turn < 0;
  return kClipped;
}

/// Piece k (0 to count - 3) of the fan; false where snapping left it no area, or turned it over: then the others cover
/// it.
GPGP_FN bool fanPiece(ScreenPolygon screen, int k, Grid grid, GPGP_OUT(ScreenTriangle) triangle) {
  int i = screen.reversedOrder ? k + 2 : k + 1;
  int j = screen.reversedOrder ? k + 1 : k + 2;
  bool positive = wideSign(twiceArea(screen.p[0], screen.p[i], screen.p[j])) > 0;
  if (positive)
    triangle = makeTriangle(screen.p[0], screen.p[i], screen.p[j], screen.z[0], screen.z[i], screen.z[j], grid);
  else
    triangle = noTriangle();
  return positive;
}

GPGP_SHADER_END
#endif
