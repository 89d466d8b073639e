#version 460
#extension GL_GOOGLE_include_directive : require
// Runs the arithmetic of core/math.h and core/random.h on pairs of words: eight results each.
#include "core/math.h"
#include "core/random.h"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Input { uvec2 inputs[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Output { uint results[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= inputs.length()) return;
  const float a = uintBitsToFloat(inputs[i].x);
  const float b = uintBitsToFloat(inputs[i].y);
  const vec2 degrees = sineCosineDegrees(a);
  const vec2 radians = sineCosine(b);
  results[i * 12] = floatBitsToUint(settle(a));
  results[i * 12 + 1] = floatBitsToUint(divide(a, b));
  results[i * 12 + 2] = floatBitsToUint(squareRoot(a));
  results[i * 12 + 3] = floatBitsToUint(degrees.x);
  results[i * 12 + 4] = floatBitsToUint(degrees.y);
  results[i * 12 + 5] = floatBitsToUint(radians.x);
  results[i * 12 + 6] = floatBitsToUint(radians.y);
  results[i * 12 + 7] = floatBitsToUint(multiply(settle(a), settle(b)));
  results[i * 12 + 8] = floatBitsToUint(subtract(settle(a), settle(b)));
  results[i * 12 + 9] = floatBitsToUint(dot3(settle3(vec3(a, b, a)), settle3(vec3(b, b, a))));
  const uvec2 key = childKey(inputs[i], inputs[i].x ^ 5u);
  results[i * 12 + 10] = key.x ^ childSeed(inputs[i].x, inputs[i].y);
  results[i * 12 + 11] = key.y ^ floatBitsToUint(unitFloat(inputs[i].x));
}
