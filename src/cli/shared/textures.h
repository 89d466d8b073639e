// Pictures as textures that canvases paint with.
#pragma once
#include "host/memory.h"
#include "host/picture.h"

#include <gpgp/vector.h>

#include <vector>

namespace gpgp::cli {

/// Halved along each side until fewer than 1.5 texels lie along a pixel, as the larger of mip levels: what a texture
/// without them needs.
host::Picture shrunk(host::Picture picture, double texelsAcross, double texelsDown);

/// A texture for each picture, as it is encoded, filtered linearly and clamped.
class Textures {
public:
  Textures(host::HeadlessDevice& device, const std::vector<host::Picture>& pictures);
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
