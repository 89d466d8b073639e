// Pictures as textures that canvases paint with.
#pragma once
#include "host/memory.h"
#include "host/picture.h"

#include <gpgp/vector.h>

#include <vector>

namespace gpgp::cli {

/// A picture and how many levels its texture has.
struct TexturePicture {
  host::Picture picture;
  uint32_t levels = 1;
};

/// The part of a picture's width and height that lies along a pixel, where it is shown.
struct ShareOfPixel {
  double across = 0, down = 0;
};

/// Halved along each side until fewer than 1.5 texels lie along a pixel where the picture is shown largest. It has
/// levels where it is shown smaller as well.
TexturePicture shrunk(host::Picture picture, const ShareOfPixel& largest, const ShareOfPixel& smallest);

/// A texture for each picture, as it is encoded, filtered linearly and clamped.
class Textures {
public:
  Textures(host::HeadlessDevice& device, const std::vector<TexturePicture>& pictures);
  ~Textures();
  Textures(const Textures&) = delete;
  Textures& operator=(const Textures&) = delete;
  const std::vector<GpgpCanvasImage>& views() const { return views_; }

private:
  host::HeadlessDevice& device_;
  VkSampler sampler_ = VK_NULL_HANDLE;
  std::vector<host::Image> textures_;
  std::vector<GpgpCanvasImage> views_;
};

} // namespace gpgp::cli
