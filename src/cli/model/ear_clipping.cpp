#include "cli/model/ear_clipping.h"

#include <glm/glm.hpp>

#include <numeric>

namespace gpgp::cli {
namespace {

/// The outline where it is widest: seen along the axis that its normal (Newell's) is nearest to, counter-clockwise.
std::vector<glm::dvec2> flattened(std::span<const glm::dvec3> outline) {
  glm::dvec3 normal(0);
  for (size_t i = 0; i < outline.size(); ++i)
    normal += glm::cross(outline[i] - outline[0], outline[(i + 1) % outline.size()] - outline[0]);
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int right = (axis + 1) % 3, up = (axis + 2) % 3;
  std::vector<glm::dvec2> flat;
  for (const glm::dvec3& p : outline) flat.emplace_back(normal[axis] < 0 ? -p[right] : p[right], p[up]);
  return flat;
}

/// Positive where c lies to the left of the way from a to b.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

} // namespace

std::vector<size_t> clipEars(std::span<const glm::dvec3> outline) {
  const std::vector<glm::dvec2> flat = flattened(outline);
  std::vector<size_t> left(outline.size()), triangles;
  std::iota(left.begin(), left.end(), size_t{0});
  const auto isEar = [&](size_t i) {
    const glm::dvec2 a = flat[left[i - 1]], b = flat[left[i]], c = flat[left[(i + 1) % left.size()]];
    const double area = turn(a, b, c);
    if (area <= 0) return area == 0; // nothing lies in a corner without area
    for (const size_t other : left) {
      const glm::dvec2 p = flat[other];
      // On the cut it is in the way as well, unless it is one of its ends: outlines may touch themselves.
      if (p != a && p != c && turn(a, b, p) > 0 && turn(b, c, p) > 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  };
  while (left.size() >= 3) {
    size_t ear = 1;
    while (ear < left.size() && !isEar(ear)) ++ear;
    if (ear == left.size()) ear = 1; // it crosses itself
    triangles.insert(triangles.end(), {left[ear - 1], left[ear], left[(ear + 1) % left.size()]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

} // namespace gpgp::cli
