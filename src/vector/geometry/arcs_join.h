// The join `arcs` (SVG 2, 13.5.5): both outer edges go on with their curvature until they meet.
#pragma once
#include "vector/geometry/curve.h"

#include <optional>

namespace gpgp::vector {

/// How a curve bends at its first or last point: 1 / radius, positive where it turns towards (-y, x) of its tangent.
/// Zero for lines, and where the curve stops at that point.
double startCurvature(const Cubic& curve);
double endCurvature(const Cubic& curve);

/// The outer corner of a stroke.
struct OuterCorner {
  Point vertex;          ///< of the path
  Point from, to;        ///< unit tangents of the path before and behind it
  double offset;         ///< of the outer edge, towards (-y, x) of the tangents; below zero: the other way
  double before, behind; ///< curvatures of the path
  double limit;          ///< of the length from the vertex to the tip, in half widths, at least 1
};

/// A part of an edge: an arc around a centre, or a line where the radius is 0.
struct EdgePart {
  Point end;
  Point centre;
  double radius = 0, sweep = 0; ///< radians, positive from x to y
};
/// From the end of the edge before to the start of the edge behind.
struct ArcsJoin {
  EdgePart before, cut, behind; ///< the cut is a line; its ends coincide where the tip is within the limit
};

/// Nothing where the edges bend too sharply or cannot meet: the join is as `miter-clip` then.
///
/// Circles that do not meet change their radii until they touch: both become larger by the same amount, the inner one
/// of two becomes larger as the outer one becomes smaller, and one that misses a line becomes larger. A tip beyond the
/// limit is cut off at right angles to the arc that leads from the vertex to it.
std::optional<ArcsJoin> arcsJoin(const OuterCorner& corner);

} // namespace gpgp::vector
