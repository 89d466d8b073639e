// The images inside an SVG as textures: decoded while it is compiled, uploaded when it is known how large they are
// shown.
#pragma once
#include "host/memory.h"
#include "host/picture.h"

#include <gpgp/vector.h>

#include <vector>

namespace gpgp::vector {
struct Drawing;
}

namespace gpgp::cli {

/// Takes the images while the source is compiled.
class VectorImages {
public:
  VectorImages() = default;
  VectorImages(const VectorImages&) = delete; // the source refers to it
  VectorImages& operator=(const VectorImages&) = delete;
  void attach(GpgpSvgSource& source);
  const std::vector<host::Picture>& pictures() const { return pictures_; }

private:
  static VkBool32 GPGP_CALL decode(void* userData, uint32_t index, const void* data, size_t size, uint32_t* width,
                                   uint32_t* height);
  std::vector<host::Picture> pictures_;
};

/// Textures of all of them, halved until they have about as many texels as the picture has pixels there: what mip
/// levels do. The transform: drawing to pixel.
class VectorTextures {
public:
  VectorTextures(host::HeadlessDevice& device, const std::vector<host::Picture>& pictures,
                 const vector::Drawing& drawing, const float (&transform)[6]);
  ~VectorTextures();
  VectorTextures(const VectorTextures&) = delete;
  VectorTextures& operator=(const VectorTextures&) = delete;
  const std::vector<GpgpCanvasImage>& views() const { return views_; }

private:
  host::HeadlessDevice& device_;
  VkSampler sampler_ = VK_NULL_HANDLE;
  std::vector<host::Image> textures_;
  std::vector<GpgpCanvasImage> views_;
};

} // namespace gpgp::cli
