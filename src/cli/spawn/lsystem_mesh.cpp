#include "cli/spawn/lsystem_mesh.h"

#include "cli/model/ear_clipping.h"
#include "cli/spawn/unit_shapes.h"

#include <algorithm>
#include <cmath>

namespace gpgp::cli {
namespace {

constexpr size_t kSides = 8;

struct Builder {
  LsystemMesh mesh;
  const GpgpInstance* instance = nullptr;

  uint32_t vertex(const glm::vec3& position, const glm::vec3& normal, const glm::vec2& uv) {
    SpawnedVertex v{};
    for (int i = 0; i < 3; ++i) {
      v.position[i] = position[i];
      v.normal[i] = static_cast<int8_t>(std::lround(std::clamp(normal[i], -1.0f, 1.0f) * 127));
    }
    v.uv[0] = uv.x;
    v.uv[1] = uv.y;
    v.terminal = instance->terminal;
    v.axiom = instance->axiomId;
    mesh.vertices.push_back(v);
    return static_cast<uint32_t>(mesh.vertices.size() - 1);
  }
  void triangle(uint32_t a, uint32_t b, uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
    mesh.colours.push_back(instance->attribute);
  }
};

glm::vec3 placeOf(const GpgpLsystemCorner& c) { return {c.position[0], c.position[1], c.position[2]}; }
glm::vec3 unit(const glm::vec3& v, const glm::vec3& fallback) {
  const float length = glm::length(v);
  return length > 1e-12f ? v / length : fallback;
}

void addPolygon(Builder& b, std::span<const GpgpLsystemCorner> corners) {
  std::vector<glm::dvec3> outline;
  for (const GpgpLsystemCorner& c : corners) // equal neighbours make no edge
    if (outline.empty() || glm::length(glm::dvec3(placeOf(c)) - outline.back()) > 1e-9) outline.push_back(placeOf(c));
  while (outline.size() > 1 && glm::length(outline.back() - outline.front()) <= 1e-9) outline.pop_back();
  if (outline.size() < 3) return;
  glm::dvec3 area(0);
  for (size_t i = 0; i < outline.size(); ++i)
    area += glm::cross(outline[i] - outline[0], outline[(i + 1) % outline.size()] - outline[0]);
  const glm::vec3 normal = unit(glm::vec3(area), {0, 0, 1});
  std::vector<uint32_t> vertices;
  for (const glm::dvec3& p : outline) vertices.push_back(b.vertex(glm::vec3(p), normal, {0, 0}));
  const std::vector<size_t> ears = clipEars(outline);
  for (size_t i = 0; i + 2 < ears.size(); i += 3)
    b.triangle(vertices[ears[i]], vertices[ears[i + 1]], vertices[ears[i + 2]]);
}

/// Rings around the sections, turned as little as the path allows.
void addCylinder(Builder& b, std::span<const GpgpLsystemCorner> sections) {
  std::vector<GpgpLsystemCorner> path;
  for (const GpgpLsystemCorner& s : sections)
    if (path.empty() || glm::length(placeOf(s) - placeOf(path.back())) > 1e-7f) path.push_back(s);
  if (path.size() < 2) return;
  glm::vec3 across(0);
  std::vector<uint32_t> ring;
  for (size_t i = 0; i < path.size(); ++i) {
    const glm::vec3 before = i ? unit(placeOf(path[i]) - placeOf(path[i - 1]), {}) : glm::vec3(0);
    const glm::vec3 behind = i + 1 < path.size() ? unit(placeOf(path[i + 1]) - placeOf(path[i]), {}) : glm::vec3(0);
    const glm::vec3 along = unit(before + behind, {0, 1, 0});
    if (i == 0) across = std::abs(along.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    across = unit(across - along * glm::dot(across, along), {1, 0, 0});
    const glm::vec3 other = glm::cross(along, across);
    std::vector<uint32_t> next;
    for (size_t side = 0; side <= kSides; ++side) {
      const float angle = 6.2831853f * static_cast<float>(side) / kSides;
      const glm::vec3 out = across * std::cos(angle) + other * std::sin(angle);
      next.push_back(
          b.vertex(placeOf(path[i]) + out * (path[i].width * 0.5f), out,
                   {static_cast<float>(side) / kSides, static_cast<float>(i) / static_cast<float>(path.size() - 1)}));
    }
    for (size_t side = 0; side < kSides && !ring.empty(); ++side) {
      b.triangle(ring[side], next[side + 1], next[side]);
      b.triangle(ring[side], ring[side + 1], next[side + 1]);
    }
    ring = std::move(next);
  }
}

} // namespace

LsystemMesh meshOf(std::span<const GpgpInstance> instances, std::span<const GpgpLsystemCorner> corners) {
  std::vector<UnitShape> shapes;
  for (uint32_t shape = 0; shape <= GPGP_SHAPE_SPHERE; ++shape) shapes.push_back(unitShape(shape));
  Builder b;
  for (const GpgpInstance& instance : instances) {
    b.instance = &instance;
    if (instance.rule != GPGP_NO_RULE) {
      const size_t first = std::min<size_t>(instance.rule, corners.size());
      const size_t count = std::min(static_cast<size_t>(instance.size[0]), corners.size() - first);
      const auto own = corners.subspan(first, count);
      if (instance.shape == GPGP_SHAPE_DYNAMIC_POLYGON)
        addPolygon(b, own);
      else
        addCylinder(b, own);
      continue;
    }
    const UnitShape& shape = shapes[std::min<uint32_t>(instance.shape, GPGP_SHAPE_SPHERE)];
    const bool mirrored = isMirrored(instance);
    const uint32_t first = static_cast<uint32_t>(b.mesh.vertices.size());
    for (const UnitVertex& v : shape.vertices) {
      const UnitVertex at = placed(instance, v);
      b.vertex(at.position, at.normal, at.uv);
    }
    for (const auto& t : shape.triangles)
      b.triangle(first + t[0], first + t[mirrored ? 2 : 1], first + t[mirrored ? 1 : 2]);
  }
  return std::move(b.mesh);
}

} // namespace gpgp::cli
