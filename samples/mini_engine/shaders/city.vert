#version 450
// One unit box, bent into what the terminal is: a box, a flat polygon, or a triangular prism (a roof).
layout(location = 0) in vec3 corner;
layout(location = 1) in vec4 row0; // GpgpInstance::transform, as instance-rate vertex attributes
layout(location = 2) in vec4 row1;
layout(location = 3) in vec4 row2;
layout(location = 4) in uvec3 kind; // bucket, shape, axiomId
#ifdef FADES
layout(location = 5) in uint seed;
layout(location = 6) in float kept; // the instance's share of its pixels
#endif

layout(push_constant) uniform Push {
  mat4 viewProjection;
  vec4 eye;
  vec4 colour;
} push;

layout(location = 0) out vec3 world;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 colour;
#ifdef FADES
layout(location = 3) flat out float share;
layout(location = 4) flat out uint pattern;
#endif

const uint kOctagon = 5u, kPrism3 = 6u, kDynamicConvexPolygon = 12u, kDynamicPolygon = 13u; // GpgpShape

void main() {
  vec3 p = corner;
  uint shape = kind.y;
  if (shape <= kOctagon || shape == kDynamicConvexPolygon || shape == kDynamicPolygon) p.z = 0.0;
  if (shape == 0u) p.x *= 0.5 - p.y;       // a triangle, apex along +Y
  if (shape == kPrism3) p.x *= 0.5 + p.z; // it stands along Y, its triangle's apex lies along -Z
  vec4 local = vec4(p, 1.0);
  world = vec3(dot(row0, local), dot(row1, local), dot(row2, local));
  normal = vec3(0.0); // flat: the fragment shader takes it from the surface
  float tone = fract(float(kind.z) * 0.618034);
  colour = push.colour.rgb * mix(vec3(1.0), mix(vec3(0.72, 0.84, 1.02), vec3(1.28, 1.0, 0.78), tone), push.colour.a);
#ifdef FADES
  share = kept;
  pattern = seed;
#endif
  gl_Position = push.viewProjection * vec4(world, 1.0);
}
