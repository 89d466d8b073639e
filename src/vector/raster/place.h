// How an item's transform becomes what shaders read; shared with the CPU reference, which must see the same numbers.
#pragma once
#include "vector/shared/layout.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <cmath>

namespace gpgp::vector {

/// A map of the plane: x' = a x + c y + e, y' = b x + d y + f, both over w = p x + q y + r.
struct Map {
  double a = 1, b = 0, c = 0, d = 1, e = 0, f = 0, p = 0, q = 0, r = 1;
  bool operator==(const Map&) const = default;
  bool projective() const { return p != 0 || q != 0; }
};
/// As the API gives it; `perspective` null or all 0: affine.
inline Map toMap(const float* t, const float* perspective) {
  const auto number = [](float v) { return static_cast<double>(v); };
  Map m{number(t[0]), number(t[1]), number(t[2]), number(t[3]), number(t[4]), number(t[5])};
  if (perspective && (perspective[0] != 0 || perspective[1] != 0 || perspective[2] != 0))
    m.p = number(perspective[0]), m.q = number(perspective[1]), m.r = number(perspective[2]);
  return m;
}
/// First `inner`, then `outer`.
inline Map compose(const Map& outer, const Map& inner) {
  const auto row = [&](double x, double y, double w, double& u, double& v, double& t) {
    u = x * inner.a + y * inner.b + w * inner.p;
    v = x * inner.c + y * inner.d + w * inner.q;
    t = x * inner.e + y * inner.f + w * inner.r;
  };
  Map m;
  row(outer.a, outer.c, outer.e, m.a, m.c, m.e);
  row(outer.b, outer.d, outer.f, m.b, m.d, m.f);
  row(outer.p, outer.q, outer.r, m.p, m.q, m.r);
  return m;
}

/// Fills in transform, inverse, offsets, side, no scissor and, for projective maps, perspective and eye. False where
/// nothing is to be seen on a canvas of that size, which begins at (left, top): the map has no inverse that float can
/// hold, or all lies behind the eye.
inline bool placeItem(const Map& map, uint32_t width, uint32_t height, shader::ItemRecord& item, int left = 0,
                      int top = 0) {
  const auto narrow = [](double v) { return static_cast<float>(v); };
  auto [a, b, c, d, e, f, p, q, r] = map;
  const bool projective = map.projective();
  item.scissor = {-shader::kUnbounded, -shader::kUnbounded, shader::kUnbounded, shader::kUnbounded};
  if (!projective) { // all at one distance: affine
    if (!(r > 0)) return false;
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
    const double nearest = std::max((left - kMargin) * x, (left + width + kMargin) * x) +
                           std::max((top - kMargin) * y, (top + height + kMargin) * y) + z;
    if (!(nearest > 0)) return false;
    item.perspective = {narrow(p), narrow(q), narrow(r), narrow(0.5 / nearest)};
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

inline bool placeItem(const GpgpCanvasItem& from, uint32_t width, uint32_t height, shader::ItemRecord& item) {
  return placeItem(toMap(from.transform, from.perspective), width, height, item);
}

/// How an item's patches are placed: points of the drawing count from what the canvas shows at (middleX, middleY), as
/// far as that is known. `map`: one that placeItem() takes.
inline shader::PatchItemRecord patchItemOf(const Map& map, int middleX, int middleY) {
  const double mx = middleX, my = middleY, scale = map.projective() ? 1 : map.r;
  // Rows x, y and w of the map, and of the one that counts from the middle.
  double m[3][3] = {{map.a / scale, map.c / scale, map.e / scale},
                    {map.b / scale, map.d / scale, map.f / scale},
                    {map.p / scale, map.q / scale, map.r / scale}};
  for (int c = 0; c < 3; ++c) m[0][c] -= mx * m[2][c], m[1][c] -= my * m[2][c];
  const auto minor = [&](int r, int c) {
    const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  double inverse[3][3];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) inverse[r][c] = minor(c, r) / determinant;
  double origin[2] = {};
  if (inverse[2][2] > 0)
    for (int i = 0; i < 2; ++i) {
      const double at = inverse[i][2] / inverse[2][2];
      const volatile float rounded = static_cast<float>(at); // g++ 12 may drop the rounding of a pair
      if (std::abs(at) <= 4e7) origin[i] = static_cast<double>(rounded);
    }
  const auto narrow = [](double v) { return static_cast<float>(v); };
  const auto forward = [&](int r, double w) {
    return shader::vec4(narrow(m[r][0]), narrow(m[r][1]), narrow(m[r][2] + m[r][0] * origin[0] + m[r][1] * origin[1]),
                        narrow(w));
  };
  const auto back = [&](int r, double w) {
    const double at = r < 2 ? origin[r] : 0;
    return shader::vec4(narrow(inverse[r][0] - at * inverse[2][0]), narrow(inverse[r][1] - at * inverse[2][1]),
                        narrow(inverse[r][2] - at * inverse[2][2]), narrow(w));
  };
  return {back(0, origin[0]),
          back(1, origin[1]),
          back(2, map.projective() ? 1 : 0),
          forward(0, mx),
          forward(1, my),
          forward(2, 0),
          0,
          0,
          0,
          0};
}

/// Whether glyphs placed by it stay finite, whatever their place and size.
inline bool placesGlyphs(const shader::ItemRecord& item) {
  bool good = std::abs(item.offsets.z) < 1e20f && std::abs(item.offsets.w) < 1e20f;
  for (int i = 0; i < 4; ++i)
    good = good && std::abs(item.transform[i]) < 1e20f && std::abs(item.perspective[i]) < 1e20f;
  return good;
}

} // namespace gpgp::vector
