// Drawings and glyphs as CPatches, at a point: which part of a pixel a path covers, whether a sample lies inside it,
// and its paint. GLSL and HLSL for the engine's own materials; the library's in-pass draw and its tests compile the
// same text.
//
// Before this file is included, define
//
//   GPGP_PATCH_LOAD(slot, index)   uvec4 number `index` of the buffer that `slot` names
//
// and for HLSL also GPGP_HLSL. GLSL:
//
//   layout(std430, set = 0, binding = 0) readonly buffer Patches { uvec4 patches[]; };
//   #define GPGP_PATCH_LOAD(slot, index) patches[index]
//   #include "gpgp/shaders/patches.h"
//
// and in a fragment shader, where `at` is the point of the drawing that the fragment shows:
//
//   vec4 color = gpgpPaintDrawing(0u, 0u, at, dFdx(at), dFdy(at));   // premultiplied, linear
//
// What a CPatch is: the points in the rows from `top` to `bottom` (half open) that lie right of each of its left curves
// and left of each of its right curves. A curve counts in its own rows alone, runs down, and never turns in x or y. Its
// implicit form is positive on one side of it and negative on the other:
//
//   line     cross(end, q)
//   conic    b^2 - 4 w^2 a c, where (a, b, c) are the areas of the triangle of start, control and end (Salmon); w = 1
//            is a quadratic Bezier curve, others are arcs of circles and ellipses, exactly
//   cubic    k^3 - l m, with k, l and m linear in x and y by the type of the curve: serpentine, cusp or loop (Loop and
//            Blinn 2005); multiplied out around the curve's start
//
// Outside of the triangle between a curve and its tangents, chord and tangents decide: there the form follows the
// curve's continuation. Patches of a path are disjoint, and where two meet, one entry of the curve table decides.
//
// Points are given as two terms, `origin` and `at`, whose sum is meant. Terms that cancel leave no error behind, so a
// drawing stays exact when it is magnified: take for `origin` a point near to what is seen. 0 is always allowed.
#ifndef GPGP_SHADERS_PATCHES_H
#define GPGP_SHADERS_PATCHES_H
#ifndef __cplusplus // C++ includes this inside a class that has load() (src/vector/patch/patch_reader.h)
#include "gpgp/shaders/ramp.h"
#endif
#ifndef GPGP_PATCH_CONST
#define GPGP_PATCH_CONST GPGP_CONST
#endif
#ifndef GPGP_PATCH_COUNT
#define GPGP_PATCH_COUNT(what) // tests count the work by it
#endif

GPGP_PATCH_CONST uint kPatchHeader = 2u; // uvec4: paths, version, left out, size; quads' place and number, least spread
GPGP_PATCH_CONST uint kPatchPathSize = 6u;   // uvec4
GPGP_PATCH_CONST uint kPatchForeground = 1u; // flag: the path takes the text's colour
GPGP_PATCH_CONST uint kPatchCurveKind = 30u; // bits of a curve's number: its place, and from here on its kind
GPGP_PATCH_CONST uint kPatchCurvePlace = (1u << 30u) - 1u;
GPGP_PATCH_CONST uint kPatchLine = 0u;
GPGP_PATCH_CONST uint kPatchConic = 1u;
GPGP_PATCH_CONST uint kPatchCubic = 2u;
GPGP_PATCH_CONST uint kPatchSolid = 0xffffffffu; // count of a cell that is inside as a whole
GPGP_PATCH_CONST uint kPatchFewCells = 5u;       // along an axis: pixels that meet more are summed from a table

// A path of a drawing, as it lies in the buffer. Places count from the beginning of the drawing.
struct GpgpPatchPath {
  vec4 color; // straight, linear
  vec4 box;   // left, top, right, bottom
  vec4 cell;  // width and height of a cell; and their inverses
  uint paint; // place of its PaintRecord; 0: none
  uint flags;
  uint columns, rows;                // of cells
  uint cells, patches, curves, sums; // sums: 0 where there are few cells
  float smallest;                    // pixels along a cell's sides, from which on cells are drawn; 0: never
};

