// Reads GpgpCompactInstance in a vertex shader, in GLSL and HLSL. See docs/guide/world.md.
//
// Before it is included, define GPGP_COMPACT_LOAD(index): the uvec4 (uint4) number `index` of the buffer; an instance
// is two of them. Number instances as the draw does: in GLSL gl_InstanceIndex, which contains firstInstance.
//
//   layout(std430, set = 0, binding = 0) readonly buffer Instances { uvec4 instances[]; };
//   #define GPGP_COMPACT_LOAD(index) instances[index]
//   #include "gpgp/shaders/compact_instance.h"
//   GpgpCompact i = gpgpCompactInstance(uint(gl_InstanceIndex));
//   gl_Position = viewProjection * vec4(gpgpCompactPoint(i, position), 1);
#ifndef GPGP_SHADERS_COMPACT_INSTANCE_H
#define GPGP_SHADERS_COMPACT_INSTANCE_H
#include "gpgp/shaders/language.h"

GPGP_SHADER_BEGIN

struct GpgpCompact {
  vec3 position; // world space
  vec3 scale;    // extents in the world; the first is negative where the instance is mirrored
  vec4 rotation; // unit quaternion x, y, z, w
  uint seed;
  uint terminal; // index into gpgpGetGrammarTerminals
  uint shape;    // a GpgpShape
};

// 16 bits of a half float, which is no infinity and no NaN.
GPGP_FN float gpgpHalf(uint bits) {
  const float size = uintBitsToFloat((bits & 0x7fffu) << 13) * uintBitsToFloat(0x77800000u); // 2^112
  return (bits & 0x8000u) != 0u ? -size : size;
}
GPGP_FN float gpgpQuaternionPart(uint bits) { return (float(bits & 0x7fffu) * (1.0f / 32767.0f) - 0.5f) * 1.41421356f; }
GPGP_FN vec4 gpgpCompactRotation(uint xy, uint z) {
  const vec3 rest = vec3(gpgpQuaternionPart(xy), gpgpQuaternionPart(xy >> 16), gpgpQuaternionPart(z));
  const uint missing = ((xy >> 15) & 1u) | ((xy >> 30) & 2u);
  const float squares = rest.x * rest.x + rest.y * rest.y + rest.z * rest.z;
  const float largest = sqrt(max(1.0f - squares, 0.0f));
  if (missing == 0u) return vec4(largest, rest.x, rest.y, rest.z);
  if (missing == 1u) return vec4(rest.x, largest, rest.y, rest.z);
  if (missing == 2u) return vec4(rest.x, rest.y, largest, rest.z);
  return vec4(rest.x, rest.y, rest.z, largest);
}

GPGP_FN GpgpCompact gpgpUnpackCompact(uvec4 first, uvec4 second) {
  GpgpCompact i;
  i.position = vec3(uintBitsToFloat(first.x), uintBitsToFloat(first.y), uintBitsToFloat(first.z));
  i.seed = first.w;
  i.scale = vec3(gpgpHalf(second.x), gpgpHalf(second.x >> 16), gpgpHalf(second.y));
  i.terminal = second.y >> 16;
  i.rotation = gpgpCompactRotation(second.z, second.w);
  i.shape = second.w >> 16;
  return i;
}

// A direction turned by the instance's rotation.
GPGP_FN vec3 gpgpRotate(vec4 q, vec3 v) {
  const vec3 axis = vec3(q.x, q.y, q.z);
  const vec3 t = cross(axis, v) * 2.0f;
  return v + t * q.w + cross(axis, t);
}
// A point of the unit shape in the world.
GPGP_FN vec3 gpgpCompactPoint(GpgpCompact i, vec3 p) {
  return i.position + gpgpRotate(i.rotation, vec3(p.x * i.scale.x, p.y * i.scale.y, p.z * i.scale.z));
}
// A normal of the unit shape in the world, not of unit length. Extents of 0 count as very small ones.
GPGP_FN vec3 gpgpCompactNormal(GpgpCompact i, vec3 n) {
  const float least = 1e-8f; // half floats go down to 6e-8
  const vec3 s = vec3(abs(i.scale.x) < least ? least : i.scale.x, abs(i.scale.y) < least ? least : i.scale.y,
                      abs(i.scale.z) < least ? least : i.scale.z);
  return gpgpRotate(i.rotation, vec3(n.x / s.x, n.y / s.y, n.z / s.z));
}

#ifdef GPGP_COMPACT_LOAD
GPGP_FN GpgpCompact gpgpCompactInstance(uint index) {
  return gpgpUnpackCompact(GPGP_COMPACT_LOAD(2u * index), GPGP_COMPACT_LOAD(2u * index + 1u));
}
#endif

GPGP_SHADER_END
#endif
