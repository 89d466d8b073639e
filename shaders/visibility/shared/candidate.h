// One triangle within one pixel, for the methods that look below a pixel: whether it touches the pixel, how near it
// comes there, and which of the pixel's 64 x 64 samples it covers, a row at a time.
//
// Guarantees: one result on every device. The rows' masks are made with floats and may be wrong by a sample at either
// end, but two triangles with a common edge leave no sample out there.
#ifndef GPGP_SHADERS_VISIBILITY_CANDIDATE_H
#define GPGP_SHADERS_VISIBILITY_CANDIDATE_H
#include "visibility/shared/layout.h"
#include "visibility/shared/raster.h"

GPGP_SHADER_BEGIN

/// Pixels whose points may be covered, like ScreenTriangle::bounds.
GPGP_FN ivec4 pixelBounds(ivec2 a, ivec2 b, ivec2 c, Grid grid) {
  ivec4 r;
  r.x = max(min(a.x, min(b.x, c.x)) >> 8, 0);
  r.y = max(min(a.y, min(b.y, c.y)) >> 8, grid.top);
  r.z = min((max(a.x, max(b.x, c.x)) >> 8) + 1, grid.pixels.x);
  r.w = min((max(a.y, max(b.y, c.y)) >> 8) + 1, grid.top + grid.pixels.y);
  return r;
}

/// The pixel's point where an edge function is greatest.
GPGP_FN ivec2 innermost(ivec2 slope, ivec2 pixel) {
  return ivec2(pixel.x * 256 + (slope.x > 0 ? 255 : 0), pixel.y * 256 + (slope.y > 0 ? 255 : 0));
}

/// Whether a triangle may own a point of a pixel within its pixelBounds: no edge has all of them outside.
GPGP_FN bool touchesCompact(ScreenTriangle t, ivec2 pixel) {
  ivec2 s0 = edgeSlope(t.p1, t.p2);
  ivec2 s1 = edgeSlope(t.p2, t.p0);
  ivec2 s2 = edgeSlope(t.p0, t.p1);
  return edgeCompact(t.p1, s0, innermost(s0, pixel)) >= edgeBias(s0) &&
         edgeCompact(t.p2, s1, innermost(s1, pixel)) >= edgeBias(s1) &&
         edgeCompact(t.p0, s2, innermost(s2, pixel)) >= edgeBias(s2);
}
GPGP_FN bool touchesWide(ScreenTriangle t, ivec2 pixel) {
  ivec2 s0 = edgeSlope(t.p1, t.p2);
  ivec2 s1 = edgeSlope(t.p2, t.p0);
  ivec2 s2 = edgeSlope(t.p0, t.p1);
  return insideWide(t.p1, s0, innermost(s0, pixel)) && insideWide(t.p2, s1, innermost(s1, pixel)) &&
         insideWide(t.p0, s2, innermost(s2, pixel));
}

/// The same for pixels of a block of up to 16 x 16 that starts at `first`: pixel (i, j) of it has points inside an edge
/// exactly if innermostBlock + slope.x * i + slope.y * j >= 0.
GPGP_FN int innermostBlock(ivec2 u, ivec2 slope, ivec2 first) {
  Grid grid;
  grid.pixels = ivec2(0, 0);
  grid.shift = 8;
  grid.offset = innermost(slope, ivec2(0, 0));
  grid.top = 0;
  grid.margin = 0;
  return edgeBlock(u, slope, first, grid, 0);
}

/// Bits: which pixels of a tile of 8 x 8 a triangle touches, whose pixelBounds and the tile's first pixel are given.
GPGP_FN uvec2 touchedPixels(ScreenTriangle t, ivec4 bounds, ivec2 first) {
  ivec2 s0 = edgeSlope(t.p1, t.p2);
  ivec2 s1 = edgeSlope(t.p2, t.p0);
  ivec2 s2 = edgeSlope(t.p0, t.p1);
  ivec3 corner =
      ivec3(innermostBlock(t.p1, s0, first), innermostBlock(t.p2, s1, first), innermostBlock(t.p0, s2, first));
  ivec3 toRight = ivec3(s0.x, s1.x, s2.x);
  ivec3 down = ivec3(s0.y, s1.y, s2.y);
  ivec2 low = max(ivec2(bounds.x, bounds.y) - first, ivec2(0, 0));
  ivec2 high = min(ivec2(bounds.z, bounds.w) - first, ivec2(8, 8));
  uvec2 mask = uvec2(0u, 0u);
  for (int y = low.y; y < high.y; ++y) {
    ivec3 edges = corner + down * y + toRight * low.x;
    uint row = 0u;
    for (int x = low.x; x < high.x; ++x) {
      if ((edges.x | edges.y | edges.z) >= 0) row |= 1u << uint(x);
      edges += toRight;
    }
    if (y < 4)
      mask.x |= row << uint(y * 8);
    else
      mask.y |= row << uint(y * 8 - 32);
  }
  return mask;
}

