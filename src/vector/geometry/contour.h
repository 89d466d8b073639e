// Contours as runs of cubics with tangents: what strokes are made from.
#pragma once
#include "vector/geometry/shape.h"

#include <span>

namespace gpgp::vector {

struct Segment {
  Cubic curve;
  Point in, out;      ///< unit tangents at its ends
  bool smooth = true; ///< its end is inside a curve of the path: a join there is round whatever the style says
};

struct Contour {
  explicit Contour(std::pmr::memory_resource* memory) : segments(memory) {}
  std::pmr::vector<Segment> segments;
  bool closed = false;
  Point start, direction{1, 0}; ///< where it is, if it has no segments: a point
};

/// The contours of a shape, as a stroke sees them: parts shorter than `tiny` are left out, flat curves are lines there
/// and back, and what turns within less than `reach` is a corner. A contour without length has no segments.
void contoursOf(const Shape& shape, double tiny, double reach, std::pmr::vector<Contour>& contours);

/// Cuts a contour into its dashes by arc length. False where there would be more than `maxDashes`.
bool dash(const Contour& contour, std::span<const double> pattern, double offset, size_t maxDashes,
          std::pmr::vector<Contour>& dashes);

} // namespace gpgp::vector
