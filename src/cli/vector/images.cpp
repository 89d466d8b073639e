#include "cli/vector/images.h"

#include "vector/patch/drawing.h"

#include <algorithm>
#include <cmath>

namespace gpgp::cli {

VkBool32 GPGP_CALL VectorImages::decode(void* userData, uint32_t index, const void* data, size_t size, uint32_t* width,
                                        uint32_t* height) {
  auto& images = *static_cast<VectorImages*>(userData);
  try {
    host::Picture picture = host::decodePicture({static_cast<const uint8_t*>(data), size});
    if (picture.width == 0) return VK_FALSE;
    *width = picture.width;
    *height = picture.height;
    images.pictures_.resize(std::max<size_t>(images.pictures_.size(), index + 1));
    images.pictures_[index] = std::move(picture);
    return VK_TRUE;
  } catch (const std::bad_alloc&) { // the compiler, which calls this, throws nothing on
    return VK_FALSE;
  }
}

std::vector<TexturePicture> shrunkToShown(std::vector<host::Picture> pictures, const vector::Drawing& drawing,
                                          const float (&transform)[6]) {
  const double scale = std::sqrt(std::abs(static_cast<double>(transform[0]) * static_cast<double>(transform[3])));
  std::vector<TexturePicture> shown;
  for (uint32_t i = 0; i < pictures.size(); ++i) {
    ShareOfPixel largest, smallest; // where the picture is shown largest, and smallest
    for (const vector::PaintRecord& paint : drawing.paints) {
      if (paint.kind != shader::kPaintImage || paint.firstStop != i) continue;
      const auto length = [scale](float a, float b) { return static_cast<double>(std::hypot(a, b)) / scale; };
      const double u = length(paint.matrix.x, paint.matrix.z), v = length(paint.matrix.y, paint.matrix.w);
      largest.across = largest.across > 0 ? std::min(largest.across, u) : u;
      largest.down = largest.down > 0 ? std::min(largest.down, v) : v;
      smallest = {std::max(smallest.across, u), std::max(smallest.down, v)};
    }
    shown.push_back(shrunk(std::move(pictures[i]), largest, smallest));
  }
  return shown;
}

} // namespace gpgp::cli
