// A model on the CPU: from glTF 2, or made here where there is no file.
#pragma once
#include <gpgp/visibility.h>

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace mini {

struct Model {
  std::string name;
  std::vector<float> positions, normals; // x, y, z
  std::vector<uint32_t> indices;
  std::vector<GpgpMesh> meshes;
  std::vector<GpgpVisibilityDraw> draws; // triangles numbered one draw after the other
  uint32_t triangleCount = 0;
  glm::vec3 low{1e30f}, high{-1e30f}; // of the placed triangles

  /// One use of a mesh; placed by a matrix.
  void addDraw(uint32_t mesh, const glm::mat4& world);
  /// Moves and scales all draws so that the model stands at the origin, on y = ground, and is this wide at most.
  void place(float width, float ground);
};

/// Throws std::runtime_error where the file is no glTF 2 with triangles.
Model loadGltf(const std::string& file);
/// Rings in one another: little, but with much that hides.
Model makeFallbackModel();

} // namespace mini
