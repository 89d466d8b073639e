// Conservative sampling (6.1.3): a triangle's depths and normal within one pixel, and whether the heuristics accept it
// beside what was found at the pixel's centre.
//
// Guarantees: one result on every device. Depth is clip space's w, interpolated as 1/w, which is linear on the screen;
// with parallel projections, whose w is 1, it is z, counted from the near plane. The triangle is clipped to the pixel,
// so its nearest and farthest depths are those of the part inside (6.2.1).
#ifndef GPGP_SHADERS_VISIBILITY_CONSERVATIVE_H
#define GPGP_SHADERS_VISIBILITY_CONSERVATIVE_H
#include "visibility/shared/candidate.h"
#include "visibility/shared/triangle.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kInCircle = 1u; ///< GPGP_HEURISTIC_...
GPGP_CONST uint kDepths = 2u;
GPGP_CONST uint kKeepFront = 4u;

/// Whether depths are w rather than z.
GPGP_FN bool isPerspective(mat4 viewProjection) {
  return viewProjection[0].w != 0.0f || viewProjection[1].w != 0.0f || viewProjection[2].w != 0.0f;
}

/// Numbers at the corners a, b and another one of a triangle, in the order in which it has them.
GPGP_FN vec3 inOrderOf(ScreenTriangle t, ivec2 a, ivec2 b, vec3 v) {
  bool aThird = t.p2.x == a.x && t.p2.y == a.y;
  bool bThird = t.p2.x == b.x && t.p2.y == b.y;
  if (t.p0.x == a.x && t.p0.y == a.y) return bThird ? vec3(v.x, v.z, v.y) : v;
  if (t.p0.x == b.x && t.p0.y == b.y) return aThird ? vec3(v.y, v.z, v.x) : vec3(v.y, v.x, v.z);
  return aThird ? vec3(v.z, v.y, v.x) : vec3(v.z, v.x, v.y);
}

/// What is linear on the screen, at the corners of a whole triangle that classify() made.
GPGP_FN vec3 wholeDepths(vec4 a, vec4 b, vec4 c, ScreenTriangle t, Grid grid, bool perspective) {
  if (!perspective) return vec3(t.z0, t.z0 + t.dz1, t.z0 + t.dz2);
  ivec2 first;
  ivec2 second;
  float z;
  bool ok = project(a, grid, first, z) && project(b, grid, second, z);
  return ok ? inOrderOf(t, first, second, vec3(divide(1.0f, a.w), divide(1.0f, b.w), divide(1.0f, c.w)))
            : vec3(0.0f, 0.0f, 0.0f);
}

/// The same at the corners of piece k of a clipped one.
GPGP_FN vec3 pieceDepths(ScreenPolygon screen, int k, ScreenTriangle t, bool perspective) {
  if (!perspective) return vec3(t.z0, t.z0 + t.dz1, t.z0 + t.dz2);
  int i = screen.reversedOrder ? k + 2 : k + 1;
  int j = screen.reversedOrder ? k + 1 : k + 2;
  return inOrderOf(t, screen.p[0], screen.p[i], vec3(screen.q[0], screen.q[i], screen.q[j]));
}

/// A triangle cut by a pixel's four sides: x, y in units from the pixel's corner, and depth.
struct PixelPolygon {
  vec3 v[7];
  int count;
};

GPGP_FN float sideDistance(int side, vec3 v) {
  GPGP_PRECISE float d = v.x;
  if (side == 1) d = 256.0f - v.x;
  if (side == 2) d = v.y;
  if (side == 3) d = 256.0f - v.y;
  return d;
}

