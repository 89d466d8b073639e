// Exact integers for the rasteriser, and which floats it computes with.
//
// Guarantees: every function gives the same bits on every device and in the CPU reference. 64-bit integers are two
// 32-bit words, because shaderInt64 is not part of the baseline.
#ifndef GPGP_SHADERS_VISIBILITY_EXACT_H
#define GPGP_SHADERS_VISIBILITY_EXACT_H
#include "core/shared.h"

GPGP_SHADER_BEGIN

#ifdef __cplusplus // GLSL's built-in functions
inline void imulExtended(int a, int b, int& high, int& low) {
  const std::int64_t product = std::int64_t(a) * b;
  high = static_cast<int>(product >> 32);
  low = static_cast<int>(product);
}
inline uint uaddCarry(uint a, uint b, uint& carry) {
  carry = a + b < a ? 1u : 0u;
  return a + b;
}
#endif

/// A signed 64-bit integer: high * 2^32 + low.
struct Wide {
  int high;
  uint low;
};

GPGP_FN Wide wideProduct(int a, int b) {
  int high = 0;
  int low = 0;
  imulExtended(a, b, high, low);
  Wide r;
  r.high = high;
  r.low = uint(low);
  return r;
}

GPGP_FN Wide wideSum(Wide a, Wide b) {
  uint carry = 0u;
  Wide r;
  r.low = uaddCarry(a.low, b.low, carry);
  r.high = a.high + b.high + int(carry);
  return r;
}

/// -1, 0 or 1
GPGP_FN int wideSign(Wide a) {
  if (a.high < 0) return -1;
  return a.high == 0 && a.low == 0u ? 0 : 1;
}

/// The nearest float of a number below 2^48 in magnitude; one rounding.
GPGP_FN float wideToFloat(Wide a) {
  GPGP_PRECISE float top = float(a.high * 256 + int(a.low >> 24u));
  GPGP_PRECISE float bottom = float(a.low & 0xffffffu);
  GPGP_PRECISE float sum = top * 16777216.0f + bottom;
  return sum;
}

/// A float of a number below 2^62 in magnitude; two roundings.
GPGP_FN float widerToFloat(Wide a) {
  GPGP_PRECISE float top = float(a.high >> 8);
  GPGP_PRECISE float middle = float(uint(a.high & 255) << 16u | a.low >> 16u);
  GPGP_PRECISE float bottom = float(a.low & 0xffffu);
  GPGP_PRECISE float sum = (top * 16777216.0f + middle) * 65536.0f + bottom;
  return sum;
}

GPGP_CONST int kSaturated = 1 << 30;

/// floor(a / 2^shift), held within +-2^30; shift is 0 to 8.
GPGP_FN int wideShifted(Wide a, int shift) {
  int low = shift == 0 ? int(a.low) : int((a.low >> uint(shift)) | (uint(a.high) << uint(32 - shift)));
  bool fits = (a.high >> shift) == (low >> 31);
  if (!fits) return a.high < 0 ? -kSaturated : kSaturated;
  return clamp(low, -kSaturated, kSaturated);
}

/// Whether a float is a number below 2^100 in magnitude. Looks at bits: compilers may assume that NaN does not occur.
GPGP_FN bool isModerate(float v) { return (floatBitsToUint(v) & 0x7f800000u) < (227u << 23u); }

/// Zero instead of numbers below 2^-100 in magnitude: some devices flush subnormal numbers, so none may arise.
GPGP_FN float withoutTiny(float v) { return (floatBitsToUint(v) & 0x7f800000u) < (27u << 23u) ? 0.0f : v; }

/// Whether a positive number may be divided by: 2^-100 <= v < 2^100, the range of core/math.h's divide.
GPGP_FN bool isDivisor(float v) {
  uint bits = floatBitsToUint(v);
  return bits >= (27u << 23u) && bits < (227u << 23u);
}

/// 1 / v for what isDivisor() allows, correctly rounded: core/math.h's divide(1, v) in fewer steps.
GPGP_FN float reciprocal(float v) {
  uint bits = floatBitsToUint(v);
  uint exponent = bits >> 23u;
  if ((bits & 0x7fffffu) == 0u) return uintBitsToFloat((254u - exponent) << 23u);
  uint digits = (bits & 0x7fffffu) | 0x800000u;
  // floor(2^48 / digits), 25 bits. The estimate may be off by a few units; the remainder then fits 32 bits, so that it
  // is exact although the product wraps. It is never zero, so the last bit alone decides how to round.
  float inverse = 1.0f / float(digits);
  uint quotient = uint(inverse * 281474976710656.0f);
  int remainder = int(0u - quotient * digits);
  int correction = int(floor(float(remainder) * inverse));
  quotient += uint(correction);
  remainder -= correction * int(digits);
  if (remainder < 0) quotient -= 1u;
  if (remainder >= int(digits)) quotient += 1u;
  return uintBitsToFloat(((252u - exponent) << 23u) + ((quotient + 1u) >> 1u));
}

GPGP_SHADER_END
#endif
