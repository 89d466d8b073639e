// Triangles to a picture on the CPU, for --image and --overlay: depth-buffered, flat-lit, with the sun's shadows where
// asked for. It shows results; it is no part of how they are computed.
#pragma once
#include "host/picture.h"

#include <glm/glm.hpp>

#include <array>
#include <span>
#include <vector>

namespace gpgp::cli {

struct Bounds {
  glm::vec3 low{1e30f}, high{-1e30f};
  void add(const glm::vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  glm::vec3 centre() const { return (low + high) * 0.5f; }
  /// Half the diagonal; of a point not 0, either, for cameras divide by it.
  float radius() const {
    const float half = glm::length(high - low) * 0.5f;
    return half > 0 ? half : 1.0f;
  }
};

/// World to clip (Vulkan's: +Y down, depth 0 to 1), looking at the middle of the bounds from a direction so that all of
/// it is seen. yaw and pitch in degrees: 0, 0 looks along -Z.
glm::mat4 viewAll(const Bounds& bounds, float yaw, float pitch, uint32_t width, uint32_t height);

/// The same from a place at another, with the field of view from top to bottom in degrees. The near plane is a
/// thousandth of the distance between them away, at most 10 cm, the far plane 100 000 times as far. The places must
/// differ.
glm::mat4 viewFrom(const glm::vec3& eye, const glm::vec3& target, float fov, uint32_t width, uint32_t height);

class Painter {
public:
  /// smooth: a pixel is the mean of its four quarters. magnified: it becomes 3 x 3 of the picture's, and the middle one
  /// shows what lies at its centre.
  enum class Style { smooth, magnified };
  /// reversed: the cameras' near is 1.
  Painter(uint32_t width, uint32_t height, bool reversed = false, Style style = Style::smooth);
  /// For shadows: first the bounds of what casts them, then each triangle that does, then the picture's triangles.
  void sun(const Bounds& bounds);
  void shadow(std::span<const glm::vec3, 3> corners);
  struct Triangle {
    std::array<glm::vec3, 3> corners; ///< in world space
    glm::vec3 colour;                 ///< sRGB, 0 to 1
    uint8_t rank = 0;                 ///< for mark(): 0 to 254
    uint32_t number = 0;              ///< and its own number
  };
  /// What lies before the near plane is cut off.
  void triangle(const glm::mat4& viewProjection, const Triangle& triangle);
  /// In a magnified picture, after all triangles: one that no point shows takes those that it touches and that show the
  /// background or a lower rank farther away. If all are nearer, but it is known to be in sight, it takes the one where
  /// it is least behind. Centres stay as they are.
  void mark(const glm::mat4& viewProjection, const Triangle& triangle, bool isInSight);
  host::Picture picture() const;

private:
  struct Piece;
  /// The parts of a triangle behind the near plane, on the points.
  std::vector<Piece> pieces(const glm::mat4& viewProjection, const Triangle& triangle) const;
  bool lit(const glm::vec3& point, float tolerance) const;
  void put(size_t point, const Triangle& triangle, float light);
  bool reversed_;
  Style style_;
  uint32_t width_, height_; // in points
  std::vector<float> depth_;
  std::vector<glm::u8vec4> colour_; // and the rank, one higher than given; 0: background
  std::vector<uint32_t> number_;    // of the triangle that is shown; in magnified pictures
  glm::mat4 toSun_{1.0f}; // world to the shadow map: x and y in its pixels, z the distance from the sun in metres
  float sunPixel_ = 0;    // metres that a pixel of the shadow map covers
  std::vector<float> sunDepth_;
};

/// A pleasant colour for the n-th of something.
glm::vec3 paletteColour(uint32_t n);

} // namespace gpgp::cli
