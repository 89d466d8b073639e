#include "cli/spawn/scene_picture.h"

#include "cli/shared/painter.h"
#include "host/picture.h"

#include <algorithm>

namespace gpgp::cli {

void paintScene(const std::string& file, const SceneView& view, std::span<const std::array<glm::vec3, 3>> triangles,
                const std::function<glm::vec3(size_t)>& colour) {
  Bounds bounds;
  for (const auto& corners : triangles)
    for (const glm::vec3& corner : corners) bounds.add(corner);
  if (triangles.empty()) bounds.add(glm::vec3(0));
  glm::mat4 camera = viewAll(bounds, view.yaw, view.pitch, view.size.width, view.size.height);
  for (int c = 0; c < 4; ++c) {
    camera[c].x *= view.zoom;
    camera[c].y *= view.zoom;
  }
  if (view.camera) camera = *view.camera;
  Painter painter(view.size.width, view.size.height);
  painter.sun(bounds);
  for (const auto& corners : triangles) painter.shadow(corners);
  for (size_t i = 0; i < triangles.size(); ++i) painter.triangle(camera, {triangles[i], colour(i)});
  const glm::vec3 extent = bounds.high - bounds.low;
  const float widest = std::max({extent.x, extent.y, extent.z}), margin = 0.15f * widest;
  const float height = bounds.low.y - view.ground * widest;
  const glm::vec3 a(bounds.low.x - margin, height, bounds.low.z - margin), ground(0.80f, 0.82f, 0.76f);
  const glm::vec3 b(a.x, a.y, bounds.high.z + margin), c(bounds.high.x + margin, a.y, b.z), d(c.x, a.y, a.z);
  painter.triangle(camera, {{a, b, c}, ground});
  painter.triangle(camera, {{a, c, d}, ground});
  host::writePng(file, painter.picture());
}

} // namespace gpgp::cli