// A curve of the table: start, from the origin; end and controls, from the start; weight of a conic.
struct GpgpPatchCurve {
  vec2 start, end, control, control2;
  float bottom; // the end's y, from the origin: what the next curve has as its start
  float weight;
};

#define GPGP_PATCH_FLOAT(slot, index) gpgpBits(GPGP_PATCH_LOAD(slot, index))
GPGP_FN vec4 gpgpBits(uvec4 v) {
  return vec4(uintBitsToFloat(v.x), uintBitsToFloat(v.y), uintBitsToFloat(v.z), uintBitsToFloat(v.w));
}

GPGP_FN uint gpgpPatchPaths(uint slot, uint drawing) { return GPGP_PATCH_LOAD(slot, drawing).x; }

GPGP_FN GpgpPatchPath gpgpLoadPath(uint slot, uint drawing, uint index) {
  const uint first = drawing + kPatchHeader + index * kPatchPathSize;
  const uvec4 kind = GPGP_PATCH_LOAD(slot, first + 3u), place = GPGP_PATCH_LOAD(slot, first + 4u);
  GpgpPatchPath path;
  path.color = GPGP_PATCH_FLOAT(slot, first);
  path.box = GPGP_PATCH_FLOAT(slot, first + 1u);
  path.cell = GPGP_PATCH_FLOAT(slot, first + 2u);
  path.paint = kind.x;
  path.flags = kind.y;
  path.columns = kind.z;
  path.rows = kind.w;
  path.cells = drawing + place.x;
  path.patches = drawing + place.y;
  path.curves = drawing + place.z;
  path.sums = place.w == 0u ? 0u : drawing + place.w;
  path.smallest = GPGP_PATCH_FLOAT(slot, first + 5u).x;
  return path;
}

// A curve's ends, which suffice to tell whether it comes near; a line has nothing else.
GPGP_FN GpgpPatchCurve gpgpLoadEnds(uint slot, uint curves, uint number, vec2 origin) {
  const vec4 ends = GPGP_PATCH_FLOAT(slot, curves + (number & kPatchCurvePlace));
  GpgpPatchCurve c;
  c.start = vec2(ends.x - origin.x, ends.y - origin.y);
  c.end = vec2(ends.z - ends.x, ends.w - ends.y);
  c.bottom = ends.w - origin.y;
  c.control = c.end;
  c.control2 = c.end;
  c.weight = 0.0f;
  return c;
}
GPGP_FN GpgpPatchCurve gpgpLoadControls(uint slot, uint curves, uint number, GpgpPatchCurve ends) {
  GpgpPatchCurve c = ends;
  const vec4 controls = GPGP_PATCH_FLOAT(slot, curves + (number & kPatchCurvePlace) + 1u);
  c.control = vec2(controls.x, controls.y);
  c.control2 = vec2(controls.z, controls.w);
  c.weight = controls.z; // of a conic
  return c;
}
GPGP_FN GpgpPatchCurve gpgpLoadCurve(uint slot, uint curves, uint number, vec2 origin) {
  const GpgpPatchCurve ends = gpgpLoadEnds(slot, curves, number, origin);
  if ((number >> kPatchCurveKind) == kPatchLine) return ends;
  return gpgpLoadControls(slot, curves, number, ends);
}

// The column and the row of cells in which a point lies, counted from the origin: the first or last one where the point
// lies beside the box. A point has one cell, whoever asks.
GPGP_FN uint gpgpColumnAt(GpgpPatchPath path, vec2 origin, float x) {
  GPGP_PRECISE float column = ((origin.x - path.box.x) + x) * path.cell.z;
  return uint(clamp(column, 0.0f, float(path.columns - 1u)));
}
GPGP_FN uint gpgpRowAt(GpgpPatchPath path, vec2 origin, float y) {
  GPGP_PRECISE float row = ((origin.y - path.box.y) + y) * path.cell.w;
  return uint(clamp(row, 0.0f, float(path.rows - 1u)));
}
// A cell's first patch, from path.patches on, and how many it has; kPatchSolid: it is inside as a whole.
GPGP_FN uint gpgpCellCount(uint slot, GpgpPatchPath path, uint column, uint row, GPGP_OUT(uint) first) {
  const uint cell = row * path.columns + column;
  const uvec4 pair = GPGP_PATCH_LOAD(slot, path.cells + cell / 2u);
  first = path.patches + ((cell & 1u) != 0u ? pair.z : pair.x);
  return (cell & 1u) != 0u ? pair.w : pair.y;
}
// The number of a patch's curve k.
GPGP_FN uint gpgpCurveOf(uint slot, uint place, uint k) {
  const uvec4 four = GPGP_PATCH_LOAD(slot, place + 1u + k / 4u);
  return (k & 2u) == 0u ? ((k & 1u) == 0u ? four.x : four.y) : ((k & 1u) == 0u ? four.z : four.w);
}

