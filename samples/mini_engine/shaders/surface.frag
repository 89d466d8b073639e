#version 450
#extension GL_GOOGLE_include_directive : require
// One sun, light from the sky, haze. Surfaces without a normal are flat and take it from their slope on the screen.
#include "common.glsl"
layout(location = 0) in vec3 world;
layout(location = 1) in vec3 normal;
#ifdef FLAT_COLOUR
layout(location = 2) flat in vec3 colour;
#else
layout(location = 2) in vec3 colour;
#endif
#ifdef FADES
layout(location = 3) flat in float share;
layout(location = 4) flat in uint pattern;
#endif
layout(push_constant) uniform Push {
  mat4 viewProjection;
  vec4 eye; // w: daylight
} push;
layout(location = 0) out vec4 result;

#ifdef FADES
// Whether an instance keeps this pixel: as many as its share says, the same ones in every frame.
bool keeps() {
  uvec2 pixel = uvec2(gl_FragCoord.xy);
  uint h = pattern ^ (pixel.x * 0x9e3779b1u) ^ (pixel.y * 0x85ebca77u);
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return float((h ^ (h >> 15)) >> 8) / 16777216.0 < share;
}
#endif

void main() {
#ifdef FADES
  if (!keeps()) discard;
#endif
  vec3 n = dot(normal, normal) > 0.0 ? normal : cross(dFdx(world), dFdy(world));
#ifdef FLAT_COLOUR
  const float shine = 0.35;
#else
  const float shine = 0.0;
#endif
  result = vec4(byLight(haze(lit(colour, world, n, push.eye.xyz, shine), push.eye.xyz, world), push.eye.w), 1.0);
}
