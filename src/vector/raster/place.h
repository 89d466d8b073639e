// How an item's transform becomes what shaders read; shared with the CPU twin, which must see the same numbers.
#pragma once
#include "vector/layout.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <cmath>

namespace gpgp::vector {

/// Fills in transform, inverse, offsets, side and, for projective items, perspective and eye. False where nothing is to
/// be seen on a canvas of that size: the map has no inverse that float can hold, or all lies behind the eye.
inline bool placeItem(const GpgpCanvasItem& from, uint32_t width, uint32_t height, shader::ItemRecord& item) {
  const auto number = [](float v) { return static_cast<double>(v); };
  const auto narrow = [](double v) { return static_cast<float>(v); };
  const float* t = from.transform;
  double a = number(t[0]), b = number(t[1]), c = number(t[2]), d = number(t[3]), e = number(t[4]), f = number(t[5]);
  const double p = number(from.perspective[0]), q = number(from.perspective[1]), r = number(from.perspective[2]);
  const bool projective = p != 0 || q != 0;
  if (!projective && r != 0) { // all at one distance: affine
    if (r < 0) return false;
    a /= r, b /= r, c /= r, d /= r, e /= r, f /= r;
  }
  item.transform = {narrow(a), narrow(b), narrow(c), narrow(d)};
  if (!projective) {
    const double determinant = a * d - b * c;
    if (!(std::abs(determinant) > 1e-30)) return false;
    item.inverse = {narrow(d / determinant), narrow(-b / determinant), narrow(-c / determinant),
                    narrow(a / determinant)};
    item.offsets = {narrow((c * f - d * e) / determinant), narrow((b * e - a * f) / determinant), narrow(e), narrow(f)};
    item.side = determinant < 0 ? -1.0f : 1.0f;
  } else {
    // The inverse of the rows (a c e), (b d f), (p q r).
    const double determinant = a * (d * r - f * q) - c * (b * r - f * p) + e * (b * q - d * p);
    if (!(std::abs(determinant) > 1e-60)) return false;
    const auto over = [&](double v) { return narrow(v / determinant); };
    item.inverse = {over(d * r - f * q), over(f * p - b * r), over(e * q - c * r), over(a * r - e * p)};
    item.offsets = {over(c * f - e * d), over(e * b - a * f), narrow(e), narrow(f)};
    const double x = (b * q - d * p) / determinant, y = (c * p - a * q) / determinant,
                 z = (a * d - c * b) / determinant;
    // 1 / w over the canvas and a margin around it is at most that of a corner; what lies at half that distance is
    // seen beyond the canvas.
    constexpr double kMargin = 64;
    const double nearest =
        std::max(-kMargin * x, (width + kMargin) * x) + std::max(-kMargin * y, (height + kMargin) * y) + z;
    if (!(nearest > 0)) return false;
    item.perspective = {from.perspective[0], from.perspective[1], from.perspective[2], narrow(0.5 / nearest)};
    item.eye = {narrow(x), narrow(y), narrow(z), x < 0 ? 1.0f : 0.0f};
    item.side = determinant < 0 ? -1.0f : 1.0f;
    if (!(item.perspective.w > 1e-30f)) return false;
  }
  for (int i = 0; i < 4; ++i)
    if (!std::isfinite(item.transform[i]) || !std::isfinite(item.inverse[i]) || !std::isfinite(item.offsets[i]) ||
        !std::isfinite(item.perspective[i]) || !std::isfinite(item.eye[i]))
      return false;
  return true;
}

/// Whether glyphs placed by it stay finite, whatever their place and size.
inline bool placesGlyphs(const shader::ItemRecord& item) {
  bool good = std::abs(item.offsets.z) < 1e20f && std::abs(item.offsets.w) < 1e20f;
  for (int i = 0; i < 4; ++i)
    good = good && std::abs(item.transform[i]) < 1e20f && std::abs(item.perspective[i]) < 1e20f;
  return good;
}

} // namespace gpgp::vector
