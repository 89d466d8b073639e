// Which points lie in polygons, and in the faces of forms on the ground.
#pragma once
#include "shapes.h"
#include "spawn/geometry/internal.h"

#include <algorithm>

namespace gpgp::spawn::test {

/// Of a polygon, or of faces in the plane y = 0 (x, -z).
inline bool holds(const std::vector<std::vector<vec2>>& loops, vec2 p) {
  bool inside = false;
  for (const auto& loop : loops)
    for (size_t i = 0; i < loop.size(); ++i) {
      const vec2 a = loop[i], b = loop[(i + 1) % loop.size()];
      if ((a.y > p.y) != (b.y > p.y) && a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x) inside = !inside;
    }
  return inside;
}
inline std::vector<std::vector<vec2>> loopsOf(MeshPool& pool, const Form& form) {
  std::vector<std::vector<vec2>> loops;
  for (uint32_t l = 0; l < shader::meshLoops(pool, form.mesh); ++l) {
    const shader::Loop loop = shader::loopOf(pool, form.mesh, l);
    std::vector<vec2> points;
    for (uint32_t c = 0; c < loop.corners; ++c) {
      const vec3 p =
          shader::scopePoint(form.scope, shader::cornerPosition(pool, form.mesh, loop.firstCorner + c) * form.scale);
      points.emplace_back(p.x, -p.z);
    }
    loops.push_back(points);
  }
  return loops;
}
inline double nearest(const std::vector<std::vector<vec2>>& loops, vec2 p) {
  double least = 1e300;
  for (const auto& loop : loops)
    for (size_t i = 0; i < loop.size(); ++i) {
      const vec2 a = loop[i], d = loop[(i + 1) % loop.size()] - a;
      const float t = std::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0f, 1.0f);
      least = std::min(least, double(glm::length(a + d * t - p)));
    }
  return least;
}

} // namespace gpgp::spawn::test
