#include "vector/text/color_blend.h"

#include <algorithm>
#include <cmath>

namespace gpgp::text {
namespace {

using Color = std::array<float, 3>; // straight

constexpr float kNone = 1e-4f, kAll = 1 - kNone; ///< but for rounding

/// Of channels that mix each by itself: backdrop, source (chapter 10.1).
float blend(uint32_t mode, float b, float s) {
  const auto hardLight = [](float below, float above) {
    return above <= 0.5f ? 2 * below * above : below + (2 * above - 1) - below * (2 * above - 1);
  };
  switch (mode) {
  case 13: return b + s - b * s;                                                   // screen
  case 14: return hardLight(s, b);                                                 // overlay
  case 15: return std::min(b, s);                                                  // darken
  case 16: return std::max(b, s);                                                  // lighten
  case 17: return b <= kNone ? 0 : s >= kAll ? 1 : std::min(1.f, b / (1 - s));     // color-dodge
  case 18: return b >= kAll ? 1 : s <= kNone ? 0 : 1 - std::min(1.f, (1 - b) / s); // color-burn
  case 19: return hardLight(b, s);
  case 20: { // soft-light
    if (s <= 0.5f) return b - (1 - 2 * s) * b * (1 - b);
    const float d = b <= 0.25f ? ((16 * b - 12) * b + 4) * b : std::sqrt(b);
    return b + (2 * s - 1) * (d - b);
  }
  case 21: return std::abs(b - s);   // difference
  case 22: return b + s - 2 * b * s; // exclusion
  default: return b * s;             // multiply
  }
}

float luminosity(const Color& c) { return 0.3f * c[0] + 0.59f * c[1] + 0.11f * c[2]; }
float saturation(const Color& c) { return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}); }
Color withLuminosity(Color c, float wanted) {
  const float change = wanted - luminosity(c);
  for (float& v : c) v += change;
  const float l = luminosity(c), low = std::min({c[0], c[1], c[2]}), high = std::max({c[0], c[1], c[2]});
  for (float& v : c) {
    if (low < 0) v = l + (v - l) * l / (l - low);
    if (high > 1) v = l + (v - l) * (1 - l) / (high - l);
  }
  return c;
}
Color withSaturation(Color c, float wanted) {
  const float low = std::min({c[0], c[1], c[2]}), range = saturation(c);
  for (float& v : c) v = range > 0 ? (v - low) * wanted / range : 0;
  return c;
}
/// Of channels that mix together (chapter 10.2).
Color blendTogether(uint32_t mode, const Color& b, const Color& s) {
  switch (mode) {
  case 24: return withLuminosity(withSaturation(s, saturation(b)), luminosity(b)); // hue
  case 25: return withLuminosity(withSaturation(b, saturation(s)), luminosity(b)); // saturation
  case 26: return withLuminosity(s, luminosity(b));                                // color
  default: return withLuminosity(b, luminosity(s));                                // luminosity
  }
}

} // namespace

Pixel composite(uint32_t mode, const Pixel& s, const Pixel& b) {
  const float sa = s[3], ba = b[3];
  // Porter and Duff: how much of each remains.
  const auto parts = [&](float ofSource, float ofBackdrop) {
    Pixel out{};
    for (size_t c = 0; c < 4; ++c) out[c] = std::min(1.f, ofSource * s[c] + ofBackdrop * b[c]);
    return out;
  };
  switch (mode) {
  case 0: return parts(0, 0);
  case 1: return parts(1, 0);
  case 2: return parts(0, 1);
  case 4: return parts(1 - ba, 1);
  case 5: return parts(ba, 0);
  case 6: return parts(0, sa);
  case 7: return parts(1 - ba, 0);
  case 8: return parts(0, 1 - sa);
  case 9: return parts(ba, 1 - sa);
  case 10: return parts(1 - ba, sa);
  case 11: return parts(1 - ba, 1 - sa);
  case 12: return parts(1, 1);
  default: break;
  }
  if (mode < 13 || mode >= kCompositeModes) return parts(1, 1 - sa);
  if (!(sa > 0) || !(ba > 0)) return parts(1, 1);
  Color source, backdrop, mixed;
  for (size_t c = 0; c < 3; ++c) source[c] = s[c] / sa, backdrop[c] = b[c] / ba;
  if (mode >= 24)
    mixed = blendTogether(mode, backdrop, source);
  else
    for (size_t c = 0; c < 3; ++c) mixed[c] = blend(mode, backdrop[c], source[c]);
  Pixel out = parts(1 - ba, 1 - sa);
  for (size_t c = 0; c < 3; ++c) out[c] += sa * ba * mixed[c];
  out[3] = sa + ba - sa * ba;
  return out;
}

} // namespace gpgp::text
