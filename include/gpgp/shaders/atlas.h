// The shading atlas in the engine's own shaders: which point of which triangle a texel shows, and where in the atlas a
// point of a triangle lies. GLSL and HLSL; the library's CPU reference and its tests compile the same text.
//
// For HLSL define GPGP_HLSL. Nothing else is needed: all functions take values, so that the engine binds its buffers as
// it likes.
//
// To shade, a workgroup of 64 invocations takes four tiles of 4 x 4 texels (GpgpAtlasInfo::tiles):
//
//   uint number = (gl_WorkGroupID.y * 65535u + gl_WorkGroupID.x) * 4u + gl_LocalInvocationIndex / 16u;
//   if (number >= tileCount) return;                          // word 4 of the bucket's arguments
//   uvec2 tile = tiles[firstTile + number];                   // word 3: firstTile
//   uint second = tile.x + 1u < triangleCount ? blocks[tile.x + 1u] : 0u;
//   GpgpAtlasTexel texel = gpgpAtlasTexel(blocks[tile.x], second, tile.y, gl_LocalInvocationIndex % 16u, gutter);
//   if (!texel.shown) return;
//   uint triangle = tile.x + texel.second;
//   // position = a * texel.weights.x + b * texel.weights.y + c * texel.weights.z, with the corners a, b, c of triangle
//   imageStore(atlas, ivec2(texel.place), color);
//
// To display, where `triangle` is the number of the triangle that a fragment shows and `weights` its barycentrics:
//
//   uint block = blocks[triangle];
//   if (gpgpAtlasHasBlock(block)) color = textureLod(atlas, gpgpAtlasPoint(block, weights, gutter) / atlasSize, 0.0);
#ifndef GPGP_SHADERS_ATLAS_H
#define GPGP_SHADERS_ATLAS_H
#include "gpgp/shaders/language.h"

GPGP_SHADER_BEGIN

// Where a triangle's block lies, in texels, and how the triangle lies in it. A block is a rectangle of one triangle, or
// of two that share its diagonal: the first one's right angle is at the left top, the second one's at the right bottom.
struct GpgpAtlasBlock {
  uint x, y, width, height;
  uint corner; // 0 to 2: which of the triangle's corners is at the right angle
  uint second; // 1: the triangle is the second one of its block
};

// What one texel of a tile shows.
struct GpgpAtlasTexel {
  uvec2 place;  // in the atlas, texels
  uint second;  // 0: the block's first triangle, 1: its second one
  bool shown;   // false: no bilinear filter reads the texel
  vec3 weights; // barycentrics of the texel's centre; in gutters some are below 0 and above 1
  vec3 right;   // what one texel to the right adds to the barycentrics
  vec3 down;    // what one texel down adds
};

GPGP_FN bool gpgpAtlasHasBlock(uint block) { return (block >> 31u) != 0u; }

// Of a word of GpgpAtlasInfo::blocks. All zero where the triangle has no block.
GPGP_FN GpgpAtlasBlock gpgpAtlasBlock(uint block) {
  GpgpAtlasBlock b;
  b.x = (block & 2047u) * 4u;
  b.y = ((block >> 11u) & 2047u) * 4u;
  b.width = gpgpAtlasHasBlock(block) ? 4u << ((block >> 22u) & 7u) : 0u;
  b.height = gpgpAtlasHasBlock(block) ? 4u << ((block >> 25u) & 7u) : 0u;
  b.corner = (block >> 28u) & 3u;
  b.second = (block >> 30u) & 1u;
  return b;
}

// Puts weights of the right angle's corner and the two that follow it into the triangle's own order, and back.
GPGP_FN vec3 gpgpAtlasTurn(vec3 w, uint corner) {
  if (corner == 1u) return vec3(w.z, w.x, w.y);
  if (corner == 2u) return vec3(w.y, w.z, w.x);
  return w;
}
GPGP_FN vec3 gpgpAtlasTurnBack(vec3 w, uint corner) {
  if (corner == 1u) return vec3(w.y, w.z, w.x);
  if (corner == 2u) return vec3(w.z, w.x, w.y);
  return w;
}

// Texels from the first texel's centre that shows the triangle's edge to the last one's.
GPGP_FN vec2 gpgpAtlasSpan(GpgpAtlasBlock b, uint gutter) {
  return vec2(float(b.width) - 1.0f - 2.0f * float(gutter), float(b.height) - 1.0f - 2.0f * float(gutter));
}

// Where the point of a triangle with these barycentrics lies, in texels from the atlas's left top; a texel's centre is
// at halves. gutter: that of the atlas. A bilinear filter at this point reads texels of the block only.
GPGP_FN vec2 gpgpAtlasPoint(uint block, vec3 weights, uint gutter) {
  GpgpAtlasBlock b = gpgpAtlasBlock(block);
  vec2 span = gpgpAtlasSpan(b, gutter);
  vec3 w = gpgpAtlasTurnBack(weights, b.corner);
  float u = b.second != 0u ? 1.0f - w.y : w.y;
  float v = b.second != 0u ? 1.0f - w.z : w.z;
  float first = 0.5f + float(gutter);
  return vec2(float(b.x) + first + u * span.x, float(b.y) + first + v * span.y);
}

// The texel `local` (0 to 15, row by row) of tile number `tile` (row by row) of a block. first: the word in
// GpgpAtlasInfo::blocks of the triangle that the tile names; second: the word behind it, or 0 where there is none.
GPGP_FN GpgpAtlasTexel gpgpAtlasTexel(uint first, uint second, uint tile, uint local, uint gutter) {
  GpgpAtlasBlock b = gpgpAtlasBlock(first);
  GpgpAtlasBlock other = gpgpAtlasBlock(second);
  bool paired = other.second != 0u;
  vec2 span = gpgpAtlasSpan(b, gutter);
  uint columns = max(b.width / 4u, 1u);
  uint x = tile % columns * 4u + local % 4u;
  uint y = tile / columns * 4u + local / 4u;
  float du = 1.0f / span.x;
  float dv = 1.0f / span.y;
  float u = (float(x) - float(gutter)) * du;
  float v = (float(y) - float(gutter)) * dv;
  GpgpAtlasTexel t;
  t.place = uvec2(b.x + x, b.y + y);
  t.second = paired && u + v > 1.0f ? 1u : 0u;
  t.shown = gpgpAtlasHasBlock(first) && y < b.height && (paired || u + v <= 1.0f + (1.0f + float(gutter)) * (du + dv));
  if (t.second != 0u) {
    t.weights = gpgpAtlasTurn(vec3(u + v - 1.0f, 1.0f - u, 1.0f - v), other.corner);
    t.right = gpgpAtlasTurn(vec3(du, -du, 0.0f), other.corner);
    t.down = gpgpAtlasTurn(vec3(dv, 0.0f, -dv), other.corner);
  } else {
    t.weights = gpgpAtlasTurn(vec3(1.0f - u - v, u, v), b.corner);
    t.right = gpgpAtlasTurn(vec3(-du, du, 0.0f), b.corner);
    t.down = gpgpAtlasTurn(vec3(-dv, 0.0f, dv), b.corner);
  }
  return t;
}

GPGP_SHADER_END
#endif
