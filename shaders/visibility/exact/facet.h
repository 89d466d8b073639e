// Which of two triangles is nearer at each sample of a pixel. A list's order by one depth each says it for most pairs;
// where surfaces cut each other, coincide, or turn away within the pixel, their planes have to.
//
// Guarantees: one result on every device. Of two triangles in exactly the same plane the lower number is nearer.
#ifndef GPGP_SHADERS_VISIBILITY_FACET_H
#define GPGP_SHADERS_VISIBILITY_FACET_H
#include "visibility/shared/candidate.h"

GPGP_SHADER_BEGIN

/// The part of a candidate's plane that lies in its box in a pixel. Depths grow with distance, also where the
/// recording's are reversed.
struct Facet {
  vec3 plane;    ///< depth at the pixel's first sample, and how it changes from column to column and row to row
  float nearest; ///< of the triangle within the box, at least
  float farthest;
  ivec4 box; ///< first and last unit within the pixel: x, y, z, w; 0 to 255
};

GPGP_FN Facet facetOf(Candidate c, Footing box, ivec2 pixel, bool reversed) {
  ivec2 first = pixel * 256;
  GPGP_PRECISE float least = max(box.depth - box.reach, c.zMin);
  GPGP_PRECISE float most = min(box.depth + box.reach, c.zMax);
  GPGP_PRECISE float atFirst =
      box.depth + box.slope.x * float(first.x + 2 - box.middle.x) + box.slope.y * float(first.y + 2 - box.middle.y);
  float side = reversed ? -1.0f : 1.0f;
  Facet f;
  f.plane = vec3(atFirst * side, box.slope.x * 4.0f * side, box.slope.y * 4.0f * side);
  f.nearest = reversed ? -most : least;
  f.farthest = reversed ? -least : most;
  f.box = ivec4(box.low - first, box.high - first);
  return f;
}

/// Whether a facet's box has one of the given columns and one of the given rows of samples; each as 64 bits.
GPGP_FN bool reaches(Facet f, uvec2 columns, uvec2 rows) {
  uvec2 ownColumns = bitRange(f.box.x >> 2, (f.box.z >> 2) + 1) & columns;
  uvec2 ownRows = bitRange(f.box.y >> 2, (f.box.w >> 2) + 1) & rows;
  return (ownColumns.x | ownColumns.y) != 0u && (ownRows.x | ownRows.y) != 0u;
}

/// A number whose order is a float's.
GPGP_FN uint orderOf(float v) {
  uint bits = floatBitsToUint(v);
  return (bits >> 31u) != 0u ? ~bits : bits | 0x80000000u;
}

/// By how much the plane of `a` is nearer than that of `b` at most, in the box that both are in; below 0: nowhere.
GPGP_FN float leadWithin(Facet a, Facet b) {
  ivec2 low = max(ivec2(a.box.x, a.box.y), ivec2(b.box.x, b.box.y));
  ivec2 high = min(ivec2(a.box.z, a.box.w), ivec2(b.box.z, b.box.w));
  if (low.x > high.x || low.y > high.y) return -1.0f;
  GPGP_PRECISE vec3 behind = b.plane - a.plane;
  GPGP_PRECISE float column = (float(low.x + high.x) * 0.5f - 2.0f) * 0.25f;
  GPGP_PRECISE float row = (float(low.y + high.y) * 0.5f - 2.0f) * 0.25f;
  GPGP_PRECISE float atMiddle = behind.x + behind.y * column + behind.z * row;
  GPGP_PRECISE float most = atMiddle + abs(behind.y) * float(high.x - low.x + 1) * 0.125f +
                            abs(behind.z) * float(high.y - low.y + 1) * 0.125f;
  return most;
}

/// Whether `a` is nearer than `b` anywhere in that box.
GPGP_FN bool isNearerSomewhere(Facet a, Facet b) { return a.nearest < b.farthest && leadWithin(a, b) > 0.0f; }

GPGP_FN Corners cornersOf(Candidate c) {
  Corners r;
  r.p0 = nearestUnit(c.p0);
  r.p1 = nearestUnit(c.p1);
  r.p2 = nearestUnit(c.p2);
  return r;
}

/// Whether all of a compact triangle lies outside the edge from u to v of another one, and both touch one pixel.
GPGP_FN bool liesOutside(Corners c, ivec2 u, ivec2 v) {
  ivec2 slope = edgeSlope(u, v);
  return edgeCompact(u, slope, c.p0) <= 0 && edgeCompact(u, slope, c.p1) <= 0 && edgeCompact(u, slope, c.p2) <= 0;
}

/// Whether two compact triangles that touch one pixel have area in common on the screen: no edge has all of the other
/// outside. Larger ones are not asked: what that takes is more than what it saves.
GPGP_FN bool overlap(Corners a, Corners b) {
  return !(liesOutside(b, a.p0, a.p1) || liesOutside(b, a.p1, a.p2) || liesOutside(b, a.p2, a.p0) ||
           liesOutside(a, b.p0, b.p1) || liesOutside(a, b.p1, b.p2) || liesOutside(a, b.p2, b.p0));
}

/// Where one facet is nearer than another: in row r, left (side -1) or right (side 1) of start + r * step, in widths of
/// the pixel; side 0: in rows in which that is below 0.
struct Crossing {
  float start;
  float step;
  int side;
};

/// Where `a` is nearer than `b`; `wins`: also where they are equally far.
GPGP_FN Crossing crossingOf(Facet a, Facet b, bool wins) {
  GPGP_PRECISE vec3 ahead = a.plane - b.plane;
  Crossing c;
  if (isDivisor(abs(ahead.y))) {
    GPGP_PRECISE float inverse = reciprocal(abs(ahead.y)) * (ahead.y > 0.0f ? -1.0f : 1.0f);
    GPGP_PRECISE float start = ahead.x * inverse + 0.498046875f; // samples on the line lie right of it, as in addEdge
    GPGP_PRECISE float step = ahead.z * inverse;
    c.start = start * kColumn;
    c.step = stepOf(step * kColumn);
    c.side = ahead.y > 0.0f ? -1 : 1;
  } else {
    c.start = ahead.x == 0.0f && ahead.z == 0.0f && wins ? -1.0f : ahead.x;
    c.step = stepOf(ahead.z);
    c.side = 0;
  }
  return c;
}

/// Which columns of a row an outline covers on a crossing's side.
GPGP_FN ivec2 spanAhead(Outline o, Crossing c, int row) {
  vec2 columns = columnsOf(o, float(row));
  GPGP_PRECISE float at = fma(float(row), c.step, c.start);
  bool any = c.side != 0 || at < 0.0f;
  float held = clamp(at, 0.0f, 1.0f);
  if (c.side < 0) columns.y = min(columns.y, held);
  if (c.side > 0) columns.x = max(columns.x, held);
  return ivec2(roundedColumn(columns.x), any ? roundedColumn(columns.y) : 0);
}
GPGP_FN uvec2 samplesAhead(Outline o, Crossing c, int row) {
  ivec2 span = spanAhead(o, c, row);
  return bitRange(span.x, span.y);
}

GPGP_SHADER_END
#endif
