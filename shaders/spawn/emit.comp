#version 460
#extension GL_GOOGLE_include_directive : require
// Terminal records to the engine's instances, in bucket order where draws are asked for.
#include "spawn/bindings.glsl"
layout(local_size_x = 64) in; // kSpawnGroupSize
#include "spawn/shape.h"

void main() {
  const uint kept = min(state.terminals, record.maxTerminals);
  for (uint i = gl_GlobalInvocationID.x; i < kept; i += gl_NumWorkGroups.x * kSpawnGroupSize) {
    const Shape s = unpackShape(records[i], records[i + record.maxTerminals], records[i + 2 * record.maxTerminals],
                                records[i + 3 * record.maxTerminals], records[i + 4 * record.maxTerminals],
                                records[i + 5 * record.maxTerminals]);
    const uint terminal = graphWords[s.node + kNodeArgument];
    const uint bucket = graphWords[s.node + kNodeArgument2];
    const uint place = atomicAdd(bucketCounts[kBucketPlaces + bucket], 1);
    if (place >= record.instanceCapacity) continue;
    const uint axiom = s.axiom * 6;
    for (uint row = 0; row < 3; ++row)
      instances[place * 6 + row] = floatBitsToUint(instanceRow(s, uintBitsToFloat(axioms[axiom + row])));
    instances[place * 6 + 3] = uvec4(bucket, shapeType(s), axioms[axiom + 4].x, terminal);
    instances[place * 6 + 4] = uvec4(s.seed, floatBitsToUint(s.custom), s.key);
    instances[place * 6 + 5] = packPlane(s.size, 0);
  }
}
