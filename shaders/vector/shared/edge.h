// A boundary of a path as flattened segments, and which samples lie right of a flatSegment.
//
// A segment is a part of a curve on the boundary of a path's filled region: the region lies on one side of it, nothing
// on the other. Segments of a path form closed outlines, so a sample is inside where an odd number of them lies left of
// it in its row. A segment's curve is cut into equal steps of its parameter, as many as keep the flattened segments
// within kFlatness of it; between the curve's ends they begin a little outside of it, by up to 4/3 kFlatness, so that
// they leave as much area on one side of it as on the other. Flattened segments that reach beyond the segment's ends
// are clipped to those. Everything that borders shares its vertices bit for bit: consecutive flattened segments,
// segments that meet, and paths that have a curve in common.
//
// A projective item's lines stay lines, so its flattened segments need no other form; its curves take as many flattened
// segments as the largest magnification along them asks for. What lies behind the eye is cut off along a line of the
// drawing that is seen past the canvas, and the outlines are closed along it where it passes left of the canvas: all
// that then counts are the rows that each cut turns over (placeItem in src/vector/raster/place.h chooses the line).
//
// A scissor moves what lies outside of it to its edge: outlines stay closed, and inside it nothing changes. Crossings
// go to its nearer side, and ends of flattened segments above or below it to its left corners.
//
// Rows are sample rows: n of them in a pixel, one sample in each. Columns are pixels; -1 stands for all left of the
// canvas. Only + - * on precise floats and division by core/math.h: CPU and GPU agree on every bit.
#ifndef GPGP_SHADERS_VECTOR_EDGE_H
#define GPGP_SHADERS_VECTOR_EDGE_H
#include "vector/shared/sample.h"

#include "core/math.h"

#ifdef __cplusplus
#define PROJECTIVE 1
#elif !defined(PROJECTIVE) // whether items may be projective
#define PROJECTIVE 0
#endif
#ifdef __cplusplus
#define SCISSORS 1
#elif !defined(SCISSORS) // whether items may have scissors
#define SCISSORS 0
#endif

GPGP_SHADER_BEGIN

GPGP_CONST float kFlatness =
    0.03125f; // pixels: how far a flattened segment may lie from its curve, before vertices are moved
GPGP_CONST float kFlatAlone =
    256.0f; // the square of how much closer a curve's only flattened segment lies, which can't be moved
GPGP_CONST uint kMaxFlatSegments = 1024u;     // of one curve
GPGP_CONST float kLongestFlatSegment = 16.0f; // pixels, so that work is even; longer only beyond kMaxFlatSegments

// What the canvas gives to every flatSegment.
struct Grid {
  uint samples; // in a pixel, rows as well
  int rows;     // of samples on the canvas
  int columns;  // of pixels
};

#if PROJECTIVE
GPGP_FN bool projects(ItemRecord item) { return item.perspective.w > 0.0f; }
// How far a drawing's point lies from the eye.
GPGP_FN float depthOf(ItemRecord item, float x, float y) {
  GPGP_PRECISE float w = item.perspective.x * x + (item.perspective.y * y + item.perspective.z);
  return w;
}
#endif

// A drawing's point on the canvas. It must not lie behind the eye.
GPGP_FN vec2 toPixel(ItemRecord item, float x, float y) {
  GPGP_PRECISE float px = item.transform.x * x + (item.transform.z * y + item.offsets.z);
  GPGP_PRECISE float py = item.transform.y * x + (item.transform.w * y + item.offsets.w);
#if PROJECTIVE
  if (projects(item)) {
    const float w =
        max(depthOf(item, x, y), item.perspective.w); // the latter by rounding, or by flattened segments' outset
    return vec2(divide(px, w), divide(py, w));
  }
#endif
  return vec2(px, py);
}

// How far second differences reach: of a, b, c.
GPGP_FN float bendOf(vec2 a, vec2 b, vec2 c) {
  GPGP_PRECISE float x = a.x - (b.x + b.x) + c.x;
  GPGP_PRECISE float y = a.y - (b.y + b.y) + c.y;
  GPGP_PRECISE float s = x * x + y * y;
  return s;
}

