// Meshes from .glb, .gltf and .obj files: positions and triangles, one draw per use of a mesh.
#pragma once
#include <gpgp/visibility.h>

#include <glm/vec3.hpp>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace gpgp::cli {

/// The alpha of a texture that an alpha test asks.
struct AlphaTexture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> alpha; ///< rows from the top
  float cutoff = 0.5f;
  bool linear = true;
  enum class Wrap : uint8_t { repeat, mirror, clamp };
  Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;

  /// At level 0, in double precision.
  double at(double u, double v) const;
};

struct Model {
  glm::dvec3 origin{0};                 ///< of the file's world: what is below is counted from there
  std::vector<float> positions;         ///< x, y, z
  std::vector<float> coordinates;       ///< texture coordinates by vertex; empty, or shorter: 0
  std::vector<AlphaTexture> alphaTests; ///< of draws that have GPGP_DRAW_ALPHA_TEST
  std::vector<uint32_t> indices;
  std::vector<GpgpMesh> meshes;
  std::vector<GpgpVisibilityDraw> draws; ///< triangles numbered one draw after the other
  uint32_t triangleCount = 0;
  uint32_t omitted = 0;           ///< glTF primitives that are no triangles
  std::vector<std::string> notes; ///< what else is not shown as the file means it, each with how often
};

/// Throws std::runtime_error with the file's name, and the line for .obj. What lies far from the world's origin keeps
/// its form where `origin` lies near it.
Model loadModel(const std::filesystem::path& file, const glm::dvec3& origin = glm::dvec3(0));

/// Copies side by side, a tenth of the model's size apart (of its largest where it is flat), numbered one after the
/// other. Throws std::runtime_error with what they need where a device that binds mostBytes of a buffer, or memory, has
/// no room for them.
void repeatInGrid(Model& model, uint32_t columns, uint32_t rows, const glm::vec3& size, uint64_t mostBytes);

/// World-space corners of a draw's triangle.
std::array<glm::vec3, 3> worldCorners(const Model& model, const GpgpVisibilityDraw& draw, uint32_t triangle);
/// Those of each triangle in its number's order.
std::vector<glm::vec3> worldCorners(const Model& model);

} // namespace gpgp::cli