GPGP_FN vec3 cutSide(int side, vec3 inner, vec3 outer) {
  GPGP_PRECISE float di = sideDistance(side, inner);
  GPGP_PRECISE float span = di - sideDistance(side, outer);
  GPGP_PRECISE float t = divide(di, span);
  GPGP_PRECISE float x = inner.x + (outer.x - inner.x) * t;
  GPGP_PRECISE float y = inner.y + (outer.y - inner.y) * t;
  GPGP_PRECISE float d = inner.z + (outer.z - inner.z) * t;
  if (side < 2) x = side == 0 ? 0.0f : 256.0f;
  if (side >= 2) y = side == 2 ? 0.0f : 256.0f;
  return vec3(x, y, d);
}

/// Nearest and farthest depth of a triangle's part in a pixel; false where there is none.
GPGP_FN bool depthsInPixel(ScreenTriangle t, vec3 depths, ivec2 pixel, bool perspective, bool reversed,
                           GPGP_OUT(float) nearest, GPGP_OUT(float) farthest) {
  ivec2 corner = ivec2(pixel.x * 256, pixel.y * 256);
  PixelPolygon polygon;
  polygon.v[0] = vec3(float(t.p0.x - corner.x), float(t.p0.y - corner.y), depths.x);
  polygon.v[1] = vec3(float(t.p1.x - corner.x), float(t.p1.y - corner.y), depths.y);
  polygon.v[2] = vec3(float(t.p2.x - corner.x), float(t.p2.y - corner.y), depths.z);
  polygon.count = 3;
  for (int side = 0; side < 4; ++side) {
    PixelPolygon cut;
    cut.count = 0;
    for (int i = 0; i < polygon.count; ++i) {
      vec3 a = polygon.v[i];
      vec3 b = polygon.v[i + 1 == polygon.count ? 0 : i + 1];
      bool insideA = sideDistance(side, a) >= 0.0f;
      bool insideB = sideDistance(side, b) >= 0.0f;
      // Rounding may bend the polygon a little: it never holds more than seven.
      if (insideA && cut.count < 7) cut.v[cut.count++] = a;
      if (insideA != insideB && cut.count < 7) {
        if (insideA)
          cut.v[cut.count] = cutSide(side, a, b);
        else
          cut.v[cut.count] = cutSide(side, b, a);
        ++cut.count;
      }
    }
    polygon = cut;
  }
  nearest = 0.0f;
  farthest = 0.0f;
  if (polygon.count == 0) return false;
  float low = polygon.v[0].z;
  float high = low;
  for (int i = 1; i < polygon.count; ++i) {
    low = min(low, polygon.v[i].z);
    high = max(high, polygon.v[i].z);
  }
  float least = min(depths.x, min(depths.y, depths.z));
  float most = max(depths.x, max(depths.y, depths.z));
  low = clamp(low, least, most);
  high = clamp(high, least, most);
  if (perspective) {
    nearest = divide(1.0f, high);
    farthest = divide(1.0f, low);
  } else {
    GPGP_PRECISE float front = reversed ? 1.0f - high : low;
    GPGP_PRECISE float back = reversed ? 1.0f - low : high;
    nearest = withoutTiny(front);
    farthest = withoutTiny(back);
  }
  return true;
}

/// A vector's largest component, or 0 where it cannot be divided by.
GPGP_FN float scaleOf(vec3 v) {
  if (!isModerate(v.x) || !isModerate(v.y) || !isModerate(v.z)) return 0.0f;
  float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
  return isDivisor(largest) ? largest : 0.0f;
}

GPGP_FN vec3 scaled(vec3 v, float by) { return vec3(divide(v.x, by), divide(v.y, by), divide(v.z, by)); }

/// A triangle's normal in world space, of length 1; 0 where it has none.
GPGP_FN vec3 normalOf(vec3 a, vec3 b, vec3 c) {
  GPGP_PRECISE vec3 e = b - a;
  GPGP_PRECISE vec3 f = c - a;
  float scaleE = scaleOf(e);
  float scaleF = scaleOf(f);
  vec3 none = vec3(0.0f, 0.0f, 0.0f);
  if (scaleE == 0.0f || scaleF == 0.0f) return none;
  e = scaled(e, scaleE);
  f = scaled(f, scaleF);
  GPGP_PRECISE float x = e.y * f.z - e.z * f.y;
  GPGP_PRECISE float y = e.z * f.x - e.x * f.z;
  GPGP_PRECISE float z = e.x * f.y - e.y * f.x;
  vec3 n = vec3(withoutTiny(x), withoutTiny(y), withoutTiny(z));
  float scaleN = scaleOf(n);
  if (scaleN == 0.0f) return none;
  n = scaled(n, scaleN);
  GPGP_PRECISE float square = (n.x * n.x + n.y * n.y) + n.z * n.z;
  return scaled(n, squareRoot(square));
}

