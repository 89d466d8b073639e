// The same through glslang's HLSL front end.
#define GPGP_HLSL 1
#include "gpgp/shaders/axioms.h"

[[vk::binding(0, 0)]] StructuredBuffer<uint4> instances;
[[vk::binding(1, 0)]] RWStructuredBuffer<uint4> axioms;
[[vk::binding(2, 0)]] RWStructuredBuffer<uint> counter;

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
  uint4 words[6];
  for (int i = 0; i < 6; ++i) words[i] = instances[id.x * 6 + i];
  if (gpgpInstanceTerminal(words[3]) != 2) return;
  uint place;
  InterlockedAdd(counter[0], 1, place);
  for (int j = 0; j < 6; ++j) axioms[place * 6 + j] = gpgpAxiomWord(words, j, 0);
}
