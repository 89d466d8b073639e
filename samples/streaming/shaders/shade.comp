#version 450
#extension GL_GOOGLE_include_directive : require
// Shades the tiles that gpgp's atlas lists. Texels go to a list beside that of the tiles, so that only they are read
// back.
#define WITH_LIGHT
#include "surface.glsl"
#include "gpgp/shaders/atlas.h"
layout(local_size_x = 64) in;
layout(set = 0, binding = 7, std430) readonly buffer Blocks { uint blocks[]; };
layout(set = 0, binding = 8, std430) readonly buffer Tiles { uvec2 tiles[]; };
layout(set = 0, binding = 9, std430) readonly buffer Dispatches { uint dispatches[]; };
layout(set = 0, binding = 10, std430) writeonly buffer Texels { uint texels[]; }; // 16 for each tile; 0: not shown
layout(push_constant) uniform Push {
  mat4 sun;
  vec4 lantern;
  uint triangleCount, drawCount, gutter;
} push;

void main() {
  uint number = (gl_WorkGroupID.y * 65535u + gl_WorkGroupID.x) * 4u + gl_LocalInvocationIndex / 16u;
  if (number >= dispatches[4]) return;
  uvec2 tile = tiles[number];
  uint local = gl_LocalInvocationIndex % 16u;
  uint second = tile.x + 1u < push.triangleCount ? blocks[tile.x + 1u] : 0u;
  GpgpAtlasTexel texel = gpgpAtlasTexel(blocks[tile.x], second, tile.y, local, push.gutter);
  uint colour = 0u;
  if (texel.shown) {
    uint triangle = tile.x + texel.second, draw = drawOf(triangle, push.drawCount);
    Corners corners = cornersOf(triangle, draw);
    float footprint = max(length(blend(corners.world, texel.right)), length(blend(corners.world, texel.down)));
    colour = encoded(surface(draw, blend(corners.world, texel.weights), normalOf(corners, texel.weights), footprint,
                             push.sun, push.lantern));
  }
  texels[number * 16u + local] = colour;
}
