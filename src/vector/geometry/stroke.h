// Strokes as filled shapes (SVG 2, 13.5 and 13.7).
#pragma once
#include "vector/geometry/shape.h"

#include <span>

namespace gpgp::vector {

enum class Cap { Butt, Round, Square };
enum class Join {
  Miter,
  Round,
  Bevel,
  MiterClip, ///< longer miters are cut at the limit
  Arcs       ///< edges go on with their curvature until they meet, cut at the limit; as MiterClip where they cannot
};

struct StrokeStyle {
  double width = 1;
  Cap cap = Cap::Butt;
  Join join = Join::Miter;
  double miterLimit = 4;
  std::span<const double> dashes; ///< even count, none negative, sum positive; or empty: no dashes
  double dashOffset = 0;
};

/// What a stroke may cost; more is an error, not a long wait.
struct StrokeLimits {
  size_t points = size_t(1) << 21;
  size_t dashes = size_t(1) << 16;
};

/// How long all contours are together; closing lines count, moves do not.
double lengthOf(const Shape& shape);

/// Appends the area that a stroke covers, to be filled non-zero; overlaps never show because every part turns the same
/// way. The outline is off by less than `tolerance`. Memory comes from where the result has its own. False, with
/// nothing appended, where the limits are exceeded.
bool strokeShape(const Shape& shape, const StrokeStyle& style, double tolerance, const StrokeLimits& limits,
                 Shape& result);

} // namespace gpgp::vector
