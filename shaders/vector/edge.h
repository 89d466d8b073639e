// A boundary of a path as chords, and which samples lie right of a chord.
//
// A segment is a part of a curve on the boundary of a path's filled region: the region lies on one side of it, nothing
// on the other. Segments of a path form closed outlines, so a sample is inside where an odd number of them lies left of
// it in its row. A segment's curve is cut into equal steps of its parameter, as many as keep the chords within
// kFlatness of it; chords that reach beyond the segment's ends are clipped to those. Everything that borders shares its
// vertices bit for bit: consecutive chords, segments that meet, and paths that have a curve in common.
//
// Rows are sample rows: n of them in a pixel, one sample in each. Columns are pixels; -1 stands for all left of the
// canvas. Only + - * on precise floats and division by core/math.h: CPU and GPU agree on every bit.
#ifndef GPGP_SHADERS_VECTOR_EDGE_H
#define GPGP_SHADERS_VECTOR_EDGE_H
#include "sample.h"

#include "../core/math.h"

GPGP_SHADER_BEGIN

GPGP_CONST float kFlatness = 0.03125f;  // pixels: how far a chord may lie from its curve
GPGP_CONST uint kMaxChords = 1024u;     // of one curve
GPGP_CONST float kLongestChord = 16.0f; // pixels, so that work is even; longer only beyond kMaxChords

// A drawing's point on the canvas.
GPGP_FN vec2 toPixel(ItemRecord item, float x, float y) {
  GPGP_PRECISE float px = item.transform.x * x + (item.transform.z * y + item.offsets.z);
  GPGP_PRECISE float py = item.transform.y * x + (item.transform.w * y + item.offsets.w);
  return vec2(px, py);
}

// How far second differences reach: of a, b, c.
GPGP_FN float bendOf(vec2 a, vec2 b, vec2 c) {
  GPGP_PRECISE float x = a.x - (b.x + b.x) + c.x;
  GPGP_PRECISE float y = a.y - (b.y + b.y) + c.y;
  GPGP_PRECISE float s = x * x + y * y;
  return s;
}

// How many chords a curve takes: a power of two, or one and a half times that, which needs neither roots nor division.
GPGP_FN uint chordCount(ItemRecord item, SegmentRecord s) {
  const vec2 a = toPixel(item, s.first.x, s.first.y);
  const vec2 d = toPixel(item, s.second.z, s.second.w);
  GPGP_PRECISE float width = d.x - a.x;
  GPGP_PRECISE float height = d.y - a.y;
  const float length = max(abs(width), abs(height)) * (1.0f / kLongestChord);
  float bend = 0.0f;
  if (s.line == 0u) {
    const vec2 b = toPixel(item, s.first.z, s.first.w);
    const vec2 c = toPixel(item, s.second.x, s.second.y);
    // The curve lies within 3/4 of its largest second difference over the square of the steps.
    GPGP_PRECISE float square = max(bendOf(a, b, c), bendOf(b, c, d)) * (0.5625f / (kFlatness * kFlatness));
    bend = square;
  }
  uint n = 1u;
  while (n < kMaxChords) {
    GPGP_PRECISE float m = float(n);
    GPGP_PRECISE float m2 = m * m;
    GPGP_PRECISE float m4 = m2 * m2;
    if (m >= length && m4 >= bend) return n;
    if (n > 1u && m * 1.5f >= length && m4 * 5.0625f >= bend) return n + n / 2u;
    n *= 2u;
  }
  return kMaxChords;
}

// The parameter's step for as many chords.
GPGP_FN float chordStep(uint n) {
  const uint power = 1u << uint(findMSB(n));
  const float step = uintBitsToFloat(0x3f800000u - (uint(findMSB(n)) << 23)); // 1 / power
  return n == power ? step : step * 0.6666667f;
}

// What the canvas gives to every chord.
struct Grid {
  uint samples; // in a pixel, rows as well
  int rows;     // of samples on the canvas
  int columns;  // of pixels
};

