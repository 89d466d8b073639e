// GpgpCompactInstance: a terminal in 32 bytes, as position, rotation, extents. gpgp/shaders/compact_instance.h reads
// it.
//
// The rotation is a quaternion without its largest component, 15 bits for each of the others, whose steps are
// 2 sqrt(1/2) / 32767. Errors of half a step in three components, and of up to three times that in the recovered one,
// turn a point by at most 1.5e-4 of its distance, which is sqrt(3)/2 of the largest extent or less. Half floats round
// extents by at most 2^-11 of their size. Both together: 1.3e-4 + 4.3e-4 of the largest extent.
#ifndef GPGP_SHADERS_SPAWN_COMPACT_H
#define GPGP_SHADERS_SPAWN_COMPACT_H
#include "spawn/shared/shape.h"

#ifdef __cplusplus
namespace gpgp::shader {
using glm::inversesqrt;
using glm::length;
using glm::uvec3;
} // namespace gpgp::shader
#endif

GPGP_SHADER_BEGIN

struct CompactInstance {
  uvec4 first;  // position, seed
  uvec4 second; // scale and terminal; rotation and shape: 16 bits each
};

/// The unit quaternion x, y, z, w of a rotation, whose columns are x, y, z.
GPGP_FN vec4 quaternionOf(vec3 x, vec3 y, vec3 z) {
  // Each is four times the square of a component; the largest one is at least 1.
  const vec4 squares =
      vec4(1.0f + x.x - y.y - z.z, 1.0f - x.x + y.y - z.z, 1.0f - x.x - y.y + z.z, 1.0f + x.x + y.y + z.z);
  vec4 q = vec4(y.z - z.y, z.x - x.z, x.y - y.x, squares.w);
  float largest = squares.w;
  if (squares.x > largest) {
    largest = squares.x;
    q = vec4(squares.x, x.y + y.x, z.x + x.z, y.z - z.y);
  }
  if (squares.y > largest) {
    largest = squares.y;
    q = vec4(x.y + y.x, squares.y, y.z + z.y, z.x - x.z);
  }
  if (squares.z > largest) {
    largest = squares.z;
    q = vec4(z.x + x.z, y.z + z.y, squares.z, x.y - y.x);
  }
  const float scale = inversesqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return vec4(q.x * scale, q.y * scale, q.z * scale, q.w * scale);
}

/// A half float, rounded to the nearest; devices round packHalf2x16 as they like.
GPGP_FN uint halfBits(float value) {
  const uint bits = floatBitsToUint(value), size = bits & 0x7fffffffu, least = 113u << 23; // 2^-14
  const uint rounded = size < least ? 0u : min((size + 0x1000u - (112u << 23)) >> 13, 0x7bffu);
  return rounded | ((bits >> 16) & 0x8000u);
}

GPGP_FN uint quaternionBits(float component) {
  return uint(clamp(floor((component * 0.70710678f + 0.5f) * 32767.0f + 0.5f), 0.0f, 32767.0f));
}
/// 15 bits a component, and which is missing.
GPGP_FN uvec3 packRotation(vec4 q) {
  uint missing = 3u;
  float largest = q.w;
  vec3 rest = vec3(q.x, q.y, q.z);
  if (abs(q.x) > abs(largest)) {
    missing = 0u;
    largest = q.x;
    rest = vec3(q.y, q.z, q.w);
  }
  if (abs(q.y) > abs(largest)) {
    missing = 1u;
    largest = q.y;
    rest = vec3(q.x, q.z, q.w);
  }
  if (abs(q.z) > abs(largest)) {
    missing = 2u;
    largest = q.z;
    rest = vec3(q.x, q.y, q.w);
  }
  const float turn = largest < 0.0f ? -1.0f : 1.0f;
  return uvec3(quaternionBits(rest.x * turn) | (missing & 1u) << 15,
               quaternionBits(rest.y * turn) | (missing >> 1) << 15, quaternionBits(rest.z * turn));
}

/// A terminal under the rows of its axiom's transform, which has no shear.
GPGP_FN CompactInstance compactInstance(Shape s, vec4 row0, vec4 row1, vec4 row2, uint terminal) {
  const vec3 a = vec3(row0.x, row0.y, row0.z), b = vec3(row1.x, row1.y, row1.z), c = vec3(row2.x, row2.y, row2.z);
  vec3 x = vec3(dot(a, s.axisX), dot(b, s.axisX), dot(c, s.axisX));
  vec3 y = vec3(dot(a, s.axisY), dot(b, s.axisY), dot(c, s.axisY));
  vec3 z = vec3(dot(a, s.axisZ), dot(b, s.axisZ), dot(c, s.axisZ));
  vec3 scale = vec3(length(x), length(y), length(z));
  const bool isMirrored = dot(cross(x, y), z) < 0.0f;
  x = x * ((isMirrored ? -1.0f : 1.0f) / max(scale.x, 1e-30f));
  y = y * (1.0f / max(scale.y, 1e-30f));
  z = z * (1.0f / max(scale.z, 1e-30f));
  const float thickness = isFlat(shapeType(s)) && s.size.z == 0.0f ? 1.0f : s.size.z;
  scale = vec3(scale.x * s.size.x * (isMirrored ? -1.0f : 1.0f), scale.y * s.size.y, scale.z * thickness);
  const vec3 position = vec3(dot(a, s.position) + row0.w, dot(b, s.position) + row1.w, dot(c, s.position) + row2.w);
  const uvec3 rotation = packRotation(quaternionOf(x, y, z));
  CompactInstance made;
  made.first = uvec4(floatBitsToUint(position.x), floatBitsToUint(position.y), floatBitsToUint(position.z), s.seed);
  made.second = uvec4(halfBits(scale.x) | halfBits(scale.y) << 16, halfBits(scale.z) | terminal << 16,
                      rotation.x | rotation.y << 16, rotation.z | shapeType(s) << 16);
  return made;
}

GPGP_SHADER_END
#endif
