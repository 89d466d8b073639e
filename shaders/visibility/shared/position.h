// Positions as engines store them: three floats, or three numbers of 16 bits, half or signed normalised.
//
// Guarantees: every 16-bit value gives the same float on every device, the one that Vulkan's formats define.
#ifndef GPGP_SHADERS_VISIBILITY_POSITION_H
#define GPGP_SHADERS_VISIBILITY_POSITION_H
#include "core/math.h"

GPGP_SHADER_BEGIN

GPGP_FN float halfToFloat(uint h) {
  uint sign_ = (h & 0x8000u) << 16u;
  uint exponent = (h >> 10u) & 31u;
  uint mantissa = h & 1023u;
  if (exponent == 31u) return uintBitsToFloat(sign_ | 0x7f800000u | (mantissa << 13u));
  if (exponent != 0u) return uintBitsToFloat(sign_ | ((exponent + 112u) << 23u) | (mantissa << 13u));
  GPGP_PRECISE float tiny = float(mantissa) * 5.9604644775390625e-8f; // 2^-24
  return uintBitsToFloat(sign_ | floatBitsToUint(tiny));
}

GPGP_FN float snormToFloat(uint v) {
  int number = int(v << 16u) >> 16;
  return number <= -32767 ? -1.0f : divide(float(number), 32767.0f);
}

GPGP_FN float unormToFloat(uint v) { return divide(float(v), 65535.0f); }

GPGP_SHADER_END
#endif
