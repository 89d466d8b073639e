#version 460
#extension GL_GOOGLE_include_directive : require
// Terminal records to the engine's instances, in bucket order where draws are asked for.
#include "spawn/shared/bindings.glsl"

#include "spawn/outputs/regions.glsl"
layout(local_size_x = 64) in;                       // kSpawnGroupSize
layout(constant_id = 0) const bool ordered = false; // order[] says which record comes where
layout(constant_id = 1) const bool compact = false; // GpgpCompactInstance, two uvec4
#include "spawn/shared/shape.h"
#include "spawn/outputs/compact.h"

/// Where the record goes that comes at `place` of all.
uint placeOf(uint place, uint bucket) {
  if (!ordered) return atomicAdd(bucketCounts[kBucketPlaces + bucket], 1);
  if (record.regions == 0) return place;
  const uint before = place - bucketCounts[kBucketPlaces + bucket];
  return before < regionCapacity(bucket, false) ? regionStart(bucket, false) + before : 0xffffffffu;
}

void main() {
  const uint kept = min(state.terminals, record.maxTerminals);
  for (uint at = gl_GlobalInvocationID.x; at < kept; at += gl_NumWorkGroups.x * kSpawnGroupSize) {
    const uint i = ordered ? order[orderedAt(at)] : at;
    const Shape s = unpackShape(records[i], records[i + record.maxTerminals], records[i + 2 * record.maxTerminals],
                                records[i + 3 * record.maxTerminals], records[i + 4 * record.maxTerminals],
                                records[i + 5 * record.maxTerminals]);
    const uvec4 terminal = graphRows[s.node / 4];
    const uint bucket = terminal[kNodeArgument2];
    const uint place = placeOf(at, bucket);
    if (place >= record.instanceCapacity) continue;
    const uint axiom = s.axiom * 6;
    if (compact) {
      const CompactInstance made =
          compactInstance(s, uintBitsToFloat(axioms[axiom]), uintBitsToFloat(axioms[axiom + 1]),
                          uintBitsToFloat(axioms[axiom + 2]), terminal[kNodeArgument]);
      instances[place * 2] = made.first;
      instances[place * 2 + 1] = made.second;
      continue;
    }
    for (uint row = 0; row < 3; ++row)
      instances[place * 6 + row] = floatBitsToUint(instanceRow(s, uintBitsToFloat(axioms[axiom + row])));
    const uint shape = shapeType(s) > kShapeSphere ? s.geometry : shapeType(s); // as instanceShape()
    instances[place * 6 + 3] = uvec4(bucket, shape, axioms[axiom + 4].x, terminal[kNodeArgument]);
    instances[place * 6 + 4] = uvec4(s.seed, floatBitsToUint(s.custom), s.key);
    instances[place * 6 + 5] = packPlane(s.size, terminal[kNodeRule]);
  }
}
