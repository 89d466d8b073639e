// What is measured of each axiom's terminals: box, sums, and which cells of a grid they occupy.
//
// Everything is merged by integer sums, maxima and bits, so that the result does not depend on any order: sums are
// 64-bit numbers in units of 2^-16, boxes are keys (boxes.h), cells are bits.
#ifndef GPGP_SHADERS_SPAWN_MEASURE_H
#define GPGP_SHADERS_SPAWN_MEASURE_H
#include "core/math.h"
#include "spawn/outputs/boxes.h"

GPGP_SHADER_BEGIN

// Bindings of descriptor set 0, behind those of spawn/shared/layout.h.
GPGP_CONST int kBindMeasured = 23;
GPGP_CONST int kBindMeasuring = 24;

// GpgpAxiomMeasures, in words
GPGP_CONST uint kMeasuredTerminals = 6u;
GPGP_CONST uint kMeasuredClamped = 7u;
GPGP_CONST uint kMeasuredSums = 8u; // two words each, the lower one first
GPGP_CONST uint kMeasuredCells = 16u;
GPGP_CONST uint kMeasuredMatching = 17u;
GPGP_CONST uint kMeasuredWords = 18u;

GPGP_CONST uint kMostMeasures = 4u;
GPGP_CONST uint kMostGridWords = 1024u; // of an axiom: bounds the turns of a loop for each terminal
GPGP_CONST uint kAllTerminals = 0xffffffffu;

/// What a recording measures. The target's bits follow in the buffer.
struct Measuring {
  vec4 origin;       // of the grid, in the world
  vec4 perMetre;     // cells
  uvec4 cells;       // along x, y and z; words of a row along x
  uvec4 measures[2]; // terminal and factors of two each
  uint count;        // of measures
  uint axioms;       // that there is room for
  uint gridWords;    // of an axiom, 0: no grid
  uint firstGrid;    // word, behind the axioms' measures
};

/// The product of what `factors` names: 1 x, 2 y, 4 z, 8 attribute.
GPGP_FN float measuredValue(uint factors, vec3 size, float custom) {
  GPGP_PRECISE float value = 1.0f;
  if ((factors & 1u) != 0u) value = value * size.x;
  if ((factors & 2u) != 0u) value = value * size.y;
  if ((factors & 4u) != 0u) value = value * size.z;
  if ((factors & 8u) != 0u) value = value * custom;
  return value;
}

/// Beyond, values are clamped, and counted as such: 2^24 of them add up to 63 bits.
GPGP_CONST float kMostMeasured = 8388608.0f;
GPGP_FN bool measuresTooMuch(float value) { return !(abs(value) <= kMostMeasured); }

/// A value in units of 2^-16, rounded toward zero, as the low and high word of a 64-bit number. NaN becomes 0.
GPGP_FN uvec2 fixedOf(float value) {
  if (isNan(value)) return uvec2(0u, 0u);
  const uint bits = floatBitsToUint(clamp(value, -kMostMeasured, kMostMeasured));
  const uint mantissa = (bits & 0x7fffffu) | 0x800000u;
  const int shift = int((bits >> 23) & 0xffu) - 134; // exponent - 127 - 23 + 16
  if (shift <= -24) return uvec2(0u, 0u);
  uvec2 fixedPoint =
      shift <= 0 ? uvec2(mantissa >> uint(-shift), 0u) : uvec2(mantissa << uint(shift), mantissa >> uint(32 - shift));
  if ((bits >> 31) != 0u) {
    const uint low = ~fixedPoint.x + 1u;
    fixedPoint = uvec2(low, ~fixedPoint.y + (low == 0u ? 1u : 0u));
  }
  return fixedPoint;
}

/// The cells along an axis whose centres lie between two places, first and last; none where first > last. A single cell
/// is met by all that touches it.
GPGP_FN uvec2 cellsBetween(float low, float high, float origin, float perMetre, uint cells) {
  GPGP_PRECISE float from = (low - origin) * perMetre;
  GPGP_PRECISE float to = (high - origin) * perMetre;
  if (cells == 1u) return from <= 1.0f && to >= 0.0f ? uvec2(0u, 0u) : uvec2(1u, 0u);
  GPGP_PRECISE float first = max(ceil(from - 0.5f), 0.0f);
  GPGP_PRECISE float last = min(floor(to - 0.5f), float(cells - 1u));
  return first <= last ? uvec2(uint(first), uint(last)) : uvec2(1u, 0u);
}

/// The bits of a word of a row, for the cells first to last.
GPGP_FN uint cellBits(uint word, uint first, uint last) {
  const uint begin = word * 32u, from = max(first, begin) - begin, to = min(last, begin + 31u) - begin;
  return (0xffffffffu << from) & (0xffffffffu >> (31u - to));
}

GPGP_SHADER_END
#endif
