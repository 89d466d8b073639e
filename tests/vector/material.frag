#version 460
// An engine's material, in GLSL: a drawing on a surface, lit.
#extension GL_GOOGLE_include_directive : require
layout(std430, set = 0, binding = 0) readonly buffer Patches { uvec4 patches[]; };
#define GPGP_PATCH_LOAD(slot, index) patches[index]
#include "gpgp/shaders/patches.h"
layout(location = 0) in vec2 at;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 color;

void main() {
  const vec4 paint = gpgpPaintDrawing(0u, 0u, at, dFdx(at), dFdy(at));
  const float light = max(dot(normalize(normal), vec3(0.6, 0.8, 0)), 0.0);
  color = vec4(mix(vec3(0.3), vec3(0), paint.a) + paint.rgb, 1) * light;
}
