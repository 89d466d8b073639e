// A shader whose loops are as long as a list says at its end whether the device has ended them.
#include "core/turns.h"

layout(constant_id = 0) const bool kEndsLoops = true; // only software devices do

void sayIfEnded() {
  if (kEndsLoops && loopsWereEnded(min(params.cameraCount, 1u))) atomicOr(counters.ended, 1u);
}