// ---------------------------------------------------------------- samples

GPGP_FN float gpgpCross(vec2 a, vec2 b) {
  GPGP_PRECISE float product = a.x * b.y - a.y * b.x;
  return product;
}

// Whether a point, given from the curve's start, lies right of the curve or on it; its height is one of the curve's.
GPGP_FN bool gpgpRightOf(uint slot, uint curves, uint number, GpgpPatchCurve c, vec2 q) {
  const uint kind = number >> kPatchCurveKind;
  const float side = gpgpCross(q, c.end);
  if (kind == kPatchLine) return side >= 0.0f;
  const vec2 last = kind == kPatchConic ? c.control : c.control2;
  // Areas by which the point is away from the tangents and from the chord, positive on the curve's side of each.
  const float bulge = gpgpCross(vec2(c.control.x + last.x, c.control.y + last.y), c.end) < 0.0f ? -1.0f : 1.0f;
  const float chord = bulge * side;
  const float first = bulge * gpgpCross(c.control, q);
  const float second = bulge * gpgpCross(vec2(last.x - q.x, last.y - q.y), vec2(c.end.x - q.x, c.end.y - q.y));
  bool beyond = false; // the curve, as seen from the chord
  if (first < 0.0f || second < 0.0f) {
    beyond = true;
  } else if (kind == kPatchConic) {
    GPGP_PRECISE float form = chord * chord - 4.0f * c.weight * c.weight * (first * second);
    beyond = form >= 0.0f;
  } else {
    const uint place = curves + (number & kPatchCurvePlace);
    const vec4 f = GPGP_PATCH_FLOAT(slot, place + 2u), g = GPGP_PATCH_FLOAT(slot, place + 3u);
    GPGP_PRECISE float cube = g.y * q.x + g.z * q.y;
    GPGP_PRECISE float form =
        (f.x * q.x + f.y * q.y) + ((f.z * q.x + f.w * q.y) * q.x + g.x * q.y * q.y) + cube * cube * cube;
    beyond = form >= 0.0f;
  }
  if (bulge > 0.0f) return chord >= 0.0f && beyond;
  return chord <= 0.0f || !beyond;
}

// In how many patches of a cell a point lies: 0 or 1.
GPGP_FN uint gpgpPatchesAt(uint slot, GpgpPatchPath path, vec2 origin, vec2 at) {
  const float x = at.x + origin.x, y = at.y + origin.y;
  if (x < path.box.x || x > path.box.z || y < path.box.y || y > path.box.w) return 0u;
  uint place = 0u;
  const uint count = gpgpCellCount(slot, path, gpgpColumnAt(path, origin, at.x), gpgpRowAt(path, origin, at.y), place);
  if (count == kPatchSolid) return 1u;
  uint found = 0u;
  for (uint i = 0u; i < count; ++i) {
    const uvec4 head = GPGP_PATCH_LOAD(slot, place);
    const uint curveCount = head.z, lefts = head.w;
    bool inside = at.y >= uintBitsToFloat(head.x) - origin.y && at.y < uintBitsToFloat(head.y) - origin.y;
    for (uint k = 0u; k < curveCount && inside; ++k) {
      const uint number = gpgpCurveOf(slot, place, k);
      const GpgpPatchCurve c = gpgpLoadCurve(slot, path.curves, number, origin);
      const vec2 q = vec2(at.x - c.start.x, at.y - c.start.y);
      if (at.y >= c.start.y && at.y < c.bottom) inside = gpgpRightOf(slot, path.curves, number, c, q) == (k < lefts);
    }
    found += inside ? 1u : 0u;
    place += 1u + (curveCount + 3u) / 4u;
  }
  return found;
}

