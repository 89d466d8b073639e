// Candidates and the tiles of 8 x 8 pixels that they reach over. Needs lists.glsl and `counters`.
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
#include "visibility/candidates.glsl"
layout(std430, set = 0, binding = kBindPairs) writeonly buffer PairBuffer { uint pairs[]; };

bool isSeen(uint id) { return (bits[id >> 5u] & (1u << (id & 31u))) != 0u; }

/// What finds no room counts as visible.
void show(uint id) {
  atomicOr(bits[id >> 5u], 1u << (id & 31u));
  atomicAdd(counters.unresolved, 1u);
}

/// Those that are seen already only hide others: a tile that has none but such needs no lists.
void enter(uint candidate, bool seen, uint tile, uint pair) {
  if (!seen) slots[tileWord(tile) + 1u] = 1u;
  pairs[pair * kTilePairWords] = tile;
  pairs[pair * kTilePairWords + 1u] = candidate | (seen ? kIsSeen : 0u);
  pairs[pair * kTilePairWords + 2u] = atomicAdd(slots[tileWord(tile)], 1u);
}
