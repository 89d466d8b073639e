// Shapes of lists as segments: rectangles with round corners and what lies between two of them, ellipses among them.
//
// A quarter of an ellipse is two cubics, off by less than 5e-6 of its radius. Vertices that segments share are the
// result of one expression, so outlines are closed bit for bit, and rectangles that abut share their edges.
#ifndef GPGP_SHADERS_VECTOR_SHAPE_H
#define GPGP_SHADERS_VECTOR_SHAPE_H
#include "vector/shared/triangle.h"

GPGP_SHADER_BEGIN

GPGP_CONST float kArcHandle = 0.26521648f; // of an eighth of a circle: 4/3 tan(1/16 of a turn)
GPGP_CONST float kArcMiddle = 0.70710678f;

GPGP_FN uint contourSegments(ShapeRecord s) { return isTriangle(s) ? 3u : ((s.kind & kShapeRound) != 0u ? 12u : 4u); }
GPGP_FN uint shapeSegments(ShapeRecord s) { return contourSegments(s) * (s.border > 0.0f ? 2u : 1u); }

// A point of the shape's frame.
GPGP_FN vec2 fromFrame(ShapeRecord s, float x, float y) {
  GPGP_PRECISE float u = s.frame.x + (x * s.frame.z - y * s.frame.w);
  GPGP_PRECISE float v = s.frame.y + (x * s.frame.w + y * s.frame.z);
  return vec2(u, v);
}

// A corner of one of the outlines: 0 bottom left, 1 bottom right, 2 top right, 3 top left. `side` is the y at which it
// meets the upright edge, `level` the x at which it meets the level one; `toward` leads inward, as long as the radii.
struct ShapeCorner {
  float x, y, side, level;
  vec2 toward;
};
GPGP_FN ShapeCorner shapeCorner(ShapeRecord s, bool inner, uint q) {
  const float inset = inner ? s.border : 0.0f;
  const bool left = q == 0u || q == 3u, bottom = q < 2u;
  const float radius = q == 0u ? s.radii.w : (q == 1u ? s.radii.z : (q == 2u ? s.radii.y : s.radii.x));
  GPGP_PRECISE float rx = max(radius - inset, 0.0f);
  GPGP_PRECISE float tall = radius * s.ratio;
  GPGP_PRECISE float ry = max(tall - inset, 0.0f);
  ShapeCorner c;
  GPGP_PRECISE float x = left ? s.box.x + inset : s.box.z - inset;
  GPGP_PRECISE float y = bottom ? s.box.w - inset : s.box.y + inset;
  c.toward = vec2(left ? rx : -rx, bottom ? -ry : ry);
  GPGP_PRECISE float level = x + c.toward.x;
  GPGP_PRECISE float side = y + c.toward.y;
  c.x = x;
  c.y = y;
  c.level = level;
  c.side = side;
  return c;
}

// Segment k of a shape; its path is 0. Outlines run with the region on their left, the inner one against that.
GPGP_FN SegmentRecord shapeSegment(ShapeRecord s, uint k) {
  if (isTriangle(s)) return triangleSegment(s, k);
  const uint whole = contourSegments(s);
  const bool inner = k >= whole;
  const uint at = inner ? k - whole : k;
  vec2 a, b, c, d;
  float side = 1.0f;
  if (at < 4u) { // left, right, bottom, top
    const ShapeCorner from = shapeCorner(s, inner, at == 1u ? 2u : (at == 2u ? 0u : 3u));
    const ShapeCorner to = shapeCorner(s, inner, at == 0u ? 0u : (at == 3u ? 2u : 1u));
    a = at < 2u ? vec2(from.x, from.side) : vec2(from.level, from.y);
    d = at < 2u ? vec2(to.x, to.side) : vec2(to.level, to.y);
    b = a;
    c = d;
    if (at == 1u || at == 3u) side = -1.0f;
  } else { // of each corner, from the upright edge to the middle, and on to the level edge
    const uint q = (at - 4u) / 2u;
    const ShapeCorner o = shapeCorner(s, inner, q);
    GPGP_PRECISE float mx = o.level - o.toward.x * kArcMiddle;
    GPGP_PRECISE float my = o.side - o.toward.y * kArcMiddle;
    const float slant = kArcHandle * kArcMiddle;
    if ((at & 1u) == 0u) {
      GPGP_PRECISE float by = o.side - o.toward.y * kArcHandle;
      GPGP_PRECISE float cx = mx - o.toward.x * slant;
      GPGP_PRECISE float cy = my + o.toward.y * slant;
      a = vec2(o.x, o.side);
      b = vec2(o.x, by);
      c = vec2(cx, cy);
      d = vec2(mx, my);
    } else {
      GPGP_PRECISE float bx = mx + o.toward.x * slant;
      GPGP_PRECISE float by = my - o.toward.y * slant;
      GPGP_PRECISE float cx = o.level - o.toward.x * kArcHandle;
      a = vec2(mx, my);
      b = vec2(bx, by);
      c = vec2(cx, o.y);
      d = vec2(o.level, o.y);
    }
    if ((q & 1u) != 0u) side = -1.0f;
  }
  a = fromFrame(s, a.x, a.y);
  b = fromFrame(s, b.x, b.y);
  c = fromFrame(s, c.x, c.y);
  d = fromFrame(s, d.x, d.y);
  SegmentRecord segment;
  segment.first = vec4(a.x, a.y, b.x, b.y);
  segment.second = vec4(c.x, c.y, d.x, d.y);
  segment.ends = vec4(a.x, a.y, d.x, d.y);
  segment.path = 0u;
  segment.side = inner ? -side : side;
  segment.line = at < 4u ? 1u : 0u;
  segment.pad0 = 0u;
  return segment;
}

GPGP_SHADER_END
#endif
