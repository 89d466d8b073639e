// Random values without state: a value depends on its seed and its place only, never on the order of execution.
//
// Mixing is by xorshift-multiply rounds with full avalanche (constants found by the hash prospector of C. Wellons); the
// 64-bit path key is a three-round Feistel network over them, a bijection for each index, so that two paths share a
// key only by chance (2^-64).
#ifndef GPGP_SHADERS_CORE_RANDOM_H
#define GPGP_SHADERS_CORE_RANDOM_H
#include "core/shared.h"

GPGP_SHADER_BEGIN

GPGP_FN uint mixBits(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

/// The seed of child number index.
GPGP_FN uint childSeed(uint seed, uint index) { return mixBits(seed ^ mixBits(index + 0x9e3779b9u)); }

/// The path key of child number index.
GPGP_FN uvec2 childKey(uvec2 key, uint index) {
  uint left = key.x;
  uint right = key.y;
  left ^= mixBits(right + index * 0x9e3779b1u + 0x632be5abu);
  right ^= mixBits(left + index * 0x85ebca77u + 0x27d4eb2fu);
  left ^= mixBits(right + 0x165667b1u);
  return uvec2(left, right);
}

/// [0, 1) with 24 bits, exact.
GPGP_FN float unitFloat(uint bits) { return float(bits >> 8) * 5.9604645e-8f; }

/// [0, 1), from two values alone.
GPGP_FN float noise(float a, float b) {
  return unitFloat(mixBits(floatBitsToUint(a) ^ mixBits(floatBitsToUint(b) + 0x9e3779b9u)));
}

/// Number index of those that are drawn at a place in a derivation, in [0, 1). A key's halves are mixed, so that one
/// round of one of them is enough, which kernels have at each place that draws.
GPGP_FN float drawnNumber(uvec2 key, uint index) { return unitFloat(mixBits(key.y + index * 0xc2b2ae3du)); }
/// The path key behind that place: what is drawn next differs. A bijection as well.
GPGP_FN uvec2 drawnKey(uvec2 key) { return uvec2(key.x, key.y + 0x27220a95u); }

GPGP_SHADER_END
#endif
