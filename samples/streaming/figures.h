// What displays showed: fallback shades, holes, and likeness to local rendering.
#pragma once
#include "quality.h"
#include "statistics.h"

namespace streaming {

class DisplayFigures {
public:
  void add(const PixelCounts& counts);
  void add(const Quality& quality);
  /// Of its last picture, in per cent of the pixels that show geometry.
  double lastFallback() const { return last_; }
  /// Every pixel of geometry had a shade, and was counted.
  bool allShaded() const { return holes_ == 0 && accounted_; }
  uint64_t displays() const { return fallback_.count(); }
  void print() const;
  nlohmann::json json() const;

private:
  double fallbackPerCent() const;
  double framesPerCent() const;
  uint64_t pixels_ = 0, lastPixels_ = 0, meanPixels_ = 0, unseenPixels_ = 0, frames_ = 0, holes_ = 0;
  bool accounted_ = true;
  double last_ = 0;
  Series fallback_, psnr_, ssim_;
};

} // namespace streaming