/// All of a triangle but its bounds.
GPGP_FN ScreenTriangle triangleOf(Candidate c) {
  ScreenTriangle t;
  t.bounds = ivec4(0, 0, 0, 0);
  t.p0 = nearestUnit(c.p0);
  t.p1 = nearestUnit(c.p1);
  t.p2 = nearestUnit(c.p2);
  t.z0 = c.z0;
  t.dz1 = c.dz1;
  t.dz2 = c.dz2;
  t.zMin = c.zMin;
  t.zMax = c.zMax;
  GPGP_PRECISE float inverseArea = c.inverseArea * float(kFine * kFine);
  t.inverseArea = inverseArea;
  return t;
}

GPGP_FN float withinDepths(ScreenTriangle t, float z) {
  float held = clamp(z, t.zMin, t.zMax);
  return held < 1.17549435e-38f ? 0.0f : held;
}

/// How the depth of a triangle's plane changes by unit.
GPGP_FN vec2 depthSlope(ScreenTriangle t) {
  ivec2 s1 = edgeSlope(t.p2, t.p0);
  ivec2 s2 = edgeSlope(t.p0, t.p1);
  GPGP_PRECISE float alongX = (float(s1.x) * t.dz1 + float(s2.x) * t.dz2) * t.inverseArea;
  GPGP_PRECISE float alongY = (float(s1.y) * t.dz1 + float(s2.y) * t.dz2) * t.inverseArea;
  return vec2(alongX, alongY);
}

/// The depth of a candidate's plane at a point within a pixel of its box, and what rounding may add to it: slivers'
/// planes are steep.
GPGP_FN vec2 planeDepth(Candidate c, ivec2 point) {
  ivec2 fine = point * kFine;
  float weight1 = widerToFloat(edgeWide(c.p2, edgeSlope(c.p2, c.p0), fine));
  float weight2 = widerToFloat(edgeWide(c.p0, edgeSlope(c.p0, c.p1), fine));
  GPGP_PRECISE float z = c.z0 + (weight1 * c.dz1 + weight2 * c.dz2) * c.inverseArea;
  GPGP_PRECISE float rounding = (abs(weight1 * c.dz1) + abs(weight2 * c.dz2)) * c.inverseArea * 4.8e-7f;
  return vec2(z, rounding);
}

/// How the depth of its plane changes by unit.
GPGP_FN vec2 planeSlope(Candidate c) {
  ivec2 s1 = edgeSlope(c.p2, c.p0);
  ivec2 s2 = edgeSlope(c.p0, c.p1);
  GPGP_PRECISE float inverse = c.inverseArea * 32.0f;
  GPGP_PRECISE float alongX = (float(s1.x) * c.dz1 + float(s2.x) * c.dz2) * inverse;
  GPGP_PRECISE float alongY = (float(s1.y) * c.dz1 + float(s2.y) * c.dz2) * inverse;
  return vec2(alongX, alongY);
}

/// The part of a triangle's box that lies in a pixel, and its plane there.
struct Footing {
  ivec2 low; ///< first and last unit
  ivec2 high;
  ivec2 middle;
  float depth; ///< in the middle
  vec2 slope;  ///< how it changes by unit
  float reach; ///< how far from it the depths in the box lie at most
};

GPGP_FN Footing footingOf(Candidate c, ivec2 pixel) {
  ScreenTriangle t = triangleOf(c);
  Footing f;
  f.low = max(min(t.p0, min(t.p1, t.p2)), pixel * 256);
  f.high = min(max(t.p0, max(t.p1, t.p2)), pixel * 256 + 255);
  f.middle = ivec2((f.low.x + f.high.x) >> 1, (f.low.y + f.high.y) >> 1);
  vec2 depth = planeDepth(c, f.middle);
  f.depth = depth.x;
  f.slope = planeSlope(c);
  GPGP_PRECISE float reach =
      (abs(f.slope.x) * float(f.high.x - f.low.x + 1) + abs(f.slope.y) * float(f.high.y - f.low.y + 1)) * 0.5f +
      depth.y;
  f.reach = reach;
  return f;
}