// How many flattened segments a curve takes: a power of two, or one and a half times that, which needs neither roots
// nor division. `length` in longest flattened segments, `bend` the fourth power of what flatness asks for.
GPGP_FN uint flatSegmentsFor(float length, float bend) {
  uint n = bend * kFlatAlone > 1.0f ? 2u : 1u;
  while (n < kMaxFlatSegments) {
    GPGP_PRECISE float m = float(n);
    GPGP_PRECISE float m2 = m * m;
    GPGP_PRECISE float m4 = m2 * m2;
    if (m >= length && m4 >= bend) return n;
    if (n > 1u && m * 1.5f >= length && m4 * 5.0625f >= bend) return n + n / 2u;
    n *= 2u;
  }
  return kMaxFlatSegments;
}

#if PROJECTIVE
// Of a segment's control points, how many lie in front of the eye: 0 to 4.
GPGP_FN uint inFront(ItemRecord item, SegmentRecord s) {
  const float near = item.perspective.w;
  return (depthOf(item, s.first.x, s.first.y) >= near ? 1u : 0u) +
         (depthOf(item, s.first.z, s.first.w) >= near ? 1u : 0u) +
         (depthOf(item, s.second.x, s.second.y) >= near ? 1u : 0u) +
         (depthOf(item, s.second.z, s.second.w) >= near ? 1u : 0u);
}

// How far a small step in the drawing reaches on the canvas, at most, times w.
GPGP_FN vec2 reachOf(Grid g, ItemRecord item, float x, float y) {
  const float halfX = 0.5f * float(g.columns), halfY = 0.5f * float(g.rows) * sampleStep(g.samples);
  GPGP_PRECISE float w = item.perspective.x * x + item.perspective.y * y;
  GPGP_PRECISE float px = item.transform.x * x + item.transform.z * y - halfX * w;
  GPGP_PRECISE float py = item.transform.y * x + item.transform.w * y - halfY * w;
  GPGP_PRECISE float u = abs(px) + halfX * abs(w);
  GPGP_PRECISE float v = abs(py) + halfY * abs(w);
  return vec2(u, v);
}

// Flattened segments within kFlatness of the curve and, up to kMaxFlatSegments, no longer than kLongestFlatSegment, by
// the part nearest to the eye; twice as many where the segment passes behind the eye, as each flattened segment may
// then be cut (flatSegmentOf).
GPGP_FN uint projectedFlatSegments(Grid g, ItemRecord item, SegmentRecord s) {
  const float near = item.perspective.w;
  const float w = max(min(min(depthOf(item, s.first.x, s.first.y), depthOf(item, s.first.z, s.first.w)),
                          min(depthOf(item, s.second.x, s.second.y), depthOf(item, s.second.z, s.second.w))),
                      near);
  GPGP_PRECISE float wholeX = s.second.z - s.first.x;
  GPGP_PRECISE float wholeY = s.second.w - s.first.y;
  const vec2 whole = reachOf(g, item, wholeX, wholeY);
  const float length = divide(max(whole.x, whole.y), w) * (1.0f / kLongestFlatSegment);
  float bend = 0.0f;
  if (s.line == 0u) {
    GPGP_PRECISE float ax = s.first.x - (s.first.z + s.first.z) + s.second.x;
    GPGP_PRECISE float ay = s.first.y - (s.first.w + s.first.w) + s.second.y;
    GPGP_PRECISE float bx = s.first.z - (s.second.x + s.second.x) + s.second.z;
    GPGP_PRECISE float by = s.first.w - (s.second.y + s.second.y) + s.second.w;
    const vec2 a = reachOf(g, item, ax, ay);
    const vec2 b = reachOf(g, item, bx, by);
    GPGP_PRECISE float u = a.x * a.x + a.y * a.y;
    GPGP_PRECISE float v = b.x * b.x + b.y * b.y;
    GPGP_PRECISE float w2 = w * w;
    bend = divide(max(u, v), w2) * (0.5625f / (kFlatness * kFlatness));
  }
  const uint n = flatSegmentsFor(length, bend);
  const uint front = inFront(item, s);
  return front == 0u || front == 4u ? n : n + n;
}
#endif

