// Boxes of terminals in the world, and as integers that only grow, which atomics merge in any order.
#ifndef GPGP_SHADERS_SPAWN_BOXES_H
#define GPGP_SHADERS_SPAWN_BOXES_H
#include "core/shared.h"

GPGP_SHADER_BEGIN

/// How far the unit shape reaches from its centre along an axis. row: of the instance's transform, for that axis.
GPGP_FN float boxReach(vec4 row, bool withoutZ) {
  GPGP_PRECISE float reach = 0.5f * (abs(row.x) + abs(row.y) + (withoutZ ? 0.0f : abs(row.z)));
  return reach;
}
GPGP_FN float boxLow(vec4 row, bool withoutZ) {
  GPGP_PRECISE float low = row.w - boxReach(row, withoutZ);
  return low;
}
GPGP_FN float boxHigh(vec4 row, bool withoutZ) {
  GPGP_PRECISE float high = row.w + boxReach(row, withoutZ);
  return high;
}

/// A float as an integer of the same order, never 0 for what is finite. Lower ends are kept turned over.
GPGP_FN uint boundKey(float value) {
  const uint word = floatBitsToUint(value);
  return (word >> 31) != 0u ? ~word : word | 0x80000000u;
}
GPGP_FN float boundValue(uint key) { return uintBitsToFloat((key >> 31) != 0u ? key & 0x7fffffffu : ~key); }
/// Of lower and upper ends; 0: nothing was added, and the box is empty.
GPGP_FN float lowOf(uint key) { return key == 0u ? uintBitsToFloat(0x7f800000u) : boundValue(~key); }
GPGP_FN float highOf(uint key) { return key == 0u ? uintBitsToFloat(0xff800000u) : boundValue(key); }

GPGP_SHADER_END
#endif
