#include "cli/visibility/cell_walls.h"

#include "visibility/reference/ray_segments.h"

#include <glm/glm.hpp>

namespace gpgp::cli {
uint32_t leaveOutBehindWalls(std::vector<View>& views, const Model& model) {
  std::vector<glm::dvec3> eyes;
  for (const View& view : views) {
    const auto eye = eyeOf(view);
    if (!eye) return 0;
    eyes.push_back(*eye);
  }
  if (eyes.size() < 2) return 0;
  const std::vector<bool> blocked =
      visibility::blockedWays({model.positions, model.indices, model.meshes, model.draws, model.triangleCount}, eyes[0],
                              std::span(eyes).subspan(1));
  std::vector<View> kept{views[0]};
  for (size_t i = 0; i < blocked.size(); ++i)
    if (!blocked[i]) kept.push_back(views[i + 1]);
  const auto left = static_cast<uint32_t>(views.size() - kept.size());
  views = std::move(kept);
  return left;
}

} // namespace gpgp::cli
