#version 450
#extension GL_GOOGLE_include_directive : require
// The client's picture: each pixel's triangle is looked up in the atlas. What has no block gets the colour that the
// triangle had when it was last there, or else its draw's; both are counted. Beside it, where it is wanted, the picture
// that local rendering would give.
#define WITH_LIGHT
#include "surface.glsl"
#include "gpgp/shaders/atlas.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 7, std430) readonly buffer Blocks { uint blocks[]; };
layout(set = 0, binding = 8, std430) readonly buffer Atlas { uint atlas[]; }; // RGBA8
layout(set = 0, binding = 9, std430) readonly buffer TriangleColours { uint triangleColours[]; };
layout(set = 0, binding = 10, std430) readonly buffer DrawColours { uint drawColours[]; };
layout(set = 0, binding = 11, std430) readonly buffer VisibleBits { uint visibleBits[]; };
layout(set = 0, binding = 12, std430) readonly buffer Pixels { uvec4 pixels[]; }; // visible.frag
layout(set = 0, binding = 13, std430) buffer Picture { uint picture[]; };
layout(set = 0, binding = 14, std430) buffer Local { uint local[]; };
layout(set = 0, binding = 15, std430) buffer Counters { uint counters[]; };
layout(push_constant) uniform Push {
  mat4 sun;
  vec4 lantern;
  vec4 eye; // w: width of a pixel one metre away
  uint width, height, drawCount, atlasWidth;
  uint flags; // kFlag...
  uint gutter;
} push;
const uint kCompare = 1u, kMark = 2u; // display.h
const uint kAtlas = 1u, kLast = 2u, kMean = 3u, kHole = 4u, kUnseen = 5u;

shared uint counted[6];

vec4 texelAt(ivec2 at) { return unpackUnorm4x8(atlas[uint(at.y) * push.atlasWidth + uint(at.x)]); }
vec4 filtered(vec2 point) { // as a linear filter does
  vec2 at = point - 0.5;
  ivec2 first = ivec2(floor(at));
  vec2 part = at - vec2(first);
  ivec2 next = ivec2(greaterThan(part, vec2(0.0))); // no texel beyond the block's last is read
  return mix(mix(texelAt(first), texelAt(first + ivec2(next.x, 0)), part.x),
             mix(texelAt(first + ivec2(0, next.y)), texelAt(first + next), part.x), part.y);
}

void main() {
  if (gl_LocalInvocationIndex < 6u) counted[gl_LocalInvocationIndex] = 0u;
  barrier();
  uvec2 at = gl_GlobalInvocationID.xy;
  if (at.x < push.width && at.y < push.height) {
    uint place = at.y * push.width + at.x;
    uvec4 pixel = pixels[place];
    uint sky = packUnorm4x8(vec4(mix(vec3(0.38, 0.56, 0.82), vec3(0.80, 0.86, 0.90),
                                     float(at.y) / float(push.height)), 1.0));
    uint colour = sky, direct = sky;
    if (pixel.x != 0u) {
      uint triangle = pixel.x - 1u, draw = drawOf(triangle, push.drawCount);
      vec3 weights = vec3(uintBitsToFloat(pixel.y), uintBitsToFloat(pixel.z), 0.0);
      weights.z = 1.0 - weights.x - weights.y;
      uint block = blocks[triangle], source = kHole;
      colour = 0u;
      if (gpgpAtlasHasBlock(block)) {
        vec3 inside = clamp(weights, 0.0, 1.0);
        inside /= inside.x + inside.y + inside.z;
        colour = packUnorm4x8(vec4(filtered(gpgpAtlasPoint(block, inside, push.gutter)).rgb, 1.0));
        source = kAtlas;
      } else if (triangleColours[triangle] != 0u) {
        colour = triangleColours[triangle];
        source = kLast;
      } else if (drawColours[draw] != 0u) {
        colour = drawColours[draw];
        source = kMean;
      }
      if (source != kAtlas && (push.flags & kMark) != 0u) colour = packUnorm4x8(vec4(0.95, 0.0, 0.75, 1.0));
      atomicAdd(counted[0], 1u);
      atomicAdd(counted[source], 1u);
      bool found = (visibleBits[triangle / 32u] >> triangle % 32u & 1u) != 0u;
      if (source != kAtlas && !found) atomicAdd(counted[kUnseen], 1u);
      if ((push.flags & kCompare) != 0u) {
        Corners corners = cornersOf(triangle, draw);
        vec3 world = blend(corners.world, weights);
        direct = encoded(surface(draw, world, normalOf(corners, weights), distance(world, push.eye.xyz) * push.eye.w,
                                 push.sun, push.lantern));
      }
    }
    picture[place] = colour;
    if ((push.flags & kCompare) != 0u) local[place] = direct;
  }
  barrier();
  if (gl_LocalInvocationIndex < 6u) atomicAdd(counters[gl_LocalInvocationIndex], counted[gl_LocalInvocationIndex]);
}
