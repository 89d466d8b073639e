// A shader whose loops are as long as a list says at its end whether the device has ended them.
#include "core/turns.h"

void sayIfEnded() {
  if (loopsWereEnded(min(params.cameraCount, 1u))) atomicOr(counters.ended, 1u);
}
