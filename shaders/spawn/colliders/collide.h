// Collider and IfCollides: boxes of shapes in the world, whether two intersect, and how those near one are found.
//
// A shape's box is what its frame and size span under the axiom's transform: any parallelepiped. Two intersect where no
// face normal and no product of edges separates them (Gottschalk, Lin, Manocha 1996), and they overlap along each of
// these by more than a part in 65 536 of their coordinates in the axiom's object and their extents; between axioms also
// by more than the last digits of the axioms' positions. Distances come from differences, of the axioms' positions and
// of the places within, so that far from the origin shapes of one axiom lose no precision.
//
// Colliders are linked in cells of a grid without bounds, with edges of a power of two above each one's extents, by the
// hash of cell and level. Where they lie does not decide what a query finds: it tests all that could intersect, and
// says whether any does. All that decides is arithmetic within bounds (lengths are 0 or 2^-20 to 2^30 metres) in which
// no float under- or overflows, so that CPU and GPU agree to the last bit.
#ifndef GPGP_SHADERS_SPAWN_COLLIDE_H
#define GPGP_SHADERS_SPAWN_COLLIDE_H
#include "spawn/shared/shape.h"

GPGP_SHADER_BEGIN

struct ColliderBox {
  vec3 origin; // the axiom's position
  vec3 offset; // of the centre from it
  vec3 halfX;  // from the centre to a face
  vec3 halfY;
  vec3 halfZ;
};

/// Shape::axiom of a shape that was registered: this and the number of its last collider, which knows what it was
/// before. So a shape knows its own colliders, and those that it descends from, without a word more.
GPGP_CONST uint kColliderLink = 0x80000000u;
GPGP_CONST uint kNoCollider = 0xffffffffu;

#ifdef __cplusplus
/// What a query reads.
struct Collider {
  ColliderBox box;
  uint tag;
  uint before; // Shape::axiom before
  uint next;   // in its cell
};
struct ColliderSet {
  const Collider* colliders;
  const uint* cells; // first collider of each
  uint cellMask;
  uint levels;                   // bit set of those in use
  uint linked;                   // colliders that can be found
  const Collider* own = nullptr; // those of this phase, numbered from linked on
};
inline ColliderBox colliderBox(const ColliderSet& set, uint i) { return set.colliders[i].box; }
inline uint colliderTag(const ColliderSet& set, uint i) { return set.colliders[i].tag; }
inline uint colliderBefore(const ColliderSet& set, uint i) {
  return i < set.linked ? set.colliders[i].before : set.own[i - set.linked].before;
}
inline uint colliderNext(const ColliderSet& set, uint i) { return set.colliders[i].next; }
inline uint firstInCell(const ColliderSet& set, uint cell) { return set.cells[cell & set.cellMask]; }
inline uint usedLevels(const ColliderSet& set) { return set.levels; }
inline uint linkedColliders(const ColliderSet& set) { return set.linked; }
#define GPGP_COLLIDER_SET const ::gpgp::shader::ColliderSet &colliderSet,
#define GPGP_C colliderSet,
#define GPGP_C0 colliderSet
#else
#define GPGP_COLLIDER_SET
#define GPGP_C
#define GPGP_C0
ColliderBox colliderBox(uint i);
uint colliderTag(uint i);
uint colliderBefore(uint i);
uint colliderNext(uint i);
uint firstInCell(uint cell);
uint usedLevels();
uint linkedColliders();
#endif

