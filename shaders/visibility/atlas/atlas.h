// How the atlas decides: pairs, size classes with hysteresis, lowering under pressure, and where a block lies.
//
// Guarantees: integers, and products of floats by values that the host gives: one result on every device. A block that
// keeps its class keeps its place, unless its superblock is vacated or the atlas is repacked.
#ifndef GPGP_SHADERS_VISIBILITY_ATLAS_H
#define GPGP_SHADERS_VISIBILITY_ATLAS_H
#include "visibility/atlas/layout.h"

GPGP_SHADER_BEGIN

// ---------------------------------------------------------------- pairs

/// Which edges two triangles share, run through in opposite directions: 1 + 3 * the first one's corner opposite to it +
/// the second one's. 0: none, or a triangle without three corners.
GPGP_FN uint pairCode(uvec3 a, uvec3 b) {
  if (a.x == a.y || a.y == a.z || a.z == a.x || b.x == b.y || b.y == b.z || b.z == b.x) return 0u;
  for (uint i = 0u; i < 3u; ++i) {
    uint from = i == 0u ? a.y : i == 1u ? a.z : a.x;
    uint to = i == 0u ? a.z : i == 1u ? a.x : a.y;
    if (b.y == to && b.z == from) return 1u + i * 3u;
    if (b.z == to && b.x == from) return 2u + i * 3u;
    if (b.x == to && b.y == from) return 3u + i * 3u;
  }
  return 0u;
}

/// Eight codes lie in a word. What draws that disagree have written together counts as no pair.
GPGP_FN uint codeIn(uint word, uint triangle) {
  uint code = (word >> ((triangle >> 1u) % 8u * 4u)) & 15u;
  return code > 9u ? 0u : code;
}

// ---------------------------------------------------------------- classes

/// A size of the engine's: 0 where it is negative, at most 2^30, also where it is not a number.
GPGP_FN float saneSize(uint bits) {
  if (bits >= 0x80000000u) return 0.0f;
  return uintBitsToFloat(min(bits, 0x4e800000u));
}

/// Texels that a triangle asks for: twice its area, as its block is a rectangle. A long thin one asks for a block whose
/// sides are a quarter of its own length. area, width and height are bits of GpgpTriangleSize.
GPGP_FN float texelsFor(uint area, uint width, uint height, float scale) {
  float side = max(saneSize(width), saneSize(height)) * 0.25f;
  side = min(side, 8192.0f);
  GPGP_PRECISE float square = side * side;
  GPGP_PRECISE float twice = saneSize(area) * 2.0f;
  GPGP_PRECISE float texels = max(square, twice) * scale;
  return texels;
}

/// The least class whose blocks have more texels.
GPGP_FN uint classFor(float texels) {
  int exponent = int(floatBitsToUint(texels) >> 23u) - 127;
  return uint(clamp(exponent + 1, int(kMinClass), int(kMaxClass)));
}

/// 2^exponent, of -126 to 127.
GPGP_FN float powerOfTwo(int exponent) { return uintBitsToFloat(uint(exponent + 127) << 23u); }

/// The class that a block had stays until it is a quarter too small or less than three eighths are needed of it.
GPGP_FN uint classWithHysteresis(uint before, float texels) {
  uint fresh = classFor(texels);
  if (before == 0u) return fresh;
  if (fresh == before + 1u && texels < powerOfTwo(int(before)) * 1.25f) return before;
  if (fresh + 1u == before && texels >= powerOfTwo(int(before)) * 0.375f) return before;
  return fresh;
}

GPGP_FN uint hashOf(uint triangle) {
  uint h = triangle * 0x9e3779b1u;
  h = (h ^ (h >> 15u)) * 0x85ebca77u;
  return h ^ (h >> 13u);
}

/// Least visible area first: half octaves from 2^-6 texels on, each in parts by number.
GPGP_FN uint keyFor(float texels, uint triangle) {
  uint least = (127u - 6u) * 2u;
  uint octaves = floatBitsToUint(texels) >> 22u;
  uint bin = clamp(octaves, least, least + kKeys / kKeyParts - 1u) - least;
  return bin * kKeyParts + hashOf(triangle) % kKeyParts;
}

/// The class for a key's least size: what hysteresis makes of it differs by one at most.
GPGP_FN uint classOfKey(uint key) { return uint(clamp(int(key / kKeyParts / 2u) - 5, int(kMinClass), int(kMaxClass))); }
GPGP_FN uint variantOf(uint desired, uint key) { return desired + 1u - classOfKey(key); }

