// Shaders of software devices whose loops are as long as a drawing, or what lies over a tile, say at their end whether
// the device has ended them.
#include "core/turns.h"

void sayIfEnded() {
  if (loopsWereEnded(min(header.samples, 1))) atomicOr(counters.ended, 1);
}