GPGP_FN float boundedLength(float x) {
  const float v = settle(x);
  return abs(v) < 9.5367432e-7f ? 0.0f : clamp(v, -1.0737418e9f, 1.0737418e9f);
}
GPGP_FN vec3 boundedLengths(vec3 v) { return vec3(boundedLength(v.x), boundedLength(v.y), boundedLength(v.z)); }
GPGP_FN float largestOf(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

/// The box of a shape under the rows of its axiom's transform.
GPGP_FN ColliderBox boxOf(Shape s, vec4 row0, vec4 row1, vec4 row2) {
  const vec3 x = boundedLengths(vec3(row0.x, row0.y, row0.z));
  const vec3 y = boundedLengths(vec3(row1.x, row1.y, row1.z));
  const vec3 z = boundedLengths(vec3(row2.x, row2.y, row2.z));
  const vec3 factor = vec3(multiply(s.size.x, 0.5f), multiply(s.size.y, 0.5f), multiply(s.size.z, 0.5f));
  ColliderBox b;
  b.origin = boundedLengths(vec3(row0.w, row1.w, row2.w));
  b.offset = boundedLengths(vec3(dot3(x, s.position), dot3(y, s.position), dot3(z, s.position)));
  b.halfX = boundedLengths(vec3(multiply(dot3(x, s.axisX), factor.x), multiply(dot3(y, s.axisX), factor.x),
                                multiply(dot3(z, s.axisX), factor.x)));
  b.halfY = boundedLengths(vec3(multiply(dot3(x, s.axisY), factor.y), multiply(dot3(y, s.axisY), factor.y),
                                multiply(dot3(z, s.axisY), factor.y)));
  b.halfZ = boundedLengths(vec3(multiply(dot3(x, s.axisZ), factor.z), multiply(dot3(y, s.axisZ), factor.z),
                                multiply(dot3(z, s.axisZ), factor.z)));
  return b;
}

// ---------------------------------------------------------------- two boxes

GPGP_FN float lengthAlong(vec3 v, vec3 direction) {
  GPGP_PRECISE float r = v.x * direction.x + v.y * direction.y + v.z * direction.z;
  return abs(r);
}
GPGP_FN vec3 perpendicular(vec3 a, vec3 b) {
  GPGP_PRECISE float x = a.y * b.z - a.z * b.y;
  GPGP_PRECISE float y = a.z * b.x - a.x * b.z;
  GPGP_PRECISE float z = a.x * b.y - a.y * b.x;
  return vec3(x, y, z);
}
GPGP_FN bool isZero(vec3 v) { return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f; }

/// What a box's numbers are trusted to.
GPGP_FN float marginOf(ColliderBox b) {
  const float extent = add(largestOf(b.halfX), add(largestOf(b.halfY), largestOf(b.halfZ)));
  return multiply(add(largestOf(b.offset), extent), 7.6293945e-6f);
}
/// Whether the boxes do not overlap by more than margin along a direction, of any length. A direction of length 0,
/// from edges that are parallel, says nothing.
GPGP_FN bool isSeparating(vec3 direction, vec3 between, ColliderBox a, ColliderBox b, float margin) {
  if (isZero(direction)) return false;
  GPGP_PRECISE float reach = lengthAlong(a.halfX, direction) + lengthAlong(a.halfY, direction) +
                             lengthAlong(a.halfZ, direction) + lengthAlong(b.halfX, direction) +
                             lengthAlong(b.halfY, direction) + lengthAlong(b.halfZ, direction);
  GPGP_PRECISE float limit = reach - margin * (abs(direction.x) + abs(direction.y) + abs(direction.z));
  return lengthAlong(between, direction) >= limit;
}
/// Half the extents along the world's axes.
GPGP_FN vec3 worldExtents(ColliderBox b) {
  GPGP_PRECISE vec3 e = abs(b.halfX) + abs(b.halfY) + abs(b.halfZ);
  return e;
}

/// Boxes that touch do not intersect. Flat ones intersect what crosses them; where neither has a face, nothing does.
GPGP_FN bool boxesIntersect(ColliderBox a, ColliderBox b) {
  GPGP_PRECISE vec3 between = (b.origin - a.origin) + (b.offset - a.offset);
  GPGP_PRECISE vec3 reach = worldExtents(a) + worldExtents(b);
  if (abs(between.x) > reach.x || abs(between.y) > reach.y || abs(between.z) > reach.z) return false;
  float margin = add(marginOf(a), marginOf(b));
  if (a.origin != b.origin)
    margin = add(margin, multiply(add(largestOf(a.origin), largestOf(b.origin)), 1.1920929e-7f));
  const vec3 aX = perpendicular(a.halfY, a.halfZ);
  const vec3 aY = perpendicular(a.halfZ, a.halfX);
  const vec3 aZ = perpendicular(a.halfX, a.halfY);
  const vec3 bX = perpendicular(b.halfY, b.halfZ);
  const vec3 bY = perpendicular(b.halfZ, b.halfX);
  const vec3 bZ = perpendicular(b.halfX, b.halfY);
  if (isZero(aX) && isZero(aY) && isZero(aZ) && isZero(bX) && isZero(bY) && isZero(bZ)) return false;
  return !(isSeparating(aX, between, a, b, margin) || isSeparating(aY, between, a, b, margin) ||
           isSeparating(aZ, between, a, b, margin) || isSeparating(bX, between, a, b, margin) ||
           isSeparating(bY, between, a, b, margin) || isSeparating(bZ, between, a, b, margin) ||
           isSeparating(perpendicular(a.halfX, b.halfX), between, a, b, margin) ||
           isSeparating(perpendicular(a.halfX, b.halfY), between, a, b, margin) ||
           isSeparating(perpendicular(a.halfX, b.halfZ), between, a, b, margin) ||
           isSeparating(perpendicular(a.halfY, b.halfX), between, a, b, margin) ||
           isSeparating(perpendicular(a.halfY, b.halfY), between, a, b, margin) ||
           isSeparating(perpendicular(a.halfY, b.halfZ), between, a, b, margin) ||
           isSeparating(perpendicular(a.halfZ, b.halfX), between, a, b, margin) ||
           isSeparating(perpendicular(a.halfZ, b.halfY), between, a, b, margin) ||
           isSeparating(perpendicular(a.halfZ, b.halfZ), between, a, b, margin));
}

// ---------------------------------------------------------------- the grid

/// The last level has one cell, for what no other takes; the first has edges of 1/16 of a metre.
GPGP_CONST uint kBoundlessLevel = 31u;

GPGP_FN vec3 worldCentre(ColliderBox b) {
  GPGP_PRECISE vec3 c = b.origin + b.offset;
  return c;
}
/// The level whose cells are larger than a box.
GPGP_FN uint levelOf(vec3 extents) {
  const uint bits = floatBitsToUint(largestOf(extents)); // an edge of 2^n is more than twice what is below 2^(n - 1)
  const int level = int(bits >> 23) - 127 + 2 + 4;
  return uint(clamp(level, 0, int(kBoundlessLevel)));
}
GPGP_FN int cellAlong(float x, uint level) {
  if (level == kBoundlessLevel) return 0;
  return int(clamp(floor(x * uintBitsToFloat((131u - level) << 23)), -1.0e9f, 1.0e9f));
}
GPGP_FN ivec3 cellAt(vec3 p, uint level) {
  return ivec3(cellAlong(p.x, level), cellAlong(p.y, level), cellAlong(p.z, level));
}
GPGP_FN uint cellHash(ivec3 cell, uint level) {
  return mixBits(uint(cell.x) ^ mixBits(uint(cell.y) ^ mixBits(uint(cell.z) ^ mixBits(level))));
}

/// Cells of a level in which colliders may lie that reach a box: from low on, so many.
struct CellRange {
  ivec3 low;
  ivec3 count;
};
GPGP_FN CellRange cellsNear(vec3 centre, vec3 extents, uint level) {
  const float edge = uintBitsToFloat((123u + level) << 23);
  // half an edge, as colliders reach beyond their cells, and more than centres are rounded
  GPGP_PRECISE float beyond = edge * 0.5f + (largestOf(centre) + largestOf(extents)) * 1.9073486e-6f;
  GPGP_PRECISE vec3 reach = extents + vec3(beyond);
  GPGP_PRECISE vec3 low = centre - reach;
  GPGP_PRECISE vec3 high = centre + reach;
  CellRange r;
  r.low = cellAt(low, level);
  r.count = cellAt(high, level) - r.low + ivec3(1);
  return r;
}
/// As many, or 2^30.
GPGP_FN uint cellCount(CellRange r) {
  if (max(r.count.x, max(r.count.y, r.count.z)) > 1024) return 0x40000000u;
  return uint(r.count.x) * uint(r.count.y) * uint(r.count.z);
}

/// Whether a box intersects a linked collider with a tag, except its own: link is its Shape::axiom. Looks into cells,
/// or at every collider where that is less. spent: grows by what it looked at.
GPGP_FN bool collidesWithAny(GPGP_COLLIDER_SET ColliderBox box, uint tag, uint link, GPGP_INOUT(uint) spent) {
  const vec3 centre = worldCentre(box);
  const vec3 extents = worldExtents(box);
  const uint linked = linkedColliders(GPGP_C0);
  uint levels = usedLevels(GPGP_C0);
  uint cells = 0u;
  for (uint rest = levels; rest != 0u && cells <= linked; rest &= rest - 1u)
    cells += cellCount(cellsNear(centre, extents, uint(findLSB(rest))));
  const bool all = cells > linked;
  if (all) levels = 1u; // the loops below run once
  spent += 1u;
  for (; levels != 0u; levels &= levels - 1u) {
    const uint level = uint(findLSB(levels));
    const CellRange range = cellsNear(centre, extents, level);
    const uint count = all ? 1u : cellCount(range);
    for (uint c = 0u; c < count; ++c) {
      uint i = 0u;
      if (!all) { // else there are more cells than an int counts, perhaps
        const int n = int(c);
        const ivec3 place =
            ivec3(n % range.count.x, n / range.count.x % range.count.y, n / (range.count.x * range.count.y));
        i = firstInCell(GPGP_C cellHash(range.low + place, level));
      }
      spent += 1u;
      while (i < linked) {
        spent += 1u;
        if (colliderTag(GPGP_C i) == tag && boxesIntersect(box, colliderBox(GPGP_C i))) {
          bool own = false;
          for (uint up = link; (up & kColliderLink) != 0u && !own; up = colliderBefore(GPGP_C up & ~kColliderLink)) {
            own = (up & ~kColliderLink) == i;
            spent += 1u;
          }
          if (!own) return true;
        }
        i = all ? i + 1u : colliderNext(GPGP_C i);
      }
    }
  }
  return false;
}

GPGP_SHADER_END
#endif
