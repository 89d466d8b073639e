// Paths of shape layers, and what changes them: trims, round corners, puckers, zigzags, twists, offsets.
#pragma once
#include "vector/import/lottie/property.h"

namespace gpgp::vector::lottie {

/// A contour of cubics. `in` and `out` are the control points before and behind a vertex, not relative to it.
struct Contour {
  struct Vertex {
    Point at, in, out;
  };
  std::vector<Vertex> vertices;
  bool closed = false;

  size_t segments() const { return vertices.size() < 2 && !closed ? 0 : vertices.size() - (closed ? 0 : 1); }
  std::array<Point, 4> segment(size_t i) const {
    const Vertex &a = vertices[i], &b = vertices[(i + 1) % vertices.size()];
    return {a.at, a.out, b.in, b.at};
  }
  double length() const;
};

/// From Property's numbers.
Contour contourOf(const std::vector<double>& numbers, bool closed);
Contour rectangleOf(Point center, Point size, double radius, bool backwards);
Contour ellipseOf(Point center, Point size, bool backwards);
struct Star {
  bool polygon = false, backwards = false;
  Point center;
  double points = 5, rotation = 0;                                                 ///< degrees
  double innerRadius = 0, outerRadius = 0, innerRoundness = 0, outerRoundness = 0; ///< percent
};
Contour starOf(const Star& star);

/// What lies between two parts (0 to 1 each, start <= end) of the length of a contour. A closed contour of which all is
/// kept stays closed.
Contour trimmed(const Contour& contour, double start, double end);
/// The same for a range that wraps: `end` may be up to 2. The pieces of a closed contour are joined.
std::vector<Contour> trimmedAround(const Contour& contour, double start, double end);
Contour roundedCorners(const Contour& contour, double radius);
/// Vertices towards (positive) or away from their mean, tangents the other way; percent.
Contour puckered(const Contour& contour, double amount);
/// Turned around `center` the more the nearer to it.
Contour twisted(const Contour& contour, double degrees, Point center);
Contour zigzagged(const Contour& contour, double amplitude, double ridges, bool smooth);
Contour mapped(const Contour& contour, const Affine& map);
void append(const Contour& contour, const Affine& map, Shape& shape);

} // namespace gpgp::vector::lottie
