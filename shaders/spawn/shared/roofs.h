// The operators that make roofs of rectangles, and faces of roofs.
#ifndef GPGP_SHADERS_SPAWN_ROOFS_H
#define GPGP_SHADERS_SPAWN_ROOFS_H
#include "spawn/shared/roof_shapes.h"
#include "spawn/shared/shape.h"

GPGP_SHADER_BEGIN

// Forms.
GPGP_CONST uint kRoofGableAlongX = 0u;
GPGP_CONST uint kRoofGableAlongZ = 1u;
GPGP_CONST uint kRoofHip = 2u;
GPGP_CONST uint kRoofPyramid = 3u;
GPGP_CONST uint kRoofShed = 4u; // and the side that is low
GPGP_CONST uint kRoofForms = 8u;
// How steep they are.
GPGP_CONST uint kRoofByHeight = 0u;
GPGP_CONST uint kRoofBySlope = 1u; // rise by run
GPGP_CONST uint kRoofByAngle = 2u; // degrees

GPGP_FN float slopeOfDegrees(float degrees) {
  const vec2 both = sineCosineDegrees(degrees);
  return divide(both.x, both.y);
}

/// A quad, Y along its normal then, or the foot of a box becomes a roof. v: form, how steep it is said, the value.
GPGP_FN void makeRoof(GPGP_INOUT(Shape) s, vec3 v) {
  if (shapeType(s) == kShapeQuad) {
    const vec3 axisZ = opposite(s.axisY);
    s.axisY = s.axisZ;
    s.axisZ = axisZ;
    s.size = vec3(s.size.x, 0.0f, s.size.y);
  } else if (shapeType(s) != kShapeBox) {
    return;
  }
  const uint form = uint(clamp(floor(v.x), 0.0f, float(kRoofForms - 1u)));
  const uint how = uint(clamp(floor(v.y), 0.0f, 2.0f));
  const float longer = max(s.size.x, s.size.z);
  const float shorter = min(s.size.x, s.size.z);
  // Along x unless said otherwise; the roof rises from a side towards the ridge, over the run.
  bool isAlongZ = form == kRoofGableAlongZ || (form >= kRoofShed && (form & 1u) != 0u);
  if (form == kRoofHip) isAlongZ = s.size.z > s.size.x;
  uint ridge = kRidgeFull;
  float run = isAlongZ ? s.size.x : s.size.z;
  if (form == kRoofHip || form == kRoofPyramid) run = shorter;
  if (form == kRoofPyramid) ridge = 0u;
  if (form == kRoofHip)
    ridge = ridgeBits(longer > 0.0f ? divide(multiply(subtract(longer, shorter), 0.5f), longer) : 0.0f);
  if (form < kRoofShed)
    run = multiply(run, 0.5f);
  else
    ridge |= form < kRoofShed + 2u ? kRidgeLow : kRidgeHigh; // opposite to the side that is low
  if (isAlongZ) ridge |= kRidgeAlongZ;
  const float slope = how == kRoofByAngle ? slopeOfDegrees(v.z) : v.z;
  const float height = how == kRoofByHeight ? v.z : multiply(slope, run);
  s.position = axisPoint(s, 1u, multiply(subtract(height, s.size.y), 0.5f));
  s.size = withComponent(s.size, 1u, height);
  s.geometry = kShapeRoof | (ridge << 8);
}

/// A roof becomes one of its faces: a side, or 4, which is the bottom. X runs along the side and Z out of it. Where it
/// slopes it reaches further by v.y along the slope; v.z is how much further it reaches at both ends of a gable's
/// ridge. v.x: the face.
GPGP_FN void makeRoofFace(GPGP_INOUT(Shape) s, vec3 v) {
  if (shapeType(s) != kShapeRoof) return;
  const uint side = uint(clamp(floor(v.x), 0.0f, 4.0f));
  if (side == 4u) {
    s.position = axisPoint(s, 1u, multiply(s.size.y, -0.5f));
    const vec3 axisZ = opposite(s.axisY);
    s.axisY = s.axisZ;
    s.axisZ = axisZ;
    s.size = vec3(s.size.x, s.size.z, 0.0f);
    s.geometry = kShapeQuad | (kQuadPolygon << 8);
    return;
  }
  const vec3 edge = roofEdge(ridgeOf(s.geometry), side);
  const float across = (side & 1u) == 0u ? s.size.x : s.size.z;
  const float depth = (side & 1u) == 0u ? s.size.z : s.size.x;
  const float run = multiply(subtract(0.5f, edge.z), depth);
  const float slant = squareRoot(add(multiply(run, run), multiply(s.size.y, s.size.y)));
  const float cosine = slant > 0.0f ? divide(run, slant) : 1.0f;
  const float sine = slant > 0.0f ? divide(s.size.y, slant) : 0.0f;
  // Walls stay as they are. Hips grow by the same length in plan on all sides.
  const bool isSloped = run > 0.0f;
  const float down = isSloped ? v.y : 0.0f;
  const float beside = edge.y == 0.5f ? v.z : multiply(down, cosine);
  const float base = add(across, isSloped ? multiply(beside, 2.0f) : 0.0f);
  const float reach = multiply(edge.y, across); // half the upper edge
  const uint bits = edge.y == 0.5f ? kRidgeFull : ridgeBits(base > 0.0f ? divide(reach, base) : 0.0f);
  const float middle = multiply(subtract(slant, down), 0.5f); // along the slope, from the eave on
  s.position = framePoint(s, roofPoint(side, 0.0f, subtract(multiply(middle, sine), multiply(s.size.y, 0.5f)),
                                       subtract(multiply(depth, 0.5f), multiply(middle, cosine))));
  const vec3 axisX = frameDirection(s, roofPoint(side, 1.0f, 0.0f, 0.0f));
  const vec3 axisY = frameDirection(s, roofPoint(side, 0.0f, sine, -cosine));
  s.axisZ = frameDirection(s, roofPoint(side, 0.0f, cosine, sine));
  s.axisX = axisX;
  s.axisY = axisY;
  s.size = vec3(base, add(slant, down), 0.0f);
  const uint place = edge.x == 0.0f ? 0u : (edge.x < 0.0f ? kRidgeLow : kRidgeHigh);
  s.geometry = edge.y == 0.5f ? kShapeQuad | (kQuadPolygon << 8) : kShapeTrapezoid | ((bits | place) << 8);
}

GPGP_SHADER_END
#endif
