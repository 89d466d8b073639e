// Candidates and pairs: what a triangle adds to the lists of pixels. Needs lists.glsl and `counters`.
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
#include "visibility/candidates.glsl"
layout(std430, set = 0, binding = kBindPairs) writeonly buffer PairBuffer { uvec2 pairs[]; };

bool isSeen(uint id) { return (bits[id >> 5u] & (1u << (id & 31u))) != 0u; }

/// What finds no room counts as visible.
void show(uint id) {
  atomicOr(bits[id >> 5u], 1u << (id & 31u));
  atomicAdd(counters.unresolved, 1u);
}

/// Whether a triangle is to be entered in a pixel within its bounds: it touches it (`touching`: that is known) in front
/// of its limit. One that is seen already only hides others, so it is entered where there are such.
bool isWanted(ScreenTriangle t, bool compact, bool touching, ivec2 pixel, bool seen) {
  uint slot = slotOf(pixel);
  if (seen && slots[lengthAt(slot)] == 0u) return false;
  bool reversed = params.reversedDepth != 0u;
  uint limit = slots[slot];
  if (depthKey(reversed ? t.zMax : t.zMin, reversed) > limit || !(touching || touches(t, compact, pixel))) return false;
  return limit == kFarthest || nearestKey(t, compact, pixel, reversed) <= limit;
}

void enter(uint candidate, ivec2 pixel, uint pair) {
  uint slot = slotOf(pixel);
  atomicAdd(slots[lengthAt(slot)], 1u);
  pairs[pair] = uvec2(slot, candidate);
}
