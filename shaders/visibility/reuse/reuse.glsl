// A history that keeps decisions (reuse.h), as passes read it. Of each triangle it has four bits: whether it was
// visible; whether it was on the screen then; whether it is on the screen now; and, until bin_allocate.comp adds them
// to the visible bits, whether it is kept. Behind these arrays lies the state. Needs `params` and `counters`.
#include "visibility/reuse/reuse.h"
layout(std430, set = 0, binding = kBindView) buffer ViewBuffer { uint viewBits[]; };

uint knownAt(uint word) { return params.viewWords + word; }
uint metAt(uint word) { return params.viewWords * 2u + word; }
uint retainedAt(uint word) { return params.viewWords * 3u + word; }
uint stateAt(uint which) { return params.viewWords * kReuseArrays + which; }

/// Whether a word's triangles are decided again.
bool isDue(uint word) { return isDue(word, counters.reuseFirst, counters.reuseShare); }

/// Whether a triangle's last decision is taken over. What was not on the screen has none.
bool isReused(uint id) {
  uint word = id >> 5u;
  return params.reuse != 0u && !isDue(word) && (viewBits[knownAt(word)] & (1u << (id & 31u))) != 0u;
}
bool wasVisible(uint id) { return (viewBits[id >> 5u] & (1u << (id & 31u))) != 0u; }

/// Notes that a triangle whose last decision is taken over is still visible. Apart from the visible bits, so that these
/// tell other triangles of the pass what is at pixel centres, whatever the order of execution.
void retain(uint id) { atomicOr(viewBits[retainedAt(id >> 5u)], 1u << (id & 31u)); }

/// Notes that a triangle is on the screen.
void meet(uint id) {
  uint bit = 1u << (id & 31u);
  if (params.reuse != 0u && (viewBits[metAt(id >> 5u)] & bit) == 0u) atomicOr(viewBits[metAt(id >> 5u)], bit);
}
