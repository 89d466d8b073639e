#include "quality.h"

#include "target.h"

#include <algorithm>
#include <cmath>

namespace streaming {
namespace {

double channel(uint32_t pixel, int i) { return static_cast<double>(pixel >> (8 * i) & 255); }
double luma(uint32_t pixel) {
  return 0.2126 * channel(pixel, 0) + 0.7152 * channel(pixel, 1) + 0.0722 * channel(pixel, 2);
}

/// Wang et al. 2004, with uniform windows.
double windowSsim(const Picture& a, const Picture& b, uint32_t x0, uint32_t y0) {
  constexpr double kC1 = 6.5025, kC2 = 58.5225, kCount = 64;
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (uint32_t y = y0; y < y0 + 8; ++y)
    for (uint32_t x = x0; x < x0 + 8; ++x) {
      const double p = luma(a.pixels[size_t{y} * a.width + x]), q = luma(b.pixels[size_t{y} * b.width + x]);
      sa += p, sb += q, saa += p * p, sbb += q * q, sab += p * q;
    }
  const double ma = sa / kCount, mb = sb / kCount;
  const double va = saa / kCount - ma * ma, vb = sbb / kCount - mb * mb, cov = sab / kCount - ma * mb;
  return (2 * ma * mb + kC1) * (2 * cov + kC2) / ((ma * ma + mb * mb + kC1) * (va + vb + kC2));
}

} // namespace

Quality compare(const Picture& a, const Picture& b) {
  Quality quality;
  double sum = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double difference = std::abs(channel(a.pixels[i], c) - channel(b.pixels[i], c));
      quality.largest = std::max(quality.largest, static_cast<uint32_t>(difference));
      sum += difference * difference;
    }
  const double mean = sum / (3.0 * static_cast<double>(a.pixels.size()));
  quality.psnr = mean > 0 ? std::min(100.0, 10 * std::log10(255 * 255 / mean)) : 100;
  uint32_t windows = 0;
  for (uint32_t y = 0; y + 8 <= a.height; y += 4)
    for (uint32_t x = 0; x + 8 <= a.width; x += 4, ++windows) quality.ssim += windowSsim(a, b, x, y);
  quality.ssim /= std::max(windows, 1u);
  return quality;
}

void writePicture(const std::string& file, const Picture& picture) {
  mini::writePng(file, {picture.width, picture.height}, picture.pixels.data());
}

} // namespace streaming
