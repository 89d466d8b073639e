// An engine's material: shades the listed tiles of one bucket. Its colour is the triangle's barycentrics and number.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpgp/shaders/atlas.h"
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Blocks { uint blocks[]; };
layout(std430, set = 0, binding = 1) readonly buffer Tiles { uvec2 tiles[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Image { vec4 image[]; };
layout(push_constant) uniform Constants {
  uint width;
  uint triangleCount;
  uint firstTile;
  uint tileCount;
  uint gutter;
};

void main() {
  uint number = (gl_WorkGroupID.y * 65535u + gl_WorkGroupID.x) * 4u + gl_LocalInvocationIndex / 16u;
  if (number >= tileCount) return;
  uvec2 tile = tiles[firstTile + number];
  uint second = tile.x + 1u < triangleCount ? blocks[tile.x + 1u] : 0u;
  GpgpAtlasTexel texel = gpgpAtlasTexel(blocks[tile.x], second, tile.y, gl_LocalInvocationIndex % 16u, gutter);
  if (!texel.shown) return;
  image[texel.place.y * width + texel.place.x] = vec4(texel.weights, float(tile.x + texel.second + 1u));
}
