// Where samples lie in a pixel, and how a sample gets from the canvas into a drawing.
#ifndef GPGP_SHADERS_VECTOR_SAMPLE_H
#define GPGP_SHADERS_VECTOR_SAMPLE_H
#include "curve.h"

GPGP_SHADER_BEGIN

// Each of n samples has a column and a row of its own; which row is what spreads them evenly. n is 1, 4, 8 or 16.
GPGP_FN uint sampleRow(uint i, uint n) {
  if (n == 16u) return ((i < 8u ? 0x5ea26c08u : 0x4fb73d91u) >> ((i & 7u) * 4u)) & 15u;
  if (n == 8u) return (0x04725163u >> (i * 4u)) & 15u;
  if (n == 4u) return (0x1302u >> (i * 4u)) & 15u;
  return 0u;
}
GPGP_FN float sampleStep(uint n) { return n == 16u ? 0.0625f : (n == 8u ? 0.125f : (n == 4u ? 0.25f : 1.0f)); }

// The drawing's coordinate at a canvas point.
GPGP_FN float drawingX(ItemRecord item, float px, float py) {
  GPGP_PRECISE float x = item.inverse.x * px + (item.inverse.z * py + item.offsets.x);
  return x;
}
GPGP_FN float drawingY(ItemRecord item, float px, float py) {
  GPGP_PRECISE float y = item.inverse.y * px + (item.inverse.w * py + item.offsets.y);
  return y;
}

// Whether a point of the drawing lies in a patch; `flags` says what a tile could not decide (all: kTest...).
GPGP_FN bool insidePatch(PatchRecord p, CurveRecord left, CurveRecord right, float x, float y, float tolerance,
                         uint flags) {
  if ((flags & kTestRows) != 0u && (y < p.top || y >= p.bottom)) return false;
  if ((flags & kTestLeft) != 0u && !rightOfCurve(left, x, y, tolerance)) return false;
  return (flags & kTestRight) == 0u || !rightOfCurve(right, x, y, tolerance);
}

// Whether sample i of n of a pixel lies in a patch.
GPGP_FN bool sampleInside(ItemRecord item, PatchRecord p, CurveRecord left, CurveRecord right, uint pixelX, uint pixelY,
                          uint i, uint n, uint flags) {
  GPGP_PRECISE float step = sampleStep(n);
  GPGP_PRECISE float px = float(pixelX) + (float(i) + 0.5f) * step;
  GPGP_PRECISE float py = float(pixelY) + (float(sampleRow(i, n)) + 0.5f) * step;
  float x = drawingX(item, px, py);
  float y = drawingY(item, px, py);
  return insidePatch(p, left, right, x, y, item.tolerance, flags);
}

// Samples first ... first + count - 1 of n of a pixel, as bits 0 ... count - 1.
GPGP_FN uint coverageMask(ItemRecord item, PatchRecord p, CurveRecord left, CurveRecord right, uint pixelX, uint pixelY,
                          uint first, uint count, uint n, uint flags) {
  uint mask = 0u;
  for (uint i = 0u; i < count; ++i)
    if (sampleInside(item, p, left, right, pixelX, pixelY, first + i, n, flags)) mask |= 1u << i;
  return mask;
}

// Whether a pixel may have samples in a patch, from the patch's box alone: most pixels of a tile do not.
GPGP_FN bool mayTouch(ItemRecord item, PatchRecord p, uint pixelX, uint pixelY) {
  float px = float(pixelX) + 0.5f;
  float py = float(pixelY) + 0.5f;
  float x = drawingX(item, px, py);
  float y = drawingY(item, px, py);
  float margin = 2.0f * item.tolerance + 2e-6f * max(abs(x), abs(y));
  float width = 0.5f * (abs(item.inverse.x) + abs(item.inverse.z)) + margin;
  float height = 0.5f * (abs(item.inverse.y) + abs(item.inverse.w)) + margin;
  return x + width >= p.x0 && x - width <= p.x1 && y + height >= p.top && y - height <= p.bottom;
}

// What of a tile a patch covers, in terms of classifyTile; the tile's corners are taken to the drawing and the box
// around them is widened by what rounding and the curves' tolerance may shift.
GPGP_FN uint classifyPixels(ItemRecord item, PatchRecord p, CurveRecord left, CurveRecord right, float px0, float py0,
                            float px1, float py1) {
  float ax = drawingX(item, px0, py0);
  float bx = drawingX(item, px1, py0);
  float cx = drawingX(item, px0, py1);
  float dx = drawingX(item, px1, py1);
  float ay = drawingY(item, px0, py0);
  float by = drawingY(item, px1, py0);
  float cy = drawingY(item, px0, py1);
  float dy = drawingY(item, px1, py1);
  float x0 = min(min(ax, bx), min(cx, dx));
  float x1 = max(max(ax, bx), max(cx, dx));
  float y0 = min(min(ay, by), min(cy, dy));
  float y1 = max(max(ay, by), max(cy, dy));
  float margin = 2.0f * item.tolerance + 1e-6f * max(max(abs(x0), abs(x1)), max(abs(y0), abs(y1)));
  return classifyTile(p, left, right, x0 - margin, y0 - margin, x1 + margin, y1 + margin, item.tolerance);
}

GPGP_SHADER_END
#endif