/// The nearest and the farthest that the part of a triangle's box that lies in a pixel comes, as keys.
GPGP_FN uint nearestKey(ScreenTriangle t, Footing f, bool reversed) {
  GPGP_PRECISE float nearest = reversed ? f.depth + f.reach : f.depth - f.reach;
  return depthKey(withinDepths(t, nearest), reversed);
}
GPGP_FN uint farthestKey(ScreenTriangle t, Footing f, bool reversed) {
  GPGP_PRECISE float farthest = reversed ? f.depth - f.reach : f.depth + f.reach;
  return depthKey(withinDepths(t, farthest), reversed);
}
GPGP_FN uint nearestKey(Candidate c, ivec2 pixel, bool reversed) {
  return nearestKey(triangleOf(c), footingOf(c, pixel), reversed);
}

/// By how much an edge function, in pixels, falls at most from a pixel's centre to its border.
GPGP_FN int fallWithin(ivec2 slope) { return (abs(slope.x) + abs(slope.y) + 1) >> 1; }

/// Whether an edge has all points of a pixel inside.
GPGP_FN bool fillsEdge(ivec2 u, ivec2 slope, ivec2 pixel, Grid grid) {
  return edgeBlock(u, slope, pixel, grid, 0) >= fallWithin(slope);
}

/// Whether a triangle owns all points of a pixel; one sample a pixel, at its centre.
GPGP_FN bool fillsPixel(ScreenTriangle t, ivec2 pixel, Grid grid) {
  return fillsEdge(t.p1, edgeSlope(t.p1, t.p2), pixel, grid) && fillsEdge(t.p2, edgeSlope(t.p2, t.p0), pixel, grid) &&
         fillsEdge(t.p0, edgeSlope(t.p0, t.p1), pixel, grid);
}

/// The same for compact triangles and pixels in their bounds.
GPGP_FN bool fillsEdgeCompact(ivec2 u, ivec2 slope, ivec2 centre) {
  return (edgeCompact(u, slope, centre) - edgeBias(slope)) >> 8 >= fallWithin(slope);
}
GPGP_FN bool fillsPixelCompact(ScreenTriangle t, ivec2 centre) {
  return fillsEdgeCompact(t.p1, edgeSlope(t.p1, t.p2), centre) &&
         fillsEdgeCompact(t.p2, edgeSlope(t.p2, t.p0), centre) && fillsEdgeCompact(t.p0, edgeSlope(t.p0, t.p1), centre);
}

/// Whether a triangle is large enough to: around a square there is none of less than twice its area.
GPGP_FN bool mayFillPixel(ScreenTriangle t) { return t.inverseArea < 3.85e-6f; } // a little more than 1 / (4 * 256^2)

/// The key of what a triangle that fills a pixel hides for certain, from its depth at the centre.
GPGP_FN uint fillKey(ScreenTriangle t, float z, bool reversed) {
  vec2 slope = depthSlope(t);
  GPGP_PRECISE float reach = (abs(slope.x) + abs(slope.y)) * 128.0f + (abs(t.dz1) + abs(t.dz2)) * 4.8e-7f;
  GPGP_PRECISE float farthest = reversed ? z - reach : z + reach;
  return depthKey(withinDepths(t, farthest), reversed);
}

/// x per y along an edge; 0 for horizontal ones.
GPGP_FN float edgeLean(ivec2 u, ivec2 v) { return u.y == v.y ? 0.0f : divide(float(v.x - u.x), float(v.y - u.y)); }

/// fine: its corners, in order, in parts of kFine to a unit.
GPGP_FN Candidate makeCandidate(ScreenTriangle t, Corners fine, uint id) {
  Candidate c;
  c.p0 = fine.p0;
  c.p1 = fine.p1;
  c.p2 = fine.p2;
  c.z0 = t.z0;
  c.dz1 = t.dz1;
  c.dz2 = t.dz2;
  c.zMin = t.zMin;
  c.zMax = t.zMax;
  c.inverseArea = reciprocal(widerToFloat(twiceArea(c.p0, c.p1, c.p2)));
  c.slope0 = edgeLean(c.p1, c.p2);
  c.slope1 = edgeLean(c.p2, c.p0);
  c.slope2 = edgeLean(c.p0, c.p1);
  c.id = id;
  return c;
}

GPGP_FN bool touches(ScreenTriangle t, bool compact, ivec2 pixel) {
  if (compact) return touchesCompact(t, pixel);
  return touchesWide(t, pixel);
}

GPGP_FN int lowestBit(uvec2 m) { return m.x != 0u ? findLSB(m.x) : 32 + findLSB(m.y); }

