// Triangles of one glTF 2 primitive, as its node shows them at rest: morphed by the default weights, and skinned by the
// joints' transforms as the file has them.
#pragma once
#include "cli/model/model_formats.h"

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

#include <map>
#include <span>

namespace gpgp::cli {

/// What is not shown as the file means it: how often, by a sentence that a number begins.
using Remarks = std::map<std::string, uint32_t>;

struct Part {
  uint32_t mesh = kNoMesh; ///< of the model; kNoMesh: no triangles
  uint32_t flags = 0;      ///< of its draws
};

/// The textures of alpha tests that a model's primitives have.
class AlphaTests {
public:
  AlphaTests(Model& model, const tinygltf::Model& gltf, const std::filesystem::path& folder)
      : model_(model), gltf_(gltf), folder_(folder) {}
  /// GPGP_DRAW_ALPHA_TEST of a texture of the file with a cutoff; 0: it cannot be tested, which the remarks say.
  uint32_t flagsOf(int texture, float cutoff, Remarks& remarks);

private:
  Model& model_;
  const tinygltf::Model& gltf_;
  const std::filesystem::path folder_;
  std::map<std::pair<int, float>, uint32_t> known_;
};

/// How a node bends a mesh.
struct Pose {
  std::span<const double> weights;    ///< of morph targets; what is missing is 0
  std::span<const glm::dmat4> joints; ///< of its skin: from where vertices are to the world
  bool skinned = false;
};

/// Appends a primitive's vertices, indices and mesh. Throws std::runtime_error where something is broken.
Part addPrimitive(Model& model, const tinygltf::Model& gltf, const tinygltf::Primitive& primitive, const Pose& pose,
                  AlphaTests& alphaTests, Remarks& remarks);

} // namespace gpgp::cli
