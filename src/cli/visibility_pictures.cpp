#include "cli/visibility_pictures.h"

#include <algorithm>

namespace gpgp::cli {

void paintSeen(const VisibilityOptions& options, const std::vector<glm::vec3>& corners, const View& view,
               const Bounds& bounds, const std::vector<uint32_t>& bits) {
  const uint32_t width = options.size.width, height = options.size.height;
  host::Picture both{width * 2, height, std::vector<uint8_t>(size_t{width} * height * 8)};
  for (uint32_t side = 0; side < 2; ++side) {
    const View from =
        side == 0 ? view : View{viewAll(bounds, options.yaw + 110.0f, options.pitch, width, height), false};
    Painter painter(width, height, from.reversed);
    for (size_t t = 0; t < corners.size() / 3; ++t) {
      painter.triangle(from.camera, std::span<const glm::vec3, 3>(&corners[t * 3], 3),
                       isSet(bits, t) ? glm::vec3(0.95f, 0.55f, 0.15f) : glm::vec3(0.62f));
    }
    const host::Picture half = painter.picture();
    for (uint32_t y = 0; y < height; ++y)
      std::copy_n(&half.rgba[size_t{y} * width * 4], width * 4, &both.rgba[(size_t{y} * 2 + side) * width * 4]);
  }
  host::writePng(options.image, both);
}

void paintOverlay(const VisibilityOptions& options, const std::vector<glm::vec3>& corners, const View& view,
                  const std::vector<uint32_t>& found, const std::vector<uint32_t>& standard,
                  const std::vector<uint32_t>& truth) {
  Painter painter(options.size.width, options.size.height, view.reversed);
  for (size_t t = 0; t < corners.size() / 3; ++t) {
    const bool isFound = isSet(found, t), isTrue = truth.empty() ? isFound : isSet(truth, t);
    if (!isFound && !isTrue) continue;
    glm::vec3 colour(0.6f);
    if (isFound && !isTrue)
      colour = {0.9f, 0.1f, 0.1f};
    else if (!isFound)
      colour = {0.1f, 0.2f, 0.95f};
    else if (isSet(standard, t))
      colour = {0.2f, 0.75f, 0.25f};
    painter.triangle(view.camera, std::span<const glm::vec3, 3>(&corners[t * 3], 3), colour);
  }
  host::writePng(options.overlay, painter.picture());
}

} // namespace gpgp::cli
