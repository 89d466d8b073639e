#include "cli/visibility/pictures.h"

#include <algorithm>
#include <array>

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
      painter.triangle(from.camera, {{corners[t * 3], corners[t * 3 + 1], corners[t * 3 + 2]},
                                     isSet(bits, t) ? glm::vec3(0.95f, 0.55f, 0.15f) : glm::vec3(0.62f)});
    }
    const host::Picture half = painter.picture();
    for (uint32_t y = 0; y < height; ++y)
      std::copy_n(&half.rgba[size_t{y} * width * 4], width * 4, &both.rgba[(size_t{y} * 2 + side) * width * 4]);
  }
  host::writePng(options.image, both);
}

void paintOverlay(const VisibilityOptions& options, const std::vector<glm::vec3>& corners, const View& view,
                  bool ofCell, const std::vector<uint32_t>& found, const std::vector<uint32_t>& standard,
                  const std::vector<uint32_t>& reference) {
  constexpr std::array<glm::vec3, 4> kColours = {glm::vec3(0.2f, 0.75f, 0.25f), glm::vec3(0.6f),
                                                 glm::vec3(0.1f, 0.2f, 0.95f), glm::vec3(0.9f, 0.1f, 0.1f)};
  const size_t count = corners.size() / 3;
  const auto classOf = [&](size_t t) -> uint8_t {
    const bool isFound = isSet(found, t), isTrue = reference.empty() ? isFound : isSet(reference, t);
    return !isTrue ? 3 : !isFound ? 2 : isSet(standard, t) ? 0 : 1;
  };
  // Three points a pixel each way, so that triangles below a pixel are seen, the pixel's centre among them, where
  // standard sampling looks; what they miss all the same is marked.
  Painter painter(options.size.width, options.size.height, view.reversed, Painter::Style::magnified);
  for (const bool marks : {false, true})
    for (size_t t = 0; t < count; ++t) {
      if (!isSet(found, t) && (reference.empty() || !isSet(reference, t))) continue;
      const Painter::Triangle triangle{{corners[t * 3], corners[t * 3 + 1], corners[t * 3 + 2]},
                                       kColours[classOf(t)],
                                       classOf(t),
                                       static_cast<uint32_t>(t)};
      if (marks)
        painter.mark(view.camera, triangle, !ofCell);
      else
        painter.triangle(view.camera, triangle);
    }
  host::writePng(options.overlay, painter.picture());
}

} // namespace gpgp::cli