GPGP_FN float lengthOf(ivec2 v) {
  GPGP_PRECISE float x = float(v.x);
  GPGP_PRECISE float y = float(v.y);
  GPGP_PRECISE float square = x * x + y * y;
  return squareRoot(square);
}

/// Whether the in-circle's radius, twice the area by the circumference (6.1), is more than a pixel.
GPGP_FN bool isLarge(ScreenTriangle t) {
  GPGP_PRECISE float around = (lengthOf(t.p1 - t.p0) + lengthOf(t.p2 - t.p1)) + lengthOf(t.p0 - t.p2);
  GPGP_PRECISE float limit = around * 256.0f;
  return wideToFloat(twiceArea(t.p0, t.p1, t.p2)) > limit;
}

/// Equations 6.2 to 6.4: whether depths in a pixel are accepted beside those of what its centre shows. Depths that
/// overlap have a negative difference.
GPGP_FN bool acceptsDepths(Surface s, float nearest, float farthest, vec3 normal, uint heuristics, float epsilonStatic,
                           float epsilonDynamic) {
  GPGP_PRECISE float cosine = abs((s.normalX * normal.x + s.normalY * normal.y) + s.normalZ * normal.z);
  GPGP_PRECISE float epsilon = epsilonStatic + epsilonDynamic * (1.0f - min(cosine, 1.0f));
  GPGP_PRECISE float behind = nearest - s.farthest;
  GPGP_PRECISE float before = s.nearest - farthest;
  if ((heuristics & kKeepFront) != 0u) return behind < epsilon;
  return max(behind, before) < epsilon;
}

/// Which of a pixel's 8 x 8 samples a triangle owns, row by row.
GPGP_FN uvec2 coverageOf(ScreenTriangle t, ivec2 pixel) {
  Grid grid = middleGrid(ivec2(0, 0), 5);
  ivec2 first = ivec2(pixel.x * 8, pixel.y * 8);
  ivec2 s0 = edgeSlope(t.p1, t.p2);
  ivec2 s1 = edgeSlope(t.p2, t.p0);
  ivec2 s2 = edgeSlope(t.p0, t.p1);
  int e0 = edgeBlock(t.p1, s0, first, grid, 0);
  int e1 = edgeBlock(t.p2, s1, first, grid, 0);
  int e2 = edgeBlock(t.p0, s2, first, grid, 0);
  uvec2 mask = uvec2(0u, 0u);
  if (blockOutside(e0, s0, 8) || blockOutside(e1, s1, 8) || blockOutside(e2, s2, 8)) return mask;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      bool inside = e0 + s0.x * x + s0.y * y >= 0 && e1 + s1.x * x + s1.y * y >= 0 && e2 + s2.x * x + s2.y * y >= 0;
      if (!inside) continue;
      if (y < 4)
        mask.x |= 1u << uint(y * 8 + x);
      else
        mask.y |= 1u << uint(y * 8 + x - 32);
    }
  return mask;
}

/// Whether samples are in a quarter of their pixel: left above, right above, left below, right below.
GPGP_FN bool inQuarter(uvec2 samples, uint quarter) {
  uint rows = quarter < 2u ? samples.x : samples.y;
  return (rows & ((quarter & 1u) == 0u ? 0x0f0f0f0fu : 0xf0f0f0f0u)) != 0u;
}

GPGP_SHADER_END
#endif
