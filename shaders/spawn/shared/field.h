// Fields of the world: numbers on a grid over the ground plane, which rules read at a place of the shape.
//
// They lie in a buffer of floats, not in an image: what a sampler makes of four texels, and of the coordinate between
// them, differs from device to device, and here it decides what is derived. All of it is settled arithmetic, so that
// the CPU and every GPU read the same number.
#ifndef GPGP_SHADERS_SPAWN_FIELD_H
#define GPGP_SHADERS_SPAWN_FIELD_H
#include "spawn/shared/layout.h"
#include "spawn/shared/view.h"

GPGP_SHADER_BEGIN

/// Four values around a place, and where it lies among them.
struct FieldPlace {
  uint near;  // the first of the four, among all values
  uint right; // from it to the next one along x, and
  uint far;   // along z; 0 at the grid's end
  float u, v; // from 0 to 1
};

/// Steps of the grid from its first value, along one axis. Beyond the grid: its end. perMetre is at most 2^20, so that
/// no product here is beyond all floats.
GPGP_FN float fieldSteps(float world, float first, float perMetre, uint count) {
  GPGP_PRECISE float steps = (world - first) * perMetre;
  return clamp(settleFinite(steps), 0.0f, float(count - 1u));
}

/// x and z in the world.
GPGP_FN FieldPlace placeInField(FieldGrid grid, float x, float z) {
  const float alongX = fieldSteps(x, grid.minX, grid.perMetreX, grid.width);
  const float alongZ = fieldSteps(z, grid.minZ, grid.perMetreZ, grid.height);
  const uint column = uint(alongX), row = uint(alongZ);
  FieldPlace place;
  place.near = grid.first + row * grid.width + column;
  const uint width = grid.width;
  place.right = uint(column + 1u < width);
  place.far = uint(row + 1u < grid.height) * width;
  place.u = alongX - float(column); // exact
  place.v = alongZ - float(row);
  return place;
}

/// Between the four values: near and far along z, left and right along x. What is no number counts as 0, and what is
/// beyond 2^100 as that. Products too small for a float are lost beside their sums, or settled with them.
GPGP_FN float fieldBetween(FieldPlace place, float nearLeft, float nearRight, float farLeft, float farRight) {
  const float nl = settle(nearLeft), nr = settle(nearRight), fl = settle(farLeft), fr = settle(farRight);
  GPGP_PRECISE float near = nl + place.u * (nr - nl), far = fl + place.u * (fr - fl);
  GPGP_PRECISE float value = near + place.v * (far - near);
  return settleFinite(value);
}

/// One coordinate in the world of a point in the axiom's object space, by a row of the axiom's transform.
GPGP_FN float worldCoordinate(vec3 point, vec4 row) {
  const vec3 direction = nearbyLengths(settle3(vec3(row.x, row.y, row.z)));
  GPGP_PRECISE float sum = sumOfProducts(direction, nearbyLengths(point)) + settle(row.w);
  return settleFinite(sum);
}

GPGP_SHADER_END
#endif
