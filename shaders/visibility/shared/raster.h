// One triangle on the sample grid: snapping, fill rule, coverage, depth. Chapter 6's "standard" sampling, as
// rasterising hardware does it: one sample a pixel, at its centre; or a grid of them in each pixel.
//
// Guarantees: vertices are snapped to 1/256 pixel and all decisions are exact integers, so two triangles that share an
// edge never both cover, nor both miss, a point on it (top-left rule). Depth is a function of the triangle and the
// point alone: whichever pass or thread asks, and whichever corner comes first, the bits are the same.
#ifndef GPGP_SHADERS_VISIBILITY_RASTER_H
#define GPGP_SHADERS_VISIBILITY_RASTER_H
#include "core/math.h"
#include "visibility/shared/integers.h"
#include "visibility/shared/layout.h"

GPGP_SHADER_BEGIN

/// Snapped coordinates stay within three viewports to each side: differences below 2^24, areas below 2^48.
GPGP_CONST int kGuard = 7;
/// A triangle of at most this extent in sub-pixels has edge functions below 2^31 wherever it covers pixels.
GPGP_CONST int kCompactExtent = 16384;
/// A compact triangle whose bounds hold at most this many samples is drawn by one invocation.
GPGP_CONST int kSmallPixels = 64;

/// Samples lie 2^shift units apart (256 units a pixel).
struct Grid {
  ivec2 pixels; ///< of the viewport
  int shift;    ///< 8: one sample a pixel; 2: 64 x 64; 0: every point that a vertex can lie on
  ivec2 offset; ///< of the first sample, in units; 0 to 2^shift - 1
  int top;      ///< the viewport's first row of pixels: viewports of several cameras lie one below the other
  int margin;   ///< 0, or kMargin: what triangles own beyond their edges
};

/// Quarters of a unit that triangles own beyond their edges at most, in each direction, where samples are looked for
/// below the pixel. Snapping moves a vertex by up to half a unit, so that one on another triangle's edge (a T-junction)
/// leaves a crack of up to a unit: half a unit from either side closes it.
GPGP_CONST int kMargin = 2;

/// Standard sampling is what rasterising hardware does; conservative and nearby sampling begin with it.
GPGP_FN int marginOfMethod(uint method) { return method == kExact || method == kReference ? kMargin : 0; }

/// Samples of a viewport, in each direction.
GPGP_FN ivec2 samplesOf(Grid grid) {
  return ivec2(grid.pixels.x << (8 - grid.shift), grid.pixels.y << (8 - grid.shift));
}

/// Where a sample lies, in units.
GPGP_FN ivec2 samplePoint(ivec2 i, Grid grid) {
  return ivec2((i.x << grid.shift) + grid.offset.x, (i.y << grid.shift) + grid.offset.y);
}

/// As many samples a pixel as shift says, each in the middle of its part: the pixel's centre for 8.
GPGP_FN Grid middleGrid(ivec2 pixels, int shift) {
  Grid grid;
  grid.pixels = pixels;
  grid.shift = shift;
  grid.offset = ivec2((1 << shift) >> 1, (1 << shift) >> 1);
  grid.top = 0;
  grid.margin = 0;
  return grid;
}

/// A triangle on the grid: x right, y down, 256 units a pixel, area positive (so clockwise as seen).
struct ScreenTriangle {
  ivec4 bounds; ///< samples that may be covered: x, y (first), z, w (one past the last), inside the viewport
  ivec2 p0;
  ivec2 p1;
  ivec2 p2;
  float z0;  ///< depth of p0
  float dz1; ///< of p1, less z0
  float dz2;
  float zMin;
  float zMax;
  float inverseArea; ///< of twice the area
};

/// Twice the signed area; positive: clockwise as seen, y down.
GPGP_FN Wide twiceArea(ivec2 a, ivec2 b, ivec2 c) {
  return wideSum(wideProduct(b.x - a.x, c.y - a.y), wideProduct(a.y - b.y, c.x - a.x));
}

/// Where a clip coordinate (after division: -1 to 1) lies on the grid of an axis with `pixels` pixels.
GPGP_FN int snap(float normalised, int pixels) {
  GPGP_PRECISE float half_ = float(pixels) * 128.0f;
  GPGP_PRECISE float position = floor(normalised * half_ + (half_ + 0.5f));
  // The guard clips at kGuard times the axis; division may round past it.
  int limit = pixels * 128;
  return clamp(int(position), limit - kGuard * limit, limit + kGuard * limit);
}

/// The same to a sixteenth of that, in parts of kFine to a unit: the middle of the sixteenth that it lies in, so that
/// nearestUnit() of it is what snap() says.
GPGP_CONST int kFine = 32;
GPGP_FN int snapFinely(float normalised, int pixels) {
  GPGP_PRECISE float half_ = float(pixels) * 2048.0f;
  GPGP_PRECISE float position = floor(normalised * half_ + (half_ + 8.0f));
  return int(position) * 2 + 1 - kFine / 2;
}
GPGP_FN ivec2 nearestUnit(ivec2 fine) { return (fine + kFine / 2) >> 5; }

