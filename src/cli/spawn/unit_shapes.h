// The unit shapes that spawn's terminals are, as the service itself makes them: each spans [-0.5, 0.5], planar ones lie
// in z = 0, prisms stand along y.
#pragma once
#include <gpgp/spawn.h>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace gpgp::cli {

struct UnitVertex {
  glm::vec3 position, normal;
  glm::vec2 uv;
};
/// Four vertices for each quad, and triangles of them, counter-clockwise from outside; those without area are left out.
struct UnitShape {
  std::vector<UnitVertex> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
};

/// Shapes with corners of their own (the dynamic ones) come as their box.
UnitShape unitShape(GpgpShape shape);
/// Where an instance's transform turns right into left, it looks the same only with its triangles the other way round.
bool isMirrored(const GpgpInstance& instance);
/// The unit shape's point p, or a vertex with its normal, placed by the instance.
glm::vec3 placed(const GpgpInstance& instance, const glm::vec3& p);
UnitVertex placed(const GpgpInstance& instance, const UnitVertex& vertex);

} // namespace gpgp::cli
