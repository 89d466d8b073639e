// Any bytes as a model, as .obj, .gltf and .glb: an error, or triangles whose corners exist, in meshes and draws that
// stay within them.
#include "cli/model/model.h"
#include "fuzz/file.h"

#include <cmath>
#include <stdexcept>

namespace {
void check(bool holds) {
  if (!holds) std::abort();
}

void load(const gpgp::test::InputFile& input, const uint8_t* data, size_t size) {
  gpgp::cli::Model model;
  try {
    model = gpgp::cli::loadModel(input.write(data, size));
  } catch (const std::runtime_error&) {
    return; // with the file's name, for a person
  }
  check(model.positions.size() % 3 == 0);
  for (const float number : model.positions) check(std::isfinite(number));
  uint64_t triangles = 0;
  for (const GpgpVisibilityDraw& draw : model.draws) {
    check(draw.mesh < model.meshes.size());
    for (const float number : draw.transform) check(std::isfinite(number));
    const GpgpMesh& mesh = model.meshes[draw.mesh];
    check(uint64_t(mesh.firstIndex) + mesh.indexCount <= model.indices.size());
    for (uint32_t i = 0; i < mesh.indexCount; ++i)
      check(uint64_t(model.indices[mesh.firstIndex + i]) + static_cast<uint64_t>(mesh.vertexOffset) <
            model.positions.size() / 3);
    triangles += mesh.indexCount / 3;
  }
  check(triangles == model.triangleCount);
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const gpgp::test::InputFile obj(".obj"), gltf(".gltf"), glb(".glb");
  const bool binary = size >= 4 && data[0] == 'g' && data[1] == 'l' && data[2] == 'T' && data[3] == 'F';
  if (binary)
    load(glb, data, size);
  else {
    load(gltf, data, size);
    load(obj, data, size);
  }
  return 0;
}
