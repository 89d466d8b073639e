// Where samples lie in a pixel, and how a sample gets from the canvas into a drawing.
#ifndef GPGP_SHADERS_VECTOR_SAMPLE_H
#define GPGP_SHADERS_VECTOR_SAMPLE_H
#include "vector/shared/layout.h"

GPGP_SHADER_BEGIN

// Each of n samples has a column and a row of its own; which row is what spreads them evenly. n is 1, 4, 8 or 16.
GPGP_FN uint sampleRow(uint i, uint n) {
  if (n == 16u) return ((i < 8u ? 0x5ea26c08u : 0x4fb73d91u) >> ((i & 7u) * 4u)) & 15u;
  if (n == 8u) return (0x04725163u >> (i * 4u)) & 15u;
  if (n == 4u) return (0x1302u >> (i * 4u)) & 15u;
  return 0u;
}
// The column, among n, of the sample in sample row `row` of a pixel.
GPGP_FN uint sampleColumn(uint row, uint n) {
  if (n == 16u) return ((row < 8u ? 0x4fb73d91u : 0x5ea26c08u) >> ((row & 7u) * 4u)) & 15u;
  if (n == 8u) return (0x04725163u >> (row * 4u)) & 15u;
  if (n == 4u) return (0x1302u >> (row * 4u)) & 15u;
  return 0u;
}
// Where the samples of a pixel's rows lie, from its left, in 1/256 pixel: a byte each, from row 0 on.
GPGP_FN uvec4 sampleColumns(uint n) {
  if (n == 16u) return uvec4(0x38d89818u, 0x48f8b878u, 0x68c80888u, 0x58e8a828u);
  if (n == 8u) return uvec4(0xb030d070u, 0x1090f050u, 0u, 0u);
  if (n == 4u) return uvec4(0x60e020a0u, 0u, 0u, 0u);
  return uvec4(128u, 0u, 0u, 0u);
}
GPGP_FN uint byteOf(uvec4 bytes, uint i) {
  const uint word = i < 8u ? (i < 4u ? bytes.x : bytes.y) : (i < 12u ? bytes.z : bytes.w);
  return (word >> ((i & 3u) * 8u)) & 255u;
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

GPGP_SHADER_END
#endif
