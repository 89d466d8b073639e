// Lets one text be GLSL and C++.
//
// A header in shaders/ that includes this file is compiled by glslang for the GPU and by g++ or clang (with GLM)
// for the CPU reference. What it may contain: plain structs, constants, and pure functions on values. What it may not:
// buffers, swizzles beyond .x .y .z .w, subgroup or derivative operations, vec3 members in structs that lie in
// buffers (std430 and C++ disagree about them).
//
//   GPGP_FN          before each function
//   GPGP_OUT(T)      an output parameter; GPGP_INOUT(T) one that is read and written
//   GPGP_PRECISE     before a float whose value decides control flow, a count, a key or a mask: no contraction,
//                    no reassociation. Only + - * on such values; division and roots come from core/math.h.
//   GPGP_CONST       before a constant at file scope
//   lanes3, lanes4   vec3 and vec4 for sums and products of vectors; C++ then works on all components at once
//   GPGP_SHADER_BEGIN / GPGP_SHADER_END around everything: namespace gpgp::shader in C++
#ifndef GPGP_SHADERS_CORE_SHARED_H
#define GPGP_SHADERS_CORE_SHARED_H

#ifdef __cplusplus
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/integer.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#define GPGP_SHADER_BEGIN namespace gpgp::shader {
#define GPGP_SHADER_END }
#define GPGP_FN inline
#define GPGP_OUT(T) T&
#define GPGP_INOUT(T) T&
#define GPGP_PRECISE
#define GPGP_CONST inline constexpr

namespace gpgp::shader {
using uint = std::uint32_t;
using glm::abs;
using glm::all;
using glm::any;
using glm::ceil;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::equal;
using glm::findMSB;
using glm::floor;
using glm::greaterThan;
using glm::greaterThanEqual;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::lessThan;
using glm::lessThanEqual;
using glm::mat3;
using glm::mat4;
using glm::max;
using glm::min;
using glm::mix;
using glm::pow;
using glm::sign;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// In GLSL it may round once or twice: only where the product is exact.
inline float fma(float a, float b, float c) { return a * b + c; }
inline uint floatBitsToUint(float v) {
  uint u;
  std::memcpy(&u, &v, sizeof u);
  return u;
}
inline float uintBitsToFloat(uint u) {
  float v;
  std::memcpy(&v, &u, sizeof v);
  return v;
}
// What GLM does in many steps.
inline float abs(float v) { return std::fabs(v); }
inline int bitCount(uint v) { return std::popcount(v); }
inline int findLSB(uint v) { return v ? std::countr_zero(v) : -1; }

/// What a register holds. Conversions are implicit, so that one text is right in both languages.
struct Lanes {
  typedef float Four __attribute__((vector_size(16)));
  Four v;
  Lanes(Four four) : v(four) {}
  Lanes(float x, float y, float z, float w) : v{x, y, z, w} {}
  Lanes(const vec3& a) : v{a.x, a.y, a.z, 0} {}
  operator vec3() const { return {v[0], v[1], v[2]}; }
  operator vec4() const { return {v[0], v[1], v[2], v[3]}; }
  friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
  friend Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
  friend Lanes operator*(Lanes a, float b) { return a.v * b; }
};
using lanes3 = Lanes;
using lanes4 = Lanes;
} // namespace gpgp::shader

#else // GLSL

#define lanes3 vec3
#define lanes4 vec4

#define GPGP_SHADER_BEGIN
#define GPGP_SHADER_END
#define GPGP_FN
#define GPGP_OUT(T) out T
#define GPGP_INOUT(T) inout T
#define GPGP_PRECISE precise
#define GPGP_CONST const

#endif
#endif
