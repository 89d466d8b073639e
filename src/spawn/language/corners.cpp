#include "spawn/language/corners.h"

#include <algorithm>

namespace gpgp::spawn {
using shader::kMaxCorners;

uint32_t addCorners(Graph& graph, std::vector<std::array<float, 2>> points, bool convex, std::string& problem) {
  if (points.size() < 3 || points.size() > kMaxCorners) {
    problem = "expected 3 to " + std::to_string(kMaxCorners) + " corners, found " + std::to_string(points.size());
    return 0;
  }
  double area = 0;
  bool left = false, right = false;
  for (size_t i = 0; i < points.size(); ++i) {
    const auto &a = points[i], &b = points[(i + 1) % points.size()], &c = points[(i + 2) % points.size()];
    area += double(a[0]) * b[1] - double(b[0]) * a[1];
    const double turn = (double(b[0]) - a[0]) * (double(c[1]) - b[1]) - (double(b[1]) - a[1]) * (double(c[0]) - b[0]);
    left |= turn > 0;
    right |= turn < 0;
  }
  if (area == 0)
    problem = "the polygon has no area";
  else if (convex && left && right)
    problem = "the polygon is not convex";
  if (area < 0) std::reverse(points.begin(), points.end());
  const uint32_t polygon = addPolygon(graph, points[0].data(), static_cast<uint32_t>(points.size()));
  if (polygon != kNoPolygon) return polygon;
  if (problem.empty()) problem = "the polygon crosses itself";
  return 0;
}

} // namespace gpgp::spawn
