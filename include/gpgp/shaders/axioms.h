// Terminals of one derivation as axioms of the next, on the GPU: districts become lots, lots become rooms, and nothing
// comes back to the CPU in between. GLSL and HLSL; the tests compile the same text for the CPU. See
// docs/guide/world.md.
//
// The engine dispatches a shader of its own between two recordings of a spawner. Instances and axioms are six uvec4
// (uint4) each. The counter is GpgpSpawnInfo::axiomCounter of the second recording:
//
//   layout(std430, set = 0, binding = 0) readonly buffer Instances { uvec4 instances[]; };
//   layout(std430, set = 0, binding = 1) writeonly buffer Axioms { uvec4 axioms[]; };
//   layout(std430, set = 0, binding = 2) buffer Counter { uint counter; };
//
//   uvec4 words[6];
//   for (int i = 0; i < 6; ++i) words[i] = instances[number * 6u + uint(i)];
//   if (gpgpInstanceTerminal(words[3]) != lotTerminal) return;
//   uint place = atomicAdd(counter, 1u);
//   if (place >= mostAxioms) return;
//   for (int i = 0; i < 6; ++i) axioms[place * 6u + uint(i)] = gpgpAxiomWord(words, i, start);
//
// The order in which axioms lie does not matter: what becomes of one depends on its seed, its id and its size alone.
#ifndef GPGP_SHADERS_AXIOMS_H
#define GPGP_SHADERS_AXIOMS_H
#include "gpgp/shaders/language.h"

GPGP_SHADER_BEGIN

// GpgpInstance::bucket and terminal, of word 3 of an instance.
GPGP_FN uint gpgpInstanceBucket(uvec4 third) { return third.x; }
GPGP_FN uint gpgpInstanceTerminal(uvec4 third) { return third.w; }

// Extents that a transform is divided by. Polygons have no depth, and their transform scales z by 1.
GPGP_FN vec3 gpgpInstanceScale(uvec4 fifth) {
  const vec3 size = vec3(uintBitsToFloat(fifth.x), uintBitsToFloat(fifth.y), uintBitsToFloat(fifth.z));
  return vec3(size.x == 0.0f ? 1.0f : size.x, size.y == 0.0f ? 1.0f : size.y, size.z == 0.0f ? 1.0f : size.z);
}

// A row of an axiom's transform, of the same row of the instance's.
GPGP_FN uvec4 gpgpAxiomRow(uvec4 row, vec3 scale) {
  return uvec4(floatBitsToUint(uintBitsToFloat(row.x) / scale.x), floatBitsToUint(uintBitsToFloat(row.y) / scale.y),
               floatBitsToUint(uintBitsToFloat(row.z) / scale.z), row.w);
}

// Word `word` (0 to 5) of the axiom that an instance of six words becomes: it has the instance's place, extents, seed,
// attribute and axiom id. start: GpgpAxiom::start. Start shapes of boxes and quads have their origin in the middle, as
// instances do.
GPGP_FN uvec4 gpgpAxiomWord(const uvec4 instance[6], int word, uint start) {
  if (word < 3) return gpgpAxiomRow(instance[word], gpgpInstanceScale(instance[5]));
  if (word == 3) return uvec4(instance[5].x, instance[5].y, instance[5].z, instance[4].x);
  if (word == 4) return uvec4(instance[3].z, start, instance[4].y, 0u);
  return uvec4(0u, 0u, 0u, 0u);
}

GPGP_SHADER_END
#endif
