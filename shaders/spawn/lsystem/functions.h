// Functions of expressions that give the same bits on every device: logarithm, power, inverse tangent. Relative errors
// are some units in the last place.
#ifndef GPGP_SHADERS_SPAWN_LSYSTEM_FUNCTIONS_H
#define GPGP_SHADERS_SPAWN_LSYSTEM_FUNCTIONS_H
#include "core/math.h"

GPGP_SHADER_BEGIN

/// log2(x) for x > 0, else the least value there is.
GPGP_FN float logarithm2(float x) {
  const uint bits = floatBitsToUint(settle(x));
  if (bits == 0u || (bits & 0x80000000u) != 0u) return -128.0f;
  int exponent = int(bits >> 23) - 127;
  float m = uintBitsToFloat((bits & 0x7fffffu) | 0x3f800000u);
  if (m > 1.4142135f) {
    m = multiply(m, 0.5f);
    exponent += 1;
  }
  const float t = divide(subtract(m, 1.0f), add(m, 1.0f)); // at most 0.1716
  GPGP_PRECISE float t2 = t * t;
  GPGP_PRECISE float s =
      t * (2.8853900f + t2 * (0.96179669f + t2 * (0.57707802f + t2 * (0.41219858f + t2 * 0.32059889f))));
  return add(float(exponent), settle(s));
}

/// 2^x.
GPGP_FN float exponential2(float x) {
  const float limited = clamp(settle(x), -110.0f, 110.0f);
  GPGP_PRECISE float shifted = limited + 0.5f;
  GPGP_PRECISE float whole = floor(shifted);
  GPGP_PRECISE float f = (limited - whole) * 0.69314718f; // at most 0.3466
  GPGP_PRECISE float p =
      1.0f +
      f * (1.0f + f * (0.5f + f * (0.16666667f + f * (4.1666667e-2f + f * (8.3333333e-3f + f * 1.3888889e-3f)))));
  const float scale = uintBitsToFloat(uint(int(whole) + 127) << 23);
  return multiply(settle(p), scale);
}

/// base to the power of exponent. Whole exponents up to 64 are products. Of a negative base, other powers are 0.
GPGP_FN float power(float base, float exponent) {
  const float whole = floor(exponent);
  if (whole == exponent && abs(exponent) <= 64.0f) {
    uint left = uint(abs(exponent));
    float square = base;
    float product = 1.0f;
    for (uint bit = 0u; bit < 7u; ++bit) {
      if ((left & 1u) != 0u) product = multiply(product, square);
      left >>= 1;
      square = multiply(square, square);
    }
    return exponent < 0.0f ? divide(1.0f, product) : product;
  }
  if (base <= 0.0f) return 0.0f;
  return exponential2(multiply(exponent, logarithm2(base)));
}

/// The angle of (x, y) in degrees, in (-180, 180]. That of (0, 0) is 0.
GPGP_FN float arcTangentDegrees(float y, float x) {
  const float ax = abs(x);
  const float ay = abs(y);
  if (ax == 0.0f && ay == 0.0f) return 0.0f;
  const bool steep = ay > ax;
  float t = steep ? divide(ax, ay) : divide(ay, ax); // in [0, 1]
  float offset = 0.0f;
  if (t > 0.41421356f) { // tan(22.5): turned by 45 degrees
    t = divide(subtract(t, 1.0f), add(t, 1.0f));
    offset = 45.0f;
  }
  GPGP_PRECISE float t2 = t * t;
  GPGP_PRECISE float series =
      t *
      (57.295780f +
       t2 * (-19.098593f +
             t2 * (11.459156f + t2 * (-8.1851113f +
                                      t2 * (6.3661977f + t2 * (-5.2087072f + t2 * (4.4073677f + t2 * -3.8197186f)))))));
  float angle = add(offset, settle(series));
  if (steep) angle = subtract(90.0f, angle);
  if (x < 0.0f) angle = subtract(180.0f, angle);
  return y < 0.0f ? settle(-angle) : angle;
}

GPGP_FN float arcSineDegrees(float x) {
  const float s = clamp(x, -1.0f, 1.0f);
  return arcTangentDegrees(s, squareRoot(multiply(subtract(1.0f, s), add(1.0f, s))));
}

GPGP_SHADER_END
#endif