struct Corners {
  ivec2 p0;
  ivec2 p1;
  ivec2 p2;
};

/// The corners of a triangle on the grid, in its order, in parts of kFine to a unit.
GPGP_FN Corners unitCorners(ScreenTriangle t) {
  Corners r;
  r.p0 = t.p0 * kFine;
  r.p1 = t.p1 * kFine;
  r.p2 = t.p2 * kFine;
  return r;
}

GPGP_FN bool liesBefore(ivec2 a, ivec2 b) { return a.y < b.y || (a.y == b.y && a.x < b.x); }

/// Makes a triangle from snapped vertices with positive area. Depths lie in [0, 1]. Its p0 is the uppermost vertex, of
/// those the leftmost, so that depth does not depend on which one the mesh names first.
GPGP_FN ScreenTriangle makeTriangle(ivec2 a, ivec2 b, ivec2 c, float za, float zb, float zc, Grid grid) {
  bool second = liesBefore(b, a);
  bool third = liesBefore(c, second ? b : a);
  ScreenTriangle t;
  t.p0 = third ? c : second ? b : a;
  t.p1 = third ? a : second ? c : b;
  t.p2 = third ? b : second ? a : c;
  t.z0 = third ? zc : second ? zb : za;
  float z1 = third ? za : second ? zc : zb;
  float z2 = third ? zb : second ? za : zc;
  int around = min(grid.margin, 1); // kMargin is less than a unit
  int left = min(a.x, min(b.x, c.x)) - around;
  int top = t.p0.y - around;
  int right = max(a.x, max(b.x, c.x)) + around;
  int bottom = max(t.p1.y, t.p2.y) + around;
  int roundUp = (1 << grid.shift) - 1;
  ivec2 samples = samplesOf(grid);
  t.bounds.x = max((left - grid.offset.x + roundUp) >> grid.shift, 0);
  int firstRow = grid.top << (8 - grid.shift);
  t.bounds.y = max((top - grid.offset.y + roundUp) >> grid.shift, firstRow);
  t.bounds.z = min(((right - grid.offset.x) >> grid.shift) + 1, samples.x);
  t.bounds.w = min(((bottom - grid.offset.y) >> grid.shift) + 1, firstRow + samples.y);
  t.zMin = min(za, min(zb, zc));
  t.zMax = max(za, max(zb, zc));
  GPGP_PRECISE float dz1 = z1 - t.z0;
  GPGP_PRECISE float dz2 = z2 - t.z0;
  t.dz1 = dz1;
  t.dz2 = dz2;
  t.inverseArea = reciprocal(wideToFloat(twiceArea(a, b, c)));
  return t;
}

GPGP_FN ScreenTriangle noTriangle() {
  ScreenTriangle t;
  t.bounds = ivec4(0, 0, 0, 0);
  t.p0 = ivec2(0, 0);
  t.p1 = ivec2(0, 0);
  t.p2 = ivec2(0, 0);
  t.z0 = 0.0f;
  t.dz1 = 0.0f;
  t.dz2 = 0.0f;
  t.zMin = 0.0f;
  t.zMax = 0.0f;
  t.inverseArea = 0.0f;
  return t;
}

GPGP_FN bool isEmpty(ScreenTriangle t) { return t.bounds.x >= t.bounds.z || t.bounds.y >= t.bounds.w; }

/// Blocks of 8 x 8 samples that hold the bounds of a triangle that is not empty.
GPGP_FN uint blocksOf(ScreenTriangle t) {
  return uint(t.bounds.z - t.bounds.x + 7) / 8u * (uint(t.bounds.w - t.bounds.y + 7) / 8u);
}

GPGP_FN bool isCompact(ScreenTriangle t) {
  int width = max(t.p0.x, max(t.p1.x, t.p2.x)) - min(t.p0.x, min(t.p1.x, t.p2.x));
  int height = max(t.p0.y, max(t.p1.y, t.p2.y)) - min(t.p0.y, min(t.p1.y, t.p2.y));
  return max(width, height) <= kCompactExtent;
}

GPGP_FN bool isSmall(ScreenTriangle t) {
  return isCompact(t) && (t.bounds.z - t.bounds.x) * (t.bounds.w - t.bounds.y) <= kSmallPixels;
}

/// The edge from u to v as slopes per sub-pixel: x: along x, y: along y. Its function is positive inside.
GPGP_FN ivec2 edgeSlope(ivec2 u, ivec2 v) { return ivec2(u.y - v.y, v.x - u.x); }

/// 0 where an edge owns the points on it (top or left edge, or one of no length), 1 where it does not.
GPGP_FN int edgeBias(ivec2 slope) { return slope.x > 0 || (slope.x == 0 && slope.y >= 0) ? 0 : 1; }

GPGP_FN int spanOf(ivec2 slope) { return abs(slope.x) + abs(slope.y); }

