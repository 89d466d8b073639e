// A camera's axes, from the rows of its matrix, so that any projection will do.
#pragma once
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gpgp/visibility.h>

namespace gpgp::visibility {

inline glm::vec3 rowOf(const GpgpCamera& camera, int row) {
  const float* m = camera.viewProjection + row;
  return {m[0], m[4], m[8]};
}

/// The camera at another place, looking the same way.
inline GpgpCamera moved(const GpgpCamera& camera, const glm::vec3& by) {
  GpgpCamera result = camera;
  for (int row = 0; row < 4; ++row) result.viewProjection[12 + row] -= glm::dot(rowOf(camera, row), by);
  return result;
}

struct CameraAxes {
  bool perspective;
  glm::vec3 x, y;            ///< rows 0 and 1, without what an off-centre projection adds along the view
  glm::vec3 right, up, back; ///< of length 1, in world space; not finite where the matrix has no such direction

  explicit CameraAxes(const GpgpCamera& camera) {
    const glm::vec3 w = rowOf(camera, 3), depth = rowOf(camera, 2);
    perspective = glm::dot(w, w) > 0;
    const glm::vec3 forward = perspective ? w : camera.reversedDepth ? -depth : depth;
    back = -glm::normalize(forward);
    const auto across = [&](int row) {
      const glm::vec3 axis = rowOf(camera, row);
      return axis - back * glm::dot(axis, back);
    };
    x = across(0);
    y = across(1);
    right = glm::normalize(x);
    up = -glm::normalize(y);
  }
};

} // namespace gpgp::visibility