GPGP_FN uint flatSegmentCount(Grid g, ItemRecord item, SegmentRecord s) {
#if PROJECTIVE
  if (projects(item)) return projectedFlatSegments(g, item, s);
#endif
  const vec2 a = toPixel(item, s.first.x, s.first.y);
  const vec2 d = toPixel(item, s.second.z, s.second.w);
  GPGP_PRECISE float width = d.x - a.x;
  GPGP_PRECISE float height = d.y - a.y;
  const float length = max(abs(width), abs(height)) * (1.0f / kLongestFlatSegment);
  float bend = 0.0f;
  if (s.line == 0u) {
    const vec2 b = toPixel(item, s.first.z, s.first.w);
    const vec2 c = toPixel(item, s.second.x, s.second.y);
    // The curve lies within 3/4 of its largest second difference over the square of the steps.
    GPGP_PRECISE float square = max(bendOf(a, b, c), bendOf(b, c, d)) * (0.5625f / (kFlatness * kFlatness));
    bend = square;
  }
  return flatSegmentsFor(length, bend);
}

// The parameter's step for as many flatSegments.
GPGP_FN float flatSegmentStep(uint n) {
  const uint power = 1u << uint(findMSB(n));
  const float step = uintBitsToFloat(0x3f800000u - (uint(findMSB(n)) << 23)); // 1 / power
  return n == power ? step : step * 0.6666667f;
}

// Whether a segment can change anything on the canvas: its curve's box decides.
GPGP_FN bool mayMatter(Grid g, ItemRecord item, SegmentRecord s) {
#if PROJECTIVE
  if (projects(item)) {
    const uint front = inFront(item, s);
    if (front < 4u) return front > 0u;
  }
#endif
  const vec2 a = toPixel(item, s.first.x, s.first.y);
  const vec2 b = toPixel(item, s.first.z, s.first.w);
  const vec2 c = toPixel(item, s.second.x, s.second.y);
  const vec2 d = toPixel(item, s.second.z, s.second.w);
  const float top = min(min(a.y, b.y), min(c.y, d.y)), bottom = max(max(a.y, b.y), max(c.y, d.y));
  bool left = min(min(a.x, b.x), min(c.x, d.x)) <= float(g.columns) + 1.0f;
#if SCISSORS
  // A scissor moves to its sides, and to its left corners, what lies right of the canvas as well.
  left = left || item.scissor.z < float(g.columns) || top <= item.scissor.y + 1.0f || bottom >= item.scissor.w - 1.0f;
#endif
  return left && bottom >= -1.0f && top * float(g.samples) <= float(g.rows) + 1.0f;
}

// How far the vertex of two flattened segments lies outside of its curve, by the curve's second difference a - c, where
// a, b, c lead from control point to control point: so far that the two cover the curve's area, 1/8 for a parabola.
GPGP_FN float middleOutset(float ax, float ay, float bx, float by, float cx, float cy) {
  GPGP_PRECISE float ab = ax * by - ay * bx;
  GPGP_PRECISE float bc = bx * cy - by * cx;
  GPGP_PRECISE float ac = ax * cy - ay * cx;
  GPGP_PRECISE float whole = ab + bc + 2.0f * ac; // twice the area by which the vertex grows the triangle
  GPGP_PRECISE float over = ab + bc - ac;         // 0 for a parabola
  if (abs(whole) < 1e-20f) return 0.125f;
  // Within a hundredth, as what is not a parabola's is a small part. Curves that are not convex stay within bounds.
  const float guess = uintBitsToFloat(0x7ef311c3u - floatBitsToUint(whole));
  GPGP_PRECISE float missing = 2.0f - whole * guess;
  GPGP_PRECISE float share = over * (guess * missing);
  GPGP_PRECISE float outset = 0.125f + 0.1f * clamp(share, -0.5f, 1.0f);
  return outset;
}

