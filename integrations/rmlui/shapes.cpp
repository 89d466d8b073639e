#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gpgp::rmlui {
namespace {

constexpr float kNear = 0.02f;  // pixels
constexpr float kEdge = 0.001f; // how far from a side of its box a point on it is at most

} // namespace

Box meet(const Box& a, const Box& b) {
  return {std::max(a[0], b[0]), std::max(a[1], b[1]), std::min(a[2], b[2]), std::min(a[3], b[3])};
}

Box boundsOf(const Geometry& geometry) {
  if (geometry.vertices.empty()) return {};
  const GpgpListVertex& first = geometry.vertices.front();
  Box box{first.x, first.y, first.x, first.y};
  for (const GpgpListVertex& v : geometry.vertices)
    box = {std::min(box[0], v.x), std::min(box[1], v.y), std::max(box[2], v.x), std::max(box[3], v.y)};
  return box;
}

GeometryPointer boxGeometry(const Box& box) {
  auto made = std::make_shared<Geometry>();
  for (int corner = 0; corner < 4; ++corner)
    made->vertices.push_back(
        {box[corner == 1 || corner == 2 ? 2 : 0], box[corner < 2 ? 1 : 3], {255, 255, 255, 255}, 0, 0});
  made->indices = {0, 1, 2, 0, 2, 3};
  made->shape = RoundBox{box, {}};
  return made;
}

std::optional<RoundBox> findShape(std::span<const GpgpListVertex> vertices, std::span<const uint32_t> indices) {
  if (vertices.size() < 4 || indices.size() < 6) return std::nullopt;
  RoundBox found;
  Box& b = found.box;
  b = {vertices[0].x, vertices[0].y, vertices[0].x, vertices[0].y};
  for (const GpgpListVertex& v : vertices)
    b = {std::min(b[0], v.x), std::min(b[1], v.y), std::max(b[2], v.x), std::max(b[3], v.y)};
  if (empty(b)) return std::nullopt;

  // Where the outline leaves the box's sides: two places for each corner, equally far from it.
  const float width = b[2] - b[0], height = b[3] - b[1];
  std::array<std::array<float, 2>, 4> reach; // from the corner along the horizontal and the vertical side
  reach.fill({width, height});
  for (const GpgpListVertex& v : vertices) {
    const bool onTop = v.y - b[1] < kEdge, onBottom = b[3] - v.y < kEdge, onLeft = v.x - b[0] < kEdge,
               onRight = b[2] - v.x < kEdge;
    const auto along = [&](size_t corner, size_t side, float distance) {
      reach[corner][side] = std::min(reach[corner][side], distance);
    };
    if (onTop) along(0, 0, v.x - b[0]), along(1, 0, b[2] - v.x);
    if (onBottom) along(3, 0, v.x - b[0]), along(2, 0, b[2] - v.x);
    if (onLeft) along(0, 1, v.y - b[1]), along(3, 1, b[3] - v.y);
    if (onRight) along(1, 1, v.y - b[1]), along(2, 1, b[3] - v.y);
  }
  float squares = 0;
  for (size_t corner = 0; corner < 4; ++corner) {
    if (std::abs(reach[corner][0] - reach[corner][1]) > 2 * kNear) return std::nullopt;
    float& radius = found.radii[corner];
    radius = (reach[corner][0] + reach[corner][1]) / 2;
    if (radius < kNear) radius = 0;
    squares += radius * radius;
    const float x = corner == 0 || corner == 3 ? b[0] + radius : b[2] - radius;
    const float y = corner < 2 ? b[1] + radius : b[3] - radius;
    for (const GpgpListVertex& v : vertices) {
      const float dx = (corner == 0 || corner == 3 ? x - v.x : v.x - x), dy = (corner < 2 ? y - v.y : v.y - y);
      if (dx > 0 && dy > 0 && std::hypot(dx, dy) > radius + 2 * kNear) return std::nullopt;
    }
  }

  // The triangles' area is the shape's but for what lies between arcs and their chords, at least two a corner.
  double area = 0;
  for (size_t i = 0; i + 2 < indices.size(); i += 3) {
    const GpgpListVertex &p = vertices[indices[i]], &q = vertices[indices[i + 1]], &r = vertices[indices[i + 2]];
    area += std::abs(double(q.x - p.x) * double(r.y - p.y) - double(r.x - p.x) * double(q.y - p.y)) / 2;
  }
  const double whole = double(width) * double(height) - (1 - std::numbers::pi / 4) * double(squares);
  const double tolerance = double(kNear) * double(width + height);
  if (area > whole + tolerance || area < whole - 0.085 * double(squares) - tolerance) return std::nullopt;
  return found;
}

} // namespace gpgp::rmlui
