// Arithmetic that gives the same bits on every device and on the CPU.
//
// Vulkan leaves division, roots and trigonometry inexact, denormals and NaN up to the driver. Here: division and square
// root are correctly rounded (an estimate by the native operation, whatever its error, made exact by integers), sine
// and cosine are fixed polynomials, and every result is settled: zero below 2^-100, at most 2^100, never NaN, never -0,
// so that no denormal or infinity can arise from one more product or sum of settled values.
//
// Nothing here branches: these functions are inlined in hundreds of places, and what a driver's compiler takes grows
// with the square of a shader's blocks, or faster. GLSL chooses without a branch where both values are variables.
#ifndef GPGP_SHADERS_CORE_MATH_H
#define GPGP_SHADERS_CORE_MATH_H
#include "core/shared.h"

#ifdef __cplusplus
#include <cmath>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif
namespace gpgp::shader {
using std::sqrt;
}
#endif

GPGP_SHADER_BEGIN

GPGP_CONST uint kLargestBits = 0x71800000u;  // 2^100
GPGP_CONST uint kSmallestBits = 0x0d800000u; // 2^-100

/// x brought into the range in which all arithmetic here happens. NaN becomes 0.
GPGP_FN float settle(float x) {
  const uint bits = floatBitsToUint(x);
  const uint magnitude = bits & 0x7fffffffu;
  const uint limited = (bits & 0x80000000u) | min(magnitude, kLargestBits);
  // Below the smallest wraps around, NaN is above infinity.
  return uintBitsToFloat(magnitude - kSmallestBits > 0x7f800000u - kSmallestBits ? 0u : limited);
}

GPGP_CONST float kLargest = 1.2676506e30f;   // 2^100
GPGP_CONST float kSmallest = 7.8886091e-31f; // 2^-100

/// The same for what sums and products of settled values can be: never NaN. Fewer instructions.
GPGP_FN float settleFinite(float x) {
#ifdef __cplusplus // nearly always
  if (2u * (floatBitsToUint(x) - kSmallestBits) <= 2u * (kLargestBits - kSmallestBits)) return x;
#endif
  const float clamped = clamp(x, -kLargest, kLargest); // in a variable: GLSL then chooses without a branch
  return abs(x) < kSmallest ? 0.0f : clamped;
}

GPGP_FN vec3 settle3(vec3 v) { return vec3(settle(v.x), settle(v.y), settle(v.z)); }
GPGP_FN vec3 settleFinite3(vec3 v) { return vec3(settleFinite(v.x), settleFinite(v.y), settleFinite(v.z)); }
#ifdef __cplusplus
inline vec3 settleFinite3(Lanes a) {
  typedef int Bits __attribute__((vector_size(16)));
  const Lanes::Four largest = Lanes::Four{} + kLargest;
#ifdef __SSE2__
  a.v = _mm_min_ps(_mm_max_ps(a.v, -largest), largest);
#else
  a.v = a.v < -largest ? -largest : a.v > largest ? largest : a.v;
#endif
  const Lanes::Four magnitude = (Lanes::Four)((Bits)a.v & 0x7fffffff);
  return Lanes((Lanes::Four)((Bits)a.v & (Bits)(magnitude >= kSmallest)));
}
#endif

GPGP_FN bool isNan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }

GPGP_FN float add(float a, float b) {
  GPGP_PRECISE float r = a + b;
  return settleFinite(r);
}
GPGP_FN float subtract(float a, float b) {
  GPGP_PRECISE float r = a - b;
  return settleFinite(r);
}
GPGP_FN float multiply(float a, float b) {
  GPGP_PRECISE float r = a * b;
  return settleFinite(r);
}

/// A float from sign, unbiased exponent and a 25-bit root or quotient whose top bit is set, rounded to nearest even.
GPGP_FN float assemble(uint sign, int exponent, uint digits, bool inexact) {
  uint mantissa = digits >> 1;
  mantissa += digits & (mantissa | uint(inexact)) & 1u;
  const uint carry = mantissa >> 24; // then the mantissa is 2^24
  mantissa >>= carry;
  const int biased = exponent + 127 + int(carry);
  const uint bits = sign | (uint(biased) << 23) | (mantissa & 0x7fffffu);
  const uint largest = sign | kLargestBits;
  const uint limited = biased > 226 ? largest : bits;
  return uintBitsToFloat(biased < 27 ? 0u : limited);
}

