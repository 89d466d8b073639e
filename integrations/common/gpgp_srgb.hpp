// The sRGB curve, for colours that toolkits give encoded.
#pragma once
#include <cmath>

namespace gpgp::integration {

/// 0 to 1, IEC 61966-2-1.
inline float linearFromSrgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

} // namespace gpgp::integration
