// Roofs and trapezoids: shapes whose form is said by the 24 bits in which others name their polygon.
//
// A roof stands on the whole lower face of its unit box and ends in a ridge at y = 0.5, which is parallel to x or to z.
// A trapezoid lies in z = 0; its lower edge is that of the unit square, its upper one any part of the upper edge. A
// triangle's upper edge has no length. Faces of a roof are rectangles and trapezoids.
#ifndef GPGP_SHADERS_SPAWN_ROOF_SHAPES_H
#define GPGP_SHADERS_SPAWN_ROOF_SHAPES_H
#include "core/math.h"
#include "spawn/shared/graph_format.h"

GPGP_SHADER_BEGIN

/// A roof's ridge, or a trapezoid's upper edge.
struct Ridge {
  float halfLength; // in extents along it: 0 to 0.5
  float place;      // of a roof's ridge on the other axis, of an edge's middle along it: -0.5, 0 or 0.5
  bool isAlongZ;
};

// Bits of the 24, of which the highest stays free.
GPGP_CONST uint kRidgeFull = 1u << 19; // half the whole extent
GPGP_CONST uint kRidgePlace = 20u;
GPGP_CONST uint kRidgeLow = 1u << 20;  // place -0.5
GPGP_CONST uint kRidgeHigh = 2u << 20; // place 0.5
GPGP_CONST uint kRidgeAlongZ = 1u << 22;

GPGP_FN Ridge ridgeOf(uint geometry) {
  const uint bits = geometry >> 8;
  const uint place = (bits >> kRidgePlace) & 3u;
  Ridge r;
  r.halfLength = float(bits & 0xfffffu) * (1.0f / 1048576.0f); // exact
  r.place = place == 0u ? 0.0f : (place == 1u ? -0.5f : 0.5f);
  r.isAlongZ = (bits & kRidgeAlongZ) != 0u;
  return r;
}
/// The bits of a length.
GPGP_FN uint ridgeBits(float halfLength) {
  return uint(floor(add(multiply(min(max(halfLength, 0.0f), 0.5f), 1048576.0f), 0.5f)));
}

// Sides are counted as edges of the rectangle: 0 at the highest z, 1 at the highest x, 2 at the lowest z, 3 at the
// lowest x. Seen from outside, a side runs to the right.

/// A point of a side: along it, up, and outwards.
GPGP_FN vec3 roofPoint(uint side, float along, float up, float outwards) {
  const float a = side == 0u || side == 3u ? along : -along;
  const float o = side < 2u ? outwards : -outwards;
  return (side & 1u) == 0u ? vec3(a, up, o) : vec3(o, up, a);
}
/// The upper edge of a side of the unit shape: the place of its middle, half its length, and its place outwards.
GPGP_FN vec3 roofEdge(Ridge ridge, uint side) {
  const bool isBeside = ((side & 1u) != 0u) == ridge.isAlongZ;
  const float along = side == 0u || side == 3u ? ridge.place : -ridge.place;
  const float outwards = side < 2u ? ridge.place : -ridge.place;
  return isBeside ? vec3(0.0f, ridge.halfLength, outwards) : vec3(along, 0.0f, ridge.halfLength);
}

/// A corner of a trapezoid, or of a side of a roof as along, up and outwards.
GPGP_FN vec3 trapezoidCorner(vec3 edge, uint corner) {
  const float reach = corner < 2u ? 0.5f : edge.y;
  const float middle = corner < 2u ? 0.0f : edge.x;
  return vec3(middle + (corner == 1u || corner == 2u ? reach : -reach), corner < 2u ? -0.5f : 0.5f,
              corner < 2u ? 0.5f : edge.z);
}

GPGP_SHADER_END
#endif
