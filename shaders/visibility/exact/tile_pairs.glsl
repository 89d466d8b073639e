// Candidates and the tiles of 8 x 8 pixels that they reach over. Needs lists.glsl and `counters`.
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
#include "visibility/exact/candidates.glsl"
layout(std430, set = 0, binding = kBindPairs) writeonly buffer PairBuffer { uint pairs[]; };

bool isSeen(uint id) { return (bits[id >> 5u] & (1u << (id & 31u))) != 0u; }

/// What finds no room counts as visible.
void show(uint id) {
  atomicOr(bits[id >> 5u], 1u << (id & 31u));
  atomicAdd(counters.unresolved, 1u);
}

/// Counts a candidate of a tile. Returns its index among those of its kind.
uint countIn(uint tile, bool seen) { return atomicAdd(slots[tileWord(tile) + (seen ? 1u : 0u)], 1u); }

void enter(uint candidate, bool seen, uint tile, uint place, uint pair) {
  pairs[pair * kTilePairWords] = tile;
  pairs[pair * kTilePairWords + 1u] = candidate | (seen ? kIsSeen : 0u);
  pairs[pair * kTilePairWords + 2u] = place;
}