/// The class under pressure: each kKeys of it lower all blocks by one class, and what remains lowers those of lesser
/// keys by one more, down to the least class. 0: dropped.
GPGP_FN uint classUnder(uint desired, uint key, uint pressure) {
  if (pressure > kDropPressure && key < pressure - kDropPressure) return 0u;
  uint steps = pressure / kKeys + (key < pressure % kKeys ? 1u : 0u);
  return desired > kMinClass + steps ? desired - steps : kMinClass;
}

// ---------------------------------------------------------------- state

/// Of a triangle that has a block of its own. Bits 0 to 9: place in the superblock, 10 to 21: superblock, 22 to 25: its
/// class, 26 to 29: the class that it would have without pressure.
GPGP_FN uint makeState(uint super, uint place, uint class_, uint desired) {
  return place | super << 10u | class_ << 22u | desired << 26u;
}
GPGP_FN uint placeOf(uint state) { return state & 1023u; }
GPGP_FN uint superOf(uint state) { return (state >> 10u) & 4095u; }
GPGP_FN uint classOf(uint state) { return (state >> 22u) & 15u; }
GPGP_FN uint desiredOf(uint state) { return (state >> 26u) & 15u; }

GPGP_FN uint placesIn(uint class_) { return 1u << (kMaxClass - class_); } ///< of a superblock
GPGP_FN uint supersFor(uint blocks, uint class_) { return (blocks + placesIn(class_) - 1u) >> (kMaxClass - class_); }

/// What becomes of a triangle's block. plan: what measuring found; vacated: of its class.
GPGP_FN uint planUnder(uint plan, uint state, uint pressure) {
  uint class_ =
      (plan & kPlanVisible) != 0u ? classUnder(plan & kPlanDesired, (plan >> kPlanKeyShift) % kKeys, pressure) : 0u;
  plan |= class_ << kPlanClassShift;
  if (classOf(state) != 0u) plan |= kPlanHad;
  return plan;
}
GPGP_FN uint planClass(uint plan) { return (plan >> kPlanClassShift) & 15u; }
GPGP_FN bool keepsPlace(uint plan, uint state, uint vacated) {
  return planClass(plan) != 0u && planClass(plan) == classOf(state) && superOf(state) + 1u != vacated;
}

/// The list that a triangle's block belongs to: a row, or kMaxRows.
GPGP_FN uint listOf(uint plan) {
  bool had = (plan & kPlanHad) != 0u;
  if (planClass(plan) == 0u) return had ? kRowGone : kMaxRows;
  if (!had) return kRowNew;
  return (plan & kPlanKeeps) != 0u ? kRowKept : kRowChanged;
}

/// Whether the emptiest superblock of a class is vacated: the others have room for its blocks and as many again.
GPGP_FN bool isVacated(uint class_, uint blocks, uint free, uint requests) {
  return blocks != 0u && blocks * 2u <= placesIn(class_) && free >= requests + placesIn(class_) * 2u;
}

/// The place of free bit number n in 32 bits; n is below their number.
GPGP_FN uint freeBit(uint used, uint n) {
  uint free = ~used;
  for (uint i = 0u; i < n; ++i) free &= free - 1u;
  return uint(findLSB(free));
}
/// Bits of a superblock's word that are places of the class.
GPGP_FN uint placeBits(uint class_) { return placesIn(class_) >= 32u ? 0xffffffffu : (1u << placesIn(class_)) - 1u; }

// ---------------------------------------------------------------- words for the engine

/// GpgpAtlasInfo::blocks, see gpgp/shaders/atlas.h. columns: superblocks side by side.
GPGP_FN uint blockWord(uint state, uint columns, uint corner, uint second) {
  uint class_ = classOf(state);
  if (class_ == 0u) return 0u;
  uint logWidth = (class_ + 1u) / 2u;
  uint logHeight = class_ / 2u;
  uint logColumns = 7u - logWidth;
  uint place = placeOf(state);
  uint x = superOf(state) % columns * kSuperSide + ((place & ((1u << logColumns) - 1u)) << logWidth);
  uint y = superOf(state) / columns * kSuperSide + ((place >> logColumns) << logHeight);
  return x / 4u | y / 4u << 11u | (logWidth - 2u) << 22u | (logHeight - 2u) << 25u | corner << 28u | second << 30u |
         1u << 31u;
}
GPGP_FN uint firstCorner(uint code) { return code == 0u ? 0u : (code - 1u) / 3u; }
GPGP_FN uint secondCorner(uint code) { return code == 0u ? 0u : (code - 1u) % 3u; }

GPGP_FN uint tilesLog(uint class_) { return class_ - kMinClass; } ///< of 4 x 4 texels

GPGP_SHADER_END
#endif