// Where flattened segment i of n begins in the drawing, and the one before it ends; `step` is flatSegmentStep(n). A
// flattened segment across a curve with second derivative p lies p step^2 / 12 inside of it on average, so flattened
// segments begin as far outside. The curve's ends stay, so the vertices beside them take over the half that these
// leave, or all of it where there is but one.
GPGP_FN vec2 curvePoint(SegmentRecord s, uint i, uint n, float step) {
  if (i == 0u) return vec2(s.first.x, s.first.y);
  if (i >= n) return vec2(s.second.z, s.second.w);
  GPGP_PRECISE float t = float(i) * step;
  if (s.line != 0u) {
    GPGP_PRECISE float x = s.first.x + (s.second.z - s.first.x) * t;
    GPGP_PRECISE float y = s.first.y + (s.second.w - s.first.y) * t;
    return vec2(x, y);
  }
  GPGP_PRECISE float ax = s.first.z - s.first.x;
  GPGP_PRECISE float ay = s.first.w - s.first.y;
  GPGP_PRECISE float bx = s.second.x - s.first.z;
  GPGP_PRECISE float by = s.second.y - s.first.w;
  GPGP_PRECISE float cx = s.second.z - s.second.x;
  GPGP_PRECISE float cy = s.second.w - s.second.y;
  GPGP_PRECISE float dx = bx - ax;
  GPGP_PRECISE float dy = by - ay;
  GPGP_PRECISE float ex = (cx - bx) - dx;
  GPGP_PRECISE float ey = (cy - by) - dy;
  GPGP_PRECISE float tex = t * ex;
  GPGP_PRECISE float tey = t * ey;
  // The second derivative is 6 (d + t e).
  GPGP_PRECISE float twelfth = 0.5f * step * step;
  float atStart = i == 1u ? 0.5f : 0.0f, atEnd = i + 1u == n ? 0.5f : 0.0f;
  if (n == 2u) { // (a - c) is -2 (d + t e) there
    twelfth = 2.0f * middleOutset(ax, ay, bx, by, cx, cy);
    atStart = 0.0f;
    atEnd = 0.0f;
  }
  GPGP_PRECISE float own = 1.0f + (atStart + atEnd);
  GPGP_PRECISE float along = t + atEnd;
  GPGP_PRECISE float outX = own * dx + along * ex;
  GPGP_PRECISE float outY = own * dy + along * ey;
  GPGP_PRECISE float x = s.first.x + (t * (3.0f * ax + t * (3.0f * dx + tex)) - twelfth * outX);
  GPGP_PRECISE float y = s.first.y + (t * (3.0f * ay + t * (3.0f * dy + tey)) - twelfth * outY);
  return vec2(x, y);
}

// A flattened segment on the canvas, top to bottom.
struct FlatSegment {
  vec2 top, bottom;
  float slope;     // x per y
  int first, last; // sample rows from first to last - 1 meet it
  float side;      // 1: the region begins right of it, -1: it ends there
#if SCISSORS
  float left, right;     // crossings lie between them
  float topEnd, lastEnd; // x of its ends, moved to the scissor
#endif
};
GPGP_FN float topEnd(FlatSegment c) {
#if SCISSORS
  return c.topEnd;
#else
  return c.top.x;
#endif
}
GPGP_FN float lastEnd(FlatSegment c) {
#if SCISSORS
  return c.lastEnd;
#else
  return c.bottom.x;
#endif
}

// The first sample row at or below y.
GPGP_FN int rowOf(Grid g, float y) {
  GPGP_PRECISE float row = y * float(g.samples) - 0.5f;
  return int(clamp(-floor(-row), 0.0f, float(g.rows)));
}
GPGP_FN int columnOf(Grid g, float x) { return int(clamp(floor(x), -1.0f, float(g.columns))); }

