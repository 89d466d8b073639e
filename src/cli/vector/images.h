// The images inside an SVG or an animation: decoded while it is compiled, shrunk when it is known how large they are
// shown.
#pragma once
#include "cli/shared/textures.h"

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
  template <class Source> void attach(Source& source) {
    source.imageFn = decode;
    source.imageUserData = this;
  }
  const std::vector<host::Picture>& pictures() const { return pictures_; }

private:
  static VkBool32 GPGP_CALL decode(void* userData, uint32_t index, const void* data, size_t size, uint32_t* width,
                                   uint32_t* height);
  std::vector<host::Picture> pictures_;
};

/// Halved until they have about as many texels as the picture has pixels there. The transform: drawing to pixel.
std::vector<TexturePicture> shrunkToShown(std::vector<host::Picture> pictures, const vector::Drawing& drawing,
                                          const float (&transform)[6]);

} // namespace gpgp::cli
