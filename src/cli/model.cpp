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

} // namespace gpgp::cli