// ---------------------------------------------------------------- areas

// Where a conic or cubic reaches a value along an axis on which it grows from 0 to `end`; b, c: its controls there.
GPGP_FN float gpgpConicAt(float b, float end, float weight, float value) {
  const float v = clamp(value, 0.0f, end);
  const float p = weight * (b - v), root = sqrt(max(p * p + v * (end - v), 0.0f));
  const float above = p >= 0.0f ? v : root - p, below = p >= 0.0f ? p + root : end - v;
  return above + below > 0.0f ? above / (above + below) : 0.0f;
}
// near_: how far from the value is near enough.
GPGP_FN float gpgpCubicAt(float b, float c, float end, float value, float near_) {
  const float v = clamp(value, 0.0f, end);
  float t = gpgpConicAt(clamp(0.75f * (b + c) - 0.25f * end, 0.0f, end), end, 1.0f, v);
  float low = 0.0f, high = 1.0f;
  for (uint i = 0u; i < 5u; ++i) { // Newton's steps, kept between what is known to be below and above
    const float u = 1.0f - t;
    const float f = ((3.0f * u * u * b + 3.0f * u * t * c) + t * t * end) * t - v;
    if (abs(f) <= near_) break;
    const float slope = 3.0f * (u * u * b + 2.0f * u * t * (c - b) + t * t * (end - c));
    if (f < 0.0f)
      low = t;
    else
      high = t;
    const float next = slope > 0.0f ? t - f / slope : -1.0f;
    t = next >= low && next <= high ? next : 0.5f * (low + high);
    GPGP_PATCH_COUNT(newton)
  }
  return t;
}
// Where the curve is at a parameter, from its start.
GPGP_FN vec2 gpgpCurvePoint(bool conic, GpgpPatchCurve c, float t) {
  const float u = 1.0f - t;
  if (conic) {
    const float b = 2.0f * c.weight * u * t, e = t * t, sum = u * u + b + e;
    return vec2((b * c.control.x + e * c.end.x) / sum, (b * c.control.y + e * c.end.y) / sum);
  }
  const float b = 3.0f * u * u * t, d = 3.0f * u * t * t, e = t * t * t;
  return vec2(b * c.control.x + d * c.control2.x + e * c.end.x, b * c.control.y + d * c.control2.y + e * c.end.y);
}
GPGP_FN float gpgpCurveAtY(bool conic, GpgpPatchCurve c, float y, float near_) {
  return conic ? gpgpConicAt(c.control.y, c.end.y, c.weight, y)
               : gpgpCubicAt(c.control.y, c.control2.y, c.end.y, y, near_);
}
GPGP_FN float gpgpCurveAtX(bool conic, GpgpPatchCurve c, float x, float near_) {
  const float s = c.end.x < 0.0f ? -1.0f : 1.0f;
  return conic ? gpgpConicAt(s * c.control.x, s * c.end.x, c.weight, s * x)
               : gpgpCubicAt(s * c.control.x, s * c.control2.x, s * c.end.x, s * x, near_);
}

// On which side of a curve a box lies: 0: both, 1: all of it right, 2: all of it left. The box lies within the curve's
// rows; low, high: its corners, from the curve's start. A curve never turns in x or y, so that two corners tell.
GPGP_FN uint gpgpSideOf(uint slot, uint curves, uint number, GpgpPatchCurve c, vec2 low, vec2 high) {
  const bool falls = c.end.x >= 0.0f; // to the right
  const vec2 left = vec2(low.x, falls ? high.y : low.y), right = vec2(high.x, falls ? low.y : high.y);
  // First the corner that decides on the side of the chord on which the box lies.
  const bool beyond = gpgpCross(vec2(left.x + right.x, left.y + right.y), c.end) >= 0.0f;
  GPGP_PATCH_COUNT(sign)
  const bool first = gpgpRightOf(slot, curves, number, c, beyond ? left : right);
  if (first == beyond) return beyond ? 1u : 2u;
  GPGP_PATCH_COUNT(sign)
  if (gpgpRightOf(slot, curves, number, c, beyond ? right : left) == beyond) return 0u;
  return beyond ? 2u : 1u;
}

