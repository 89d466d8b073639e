// Rotations by angles about three axes.
#pragma once
#include "spawn/cga/functions.h"

#include <glm/vec3.hpp>

namespace gpgp::spawn::cga {

using namespace shader;

inline vec3 turned(const vec3& v, const vec3& x, const vec3& y, const vec3& z) { return x * v.x + y * v.y + z * v.z; }

/// Columns of the rotation by angles in degrees: about x, then the new y, then the new z.
struct Rotation {
  vec3 x, y, z;
  explicit Rotation(const vec3& degrees) {
    const vec2 a = sineCosineDegrees(degrees.x), b = sineCosineDegrees(degrees.y), c = sineCosineDegrees(degrees.z);
    // Rx Ry Rz
    x = {b.y * c.y, a.x * b.x * c.y + a.y * c.x, a.x * c.x - a.y * b.x * c.y};
    y = {-b.y * c.x, a.y * c.y - a.x * b.x * c.x, a.y * b.x * c.x + a.x * c.y};
    z = {b.x, -a.x * b.y, a.y * b.y};
  }
};

} // namespace gpgp::spawn::cga
