// Contours as lines: the first half of stroking.
#pragma once
#include "vector/import/svg/stroke.h"

namespace gpgp::vector::svg {

/// Distinct neighbouring points. `smooth[i]`: point i is inside a curve, where a join is round whatever the style says.
struct Polyline {
  std::vector<Point> points;
  std::vector<bool> smooth;
  bool closed = false; ///< the last point joins the first, which is not repeated
};

/// The contours of a shape, each curve off by less than `tolerance`, and fine enough for an offset by `halfWidth`.
/// A contour without length is a polyline of one point. False where there would be more than `maxPoints`.
bool flatten(const Shape& shape, double halfWidth, double tolerance, size_t maxPoints, std::vector<Polyline>& lines);

/// Cuts a polyline into its dashes. False where there would be more than `maxDashes`.
bool dash(const Polyline& line, const std::vector<double>& pattern, double offset, size_t maxDashes,
          std::vector<Polyline>& dashes);

} // namespace gpgp::vector::svg
