#version 450
#extension GL_GOOGLE_include_directive : require
// Sky above the horizon, the ground with its streets below.
#include "common.glsl"
layout(location = 0) in vec3 direction;
layout(push_constant) uniform Push {
  mat4 fromClip;
  vec4 eye; // w: daylight
} push;
layout(location = 0) out vec4 result;

// How much of a pixel's footprint a line pattern covers: no shimmer in the distance.
float stripes(float position, float period, float width, float footprint) {
  float offset = abs(fract(position / period + 0.5) - 0.5) * period;
  float stripe = clamp((width * 0.5 - offset) / max(footprint, 1e-3) + 0.5, 0.0, 1.0);
  return stripe * clamp(period / footprint - 1.0, 0.0, 1.0);
}

void main() {
  vec3 d = normalize(direction);
  if (d.y > -0.001) {
    result = vec4(byLight(skyColour(d), push.eye.w), 1.0);
    return;
  }
  float distance = -push.eye.y / d.y;
  vec2 ground = push.eye.xz + d.xz * distance;
  float footprint = distance * 0.0025 / max(-d.y, 0.05);
  // Streets run between the blocks, which stand 26 m apart (city.cpp).
  float street = max(stripes(ground.x + 13.0, 26.0, 8.0, footprint), stripes(ground.y + 13.0, 26.0, 8.0, footprint));
  float line = max(stripes(ground.x + 13.0, 26.0, 0.35, footprint), stripes(ground.y + 13.0, 26.0, 0.35, footprint));
  vec3 colour = mix(vec3(0.20, 0.20, 0.18), vec3(0.055, 0.058, 0.065), street);
  colour = mix(colour, vec3(0.42, 0.38, 0.26), line);
  // Under the model, which stands across the square (54 m wide), it is dark.
  vec2 under = max(abs(ground) - vec2(17.0, 4.0), 0.0);
  colour *= 1.0 - 0.75 * exp(-dot(under, under) / 40.0);
  result = vec4(byLight(haze(colour, push.eye.xyz, vec3(ground.x, 0.0, ground.y)), push.eye.w), 1.0);
}
