#version 460
// An engine's vertex shader, in GLSL: unit meshes placed by compact instances.
#extension GL_GOOGLE_include_directive : require
layout(std430, set = 0, binding = 0) readonly buffer Instances { uvec4 instances[]; };
#define GPGP_COMPACT_LOAD(index) instances[index]
#include "gpgp/shaders/compact_instance.h"
layout(push_constant) uniform Camera { mat4 viewProjection; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 worldNormal;
layout(location = 1) flat out uint terminal;

void main() {
  const GpgpCompact instance = gpgpCompactInstance(uint(gl_InstanceIndex));
  worldNormal = normalize(gpgpCompactNormal(instance, normal));
  terminal = instance.terminal;
  gl_Position = viewProjection * vec4(gpgpCompactPoint(instance, position), 1);
}
