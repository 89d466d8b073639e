// What a GpgpStroke must be: asked where paths are converted, and where a font's glyph takes one.
#pragma once
#include "core/result.h"

#include <gpgp/vector.h>

#include <cmath>

namespace gpgp::vector {

inline core::Result<void> checkStroke(const GpgpStroke& s) {
  const auto bad = [](const char* what, double value) {
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "stroke.%s is %g", what, value);
  };
  if (!(s.width >= 0 && s.width <= 1e7f)) return bad("width", static_cast<double>(s.width));
  if (s.cap < GPGP_CAP_BUTT || s.cap > GPGP_CAP_SQUARE) return bad("cap", s.cap);
  if (s.join < GPGP_JOIN_MITER || s.join > GPGP_JOIN_BEVEL) return bad("join", s.join);
  if (s.miterLimit != 0 && !(s.miterLimit >= 1 && std::isfinite(s.miterLimit)))
    return bad("miterLimit", static_cast<double>(s.miterLimit));
  if (!std::isfinite(s.dashOffset)) return bad("dashOffset", static_cast<double>(s.dashOffset));
  if (!(s.scale >= 0 && std::isfinite(s.scale))) return bad("scale", static_cast<double>(s.scale));
  if (s.dashCount && !s.dashes) return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "stroke.dashes is NULL");
  for (uint32_t i = 0; i < s.dashCount; ++i)
    if (!(s.dashes[i] >= 0 && std::isfinite(s.dashes[i])))
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "stroke.dashes[%u] is %g", i,
                             static_cast<double>(s.dashes[i]));
  return {};
}

} // namespace gpgp::vector
