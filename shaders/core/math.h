// Arithmetic that gives the same bits on every device and on the CPU.
//
// Vulkan leaves division, roots and trigonometry inexact, denormals and NaN up to the driver. Here: division and square
// root are correctly rounded (an estimate by the native operation, whatever its error, made exact by integers), sine
// and cosine are fixed polynomials, and every result is settled: zero below 2^-100, at most 2^100, never NaN, never -0,
// so that no denormal or infinity can arise from one more product or sum of settled values.
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
  const uint exponent = (bits >> 23) & 0xffu;
  if (exponent < 27u) return 0.0f;
  if (exponent > 226u) {
    if (exponent == 255u && (bits & 0x7fffffu) != 0u) return 0.0f;
    return uintBitsToFloat((bits & 0x80000000u) | kLargestBits);
  }
  return x;
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
  if ((digits & 1u) != 0u && (inexact || (mantissa & 1u) != 0u)) mantissa += 1u;
  if (mantissa == 0x1000000u) {
    mantissa = 0x800000u;
    exponent += 1;
  }
  const int biased = exponent + 127;
  if (biased < 27) return 0.0f;
  if (biased > 226) return uintBitsToFloat(sign | kLargestBits);
  return uintBitsToFloat(sign | (uint(biased) << 23) | (mantissa & 0x7fffffu));
}

/// a / b, correctly rounded. x / 0 has the largest magnitude and x's sign; 0 / 0 is 0.
GPGP_FN float divide(float a, float b) {
  const uint ua = floatBitsToUint(settle(a));
  const uint ub = floatBitsToUint(settle(b));
  if (ua == 0u) return 0.0f;
  if (ub == 0u) return uintBitsToFloat((ua & 0x80000000u) | kLargestBits);
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
  if (remainder < 0) {
    quotient -= 1u;
    remainder += int(mb);
  } else if (remainder >= int(mb)) {
    quotient += 1u;
    remainder -= int(mb);
  }
  const int exponent = int((ua >> 23) & 0xffu) - int((ub >> 23) & 0xffu) - (below ? 1 : 0);
  return assemble((ua ^ ub) & 0x80000000u, exponent, quotient, remainder != 0);
}

/// The square root, correctly rounded; 0 for negative values.
GPGP_FN float squareRoot(float x) {
  const uint bits = floatBitsToUint(settle(x));
  if (bits == 0u || (bits & 0x80000000u) != 0u) return 0.0f;
  int exponent = int(bits >> 23) - 127;
  uint mantissa = (bits & 0x7fffffu) | 0x800000u;
  if ((exponent & 1) != 0) {
    mantissa <<= 1;
    exponent -= 1;
  }
  // root = floor(sqrt(mantissa * 2^25)) has 25 bits
  uint root = uint(sqrt(float(mantissa)) * 5792.6187514802f);
  int remainder = int((mantissa << 25) - root * root);
  root += uint(int(floor(float(remainder) / (2.0f * float(root)))));
  remainder = int((mantissa << 25) - root * root);
  if (remainder < 0) {
    root -= 1u;
    remainder = int((mantissa << 25) - root * root);
  } else if (remainder > int(2u * root)) {
    root += 1u;
    remainder = int((mantissa << 25) - root * root);
  }
  return assemble(0u, exponent / 2, root, remainder != 0);
}

/// Sine and cosine of r in [-pi/4, pi/4] turned by whole quarters.
GPGP_FN vec2 quarterSineCosine(float r, int quarter) {
  GPGP_PRECISE float r2 = r * r;
  GPGP_PRECISE float s =
      r + r * (r2 * (-0.16666667f + r2 * (8.3333333e-3f + r2 * (-1.984127e-4f + r2 * 2.7557319e-6f))));
  GPGP_PRECISE float c =
      1.0f + r2 * (-0.5f + r2 * (4.1666667e-2f + r2 * (-1.3888889e-3f + r2 * (2.4801587e-5f - r2 * 2.755732e-7f))));
  s = settle(s);
  c = settle(c);
  const int turns = quarter & 3;
  if (turns == 0) return vec2(s, c);
  if (turns == 1) return vec2(c, settle(-s));
  if (turns == 2) return vec2(settle(-s), -c);
  return vec2(-c, s);
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
