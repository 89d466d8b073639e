// Functions of CGA programs that compute with numbers alone, equal on every device. Angles are degrees.
//
// Values are settled as in core/math.h: there is no infinity and no NaN, and x / 0 is the largest value. Logarithms,
// exponentials and arcs are polynomials, right to about 2e-7 of their value.
#ifndef GPGP_SHADERS_SPAWN_CGA_FUNCTIONS_H
#define GPGP_SHADERS_SPAWN_CGA_FUNCTIONS_H
#include "core/math.h"
#include "core/random.h"
#include "spawn/cga/program_format.h"

GPGP_SHADER_BEGIN

/// To the nearest whole number, halves away from 0.
GPGP_FN float cgaRound(float x) {
  GPGP_PRECISE float up = abs(x) + 0.5f;
  if (abs(x) >= 8388608.0f) return x;
  const float whole = floor(up);
  return settle(x < 0.0f ? -whole : whole);
}

GPGP_FN float cgaLn(float x) {
  const uint bits = floatBitsToUint(settle(x));
  if (bits == 0u || (bits & 0x80000000u) != 0u) return -kLargest;
  int exponent = int(bits >> 23) - 127;
  float m = uintBitsToFloat((bits & 0x7fffffu) | 0x3f800000u);
  if (m > 1.4142135f) {
    m *= 0.5f;
    exponent += 1;
  }
  const float s = divide(subtract(m, 1.0f), add(m, 1.0f));
  GPGP_PRECISE float s2 = s * s;
  GPGP_PRECISE float series = s * (2.0f + s2 * (0.66666667f + s2 * (0.4f + s2 * (0.28571429f + s2 * 0.22222222f))));
  GPGP_PRECISE float result = float(exponent) * 0.693147181f + series;
  return settle(result);
}

GPGP_FN float cgaExp(float x) {
  if (x > 69.3f) return kLargest;
  if (x < -69.3f) return 0.0f;
  GPGP_PRECISE float scaled = x * 1.44269504f + 0.5f;
  const float k = floor(scaled);
  GPGP_PRECISE float r = x - k * 0.693359375f;
  r = r + k * 2.12194440e-4f;
  GPGP_PRECISE float series =
      1.0f + r * (1.0f + r * (0.5f + r * (0.16666667f + r * (0.041666667f + r * (8.3333333e-3f + r * 1.3888889e-3f)))));
  return multiply(series, uintBitsToFloat(uint(int(k) + 127) << 23));
}

GPGP_FN float cgaAtan(float x) {
  float a = abs(settle(x));
  float offset = 0.0f;
  float turn = 1.0f;
  if (a > 1.0f) {
    a = divide(1.0f, a);
    offset = 90.0f;
    turn = -1.0f;
  }
  float rest = 0.0f;
  if (a > 0.41421356f) {
    a = divide(subtract(a, 1.0f), add(a, 1.0f));
    rest = 45.0f;
  }
  GPGP_PRECISE float a2 = a * a;
  GPGP_PRECISE float series =
      a *
      (1.0f - a2 * (0.33333333f -
                    a2 * (0.2f - a2 * (0.14285714f - a2 * (0.11111111f - a2 * (0.090909091f - a2 * 0.076923077f))))));
  GPGP_PRECISE float degrees = series * 57.2957795f + rest;
  GPGP_PRECISE float result = offset + turn * degrees;
  return settle(x < 0.0f ? -result : result);
}

GPGP_FN float cgaAtan2(float y, float x) {
  if (x == 0.0f) return y > 0.0f ? 90.0f : y < 0.0f ? -90.0f : 0.0f;
  const float a = cgaAtan(divide(y, x));
  if (x > 0.0f) return a;
  return y < 0.0f ? subtract(a, 180.0f) : add(a, 180.0f);
}

GPGP_FN float cgaPow(float a, float b) {
  if (b == floor(b) && abs(b) <= 64.0f) { // by products, which is right for negative bases too
    float result = 1.0f;
    float square = a;
    uint rest = uint(abs(b));
    for (int i = 0; i < 7; ++i) {
      if ((rest & 1u) != 0u) result = multiply(result, square);
      square = multiply(square, square);
      rest >>= 1;
    }
    return b < 0.0f ? divide(1.0f, result) : result;
  }
  return a <= 0.0f ? 0.0f : cgaExp(multiply(b, cgaLn(a)));
}

