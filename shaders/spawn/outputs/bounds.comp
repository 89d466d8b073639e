#version 460
#extension GL_GOOGLE_include_directive : require
// The boxes of the buckets' terminals in the world, as far as records hold them, or instances where there are none.
//
// A box is kept as six numbers that only grow, from 0 for none: floats as integers of the same order, the lower ends
// turned over. A workgroup gathers its own in shared memory, where most buckets find room, then adds what is larger to
// everybody's.
#include "spawn/shared/bindings.glsl"

// the same as instances
layout(set = 0, binding = kBindInstances, std430) readonly buffer Written { uvec4 written[]; };
layout(set = 0, binding = kBindBounds, std430) writeonly buffer Bounds { float bounds[]; };     // GpgpSpawnBounds
// kBoundWords a bucket
layout(set = 0, binding = kBindBoundKeys, std430) buffer BoundKeys { uint boundKeys[]; };
layout(local_size_x = 64) in;                        // kSpawnGroupSize
layout(constant_id = 0) const bool decodes = false; // what has been gathered to the engine's buffer
#include "spawn/shared/shape.h"
#include "spawn/outputs/boxes.h"
#include "spawn/outputs/regions.glsl"

const uint kKeys = 512 * kBoundWords;
shared uint keys[decodes ? 1 : kKeys];

void decode(uint buckets) {
  for (uint i = gl_LocalInvocationIndex; i < buckets * 3; i += kSpawnGroupSize) {
    const uint at = i / 3 * kBoundWords + i % 3;
    bounds[at] = lowOf(boundKeys[at]);
    bounds[at + 3] = highOf(boundKeys[at + 3]);
  }
}

void raise(uint at, uint key) {
  if (at < kKeys) {
    if (key > keys[at]) atomicMax(keys[at], key);
  } else if (key > boundKeys[at]) {
    atomicMax(boundKeys[at], key);
  }
}

/// rows: of the unit shape's cube to the world.
void grow(uint bucket, vec4 rows[3], bool isFlat) {
  for (uint axis = 0; axis < 3; ++axis) {
    raise(bucket * kBoundWords + axis, ~boundKey(boxLow(rows[axis], isFlat)));
    raise(bucket * kBoundWords + axis + 3, boundKey(boxHigh(rows[axis], isFlat)));
  }
}

void gatherInstances(uint first, uint count) {
  for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * kSpawnGroupSize) {
    const uint at = (first + i) * 6;
    vec4 rows[3];
    for (uint axis = 0; axis < 3; ++axis) rows[axis] = uintBitsToFloat(written[at + axis]);
    grow(written[at + 3].x, rows, written[at + 5].z << 1 == 0);
  }
}

void main() {
  const uint buckets = graphWords[kHeaderBuckets];
  if (decodes) {
    decode(buckets);
    return;
  }
  const uint used = min(buckets * kBoundWords, kKeys);
  for (uint i = gl_LocalInvocationIndex; i < used; i += kSpawnGroupSize) keys[i] = 0;
  barrier();
  const bool fromInstances = record.terminalsTo == kToInstances;
  if (fromInstances && record.regions != 0) { // there is room between them
    for (uint bucket = 0; bucket < buckets; ++bucket)
      gatherInstances(regionStart(bucket, false), min(bucketCounts[bucket], regionCapacity(bucket, false)));
  } else if (fromInstances) {
    gatherInstances(0, state.instancesWritten);
  } else {
    const uint count = min(state.terminals, record.maxTerminals);
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * kSpawnGroupSize) {
      vec4 rows[3];
      const Shape s = unpackShape(records[i], records[i + record.maxTerminals], records[i + 2 * record.maxTerminals],
                                  records[i + 3 * record.maxTerminals], records[i + 4 * record.maxTerminals],
                                  uvec4(0));
      for (uint axis = 0; axis < 3; ++axis)
        rows[axis] = instanceRow(s, uintBitsToFloat(axioms[s.axiom * 6 + axis]));
      grow(graphWords[s.node + kNodeArgument2], rows, s.size.z == 0);
    }
  }
  barrier();
  for (uint i = gl_LocalInvocationIndex; i < used; i += kSpawnGroupSize)
    if (keys[i] > boundKeys[i]) atomicMax(boundKeys[i], keys[i]);
}