// Whether a segment can change anything on the canvas: its curve's box decides.
GPGP_FN bool mayMatter(Grid g, ItemRecord item, SegmentRecord s) {
  const vec2 a = toPixel(item, s.first.x, s.first.y);
  const vec2 b = toPixel(item, s.first.z, s.first.w);
  const vec2 c = toPixel(item, s.second.x, s.second.y);
  const vec2 d = toPixel(item, s.second.z, s.second.w);
  return min(min(a.x, b.x), min(c.x, d.x)) <= float(g.columns) + 1.0f && max(max(a.y, b.y), max(c.y, d.y)) >= -1.0f &&
         min(min(a.y, b.y), min(c.y, d.y)) * float(g.samples) <= float(g.rows) + 1.0f;
}

// A segment's curve at step i of n in the drawing; `step` is chordStep(n).
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
  GPGP_PRECISE float x = s.first.x + t * (3.0f * ax + t * (3.0f * dx + t * ex));
  GPGP_PRECISE float y = s.first.y + t * (3.0f * ay + t * (3.0f * dy + t * ey));
  return vec2(x, y);
}

// A chord on the canvas, top to bottom.
struct Chord {
  vec2 top, bottom;
  float slope;     // x per y
  int first, last; // sample rows from first to last - 1 meet it
  float side;      // 1: the region begins right of it, -1: it ends there
};

// The first sample row at or below y.
GPGP_FN int rowOf(Grid g, float y) {
  GPGP_PRECISE float row = y * float(g.samples) - 0.5f;
  return int(clamp(-floor(-row), 0.0f, float(g.rows)));
}
GPGP_FN int columnOf(Grid g, float x) { return int(clamp(floor(x), -1.0f, float(g.columns))); }

// Chord i of n of a segment, clipped to it. False where nothing of it is left.
GPGP_FN bool chordOf(Grid g, ItemRecord item, SegmentRecord s, uint i, uint n, float step, GPGP_OUT(Chord) chord) {
  chord.first = 0;
  chord.last = 0;
  chord.side = 0.0f;
  chord.slope = 0.0f;
  chord.top = vec2(0.0f, 0.0f);
  chord.bottom = chord.top;
  vec2 a = curvePoint(s, i, n, step);
  vec2 b = curvePoint(s, i + 1u, n, step);
  if (s.ends.y > s.first.y) { // begins below its curve's begin
    if (b.y <= s.ends.y) return false;
    if (a.y <= s.ends.y) a = vec2(s.ends.x, s.ends.y);
  }
  if (s.ends.w < s.second.w) {
    if (a.y >= s.ends.w) return false;
    if (b.y >= s.ends.w) b = vec2(s.ends.z, s.ends.w);
  }
  a = toPixel(item, a.x, a.y);
  b = toPixel(item, b.x, b.y);
  chord.side = s.side * item.side;
  if (b.y < a.y) {
    chord.top = b;
    chord.bottom = a;
    chord.side = -chord.side;
  } else {
    chord.top = a;
    chord.bottom = b;
  }
  chord.first = rowOf(g, chord.top.y);
  chord.last = rowOf(g, chord.bottom.y);
  GPGP_PRECISE float width = chord.bottom.x - chord.top.x;
  GPGP_PRECISE float height = chord.bottom.y - chord.top.y;
  chord.slope = chord.first < chord.last ? divide(width, height) : 0.0f;
  return true;
}

// Where a chord meets a sample row; never turns from row to row and never leaves the chord's ends.
GPGP_FN float crossingOf(Grid g, Chord c, int row) {
  GPGP_PRECISE float y = (float(row) + 0.5f) * sampleStep(g.samples);
  GPGP_PRECISE float x = c.top.x + (y - c.top.y) * c.slope;
  return clamp(x, min(c.top.x, c.bottom.x), max(c.top.x, c.bottom.x));
}

GPGP_SHADER_END
#endif
