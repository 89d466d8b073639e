// An engine's shader between two derivations: instances of one terminal become axioms.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpgp/shaders/axioms.h"
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Instances { uvec4 instances[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Axioms { uvec4 axioms[]; };
layout(std430, set = 0, binding = 2) buffer Counter { uint counter; };
layout(std430, set = 0, binding = 3) readonly buffer Count { uint instanceCount; };
layout(push_constant) uniform Constants {
  uint lotTerminal;
  uint start;
  uint mostAxioms;
};

void main() {
  uint number = gl_GlobalInvocationID.x;
  if (number >= instanceCount) return;
  uvec4 words[6];
  for (int i = 0; i < 6; ++i) words[i] = instances[number * 6u + uint(i)];
  if (gpgpInstanceTerminal(words[3]) != lotTerminal) return;
  uint place = atomicAdd(counter, 1u);
  if (place >= mostAxioms) return;
  for (int i = 0; i < 6; ++i) axioms[place * 6u + uint(i)] = gpgpAxiomWord(words, i, start);
}
