// Chooses the reader by the file's extension; numbers the triangles.
#include "cli/model/model.h"

#include "cli/model/model_formats.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <new>
#include <stdexcept>

namespace gpgp::cli {

double AlphaTexture::at(double u, double v) const {
  const auto placeOf = [](double at, uint32_t size, Wrap wrap) {
    const auto n = static_cast<int64_t>(size);
    auto i = static_cast<int64_t>(std::clamp(std::floor(at), -0x1p40, 0x1p40));
    if (wrap == Wrap::clamp) return static_cast<size_t>(std::clamp<int64_t>(i, 0, n - 1));
    const int64_t period = wrap == Wrap::mirror ? 2 * n : n;
    i = (i % period + period) % period;
    return static_cast<size_t>(i < n ? i : period - 1 - i);
  };
  const auto texel = [&](double x, double y) {
    return alpha[placeOf(y, height, wrapV) * width + placeOf(x, width, wrapU)] / 255.0;
  };
  const double x = u * width, y = v * height;
  if (!linear) return texel(x, y);
  const double left = x - 0.5, top = y - 0.5, fx = left - std::floor(left), fy = top - std::floor(top);
  return (texel(left, top) * (1 - fx) + texel(left + 1, top) * fx) * (1 - fy) +
         (texel(left, top + 1) * (1 - fx) + texel(left + 1, top + 1) * fx) * fy;
}

uint32_t addMesh(Model& model, const GpgpMesh& mesh) {
  if (mesh.indexCount == 0) return kNoMesh;
  model.meshes.push_back(mesh);
  return static_cast<uint32_t>(model.meshes.size() - 1);
}

void addDraw(Model& model, uint32_t mesh, const Rows& rows, uint32_t flags) {
  if (mesh == kNoMesh) return;
  const uint32_t triangles = model.meshes[mesh].indexCount / 3;
  if (triangles > UINT32_MAX - model.triangleCount) throw std::runtime_error("has more than 2^32 - 1 triangles");
  GpgpVisibilityDraw draw{};
  std::copy(rows.begin(), rows.end(), draw.transform);
  draw.mesh = mesh;
  draw.firstTriangle = model.triangleCount;
  draw.flags = flags;
  model.triangleCount += triangles;
  model.draws.push_back(draw);
}

Model loadModel(const std::filesystem::path& file, const glm::dvec3& origin) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  Model model;
  model.origin = origin;
  if (extension == ".obj")
    loadObj(file, model);
  else if (extension == ".glb" || extension == ".gltf")
    loadGltf(file, model);
  else
    throw std::runtime_error(file.string() + ": not one of .glb, .gltf, .obj");
  if (model.triangleCount == 0) throw std::runtime_error(file.string() + ": holds no triangle");
  return model;
}

void repeatInGrid(Model& model, uint32_t columns, uint32_t rows, const glm::vec3& size, uint64_t mostBytes) {
  const float largest = std::max({size.x, size.y, size.z}); // for flat models, whose copies would lie in one place
  const glm::vec3 step(1.1f * (size.x > 0 ? size.x : largest), 0, 1.1f * (size.z > 0 ? size.z : largest));
  const std::vector<GpgpVisibilityDraw> one = std::move(model.draws);
  const uint32_t triangles = model.triangleCount;
  const uint64_t copies = uint64_t{columns} * rows, allTriangles = copies * triangles, allDraws = copies * one.size();
  const auto fail = [&](const std::string& why) {
    throw std::runtime_error("a grid of " + std::to_string(columns) + " x " + std::to_string(rows) + " models has " +
                             std::to_string(allTriangles) + " triangles and " + std::to_string(allDraws) +
                             " draws of " + std::to_string(sizeof(GpgpVisibilityDraw)) + " bytes: " + why);
  };
  if (std::max(allTriangles * 4, allDraws * sizeof(GpgpVisibilityDraw)) > mostBytes) // lists hold 4 bytes a triangle
    fail("the device binds at most " + std::to_string(mostBytes) + " bytes of draws, and of a list of triangles");
  try {
    model.draws = std::vector<GpgpVisibilityDraw>();
    model.draws.reserve(allDraws);
  } catch (const std::bad_alloc&) {
    fail("there is not so much memory");
  }
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

std::array<glm::vec3, 3> worldCorners(const Model& model, const GpgpVisibilityDraw& draw, uint32_t triangle) {
  const GpgpMesh& mesh = model.meshes[draw.mesh];
  const float* m = draw.transform;
  std::array<glm::vec3, 3> corners;
  for (uint32_t i = 0; i < 3; ++i) {
    const float* p =
        &model.positions[(size_t{mesh.vertexOffset} + model.indices[mesh.firstIndex + triangle * 3 + i]) * 3];
    corners[i] = {m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3], m[4] * p[0] + m[5] * p[1] + m[6] * p[2] + m[7],
                  m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11]};
  }
  return corners;
}

std::vector<glm::vec3> worldCorners(const Model& model) {
  std::vector<glm::vec3> all;
  all.reserve(size_t{model.triangleCount} * 3);
  for (const GpgpVisibilityDraw& draw : model.draws)
    for (uint32_t t = 0; t < model.meshes[draw.mesh].indexCount / 3; ++t)
      for (const glm::vec3& corner : worldCorners(model, draw, t)) all.push_back(corner);
  return all;
}

} // namespace gpgp::cli
