// Regular polygons and prisms, box and sphere, as triangles.
#include "cli/unit_shapes.h"

#include <cmath>

namespace gpgp::cli {
namespace {

using Corners = std::vector<glm::vec2>;

Corners square() { return {{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}}; }

/// A regular polygon with a corner up, stretched to fill the unit square.
Corners regular(uint32_t sides) {
  if (sides == 4) return square();
  Corners corners;
  glm::vec2 low(1e9f), high(-1e9f);
  for (uint32_t i = 0; i < sides; ++i) {
    const float angle = 1.5707963f + 6.2831853f * static_cast<float>(i) / static_cast<float>(sides);
    corners.emplace_back(std::cos(angle), std::sin(angle));
    low = glm::min(low, corners.back());
    high = glm::max(high, corners.back());
  }
  for (glm::vec2& corner : corners) corner = (corner - low) / (high - low) - 0.5f;
  return corners;
}

void add(std::vector<glm::vec3>& out, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  out.insert(out.end(), {a, b, c});
}

std::vector<glm::vec3> polygon(const Corners& corners) {
  std::vector<glm::vec3> out;
  for (size_t i = 1; i + 1 < corners.size(); ++i)
    add(out, glm::vec3(corners[0], 0), glm::vec3(corners[i], 0), glm::vec3(corners[i + 1], 0));
  return out;
}

std::vector<glm::vec3> prism(const Corners& corners) {
  std::vector<glm::vec3> out;
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    add(out, glm::vec3(corners[0], 0.5f), glm::vec3(corners[i], 0.5f), glm::vec3(corners[i + 1], 0.5f));
    add(out, glm::vec3(corners[0], -0.5f), glm::vec3(corners[i + 1], -0.5f), glm::vec3(corners[i], -0.5f));
  }
  for (size_t i = 0; i < corners.size(); ++i) {
    const glm::vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
    add(out, glm::vec3(a, -0.5f), glm::vec3(b, -0.5f), glm::vec3(b, 0.5f));
    add(out, glm::vec3(a, -0.5f), glm::vec3(b, 0.5f), glm::vec3(a, 0.5f));
  }
  return out;
}

std::vector<glm::vec3> sphere() {
  constexpr uint32_t kRings = 8, kSegments = 12;
  const auto point = [](uint32_t ring, uint32_t segment) {
    const float polar = 3.1415927f * static_cast<float>(ring) / kRings;
    const float around = 6.2831853f * static_cast<float>(segment) / kSegments;
    return 0.5f * glm::vec3(std::sin(polar) * std::cos(around), std::cos(polar), -std::sin(polar) * std::sin(around));
  };
  std::vector<glm::vec3> out;
  for (uint32_t r = 0; r < kRings; ++r)
    for (uint32_t s = 0; s < kSegments; ++s) {
      if (r > 0) add(out, point(r, s), point(r + 1, s), point(r, s + 1));
      if (r + 1 < kRings) add(out, point(r, s + 1), point(r + 1, s), point(r + 1, s + 1));
    }
  return out;
}

} // namespace

glm::vec3 placed(const GpgpInstance& instance, const glm::vec3& p) {
  const float* m = instance.transform;
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
          m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

std::vector<glm::vec3> unitShape(GpgpShape shape) {
  if (shape <= GPGP_SHAPE_OCTAGON) return polygon(regular(3 + (shape - GPGP_SHAPE_TRIANGLE)));
  if (shape <= GPGP_SHAPE_PRISM8) return prism(regular(3 + (shape - GPGP_SHAPE_PRISM3)));
  if (shape == GPGP_SHAPE_DYNAMIC_CONVEX_POLYGON || shape == GPGP_SHAPE_DYNAMIC_POLYGON) return polygon(square());
  if (shape == GPGP_SHAPE_SPHERE) return sphere();
  return prism(square());
}

} // namespace gpgp::cli