/// `count` bits from `first` on, together at most 32.
GPGP_FN uint bitsFrom(int first, int count) {
#ifdef __cplusplus
  return count == 0 ? 0u : (0xffffffffu >> (32 - count)) << first;
#else
  return bitfieldInsert(0u, 0xffffffffu, first, count);
#endif
}

/// Bits `first` to `end` - 1 of 64; both 0 to 64.
GPGP_FN uvec2 bitRange(int first, int end) {
  int first0 = min(first, 32);
  int first1 = max(first, 32) - 32;
  return uvec2(bitsFrom(first0, max(min(end, 32) - first0, 0)), bitsFrom(first1, max(max(end, 32) - 32 - first1, 0)));
}

/// A candidate within a pixel. Each edge is a line, at x + r * y of the pixel's width in row r of 64. It covers the
/// samples from the greater of its left edges to before the lesser of its right ones, both rounded to columns; the
/// third edge is one of them. A sample that an edge meets lies right of it. The lines lie marginOf() outside the edges.
/// In rows above and below the triangle they have crossed, so that nothing is covered; a horizontal edge is a third
/// line that leaves nothing of the rows outside.
struct Outline {
  vec2 left;
  vec2 right;
  vec2 third;
  bool isThirdLeft;
  int rowBegin; ///< rows that it lies in: from this one
  int rowEnd;   ///< to before this one
};

GPGP_CONST float kNoEdge = -1e30f;
GPGP_CONST float kColumn = 0.015625f; ///< in widths; a power of two, so that what is multiplied by it stays exact

/// 18 of a step's 24 bits, so that its product with a row of 64 is exact: added to something, it is rounded once.
GPGP_FN float stepOf(float v) { return uintBitsToFloat(floatBitsToUint(v) & ~63u); }

/// Adds an edge. Its line is computed from its upper corner, so that both triangles at an edge have the same one but
/// for their margins, in quarters of a unit, and leave no sample out.
GPGP_FN void addEdge(GPGP_INOUT(Outline) o, ivec2 u, ivec2 v, float slope, ivec2 first, float margin) {
  if (u.y == v.y) { // those above it are outside, or those below it
    o.isThirdLeft = u.x < v.x;
    GPGP_PRECISE float row = float(u.y - (first.y + 2) * kFine) + (o.isThirdLeft ? -margin : margin) * 32.0f;
    o.third = vec2(row, -128.0f);
    return;
  }
  ivec2 corner = u.y < v.y ? u : v;
  ivec2 unit = nearestUnit(corner);
  ivec2 top = unit - first;
  ivec2 rest = corner - unit * kFine;
  bool isLeft = u.y > v.y; // upwards: bounds from the left, as the triangle is clockwise as seen
  GPGP_PRECISE float beyond = (isLeft ? -margin : margin) * 0.25f * (1.0f + abs(slope)); // in columns
  GPGP_PRECISE float within = (float(rest.x) - float(rest.y) * slope) * 0.0078125f;
  GPGP_PRECISE float start = (float(top.x - 2) + float(2 - top.y) * slope) * 0.25f + 0.498046875f + within + beyond;
  vec2 before = isLeft ? o.left : o.right;
  if (before.x != kNoEdge) {
    o.third = before;
    o.isThirdLeft = isLeft;
  }
  vec2 line = vec2(start * kColumn, stepOf(slope * kColumn));
  if (isLeft)
    o.left = line;
  else
    o.right = line;
}

/// What a candidate owns beyond its edges, in units, so that nothing shows through T-junctions. Clipped pieces, whose
/// corners are whole units, as elsewhere. Others are as fine as their coordinates: of those, with the rounding of clip
/// coordinates in a viewport of `extent` pixels, a sixteenth of a unit up to 2048 pixels; of small ones half as much.
GPGP_FN float outlineMargin(Candidate c, float extent) {
  ivec2 all_ = c.p0 | c.p1 | c.p2;
  if (((all_.x | all_.y) & (kFine - 1)) == 0) return float(marginOf(triangleOf(c), kMargin)) * 0.25f;
  int around = spanOf(edgeSlope(c.p1, c.p2)) + spanOf(edgeSlope(c.p2, c.p0)) + spanOf(edgeSlope(c.p0, c.p1));
  GPGP_PRECISE float inverseRadius = float(around) * c.inverseArea * float(kFine); // of what the grid may have turned
  GPGP_PRECISE float most = max(extent * 3.0517578125e-5f, 0.0625f);
  GPGP_PRECISE float half_ = most * 0.5f;
  return inverseRadius <= 0.125f ? most : inverseRadius <= 1.0f ? half_ : 0.0f;
}

