#version 460
#extension GL_GOOGLE_include_directive : require
// Counts the turns that a device makes of loops: how many, how they are nested, and which invocations make them is what
// the host says; and whether it ended one before its time.
#include "core/turns.h"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Input {
  uint one;
  uint first;      // turns of a first loop
  uint outer;      // of a second one
  uint inner;      // of a third one inside it
  uint innerLanes; // invocations that enter the third
  uint last;       // of a fourth one
};
layout(set = 0, binding = 1, std430) writeonly buffer Output { uint made[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  uvec4 turns = uvec4(0);
  uint x = i; // which no compiler knows behind a loop
  for (; turns.x < first; ++turns.x) x = x * 1664525u + 1013904223u;
  for (; turns.y < outer; ++turns.y) {
    x = x * 1664525u + 1013904223u;
    if (gl_LocalInvocationIndex < innerLanes)
      for (uint k = 0; k < inner; ++k, ++turns.z) x = x * 1664525u + 1013904223u;
  }
  for (; turns.w < last; ++turns.w) x = x * 1664525u + 1013904223u;
  made[i * 6] = turns.x;
  made[i * 6 + 1] = turns.y;
  made[i * 6 + 2] = turns.z;
  made[i * 6 + 3] = turns.w;
  made[i * 6 + 4] = loopsWereEnded(one) ? 1 : 0;
  made[i * 6 + 5] = x;
}
