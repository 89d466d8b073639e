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
layout(push_constant) uniform Push {
  mat4 viewProjection;
  vec4 eye;
} push;
layout(location = 0) out vec4 result;

void main() {
  vec3 toEye = push.eye.xyz - world;
  vec3 n = dot(normal, normal) > 0.0 ? normalize(normal) : normalize(cross(dFdx(world), dFdy(world)));
  if (dot(n, toEye) < 0.0) n = -n;
  vec3 light = vec3(1.0, 0.93, 0.80) * (1.25 * max(dot(n, normalize(kSun)), 0.0)) +
               vec3(0.42, 0.50, 0.62) * (0.42 + 0.26 * n.y);
  light *= 0.55 + 0.45 * smoothstep(0.0, 14.0, world.y); // less of the sky is seen from down in the streets
  vec3 halfway = normalize(normalize(kSun) + normalize(toEye));
#ifdef FLAT_COLOUR
  vec3 shine = vec3(0.35) * pow(max(dot(n, halfway), 0.0), 40.0);
#else
  vec3 shine = vec3(0.0);
#endif
  result = vec4(haze(colour * light + shine, push.eye.xyz, world), 1.0);
}
