// Chooses the reader by the file's extension; numbers the triangles.
#include "cli/model.h"

#include "cli/model_formats.h"

#include <algorithm>
#include <stdexcept>

namespace gpgp::cli {

void addDraw(Model& model, const GpgpMesh& mesh, const Rows& rows) {
  if (mesh.indexCount == 0) return;
  const auto same = [&mesh](const GpgpMesh& other) { return other.firstIndex == mesh.firstIndex; };
  auto known = std::find_if(model.meshes.begin(), model.meshes.end(), same);
  if (known == model.meshes.end()) known = model.meshes.insert(known, mesh);
  GpgpVisibilityDraw draw{};
  std::copy(rows.begin(), rows.end(), draw.transform);
  draw.mesh = static_cast<uint32_t>(known - model.meshes.begin());
  draw.firstTriangle = model.triangleCount;
  model.triangleCount += mesh.indexCount / 3;
  model.draws.push_back(draw);
}

Model loadModel(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  Model model;
  if (extension == ".obj")
    model = loadObj(file);
  else if (extension == ".glb" || extension == ".gltf")
    model = loadGltf(file);
  else
    throw std::runtime_error(file.string() + ": not one of .glb, .gltf, .obj");
  if (model.triangleCount == 0) throw std::runtime_error(file.string() + ": holds no triangle");
  return model;
}

void repeatInGrid(Model& model, uint32_t columns, uint32_t rows, const glm::vec3& size) {
  const glm::vec3 step = size * 1.1f;
  const std::vector<GpgpVisibilityDraw> one = std::move(model.draws);
  const uint32_t triangles = model.triangleCount;
  if (uint64_t{triangles} * columns * rows > 1u << 30)
    throw std::runtime_error("a grid of models: more than 2^30 triangles");
  model.draws.clear();
  model.triangleCount = 0;
  for (uint32_t z = 0; z < rows; ++z)
    for (uint32_t x = 0; x < columns; ++x, model.triangleCount += triangles)
      for (GpgpVisibilityDraw draw : one) {
        draw.transform[3] += step.x * static_cast<float>(x);
        draw.transform[11] += step.z * static_cast<float>(z);
        draw.firstTriangle += model.triangleCount;
        model.draws.push_back(draw);
      }
}

std::vector<glm::vec3> worldCorners(const Model& model) {
  std::vector<glm::vec3> corners;
  corners.reserve(size_t{model.triangleCount} * 3);
  for (const GpgpVisibilityDraw& draw : model.draws) {
    const GpgpMesh& mesh = model.meshes[draw.mesh];
    for (uint32_t i = 0; i < mesh.indexCount; ++i) {
      const float* p = &model.positions[(size_t{mesh.vertexOffset} + model.indices[mesh.firstIndex + i]) * 3];
      const float* m = draw.transform;
      corners.emplace_back(m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3],
                           m[4] * p[0] + m[5] * p[1] + m[6] * p[2] + m[7],
                           m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11]);
    }
  }
  return corners;
}

} // namespace gpgp::cli
