// Triangles to a picture on the CPU, for --image: depth-buffered, flat-lit, with the sun's shadows where asked for,
// four samples a pixel. It shows results; it is no part of how they are computed.
#pragma once
#include "host/picture.h"

#include <glm/glm.hpp>

#include <array>
#include <span>

namespace gpgp::cli {

struct Bounds {
  glm::vec3 low{1e30f}, high{-1e30f};
  void add(const glm::vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  glm::vec3 centre() const { return (low + high) * 0.5f; }
};

/// World to clip (Vulkan's: +Y down, depth 0 to 1), looking at the middle of the bounds from a direction so that all of
/// it is seen. yaw and pitch in degrees: 0, 0 looks along -Z.
glm::mat4 viewAll(const Bounds& bounds, float yaw, float pitch, uint32_t width, uint32_t height);

class Painter {
public:
  /// reversed: the cameras' near is 1.
  Painter(uint32_t width, uint32_t height, bool reversed = false);
  /// For shadows: first the bounds of what casts them, then each triangle that does, then the picture's triangles.
  void sun(const Bounds& bounds);
  void shadow(std::span<const glm::vec3, 3> corners);
  /// Corners in world space, colour as sRGB 0 to 1. What lies before the near plane is cut off.
  void triangle(const glm::mat4& viewProjection, std::span<const glm::vec3, 3> corners, const glm::vec3& colour);
  host::Picture picture() const;

private:
  struct Corner {
    glm::vec4 clip;
    glm::vec3 world;
  };
  /// front: the normal of the side whose corners are counter-clockwise.
  void piece(const std::array<Corner, 3>& corners, const glm::vec3& front, const glm::vec3& colour);
  bool lit(const glm::vec3& point, float tolerance) const;
  bool reversed_;
  uint32_t width_, height_; // of the picture; the buffers have twice as many pixels each way
  std::vector<float> depth_;
  std::vector<glm::vec3> colour_;
  glm::mat4 toSun_{1.0f}; // world to the shadow map: x and y in its pixels, z the distance from the sun in metres
  float sunPixel_ = 0;    // metres that a pixel of the shadow map covers
  std::vector<float> sunDepth_;
};

/// A pleasant colour for the n-th of something.
glm::vec3 paletteColour(uint32_t n);

} // namespace gpgp::cli
