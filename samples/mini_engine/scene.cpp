// Placing models, and the one that needs no file.
#include "scene.h"

#include <algorithm>
#include <cmath>

namespace mini {
namespace {

glm::mat4 matrixOf(const float (&rows)[12]) {
  glm::mat4 result(1.0f);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) result[column][row] = rows[row * 4 + column];
  return result;
}

void setRows(const glm::mat4& matrix, float (&rows)[12]) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) rows[row * 4 + column] = matrix[column][row];
}

} // namespace

void Model::addDraw(uint32_t mesh, const glm::mat4& world) {
  GpgpVisibilityDraw draw{};
  setRows(world, draw.transform);
  draw.mesh = mesh;
  draw.firstTriangle = triangleCount;
  triangleCount += meshes[mesh].indexCount / 3;
  draws.push_back(draw);
  for (uint32_t i = 0; i < meshes[mesh].indexCount; ++i) {
    const size_t vertex = (size_t{meshes[mesh].vertexOffset} + indices[meshes[mesh].firstIndex + i]) * 3;
    const glm::vec3 point =
        glm::vec3(world * glm::vec4(positions[vertex], positions[vertex + 1], positions[vertex + 2], 1.0f));
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
}

void Model::place(float width, float ground) {
  const glm::vec3 extent = high - low;
  const float scale = width / std::max({extent.x, extent.y, extent.z, 1e-6f});
  const glm::vec3 foot((low.x + high.x) * 0.5f, low.y - ground / scale, (low.z + high.z) * 0.5f);
  glm::mat4 placing(scale);
  placing[3] = glm::vec4(-foot * scale, 1.0f);
  for (GpgpVisibilityDraw& draw : draws) setRows(placing * matrixOf(draw.transform), draw.transform);
  low = (low - foot) * scale;
  high = (high - foot) * scale;
}

Model makeFallbackModel() {
  constexpr uint32_t kAround = 64, kAcross = 24;
  constexpr float kTurn = 6.2831853f;
  Model model;
  model.name = "rings made by the engine";
  const auto addRing = [&model](float radius, float thickness) {
    GpgpMesh mesh{static_cast<uint32_t>(model.indices.size()), kAround * kAcross * 6,
                  static_cast<uint32_t>(model.positions.size() / 3)};
    for (uint32_t i = 0; i < kAround; ++i)
      for (uint32_t j = 0; j < kAcross; ++j) {
        const float u = kTurn * static_cast<float>(i) / kAround, v = kTurn * static_cast<float>(j) / kAcross;
        const glm::vec3 normal(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v));
        const glm::vec3 point = glm::vec3(std::cos(u), std::sin(u), 0.0f) * radius + normal * thickness;
        model.positions.insert(model.positions.end(), {point.x, point.y, point.z});
        model.normals.insert(model.normals.end(), {normal.x, normal.y, normal.z});
        const uint32_t nextI = (i + 1) % kAround, nextJ = (j + 1) % kAcross;
        const uint32_t a = i * kAcross + j, b = nextI * kAcross + j, c = nextI * kAcross + nextJ,
                       d = i * kAcross + nextJ;
        model.indices.insert(model.indices.end(), {a, b, c, a, c, d});
      }
    model.meshes.push_back(mesh);
  };
  addRing(1.0f, 0.16f);
  addRing(0.72f, 0.10f);
  const float quarter = kTurn * 0.25f;
  for (uint32_t ring = 0; ring < 2; ++ring)
    for (int turn = 0; turn < 3; ++turn) {
      const float angle = quarter * (static_cast<float>(turn) * 0.66f + static_cast<float>(ring) * 0.4f);
      glm::mat4 world(1.0f);
      world[0] = {std::cos(angle), 0, -std::sin(angle), 0};
      world[2] = {std::sin(angle), 0, std::cos(angle), 0};
      model.addDraw(ring, world);
    }
  return model;
}

} // namespace mini
