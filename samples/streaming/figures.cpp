#include "figures.h"

#include <cstdio>

namespace streaming {

void DisplayFigures::add(const PixelCounts& counts) {
  pixels_ += counts.geometry;
  lastPixels_ += counts.last;
  meanPixels_ += counts.mean;
  unseenPixels_ += counts.unseen;
  holes_ += counts.holes;
  frames_ += counts.fallback() > 0;
  accounted_ = accounted_ && counts.geometry == counts.atlas + counts.fallback() + counts.holes;
  last_ = counts.geometry ? 100.0 * counts.fallback() / counts.geometry : 0;
  fallback_.add(last_);
}

void DisplayFigures::add(const Quality& quality) {
  psnr_.add(quality.psnr);
  ssim_.add(quality.ssim);
}

double DisplayFigures::fallbackPerCent() const {
  return pixels_ ? 100.0 * static_cast<double>(lastPixels_ + meanPixels_) / static_cast<double>(pixels_) : 0;
}

double DisplayFigures::framesPerCent() const {
  return displays() ? 100.0 * static_cast<double>(frames_) / static_cast<double>(displays()) : 0;
}

void DisplayFigures::print() const {
  std::printf("fallback: %.4f %% of pixels (worst display %.3f %%), in %.1f %% of displays; of %llu pixels %llu show "
              "triangles that were not found visible; %llu holes\n",
              fallbackPerCent(), fallback_.worst(), framesPerCent(),
              static_cast<unsigned long long>(lastPixels_ + meanPixels_),
              static_cast<unsigned long long>(unseenPixels_), static_cast<unsigned long long>(holes_));
  std::printf("against local rendering: PSNR %.2f dB (least %.2f), SSIM %.4f (least %.4f), %llu pictures\n",
              psnr_.mean(), psnr_.least(), ssim_.mean(), ssim_.least(), static_cast<unsigned long long>(psnr_.count()));
}

nlohmann::json DisplayFigures::json() const {
  return {{"displays", displays()},
          {"pixels", pixels_},
          {"fallbackPixels", {{"last", lastPixels_}, {"mean", meanPixels_}, {"notFoundVisible", unseenPixels_}}},
          {"fallbackPerCent", fallbackPerCent()},
          {"fallbackWorstDisplayPerCent", fallback_.worst()},
          {"displaysWithFallbackPerCent", framesPerCent()},
          {"holes", holes_},
          {"psnr", {{"mean", psnr_.mean()}, {"least", psnr_.least()}, {"count", psnr_.count()}}},
          {"ssim", {{"mean", ssim_.mean()}, {"least", ssim_.least()}}}};
}

} // namespace streaming
