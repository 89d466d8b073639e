// Scenes for the visibility tests: meshes, draws and a camera, as an engine's buffers would hold them.
#pragma once
#include "visibility/cpu_reference/cpu_reference.h"

#include <string>
#include <vector>

namespace gpgp::test {

/// Alpha of a texture whose coordinates repeat, one byte a texel.
struct AlphaTexture {
  uint32_t width = 1, height = 1;
  std::vector<uint8_t> alpha;
  float cutoff = 0.5f;
  bool linear = false; ///< how the device filters it; the CPU reference takes the texel that a place lies in
};

struct Scene {
  std::vector<float> coordinates; ///< texture coordinates, two a vertex
  std::vector<AlphaTexture> textures;
  std::vector<uint32_t> coordinateWords; ///< made by input()
  std::vector<float> positions;          ///< params.positionStride / 4 each, 3 used
  std::vector<uint32_t> indices;
  std::vector<uint32_t> shortIndices; ///< the same in 16 bits, two a word, where useShort is set
  bool useShort = false;
  std::vector<shader::Mesh> meshes;
  std::vector<shader::Draw> draws;
  std::vector<uint32_t> positionWords;   ///< made by input()
  std::vector<uint32_t> commands;        ///< VkDrawIndexedIndirectCommand[]: draws are their instances
  std::vector<uint32_t> numbers;         ///< with commands: of the triangles, by their place among the indices
  uint32_t drawCount = UINT32_MAX;       ///< what drawCountBuffer holds; UINT32_MAX: there is none
  std::vector<glm::dvec3> origins;       ///< of draws
  std::vector<glm::dvec3> cameraOrigins; ///< of cameras that have one
  shader::Params params{};

  uint32_t addVertex(float x, float y, float z);
  /// A mesh of all indices from firstIndex on.
  uint32_t addMesh(uint32_t firstIndex, uint32_t vertexOffset = 0);
  /// A draw with the next free triangle numbers, or the ones given.
  shader::Draw& addDraw(uint32_t mesh, const glm::mat4& transform = glm::mat4(1.0f), uint32_t flags = 0,
                        uint32_t firstTriangle = UINT32_MAX);
  void setCamera(const glm::mat4& viewProjection, uint32_t width, uint32_t height, bool reversed = false);
  /// One more camera of the same size.
  void addCamera(const glm::mat4& viewProjection);
  /// The scene as the CPU reference reads it; valid until the scene changes.
  visibility::CpuInput input();
};

/// Right-handed, +Y up to Vulkan's clip space; field of view in radians.
glm::mat4 perspective(float fieldOfView, float aspect, float nearPlane, float farPlane, bool reversed = false);
glm::mat4 lookAt(glm::vec3 eye, glm::vec3 target);

/// Triangles anywhere, of all sizes, some behind the camera; one draw, two-sided or not.
Scene randomSoup(uint32_t seed, uint32_t triangles, uint32_t width, uint32_t height, bool twoSided, bool reversed);
/// A bumpy sheet of n x n cells in the z = 0 plane, -1 to 1, with vertices moved at random inside the sheet's plane.
Scene sheet(uint32_t seed, uint32_t n, float jitter);
/// Columns of boxes and thin wires on a ground that goes through the near plane.
Scene colonnade(uint32_t width, uint32_t height);
/// bunny.obj of the fetched set `models`, on the screen as a whole; throws std::runtime_error naming the set.
Scene bunny(uint32_t width, uint32_t height);

} // namespace gpgp::test