#if SCISSORS
GPGP_FN bool hasScissor(ItemRecord item) {
  return max(item.scissor.x, item.scissor.y) > -kUnbounded || min(item.scissor.z, item.scissor.w) < kUnbounded;
}
// Moves a flattened segment to the scissor. False where nothing of it is left.
GPGP_FN bool cutFlatSegment(Grid g, vec4 scissor, GPGP_INOUT(FlatSegment) flatSegment) {
  const int begin = rowOf(g, scissor.y), end = max(rowOf(g, scissor.w), begin);
  flatSegment.left = scissor.x;
  flatSegment.right = max(scissor.z, scissor.x);
  if (flatSegment.last < begin || flatSegment.first > end) return false;
  flatSegment.topEnd =
      flatSegment.first < begin ? flatSegment.left : clamp(flatSegment.top.x, flatSegment.left, flatSegment.right);
  flatSegment.lastEnd =
      flatSegment.last > end ? flatSegment.left : clamp(flatSegment.bottom.x, flatSegment.left, flatSegment.right);
  flatSegment.first = max(flatSegment.first, begin);
  flatSegment.last = min(flatSegment.last, end);
  return true;
}
#endif

// width / height, of which the latter is neither 0 nor denormal, within a few units of its last place. Exact division
// takes several times as long, and no crossing asks for it.
GPGP_FN float slopeOf(float width, float height) {
  float inverse = uintBitsToFloat(0x7ef311c3u - floatBitsToUint(height)); // within an eighth
  for (uint i = 0u; i < 3u; ++i) {                                        // each step squares the error
    GPGP_PRECISE float missing = 2.0f - height * inverse;
    GPGP_PRECISE float better = inverse * missing;
    inverse = better;
  }
  GPGP_PRECISE float slope = width * inverse;
  return clamp(slope, -kLargest, kLargest);
}

// Flattened segment i of n of a segment, clipped to it and to the scissor. False where nothing of it is left.
GPGP_FN bool flatSegmentOf(Grid g, ItemRecord item, SegmentRecord s, uint i, uint n, float step,
                           GPGP_OUT(FlatSegment) flatSegment) {
  flatSegment.first = 0;
  flatSegment.last = 0;
  flatSegment.side = 0.0f;
  flatSegment.slope = 0.0f;
  flatSegment.top = vec2(0.0f, 0.0f);
  flatSegment.bottom = flatSegment.top;
#if SCISSORS
  flatSegment.left = 0.0f;
  flatSegment.right = 0.0f;
  flatSegment.topEnd = 0.0f;
  flatSegment.lastEnd = 0.0f;
#endif
#if PROJECTIVE
  // Of a segment that passes behind the eye, the second half of the flattened segments are the outline along the cut:
  // where flattened segment i - n / 2 is cut, down to there from above the canvas.
  uint flatSegments = n, at = i;
  float spacing = step;
  bool closing = false, cut = false;
  if (projects(item)) {
    const uint front = inFront(item, s);
    if (front == 0u) return false;
    cut = front < 4u;
    if (cut) {
      flatSegments = n / 2u;
      spacing = step + step;
      closing = i >= flatSegments;
      if (closing) {
        if (item.eye.w == 0.0f) return false;
        at = i - flatSegments;
      }
    }
  }
  vec2 a = curvePoint(s, at, flatSegments, spacing);
  vec2 b = curvePoint(s, at + 1u, flatSegments, spacing);
#else
  vec2 a = curvePoint(s, i, n, step);
  vec2 b = curvePoint(s, i + 1u, n, step);
#endif
  // What lies beyond the segment's ends becomes these, also where flattened segments turn back a little, as they may
  // where the curve is all but level: so they stay connected.
  if (s.ends.y > s.first.y) { // begins below its curve's begin
    const bool above = a.y <= s.ends.y;
    if (above && b.y <= s.ends.y) return false;
    if (above)
      a = vec2(s.ends.x, s.ends.y);
    else if (b.y <= s.ends.y)
      b = vec2(s.ends.x, s.ends.y);
  }
  if (s.ends.w < s.second.w) {
    const bool below = b.y >= s.ends.w;
    if (below && a.y >= s.ends.w) return false;
    if (below)
      b = vec2(s.ends.z, s.ends.w);
    else if (a.y >= s.ends.w)
      a = vec2(s.ends.z, s.ends.w);
  }
#if PROJECTIVE
  if (cut) { // vertices of others lie behind the eye by a hair at most, and toPixel keeps them before it
    const float near = item.perspective.w;
    const float da = depthOf(item, a.x, a.y), db = depthOf(item, b.x, b.y);
    if (da < near && db < near) return false;
    if (da < near || db < near) {
      GPGP_PRECISE float missing = near - da;
      GPGP_PRECISE float whole = db - da;
      const float t = divide(missing, whole);
      GPGP_PRECISE float x = a.x + (b.x - a.x) * t;
      GPGP_PRECISE float y = a.y + (b.y - a.y) * t;
      if (da < near)
        a = vec2(x, y);
      else
        b = vec2(x, y);
      if (closing) {
        flatSegment.bottom = vec2(-1.0f, toPixel(item, x, y).y);
        flatSegment.top = vec2(-1.0f, min(flatSegment.bottom.y, -1.0f));
        flatSegment.last = rowOf(g, flatSegment.bottom.y);
        flatSegment.side = s.side * item.side * (da < near ? 1.0f : -1.0f); // down where the outline comes back
#if SCISSORS
        return cutFlatSegment(g, item.scissor, flatSegment);
#else
        return true;
#endif
      }
    } else if (closing)
      return false;
  }
#endif
  a = toPixel(item, a.x, a.y);
  b = toPixel(item, b.x, b.y);
  flatSegment.side = s.side * item.side;
  if (b.y < a.y) {
    flatSegment.top = b;
    flatSegment.bottom = a;
    flatSegment.side = -flatSegment.side;
  } else {
    flatSegment.top = a;
    flatSegment.bottom = b;
  }
  flatSegment.first = rowOf(g, flatSegment.top.y);
  flatSegment.last = rowOf(g, flatSegment.bottom.y);
  GPGP_PRECISE float width = flatSegment.bottom.x - flatSegment.top.x;
  GPGP_PRECISE float height = flatSegment.bottom.y - flatSegment.top.y;
  flatSegment.slope = flatSegment.first < flatSegment.last ? slopeOf(width, height) : 0.0f;
#if SCISSORS
  return cutFlatSegment(g, item.scissor, flatSegment);
#else
  return true;
#endif
}

