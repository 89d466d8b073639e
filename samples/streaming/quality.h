// How like two pictures are.
#pragma once
#include "display.h"

namespace streaming {

struct Quality {
  double psnr = 0;      ///< decibels over R, G and B; 100 where they are equal
  double ssim = 0;      ///< mean over windows of 8 x 8 pixels, of luma
  uint32_t largest = 0; ///< difference of one channel
};
Quality compare(const Picture& a, const Picture& b);
/// Throws where the file cannot be written.
void writePicture(const std::string& file, const Picture& picture);

} // namespace streaming
