// A recording's colliders on the device, as collide.h reads them. A collider is four uvec4: each of its box's vectors
// with the axiom's number, its tag, what Shape::axiom was before, and nothing.
#ifndef GPGP_SHADERS_SPAWN_COLLIDERS_GLSL
#define GPGP_SHADERS_SPAWN_COLLIDERS_GLSL
layout(set = 0, binding = kBindColliders, std430) buffer Colliders { uvec4 colliders[]; };
// First collider of each cell, then the next one of each collider; numbers from 1, 0: none.
layout(set = 0, binding = kBindColliderCells, std430) buffer ColliderCells { uint colliderCells[]; };

#include "spawn/colliders/collide.h"

/// The axiom's number for a Shape::axiom.
uint axiomNumber(uint link) {
  return (link & kColliderLink) != 0 ? colliders[4 * (link & ~kColliderLink)].w : link;
}
vec4 axiomRow(uint axiom, uint row) { return uintBitsToFloat(axioms[axiom * 6 + row]); }
ColliderBox boxOfShape(Shape s) {
  const uint axiom = axiomNumber(s.axiom);
  return boxOf(s, axiomRow(axiom, 0), axiomRow(axiom, 1), axiomRow(axiom, 2));
}

ColliderBox colliderBox(uint i) {
  const uvec4 offset = colliders[4 * i];
  ColliderBox b;
  b.origin =
      boundedLengths(vec3(axiomRow(offset.w, 0).w, axiomRow(offset.w, 1).w, axiomRow(offset.w, 2).w));
  b.offset = unpackVector(offset);
  b.halfX = unpackVector(colliders[4 * i + 1]);
  b.halfY = unpackVector(colliders[4 * i + 2]);
  b.halfZ = unpackVector(colliders[4 * i + 3]);
  return b;
}
uint colliderTag(uint i) { return colliders[4 * i + 1].w; }
uint colliderBefore(uint i) { return colliders[4 * i + 2].w; }
uint colliderNext(uint i) { return colliderCells[record.cellMask + 1 + i] - 1; }
uint firstInCell(uint cell) { return colliderCells[cell & record.cellMask] - 1; }
uint usedLevels() { return state.levels; }
#endif
