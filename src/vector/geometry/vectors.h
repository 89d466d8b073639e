// Points of the plane as vectors, for outlines of strokes.
#pragma once
#include "vector/geometry/curve.h"

#include <cmath>

namespace gpgp::vector {

inline double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
inline double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
inline double length(Point p) { return std::sqrt(dot(p, p)); }
inline Point left(Point d) { return {-d.y, d.x}; } ///< turned by a quarter

} // namespace gpgp::vector
