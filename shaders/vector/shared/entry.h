// What an entry holds of a path in a tile's row of pixels, for devices with barriers: pairs of pixels (layout.h).
#ifndef GPGP_SHADERS_VECTOR_ENTRY_H
#define GPGP_SHADERS_VECTOR_ENTRY_H
#include "vector/shared/layout.h"

GPGP_SHADER_BEGIN

// Samples of pixel x of a tile's row that change sides at or left of it.
GPGP_FN uint foldRow(uvec4 row, uint x) {
  const uint lower = (x & 1u) != 0u ? ~0u : 0xffffu; // of the pair that the pixel is in
  uint sum = row.x & (x < 2u ? lower : ~0u);
  sum ^= row.y & (x < 2u ? 0u : (x < 4u ? lower : ~0u));
  sum ^= row.z & (x < 4u ? 0u : (x < 6u ? lower : ~0u));
  sum ^= row.w & (x < 6u ? 0u : lower);
  return (sum ^ (sum >> 16)) & 0xffffu;
}

GPGP_FN int differenceAt(uvec4 row, uint x) {
  const uint pair = x < 4u ? (x < 2u ? row.x : row.y) : (x < 6u ? row.z : row.w);
  const int low = int(pair << 16) >> 16;
  return (x & 1u) != 0u ? (int(pair) - low) >> 16 : low;
}

GPGP_SHADER_END
#endif
