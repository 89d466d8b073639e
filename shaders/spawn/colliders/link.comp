#version 460
#extension GL_GOOGLE_include_directive : require
// Between two phases: links the colliders that were registered since the last one into their cells, and makes the
// shapes that wait for later phases the queue of the next one's first round.
#include "spawn/shared/bindings.glsl"
layout(local_size_x = 64) in; // kSpawnGroupSize
layout(push_constant) uniform Push {
  uint first;  // round of the next phase
  uint before; // the first round of the phase that has ended
};
#include "spawn/shared/shape.h"

#include "spawn/colliders/colliders.glsl"
uint linkedColliders() { return rounds[before].linked; }

void main() {
  const uint begin = rounds[before].linked;
  const uint end = min(state.colliders, record.maxColliders);
  for (uint i = begin + gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * kSpawnGroupSize) {
    const ColliderBox box = colliderBox(i);
    const uint level = levelOf(worldExtents(box));
    const uint cell = cellHash(cellAt(worldCentre(box), level), level) & record.cellMask;
    colliderCells[record.cellMask + 1 + i] = atomicExchange(colliderCells[cell], i + 1);
    atomicOr(state.levels, 1u << level);
  }
  if (gl_GlobalInvocationID.x == 0) {
    const uint waiting = min(state.waiting, record.maxShapes);
    rounds[first].linked = end;
    rounds[first].shapes = waiting;
    rounds[first].groupsX = min(waiting, record.maxGroups);
    rounds[first].groupsY = 1;
    rounds[first].groupsZ = 1;
    const uint left = rounds[before + record.phaseRounds].shapes;
    state.peakShapes = max(state.peakShapes, max(left, state.waiting));
    state.droppedShapes += left;
  }
}
