// Which tiles a path may touch, and which a flattened segment meets.
#ifndef GPGP_SHADERS_VECTOR_TILES_H
#define GPGP_SHADERS_VECTOR_TILES_H
#include "vector/shared/edge.h"

GPGP_SHADER_BEGIN

GPGP_FN int tileOf(int column) { return column >> findMSB(kTileSize); } // of column -1: -1

// Tiles of a box of pixels: left, top, right and bottom, exclusive; zeros where it has none. `tiles`: of the canvas.
GPGP_FN uvec4 tilesIn(vec2 low, vec2 high, vec2 tiles) {
  const vec2 from = clamp(floor(low / float(kTileSize)), vec2(0.0f), tiles);
  const vec2 to = clamp(ceil(high / float(kTileSize)), vec2(0.0f), tiles);
  return from.x < to.x && from.y < to.y ? uvec4(from, to) : uvec4(0u);
}

// A corner of a box that lies in a frame (ShapeRecord).
GPGP_FN vec2 cornerOf(vec4 box, vec4 frame, uint corner) {
  const float x = (corner & 1u) != 0u ? box.z : box.x, y = (corner & 2u) != 0u ? box.w : box.y;
  GPGP_PRECISE float u = frame.x + (x * frame.z - y * frame.w);
  GPGP_PRECISE float v = frame.y + (x * frame.w + y * frame.z);
  return vec2(u, v);
}

// The tiles that a path may touch, by the box that it lies in: one that is turned over has none.
GPGP_FN uvec4 tileBox(ItemRecord item, vec4 box, vec4 frame, vec2 tiles) {
  if (!(box.x <= box.z)) return uvec4(0u);
  vec2 a = vec2(3e38f), b = vec2(-3e38f);
  for (uint corner = 0u; corner < 4u; ++corner) {
    const vec2 here = cornerOf(box, frame, corner);
#if PROJECTIVE
    if (projects(item)) { // where a side of the box passes behind the eye, the cut takes the corner's place
      const uint next = (0x8du >> (corner * 2u)) & 3u; // around the box
      const vec2 there = cornerOf(box, frame, next);
      const float near = item.perspective.w;
      const float dh = depthOf(item, here.x, here.y), dt = depthOf(item, there.x, there.y);
      if ((dh < near) != (dt < near)) {
        GPGP_PRECISE float missing = near - dh;
        GPGP_PRECISE float whole = dt - dh;
        const float t = divide(missing, whole);
        GPGP_PRECISE float x = here.x + (there.x - here.x) * t;
        GPGP_PRECISE float y = here.y + (there.y - here.y) * t;
        const vec2 at = toPixel(item, x, y);
        a = min(a, at);
        b = max(b, at);
      }
      if (dh < near) continue;
    }
#endif
    const vec2 at = toPixel(item, here.x, here.y);
    a = min(a, at);
    b = max(b, at);
  }
  GPGP_PRECISE float x = 1e-5f * max(abs(a.x), abs(b.x)) + 1.0f; // far more than rounding
  GPGP_PRECISE float y = 1e-5f * max(abs(a.y), abs(b.y)) + 1.0f;
#if SCISSORS
  a = max(a, vec2(item.scissor.x, item.scissor.y));
  b = min(b, vec2(item.scissor.z, item.scissor.w));
#endif
  GPGP_PRECISE float left = a.x - x;
  GPGP_PRECISE float top = a.y - y;
  GPGP_PRECISE float right = b.x + x;
  GPGP_PRECISE float bottom = b.y + y;
  return tilesIn(vec2(left, top), vec2(right, bottom), tiles);
}

// What a flattened segment does to a row of tiles: it meets those from low to high, and where it meets the row's first
// sample row, it turns over "inside" from a tile on. Those into which it brings a change of sides across their left
// edge are met.
struct TileSpan {
  int low, high; // none: kNoTile, -1
  int turned;    // kNoTile: none
};
GPGP_CONST int kNoTile = 0x7fffffff;

GPGP_FN TileSpan tilesMet(Grid g, FlatSegment c, int row) {
  const int tileRows = int(kTileSize * g.samples), begin = row * tileRows, end = begin + tileRows;
  const int first = max(c.first, begin), last = min(c.last, end);
  const bool meets = first < last;
  TileSpan span;
  span.low = kNoTile;
  span.high = -1;
  span.turned = kNoTile;
  if (meets || (c.first != begin && c.last > begin)) {
    int from = 0, to = 0; // tiles at either end of the rows
    if (meets) {
      from = tileOf(crossingOf(g, c, first) >> 8);
      to = tileOf(crossingOf(g, c, last - 1) >> 8);
      span.low = min(from, to);
      span.high = max(from, to);
      if (first == begin) span.turned = from + 1;
    }
    if (c.first > begin) from = tileOf(columnOf(g, topEnd(c)));
    if (c.last < end) to = tileOf(columnOf(g, lastEnd(c)));
    span.low = min(span.low, min(from, to) + 1);
    span.high = max(span.high, max(from, to));
  }
  return span;
}

GPGP_SHADER_END
#endif