// The integral of v clamped to 0 .. 1, from 0 on.
GPGP_FN float gpgpRamp(float v) { return v < 0.0f ? 0.0f : v > 1.0f ? v - 0.5f : 0.5f * v * v; }

// The area of a box that lies left of a curve. The box lies within the curve's rows; low, high: its corners, from the
// curve's start. What is far from the curve is told by its ends, then by the sign of its form.
GPGP_FN float gpgpAreaLeftOf(uint slot, uint curves, uint number, GpgpPatchCurve ends, vec2 low, vec2 high) {
  const float width = high.x - low.x, height = high.y - low.y;
  GPGP_PATCH_COUNT(box)
  if (low.x >= max(0.0f, ends.end.x)) return 0.0f;
  if (high.x <= min(0.0f, ends.end.x)) return width * height;
  const uint kind = number >> kPatchCurveKind;
  if (kind == kPatchLine) {
    GPGP_PATCH_COUNT(line)
    const float slope = ends.end.x / ends.end.y;
    const float a = (slope * low.y - low.x) / width, b = (slope * high.y - low.x) / width;
    const float mean = abs(b - a) < 1e-2f ? clamp(0.5f * (a + b), 0.0f, 1.0f) : (gpgpRamp(b) - gpgpRamp(a)) / (b - a);
    return width * height * mean;
  }
  const GpgpPatchCurve c = gpgpLoadControls(slot, curves, number, ends);
  const uint side = gpgpSideOf(slot, curves, number, c, low, high);
  if (side != 0u) return side == 1u ? 0.0f : width * height;
  GPGP_PATCH_COUNT(solve)
  const bool conic = kind == kPatchConic;
  const float nearX = 1e-3f * width, nearY = 1e-3f * height; // of an area that is told to a hundredth
  float t0 = gpgpCurveAtY(conic, c, low.y, nearY), t1 = gpgpCurveAtY(conic, c, high.y, nearY);
  vec2 p0 = gpgpCurvePoint(conic, c, t0), p1 = gpgpCurvePoint(conic, c, t1);
  p0.y = low.y;
  p1.y = high.y;
  if (max(p0.x, p1.x) <= low.x) return 0.0f;
  if (min(p0.x, p1.x) >= high.x) return width * height;
  float area = 0.0f; // of the rows in which the curve passes right of the box
  if (p0.x < low.x || p0.x > high.x) {
    const bool right = p0.x > high.x;
    t0 = gpgpCurveAtX(conic, c, right ? high.x : low.x, nearX);
    p0 = vec2(right ? high.x : low.x, clamp(gpgpCurvePoint(conic, c, t0).y, low.y, high.y));
    area += right ? width * (p0.y - low.y) : 0.0f;
  }
  if (p1.x < low.x || p1.x > high.x) {
    const bool right = p1.x > high.x;
    t1 = gpgpCurveAtX(conic, c, right ? high.x : low.x, nearX);
    p1 = vec2(right ? high.x : low.x, clamp(gpgpCurvePoint(conic, c, t1).y, p0.y, high.y));
    area += right ? width * (high.y - p1.y) : 0.0f;
  }
  // The rest lies in the box: a trapezium, and what a parabola through the middle leaves between it and the chord.
  const vec2 middle = gpgpCurvePoint(conic, c, 0.5f * (t0 + t1));
  const vec2 along = vec2(p1.x - p0.x, p1.y - p0.y), out_ = vec2(middle.x - p0.x, middle.y - p0.y);
  area += along.y * (0.5f * (p0.x + p1.x) - low.x) + (2.0f / 3.0f) * (out_.x * along.y - out_.y * along.x);
  return clamp(area, 0.0f, width * height);
}

