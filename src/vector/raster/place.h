// How an item's transform becomes what shaders read; shared with the CPU twin, which must see the same numbers.
#pragma once
#include "vector/layout.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector {

/// Fills in transform, inverse, offsets and side. False where the transform has no inverse that float can hold.
inline bool placeItem(const float t[6], shader::ItemRecord& item) {
  const double a = t[0], b = t[1], c = t[2], d = t[3], e = t[4], f = t[5];
  const double determinant = a * d - b * c;
  if (!(std::abs(determinant) > 1e-30)) return false;
  const auto narrow = [](double v) { return static_cast<float>(v); };
  item.transform = {t[0], t[1], t[2], t[3]};
  item.inverse = {narrow(d / determinant), narrow(-b / determinant), narrow(-c / determinant), narrow(a / determinant)};
  item.offsets = {narrow((c * f - d * e) / determinant), narrow((b * e - a * f) / determinant), t[4], t[5]};
  item.side = determinant < 0 ? -1.0f : 1.0f;
  for (int i = 0; i < 4; ++i)
    if (!std::isfinite(item.inverse[i]) || !std::isfinite(item.offsets[i])) return false;
  return true;
}

} // namespace gpgp::vector