/// What a triangle owns beyond its edges, of `most` quarters of a unit: at most a sixteenth of its in-circle's radius,
/// so that small ones lose nothing to their neighbours and slivers stay slivers.
GPGP_FN int marginOf(ScreenTriangle t, int most) {
  if (most == 0) return 0;
  int around = spanOf(edgeSlope(t.p1, t.p2)) + spanOf(edgeSlope(t.p2, t.p0)) + spanOf(edgeSlope(t.p0, t.p1));
  GPGP_PRECISE float inverseRadius = float(around) * t.inverseArea;
  int margin = inverseRadius <= 0.125f ? 2 : inverseRadius <= 0.25f ? 1 : 0;
  return min(margin, most);
}

/// The least value of the edge function at a point that the triangle owns; margin: what marginOf() says.
GPGP_FN int edgeLeast(ivec2 slope, int margin) { return edgeBias(slope) - ((spanOf(slope) * margin) >> 2); }

/// The edge function at a point, exact.
GPGP_FN Wide edgeWide(ivec2 u, ivec2 slope, ivec2 point) {
  return wideSum(wideProduct(slope.x, point.x - u.x), wideProduct(slope.y, point.y - u.y));
}

/// The same in 32 bits, for compact triangles and points within a pixel of their bounds.
GPGP_FN int edgeCompact(ivec2 u, ivec2 slope, ivec2 point) {
  return slope.x * (point.x - u.x) + slope.y * (point.y - u.y);
}

/// What tells inside from outside in a block of up to 16 x 16 samples that starts at `first`: sample (i, j) of the
/// block is inside the edge exactly if edgeBlock + slope.x * i + slope.y * j >= 0, which cannot overflow.
GPGP_FN int edgeBlock(ivec2 u, ivec2 slope, ivec2 first, Grid grid, int margin) {
  int least = edgeLeast(slope, margin);
  Wide bias;
  bias.high = least > 0 ? -1 : 0;
  bias.low = uint(-least);
  return wideShifted(wideSum(edgeWide(u, slope, samplePoint(first, grid)), bias), grid.shift);
}

/// Whether no sample of a block of size x size samples is inside the edge.
GPGP_FN bool blockOutside(int block, ivec2 slope, int size) {
  return block + max(slope.x, 0) * (size - 1) + max(slope.y, 0) * (size - 1) < 0;
}

/// Depth from the edge functions of p1 and p2 as floats.
GPGP_FN float depthOf(ScreenTriangle t, float weight1, float weight2) {
  GPGP_PRECISE float z = t.z0 + (weight1 * t.dz1 + weight2 * t.dz2) * t.inverseArea;
  z = clamp(z, t.zMin, t.zMax);
  // Devices may flush subnormal numbers and differ in the sign of zero.
  return z < 1.17549435e-38f ? 0.0f : z;
}

/// Depth at a covered point, any triangle.
GPGP_FN float depthWide(ScreenTriangle t, ivec2 point) {
  float weight1 = wideToFloat(edgeWide(t.p2, edgeSlope(t.p2, t.p0), point));
  float weight2 = wideToFloat(edgeWide(t.p0, edgeSlope(t.p0, t.p1), point));
  return depthOf(t, weight1, weight2);
}

GPGP_FN float compactToFloat(int v) {
  Wide w;
  w.high = v < 0 ? -1 : 0;
  w.low = uint(v);
  return wideToFloat(w);
}

/// Whether a point is inside an edge or on one that owns it.
GPGP_FN bool insideWide(ivec2 u, ivec2 slope, ivec2 point) {
  return wideSign(edgeWide(u, slope, point)) >= edgeBias(slope);
}

/// Whether the triangle owns a point, any triangle; margin: what marginOf() says.
GPGP_FN bool coversWide(ScreenTriangle t, int margin, ivec2 point) {
  Grid unit = middleGrid(ivec2(0, 0), 0);
  return edgeBlock(t.p1, edgeSlope(t.p1, t.p2), point, unit, margin) >= 0 &&
         edgeBlock(t.p2, edgeSlope(t.p2, t.p0), point, unit, margin) >= 0 &&
         edgeBlock(t.p0, edgeSlope(t.p0, t.p1), point, unit, margin) >= 0;
}

/// The same for compact triangles, with the depth where it is covered.
GPGP_FN bool coversCompact(ScreenTriangle t, int margin, ivec2 point, GPGP_OUT(float) z) {
  ivec2 s0 = edgeSlope(t.p1, t.p2);
  ivec2 s1 = edgeSlope(t.p2, t.p0);
  ivec2 s2 = edgeSlope(t.p0, t.p1);
  int e0 = edgeCompact(t.p1, s0, point);
  int e1 = edgeCompact(t.p2, s1, point);
  int e2 = edgeCompact(t.p0, s2, point);
  z = 0.0f;
  if (e0 < edgeLeast(s0, margin) || e1 < edgeLeast(s1, margin) || e2 < edgeLeast(s2, margin)) return false;
  z = depthOf(t, compactToFloat(e1), compactToFloat(e2));
  return true;
}

/// Depth as a number whose order is "nearer first".
GPGP_FN uint depthKey(float z, bool reversed) {
  uint bits = floatBitsToUint(z);
  return reversed ? ~bits : bits;
}

GPGP_SHADER_END
#endif