/// The rest with the sign of a, as CGA's %.
GPGP_FN float cgaModulo(float a, float b) {
  if (b == 0.0f) return 0.0f;
  const float q = divide(abs(a), abs(b));
  if (q >= 8388608.0f) return 0.0f;
  GPGP_PRECISE float rest = abs(a) - floor(q) * abs(b);
  if (rest < 0.0f) rest = rest + abs(b);
  if (rest >= abs(b)) rest = 0.0f;
  return settle(a < 0.0f ? -rest : rest);
}

/// Of what a function gives no number.
GPGP_FN bool cgaHasNoValue(uint function, float a) {
  return a < 0.0f && (function == kCgaLnMath || function == kCgaLog10Math || function == kCgaSqrtMath);
}

/// All of GPGP_CGA_MATH but Rand and P. b: of those with two arguments. Conditions give 0 or 1.
GPGP_FN float cgaMath(uint function, float a, float b) {
  switch (function) {
  case kCgaAbsMath: return abs(a);
  case kCgaAcosMath: return subtract(90.0f, cgaAtan2(a, squareRoot(subtract(1.0f, multiply(a, a)))));
  case kCgaAsinMath: return cgaAtan2(a, squareRoot(subtract(1.0f, multiply(a, a))));
  case kCgaAtanMath: return cgaAtan(a);
  case kCgaAtan2Math: return cgaAtan2(a, b);
  case kCgaCeilMath: return settle(ceil(a));
  case kCgaCosMath: return sineCosineDegrees(a).y;
  case kCgaExpMath: return cgaExp(a);
  case kCgaFloorMath: return settle(floor(a));
  case kCgaIsinfMath: return abs(a) >= kLargest ? 1.0f : 0.0f;
  case kCgaIsnanMath: return 0.0f;
  case kCgaLnMath: return cgaLn(a);
  case kCgaLog10Math: return multiply(cgaLn(a), 0.43429448f);
  case kCgaMaxMath: return a > b ? a : b;
  case kCgaMinMath: return a < b ? a : b;
  case kCgaPowMath: return cgaPow(a, b);
  case kCgaRintMath: return cgaRound(a);
  case kCgaSinMath: return sineCosineDegrees(a).x;
  case kCgaSqrtMath: return squareRoot(a);
  case kCgaTanMath: {
    const vec2 sc = sineCosineDegrees(a);
    return divide(sc.x, sc.y);
  }
  }
  return 0.0f;
}

// ---------------------------------------------------------------- values

/// 0 of what is no number.
GPGP_FN float cgaNumber(CgaValue v) {
  if (v.type == kCgaBool) return v.bits != 0u ? 1.0f : 0.0f;
  return v.type == kCgaFloat || v.type == kCgaRelative || v.type == kCgaFloating ? uintBitsToFloat(v.bits) : 0.0f;
}
GPGP_FN bool cgaIsTrue(CgaValue v) { return v.type == kCgaBool ? v.bits != 0u : cgaNumber(v) != 0.0f; }
GPGP_FN CgaValue cgaMake(uint type, uint bits) {
  CgaValue v;
  v.type = type;
  v.bits = bits;
  return v;
}
GPGP_FN CgaValue cgaFloatValue(float x) { return cgaMake(kCgaFloat, floatBitsToUint(settle(x))); }
GPGP_FN CgaValue cgaBoolValue(bool b) { return cgaMake(kCgaBool, b ? 1u : 0u); }

GPGP_FN bool cgaCompare(uint code, float a, float b) {
  switch (code) {
  case kCgaEqualCode: return a == b;
  case kCgaNotEqualCode: return a != b;
  case kCgaLessCode: return a < b;
  case kCgaLessEqualCode: return a <= b;
  case kCgaGreaterCode: return a > b;
  }
  return a >= b;
}

GPGP_SHADER_END
#endif
