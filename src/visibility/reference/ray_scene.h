// Triangles as the reference sees them: of the engine's buffers, in the world, in double precision.
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <gpgp/visibility.h>

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace gpgp::visibility {

struct RayScene {
  std::span<const float> positions; ///< x, y, z
  std::span<const uint32_t> indices;
  std::span<const GpgpMesh> meshes;
  std::span<const GpgpVisibilityDraw> draws;
  uint32_t triangleCount = 0;         ///< numbers are below
  std::span<const float> coordinates; ///< texture coordinates by vertex; missing ones are 0
  /// Whether an alpha test's texture lets a triangle be at a place; on any thread.
  std::function<bool(uint32_t test, glm::dvec2 place)> passesAlpha;
};

/// All triangles of all draws, by their place among them.
class RayTriangles {
public:
  /// The scene's buffers must outlive it. Draws of no mesh have no triangles.
  explicit RayTriangles(const RayScene& scene);

  struct Triangle {
    std::array<glm::dvec3, 3> corners;
    std::array<glm::dvec2, 3> coordinates{};
    uint32_t number = 0;
    uint32_t flags = 0;  ///< GPGP_DRAW_...
    bool turned = false; ///< the transform mirrors
    double rounding = 0; ///< how far float numbers as large as these may lie from what they stand for
    bool usable = false; ///< indices and number in range, corners finite and below 2^100
  };
  size_t size() const { return first_.back(); }
  Triangle at(size_t place) const;
  const RayScene& scene() const { return scene_; }

private:
  const RayScene scene_;
  std::vector<size_t> first_; ///< of each draw, and the number of all
};

} // namespace gpgp::visibility
