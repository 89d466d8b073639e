// Turns of loops that a device gives to a shader.
//
// Lavapipe (LLVM's gallivm) ends loops in silence. It has one count for a shader, which each of its loops takes from,
// and one such count for the invocations that run together (a subgroup: 4, 8 or 16), which starts anew with the next
// workgroup. Found by experiment (tests/core/loops_test.cpp), the same at all three widths:
// - a loop of n turns takes n + 1, as the turn that finds its end counts as well;
// - a turn counts once, however many of the invocations make it, so that together they take as many as would the one
//   that makes most, where each of them makes turns at another time their sum;
// - a loop that none of them enters takes one, wherever the code around it is run: masks, not branches, choose;
// - loops that the compiler unrolls take none;
// - once the count is used up, every loop ends in its first turn, those of other functions included.
//
// So that no shader may rely on what is likely: the host bounds its loops, by what the graph or the drawing can take at
// most, and a shader whose loops are long asks at its end whether they were ended.
#ifndef GPGP_SHADERS_CORE_TURNS_H
#define GPGP_SHADERS_CORE_TURNS_H
#include "core/shared.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kDeviceTurns = 65535u; ///< of a software device's shader

#ifndef __cplusplus
/// Whether the device has ended a loop of this shader before its time, for an invocation of the subgroup. one: 1, as no
/// compiler may know. A loop that is ended makes its first turn all the same, so this one has two; and what is compared
/// is not the loop's own condition, which compilers take as settled behind the loop.
bool loopsWereEnded(uint one) {
  const uint two = one + one;
  uint made = 0u;
  for (uint turns = 0u; turns < two; ++turns) made += one;
  return made < two;
}
#endif

GPGP_SHADER_END
#endif