/// a / b, correctly rounded. x / 0 has the largest magnitude and x's sign; 0 / 0 is 0.
GPGP_FN float divide(float a, float b) {
  const uint ua = floatBitsToUint(settle(a));
  const uint ub = floatBitsToUint(settle(b));
  const uint ma = (ua & 0x7fffffu) | 0x800000u;
  const uint mb = (ub & 0x7fffffu) | 0x800000u;
  const bool below = ma < mb;
  // The quotient's first 25 bits. Its estimate may be off by a few units; the remainder then still fits 32 bits, so
  // that it is exact although the products wrap.
  const float estimate = float(ma) / float(mb) * (below ? 33554432.0f : 16777216.0f);
  uint quotient = uint(estimate);
  int remainder = int((ma << (below ? 25u : 24u)) - quotient * mb);
  const int correction = int(floor(float(remainder) / float(mb)));
  quotient += uint(correction);
  remainder -= correction * int(mb);
  const int more = int(remainder >= int(mb)) - int(remainder < 0);
  quotient += uint(more);
  remainder -= more * int(mb);
  const int exponent = int((ua >> 23) & 0xffu) - int((ub >> 23) & 0xffu) - int(below);
  const uint sign = (ua ^ ub) & 0x80000000u;
  const float largest = uintBitsToFloat(sign | kLargestBits);
  const float finite = assemble(sign, exponent, quotient, remainder != 0);
  const float ratio = ub == 0u ? largest : finite;
  return ua == 0u ? 0.0f : ratio;
}

/// The square root, correctly rounded; 0 for negative values.
GPGP_FN float squareRoot(float x) {
  const uint bits = floatBitsToUint(settle(x));
  int exponent = int(bits >> 23) - 127;
  const int odd = exponent & 1;
  const uint mantissa = ((bits & 0x7fffffu) | 0x800000u) << uint(odd);
  exponent -= odd;
  // root = floor(sqrt(mantissa * 2^25)) has 25 bits
  uint root = uint(sqrt(float(mantissa)) * 5792.6187514802f);
  int remainder = int((mantissa << 25) - root * root);
  root += uint(int(floor(float(remainder) / (2.0f * float(root)))));
  remainder = int((mantissa << 25) - root * root);
  root += uint(int(remainder > int(2u * root)) - int(remainder < 0));
  remainder = int((mantissa << 25) - root * root);
  const float positive = assemble(0u, exponent / 2, root, remainder != 0);
  return int(bits) > 0 ? positive : 0.0f;
}

/// Sine and cosine of r in [-pi/4, pi/4] turned by whole quarters.
GPGP_FN vec2 quarterSineCosine(float r, int quarter) {
  GPGP_PRECISE float r2 = r * r;
  GPGP_PRECISE float s =
      r + r * (r2 * (-0.16666667f + r2 * (8.3333333e-3f + r2 * (-1.984127e-4f + r2 * 2.7557319e-6f))));
  GPGP_PRECISE float c =
      1.0f + r2 * (-0.5f + r2 * (4.1666667e-2f + r2 * (-1.3888889e-3f + r2 * (2.4801587e-5f - r2 * 2.755732e-7f))));
  const bool odd = (quarter & 1) != 0;
  const float x = odd ? c : s, y = odd ? s : c;
  const float minusX = -x, minusY = -y;
  return vec2(settle((quarter & 2) != 0 ? minusX : x), settle(((quarter + 1) & 2) != 0 ? minusY : y));
}

/// (sine, cosine) of an angle in degrees; exact at multiples of 90.
GPGP_FN vec2 sineCosineDegrees(float degrees) {
  GPGP_PRECISE float x = clamp(settle(degrees), -1.0e7f, 1.0e7f);
  GPGP_PRECISE float scaled = x * 0.011111111f + 0.5f;
  GPGP_PRECISE float quarters = floor(scaled);
  GPGP_PRECISE float rest = x - quarters * 90.0f;
  GPGP_PRECISE float radians = settle(rest) * 0.017453292f;
  return quarterSineCosine(radians, int(quarters));
}

/// (sine, cosine) of an angle in radians; meant for |x| up to some thousands.
GPGP_FN vec2 sineCosine(float radians) {
  GPGP_PRECISE float x = clamp(settle(radians), -1.0e6f, 1.0e6f);
  GPGP_PRECISE float scaled = x * 0.63661977f + 0.5f;
  GPGP_PRECISE float quarters = floor(scaled);
  // pi / 2 in three pieces of few bits, so that each product is exact
  GPGP_PRECISE float rest = x - quarters * 1.5703125f;
  rest = rest - quarters * 4.83751297e-4f;
  rest = rest - quarters * 7.5497901e-8f;
  return quarterSineCosine(settle(rest), int(quarters));
}

GPGP_FN float dot3(vec3 a, vec3 b) {
  GPGP_PRECISE float r = a.x * b.x + a.y * b.y + a.z * b.z;
  return settle(r);
}

GPGP_SHADER_END
#endif