// The area of a box that a patch covers. place: of the patch; low, high: the corners of the box, from the origin.
GPGP_FN float gpgpPatchArea(uint slot, uint curves, uint place, uvec4 head, vec2 origin, vec2 low, vec2 high) {
  const float top = max(low.y, uintBitsToFloat(head.x) - origin.y);
  const float bottom = min(high.y, uintBitsToFloat(head.y) - origin.y);
  if (top >= bottom) return 0.0f;
  const float width = high.x - low.x;
  float area = width * (bottom - top);
  for (uint k = 0u; k < head.z; ++k) {
    const uint number = gpgpCurveOf(slot, place, k);
    const GpgpPatchCurve c = gpgpLoadEnds(slot, curves, number, origin);
    const float from = max(top, c.start.y), to = min(bottom, c.bottom);
    if (from < to) {
      const float left = gpgpAreaLeftOf(slot, curves, number, c, vec2(low.x - c.start.x, from - c.start.y),
                                        vec2(high.x - c.start.x, to - c.start.y));
      area -= k < head.w ? left : width * (to - from) - left;
      if (area <= 0.0f) return 0.0f;
    }
  }
  return area;
}

// The area of a box that one cell's patches cover; the box is cut to the cell.
GPGP_FN float gpgpCellArea(uint slot, GpgpPatchPath path, uint column, uint row, vec2 origin, vec2 low, vec2 high) {
  uint place = 0u;
  const uint count = gpgpCellCount(slot, path, column, row, place);
  if (count == 0u) return 0.0f;
  const vec2 corner = vec2(path.box.x - origin.x, path.box.y - origin.y);
  // The last cells end at the box, whatever was rounded.
  const float left = max(low.x, corner.x + float(column) * path.cell.x);
  const float upper = max(low.y, corner.y + float(row) * path.cell.y);
  const float right = column + 1u == path.columns ? high.x : min(high.x, corner.x + float(column + 1u) * path.cell.x);
  const float lower = row + 1u == path.rows ? high.y : min(high.y, corner.y + float(row + 1u) * path.cell.y);
  if (left >= right || upper >= lower) return 0.0f;
  if (count == kPatchSolid) return (right - left) * (lower - upper);
  float area = 0.0f;
  for (uint i = 0u; i < count; ++i) {
    const uvec4 head = GPGP_PATCH_LOAD(slot, place);
    area += gpgpPatchArea(slot, path.curves, place, head, origin, vec2(left, upper), vec2(right, lower));
    place += 1u + (head.z + 3u) / 4u;
  }
  return area;
}

// The summed table: how many cells' worth of area lies left of and above a place, counted in cells.
GPGP_FN float gpgpSumAt(uint slot, GpgpPatchPath path, uint column, uint row) {
  const uint index = row * (path.columns + 1u) + column;
  const vec4 four = GPGP_PATCH_FLOAT(slot, path.sums + index / 4u);
  const uint k = index & 3u;
  return k == 0u ? four.x : k == 1u ? four.y : k == 2u ? four.z : four.w;
}
GPGP_FN float gpgpSummedArea(uint slot, GpgpPatchPath path, vec2 at) {
  const float x = clamp(at.x, 0.0f, float(path.columns)), y = clamp(at.y, 0.0f, float(path.rows));
  const uint column = min(uint(x), path.columns - 1u), row = min(uint(y), path.rows - 1u);
  const float u = x - float(column), v = y - float(row);
  return mix(mix(gpgpSumAt(slot, path, column, row), gpgpSumAt(slot, path, column + 1u, row), u),
             mix(gpgpSumAt(slot, path, column, row + 1u), gpgpSumAt(slot, path, column + 1u, row + 1u), u), v);
}

