#include "spawn/schedule/camera.h"

#include "core/math.h"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>

namespace gpgp::spawn {
namespace {
using shader::settle;

constexpr float kNothingOutside = shader::kLargest;
/// A plane whose normal is this small beside that of clip space's w is at infinity, but for rounding.
constexpr double kNoNormal = 1e-5;

/// A plane of clip space, seen from the camera.
shader::vec4 planeOf(const glm::dvec4& row, const glm::dvec3& camera, double unit) {
  const glm::dvec3 normal(row);
  const double length = glm::length(normal);
  if (!(length > kNoNormal * unit)) return {0, 0, 0, kNothingOutside};
  const glm::dvec3 n = normal / length;
  const double w = (row.w + glm::dot(normal, camera)) / length;
  return {settle(static_cast<float>(n.x)), settle(static_cast<float>(n.y)), settle(static_cast<float>(n.z)),
          settle(static_cast<float>(w))};
}
} // namespace

float detailOf(const GpgpSpawnCamera* camera) { return camera && camera->detail > 0 ? camera->detail : 1.0f; }

core::Result<shader::View> viewOf(const GpgpSpawnCamera* camera) {
  shader::View view{};
  if (!camera) return view;
  const float* m = camera->viewProjection;
  if (!std::all_of(m, m + 16, [](float x) { return std::isfinite(x); }) ||
      !std::all_of(camera->position, camera->position + 3, [](float x) { return std::isfinite(x); }))
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "the camera's viewProjection or position is not finite");
  if (!camera->height) return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "the camera's height is 0");
  if (!(camera->detail >= 0) || !std::isfinite(camera->detail))
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "the camera's detail is %g, which is no factor",
                           static_cast<double>(camera->detail));
  const auto row = [&](int r) { return glm::dvec4(m[r], m[4 + r], m[8 + r], m[12 + r]); };
  const glm::dvec4 x = row(0), y = row(1), z = row(2), w = row(3);
  const glm::dvec3 position(camera->position[0], camera->position[1], camera->position[2]), forward(w);
  const double depth = glm::length(forward);
  const bool parallel = depth == 0;
  const double unit = parallel ? std::abs(w.w) : depth;
  // Without what an off-centre projection adds along the line of sight.
  glm::dvec3 up(y);
  if (!parallel) up -= forward * (glm::dot(up, forward) / (depth * depth));
  const double pixels = 0.5 * camera->height * glm::length(up) / unit;
  if (!(pixels > 0) || !std::isfinite(pixels))
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "the camera's viewProjection has no height");
  const double scale = std::max(glm::length(glm::dvec3(x)), glm::length(glm::dvec3(y)));
  const double normals = parallel ? scale : depth;
  const auto plane = [&](const glm::dvec4& p) { return planeOf(p, position, normals); };
  const float size = settle(static_cast<float>(pixels * static_cast<double>(detailOf(camera))));
  view.camera = {settle(camera->position[0]), settle(camera->position[1]), settle(camera->position[2]),
                 parallel ? -size : size};
  view.left = plane(w + x);
  view.right = plane(w - x);
  view.bottom = plane(w - y);
  view.top = plane(w + y);
  view.front = plane(z);
  view.back = plane(w - z);
  return view;
}

} // namespace gpgp::spawn
