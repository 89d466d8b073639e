// Moves a camera across its own view.
#include "visibility/view_cell.h"

#include "visibility/camera_axes.h"

#include <algorithm>
#include <cmath>

namespace gpgp::visibility {
namespace {
using core::makeError;
constexpr uint32_t kMaxSide = 64, kMaxWalk = 1024;
constexpr float kPi = 3.14159265f, kGolden = 0.618033989f;

} // namespace

glm::vec4 depthScale(const GpgpCamera& camera, uint32_t width, uint32_t height, float reach) {
  const glm::vec3 w = rowOf(camera, 3);
  const float square = glm::dot(w, w);
  if (!(square > 0)) return glm::vec4(0);
  // Depth is far + near / w: what is infinitely far has `far`.
  const float far = glm::dot(rowOf(camera, 2), w) / square;
  const float near = camera.viewProjection[14] - far * camera.viewProjection[15];
  const auto pixels = [&](int row, uint32_t size) {
    const glm::vec3 axis = rowOf(camera, row), across = axis - w * (glm::dot(axis, w) / square);
    return glm::length(across) * 0.5f * static_cast<float>(size);
  };
  const glm::vec4 scale(far, 1 / near, std::max(pixels(0, width), pixels(1, height)) * reach, near);
  return near != 0 && std::isfinite(scale.x + scale.y + scale.z) ? scale : glm::vec4(0);
}

core::Result<uint32_t> viewCellCameras(const GpgpViewCellInfo& info, uint32_t room, GpgpCamera* cameras) {
  const uint32_t skip = std::max(info.skip, 1u);
  if (info.columns > kMaxSide || info.rows > kMaxSide || !info.columns != !info.rows)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "columns x rows is %u x %u; expected 1 x 1 to %u x %u, or none",
                     info.columns, info.rows, kMaxSide, kMaxSide);
  if (info.columns && (!info.height || !(info.distance > 0 && info.distance < 1e30f)))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "height, distance are %u, %g; a grid needs them above 0", info.height,
                     static_cast<double>(info.distance));
  if (info.walkCount > kMaxWalk || (info.walkCount && !(info.walkDistance > 0 && info.walkDistance < 1e30f)))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "walkCount, walkDistance are %u, %g; expected at most %u, above 0",
                     info.walkCount, static_cast<double>(info.walkDistance), kMaxWalk);
  if (info.pointCount && !info.points)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "points is NULL, but pointCount is %u", info.pointCount);
  const CameraAxes axes(info.camera);
  const glm::vec3 &y = axes.y, &right = axes.right, &up = axes.up, &back = axes.back;
  if (!std::isfinite(glm::dot(right, up) + back.x))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "camera.viewProjection has no direction across or along the view");

  uint32_t count = 0;
  const auto add = [&](const glm::vec3& offset) {
    if (cameras && count < room)
      cameras[count] = moved(info.camera, right * offset.x + up * offset.y + back * offset.z);
    ++count;
  };
  add(glm::vec3(0));
  const uint32_t columns = (info.columns + skip - 1) / skip, rows = (info.rows + skip - 1) / skip;
  const float pixel =
      columns ? 2 * (axes.perspective ? info.distance : 1.0f) / (static_cast<float>(info.height) * glm::length(y))
              : 0.0f;
  for (uint32_t j = 0; j < rows; ++j)
    for (uint32_t i = 0; i < columns; ++i) {
      const glm::vec3 at(static_cast<float>(2 * i) - static_cast<float>(columns - 1),
                         static_cast<float>(2 * j) - static_cast<float>(rows - 1), 0);
      if (at.x != 0 || at.y != 0) add(at * (0.5f * static_cast<float>(skip) * pixel));
    }
  // A lattice of the golden ratio: no two points have the same height or lie in one column. Both coordinates are spread
  // as a cosine is.
  const auto spread = [&](float share) { return -std::cos(kPi * share) * info.walkDistance; };
  for (uint32_t i = 0; i < info.walkCount; ++i) {
    const auto place = static_cast<float>(i);
    const float height = 0.5f + place * kGolden;
    add({spread(info.walkCount > 1 ? place / static_cast<float>(info.walkCount - 1) : 0.5f),
         spread(height - std::floor(height)), 0});
  }
  for (uint32_t i = 0; i < info.pointCount; ++i) {
    const glm::vec3 at(info.points[i * 3], info.points[i * 3 + 1], info.points[i * 3 + 2]);
    if (!std::isfinite(at.x + at.y + at.z))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "points[%u] is not finite", i);
    add(at);
  }
  return count;
}

} // namespace gpgp::visibility