// Where a sample row lies; sums of rows and steps are exact.
GPGP_FN float middleOf(Grid g, int row) {
  GPGP_PRECISE float y = (float(row) + 0.5f) * sampleStep(g.samples);
  return y;
}
// A flattened segment's line across sample rows, in 1/256 pixel; between `low` and `high` it stays.
struct Line {
  float x, y, slope;
  float low, high;
};
GPGP_FN Line lineOf(Grid g, FlatSegment c) {
  Line line;
  line.x = c.top.x * 256.0f;
  line.y = c.top.y;
  line.slope = c.slope * 256.0f;
  float low = min(c.top.x, c.bottom.x), high = max(c.top.x, c.bottom.x);
#if SCISSORS
  low = clamp(low, c.left, c.right);
  high = clamp(high, c.left, c.right);
#endif
  line.low = clamp(low, -1.0f, float(g.columns)) * 256.0f;
  line.high = clamp(high, -1.0f, float(g.columns)) * 256.0f;
  return line;
}
// Where it meets a row, in 1/256 pixel, rounded up; never turns from row to row. Its upper bits are the pixel's column,
// its lower eight the part of the pixel left of it; a sample at or right of it is right of the line as well.
GPGP_FN int crossingAt(Line line, float y) {
  GPGP_PRECISE float x = line.x + (y - line.y) * line.slope;
  return int(ceil(clamp(x, line.low, line.high)));
}
// By how much a pixel's area right of the line differs from what its samples say, in 1/256 sample, as sums over `rows`
// sample rows, of which `missed` have their sample left of the line; from the first and the last crossing.
GPGP_FN int areaOf(uint rows, uint missed, int first, int last) {
  return int(missed * 256u) - ((int(rows) * ((first & 255) + (last & 255))) >> 1);
}
GPGP_FN int crossingOf(Grid g, FlatSegment c, int row) { return crossingAt(lineOf(g, c), middleOf(g, row)); }

GPGP_SHADER_END
#endif
