// Ways are short and share their beginning: the triangles near all of them are looked for once, then each is tried.
#include "visibility/reference/ray_segments.h"

#include <algorithm>
#include <cmath>

namespace gpgp::visibility {
namespace {

/// Signed volume of the corner points' tetrahedron; its sign turns with the order of any two.
double volume(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  return glm::dot(a - d, glm::cross(b - d, c - d));
}

/// Whether the way from a to b goes through the triangle, or touches it.
bool meets(const std::array<glm::dvec3, 3>& t, const glm::dvec3& a, const glm::dvec3& b) {
  const double before = volume(t[0], t[1], t[2], a), behind = volume(t[0], t[1], t[2], b);
  if ((before > 0) == (behind > 0) && before != 0 && behind != 0) return false;
  if (before == 0 && behind == 0) return false; // along it
  const double u = volume(a, b, t[0], t[1]), v = volume(a, b, t[1], t[2]), w = volume(a, b, t[2], t[0]);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

} // namespace

std::vector<bool> blockedWays(const RayScene& scene, const glm::dvec3& begin, std::span<const glm::dvec3> ends) {
  glm::dvec3 low = begin, high = begin;
  for (const glm::dvec3& end : ends) low = glm::min(low, end), high = glm::max(high, end);
  const RayTriangles triangles(scene);
  std::vector<std::array<glm::dvec3, 3>> near;
  for (size_t i = 0; i < triangles.size(); ++i) {
    const RayTriangles::Triangle triangle = triangles.at(i);
    if (!triangle.usable) continue;
    const auto& c = triangle.corners;
    const glm::dvec3 least = glm::min(c[0], glm::min(c[1], c[2])), most = glm::max(c[0], glm::max(c[1], c[2]));
    bool apart = false;
    for (int axis = 0; axis < 3; ++axis) apart = apart || least[axis] > high[axis] || most[axis] < low[axis];
    if (!apart) near.push_back(c);
  }
  std::vector<bool> blocked;
  for (const glm::dvec3& end : ends)
    blocked.push_back(std::any_of(near.begin(), near.end(),
                                  [&](const std::array<glm::dvec3, 3>& t) { return meets(t, begin, end); }));
  return blocked;
}

} // namespace gpgp::visibility
