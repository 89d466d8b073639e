// Strokes as filled shapes.
#pragma once
#include "vector/import/svg/outline.h"

namespace gpgp::vector::svg {

enum class Cap { Butt, Round, Square };
enum class Join { Miter, Round, Bevel };

struct StrokeStyle {
  double width = 1;
  Cap cap = Cap::Butt;
  Join join = Join::Miter;
  double miterLimit = 4;
  std::vector<double> dashes; ///< even count, none negative, sum positive; or empty: no dashes
  double dashOffset = 0;
};

/// What a stroke may cost; more is an error, not a long wait.
struct StrokeLimits {
  size_t points = size_t(1) << 21;
  size_t dashes = size_t(1) << 16;
};

/// The area a stroke covers, to be filled non-zero; overlaps never show because every part turns the same way.
/// Curves become lines off by less than `tolerance`, round joins and caps stay curves. Returns false, with nothing
/// appended, where the limits are exceeded.
bool strokeShape(const Shape& shape, const StrokeStyle& style, double tolerance, const StrokeLimits& limits,
                 Shape& result);

} // namespace gpgp::vector::svg