/// extent: of the viewport, the greater of width and height in pixels.
GPGP_FN Outline outlineOf(Candidate c, ivec2 pixel, float extent) {
  Outline o;
  ivec2 first = pixel * 256;
  o.left = vec2(kNoEdge, 0.0f); // each triangle has both
  o.right = vec2(kNoEdge, 0.0f);
  o.third = vec2(kNoEdge, 0.0f);
  o.isThirdLeft = true;
  float margin = outlineMargin(c, extent);
  addEdge(o, c.p1, c.p2, c.slope0, first, margin);
  addEdge(o, c.p2, c.p0, c.slope1, first, margin);
  addEdge(o, c.p0, c.p1, c.slope2, first, margin);
  ScreenTriangle t = triangleOf(c);
  o.rowBegin = clamp((min(t.p0.y, min(t.p1.y, t.p2.y)) - first.y + 1) >> 2, 0, 64);
  o.rowEnd = clamp((max(t.p0.y, max(t.p1.y, t.p2.y)) - first.y + 1) >> 2, 0, 64);
  return o;
}

/// From where to where an outline reaches in a row that its edges cross there, in widths: x to before y, once rounded.
/// Clamping to 0 to 1 costs nothing where a sum is made.
GPGP_FN vec2 columnsBetween(Outline o, float left, float right, float third) {
  vec2 columns = vec2(clamp(left, 0.0f, 1.0f), clamp(right, 0.0f, 1.0f));
  float held = clamp(third, 0.0f, 1.0f);
  if (o.isThirdLeft)
    columns.x = max(columns.x, held);
  else
    columns.y = min(columns.y, held);
  return columns;
}

/// The same in one of the 64 rows.
GPGP_FN vec2 columnsOf(Outline o, float row) {
  GPGP_PRECISE float left = fma(row, o.left.y, o.left.x);
  GPGP_PRECISE float right = fma(row, o.right.y, o.right.x);
  GPGP_PRECISE float third = fma(row, o.third.y, o.third.x);
  return columnsBetween(o, left, right, third);
}

/// The column nearest to 0 to 1: a large number leaves its sum with v no bits below. Conversions are slow.
GPGP_FN int roundedColumn(float v) {
  GPGP_PRECISE float sum = v + 131072.0f;
  return int(floatBitsToUint(sum) - 0x48000000u);
}

/// Which columns of a row an outline covers: from x to before y.
GPGP_FN ivec2 spanIn(Outline o, int row) {
  vec2 columns = columnsOf(o, float(row));
  return ivec2(roundedColumn(columns.x), roundedColumn(columns.y));
}
GPGP_FN uvec2 samplesIn(Outline o, int row) {
  ivec2 span = spanIn(o, row);
  return bitRange(span.x, span.y);
}

/// The same, with all samples that are at most so many columns and rows away, corners cut off.
GPGP_FN uvec2 samplesAround(Outline o, int reach, int row) {
  if (row < o.rowBegin - reach || row >= o.rowEnd + reach) return uvec2(0u, 0u);
  Outline wide = o;
  float by = float(reach);
  GPGP_PRECISE float left = o.left.x - by * (abs(o.left.y) + kColumn);
  GPGP_PRECISE float right = o.right.x + by * (abs(o.right.y) + kColumn);
  GPGP_PRECISE float third = o.third.x + (o.isThirdLeft ? -by : by) * (abs(o.third.y) + kColumn);
  wide.left.x = left;
  wide.right.x = right;
  wide.third.x = third;
  vec2 columns = columnsOf(wide, float(row));
  return bitRange(roundedColumn(columns.x), roundedColumn(columns.y));
}

/// The depth of a candidate in a pixel, as a key: in the middle of the row that halves its box there.
GPGP_FN uint middleKey(Candidate c, Outline outline, Footing f, ivec2 pixel, bool reversed) {
  ivec2 first = pixel * 256;
  GPGP_PRECISE float row = float(f.middle.y - first.y - 2) * 0.25f;
  GPGP_PRECISE float left = outline.left.x + row * outline.left.y;
  GPGP_PRECISE float right = outline.right.x + row * outline.right.y;
  GPGP_PRECISE float third = outline.third.x + row * outline.third.y;
  vec2 columns = columnsBetween(outline, left, right, third);
  int column = f.middle.x;
  if (columns.x < columns.y) {
    GPGP_PRECISE float x = (columns.x + columns.y) * 128.0f;
    column = first.x + int(floor(x));
  }
  GPGP_PRECISE float z = f.depth + f.slope.x * float(column - f.middle.x);
  return depthKey(withinDepths(triangleOf(c), z), reversed);
}

GPGP_SHADER_END
#endif
