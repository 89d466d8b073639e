// The curve of a textPath.
#pragma once
#include "vector/geometry/shape.h"

#include <vector>

namespace gpgp::vector::svg {

/// A curve along which glyphs stand, as a polyline.
struct Track {
  std::vector<Point> points;
  std::vector<double> lengths; ///< up to each point
  struct Directions {
    Point from, to; ///< unit vectors
  };
  std::vector<Directions> directions; ///< at the ends of the line to each point
  double offset = 0;                  ///< where the text begins

  double length() const { return lengths.empty() ? 0 : lengths.back(); }
  /// The place at a length with the direction there; false beyond the ends.
  bool at(double along, Point& place, double& angle) const;
};

/// Curves become 64 lines each, and keep their directions.
Track trackOf(const Shape& shape);

} // namespace gpgp::vector::svg
