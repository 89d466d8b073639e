// A picture of triangles that stand on a ground, for --image.
#pragma once
#include "cli/shared/common.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>

namespace gpgp::cli {

struct SceneView {
  Size size{1280, 720};
  float yaw = 35, pitch = 25, zoom = 1;
  float ground = 0; ///< how far the ground lies below, in parts of the scene's extent: what is flat on it is seen then
  std::optional<glm::mat4> camera = {}; ///< world to clip, instead of yaw, pitch and zoom
};

/// Writes a PNG. colour: sRGB, of a triangle by its number.
void paintScene(const std::string& file, const SceneView& view, std::span<const std::array<glm::vec3, 3>> triangles,
                const std::function<glm::vec3(size_t)>& colour);

} // namespace gpgp::cli