// Which part of a box a path covers, 0 to 1. `at`: the middle of the box; half_: half its width and height.
GPGP_FN float gpgpBoxCoverage(uint slot, GpgpPatchPath path, vec2 origin, vec2 at, vec2 half_) {
  const vec2 corner = vec2(path.box.x - origin.x, path.box.y - origin.y);
  const vec2 low = vec2(max(at.x - half_.x, corner.x), max(at.y - half_.y, corner.y));
  const vec2 high = vec2(min(at.x + half_.x, path.box.z - origin.x), min(at.y + half_.y, path.box.w - origin.y));
  if (low.x >= high.x || low.y >= high.y) return 0.0f;
  const uint column0 = gpgpColumnAt(path, origin, low.x), column1 = gpgpColumnAt(path, origin, high.x);
  const uint row0 = gpgpRowAt(path, origin, low.y), row1 = gpgpRowAt(path, origin, high.y);
  float area = 0.0f;
  if (path.sums != 0u && (column1 - column0 > kPatchFewCells || row1 - row0 > kPatchFewCells)) {
    const vec2 from = vec2((low.x - corner.x) * path.cell.z, (low.y - corner.y) * path.cell.w);
    const vec2 to = vec2((high.x - corner.x) * path.cell.z, (high.y - corner.y) * path.cell.w);
    area = (gpgpSummedArea(slot, path, to) - gpgpSummedArea(slot, path, vec2(from.x, to.y))) -
           (gpgpSummedArea(slot, path, vec2(to.x, from.y)) - gpgpSummedArea(slot, path, from));
    area *= path.cell.x * path.cell.y;
  } else {
    for (uint row = row0; row <= row1; ++row)
      for (uint column = column0; column <= column1; ++column)
        area += gpgpCellArea(slot, path, column, row, origin, low, high);
  }
  return area / (4.0f * half_.x * half_.y);
}

// Half the box that stands for a pixel: as wide and high as the pixel's shape on the drawing spreads along each axis.
// dx, dy: how far the point moves from a pixel to the next. Exact where the pixel's sides lie along the axes.
GPGP_FN vec2 gpgpPixelBox(vec2 dx, vec2 dy) {
  return vec2(max(0.5f * sqrt(dx.x * dx.x + dy.x * dy.x), 1e-30f), max(0.5f * sqrt(dx.y * dx.y + dy.y * dy.y), 1e-30f));
}

// Which part of a pixel a path covers, 0 to 1. Where the pixel's shape on the drawing is slanted, and so much smaller
// than its box, it is divided into 2 x 2 or 3 x 3 boxes.
GPGP_FN float gpgpPathCoverage(uint slot, GpgpPatchPath path, vec2 origin, vec2 at, vec2 dx, vec2 dy) {
  const vec2 half_ = gpgpPixelBox(dx, dy);
  const float filled = abs(dx.x * dy.y - dx.y * dy.x) / (4.0f * half_.x * half_.y);
  const uint side = filled > 0.8f ? 1u : filled > 0.4f ? 2u : 3u;
  float covered = 0.0f;
  if (side == 1u) {
    covered = gpgpBoxCoverage(slot, path, origin, at, half_);
  } else {
    const float part = 1.0f / float(side);
    for (uint i = 0u; i < side * side; ++i) {
      const float u = (float(i % side) + 0.5f) * part - 0.5f, v = (float(i / side) + 0.5f) * part - 0.5f;
      covered += gpgpBoxCoverage(slot, path, origin, at + dx * u + dy * v, half_ * part);
    }
    covered *= part * part;
  }
  return covered > 0.9995f ? 1.0f : covered < 0.0005f ? 0.0f : covered; // rounding shows neither as seam nor as dust
}

// ---------------------------------------------------------------- paint

GPGP_FN vec4 gpgpStopColor(uint slot, uint first, uint count, float t) {
  uint low = 0u, high = count; // how many stops lie at or before t
  while (low < high) {
    const uint middle = (low + high) / 2u;
    if (GPGP_PATCH_FLOAT(slot, first + middle * 2u + 1u).x <= t)
      low = middle + 1u;
    else
      high = middle;
  }
  const vec4 after = GPGP_PATCH_FLOAT(slot, first + min(low, count - 1u) * 2u);
  if (low == 0u || low == count) return after;
  const vec4 before = GPGP_PATCH_FLOAT(slot, first + (low - 1u) * 2u);
  const float from = GPGP_PATCH_FLOAT(slot, first + low * 2u - 1u).x;
  const float to = GPGP_PATCH_FLOAT(slot, first + low * 2u + 1u).x;
  return mix(before, after, (t - from) / (to - from));
}

