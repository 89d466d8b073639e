// What a GpgpStroke must be: asked where paths are converted, and where a font's glyph takes one.
#pragma once
#include "core/result.h"

#include <gpgp/vector.h>

#include <cmath>

namespace gpgp::vector {

inline core::Result<void> checkStroke(const GpgpStroke& s) {
  const auto bad = [](const char* what, double value, const char* expected) {
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "stroke.%s is %g; it must be %s", what, value, expected);
  };
  if (!(s.width >= 0 && s.width <= 1e7f)) return bad("width", static_cast<double>(s.width), "0 to 1e7");
  if (s.cap < GPGP_CAP_BUTT || s.cap > GPGP_CAP_SQUARE) return bad("cap", s.cap, "a GpgpCap");
  if (s.join < GPGP_JOIN_MITER || s.join > GPGP_JOIN_BEVEL) return bad("join", s.join, "a GpgpJoin");
  if (s.miterLimit != 0 && !(s.miterLimit >= 1 && std::isfinite(s.miterLimit)))
    return bad("miterLimit", static_cast<double>(s.miterLimit), "0, for the default, or finite and at least 1");
  if (!std::isfinite(s.dashOffset)) return bad("dashOffset", static_cast<double>(s.dashOffset), "finite");
  if (!(s.scale >= 0 && std::isfinite(s.scale)))
    return bad("scale", static_cast<double>(s.scale), "finite and not negative");
  if (s.dashCount && !s.dashes) return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "stroke.dashes is NULL");
  for (uint32_t i = 0; i < s.dashCount; ++i)
    if (!(s.dashes[i] >= 0 && std::isfinite(s.dashes[i])))
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "stroke.dashes[%u] is %g; it must be finite and not negative",
                             i, static_cast<double>(s.dashes[i]));
  return {};
}

} // namespace gpgp::vector