GPGP_FN float gpgpDecodeSrgb(float v) { return v <= 0.04045f ? v / 12.92f : pow((v + 0.055f) / 1.055f, 2.4f); }
GPGP_FN float gpgpEncodeSrgb(float v) { return v <= 0.0031308f ? v * 12.92f : 1.055f * pow(v, 1.0f / 2.4f) - 0.055f; }

// A path's colour at a point: straight, linear or as sRGB encodes it. foreground: of the text, for paths that take it;
// its alpha multiplies that of every path.
GPGP_FN vec4 gpgpPathColor(uint slot, uint drawing, GpgpPatchPath path, vec2 at, vec4 foreground, bool encoded) {
  vec4 color = path.color;
  bool isEncoded = false;
  if (path.paint != 0u) {
    const uint place = drawing + path.paint;
    const uvec4 kinds = GPGP_PATCH_LOAD(slot, place + 2u), ramp = GPGP_PATCH_LOAD(slot, place + 3u);
    PaintRecord g;
    g.matrix = GPGP_PATCH_FLOAT(slot, place);
    g.origin = GPGP_PATCH_FLOAT(slot, place + 1u);
    g.startRadius = uintBitsToFloat(kinds.x);
    g.kind = kinds.y;
    g.spread = kinds.z;
    g.flags = kinds.w;
    g.firstStop = ramp.x;
    g.stopCount = ramp.y;
    g.slices = ramp.z;
    g.tangent = uintBitsToFloat(ramp.w);
    const float t = rampAt(g, paintPoint(g.matrix, g.origin, at));
    const vec4 stop = gpgpStopColor(slot, drawing + g.firstStop, g.stopCount, t);
    color = vec4(stop.x, stop.y, stop.z, t < 0.0f ? 0.0f : stop.w * path.color.w);
    isEncoded = (g.flags & kInterpolateSrgb) != 0u;
  } else if ((path.flags & kPatchForeground) != 0u) {
    color = vec4(foreground.x, foreground.y, foreground.z, path.color.w);
  }
  color.w *= foreground.w;
  if (isEncoded && !encoded)
    color = vec4(gpgpDecodeSrgb(color.x), gpgpDecodeSrgb(color.y), gpgpDecodeSrgb(color.z), color.w);
  if (encoded && !isEncoded)
    color = vec4(gpgpEncodeSrgb(color.x), gpgpEncodeSrgb(color.y), gpgpEncodeSrgb(color.z), color.w);
  return color;
}

// A whole drawing at a point: coverage and paint of its paths, in painting order, one over the other. Premultiplied,
// linear. at: in drawing units; dx, dy: its derivatives. drawing: where the drawing begins in the buffer, mostly 0.
//
// Every path is asked, so this suits lettering and signs of up to some hundred paths.
GPGP_FN vec4 gpgpPaintDrawing(uint slot, uint drawing, vec2 at, vec2 dx, vec2 dy) {
  const vec2 half_ = gpgpPixelBox(dx, dy), zero = vec2(0.0f, 0.0f);
  const uint paths = gpgpPatchPaths(slot, drawing);
  vec4 sum = vec4(0.0f, 0.0f, 0.0f, 0.0f);
  for (uint i = 0u; i < paths; ++i) {
    const vec4 box = GPGP_PATCH_FLOAT(slot, drawing + kPatchHeader + i * kPatchPathSize + 1u);
    const bool near =
        at.x + half_.x > box.x && at.x - half_.x < box.z && at.y + half_.y > box.y && at.y - half_.y < box.w;
    if (near) {
      const GpgpPatchPath path = gpgpLoadPath(slot, drawing, i);
      const float coverage = gpgpPathCoverage(slot, path, zero, at, dx, dy);
      if (coverage > 0.0f) {
        const vec4 color = gpgpPathColor(slot, drawing, path, at, vec4(0.0f, 0.0f, 0.0f, 1.0f), false);
        const float alpha = color.w * coverage;
        sum = vec4(color.x * alpha, color.y * alpha, color.z * alpha, alpha) + sum * (1.0f - alpha);
      }
    }
  }
  return sum;
}

#endif
