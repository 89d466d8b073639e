#include "cli/triangles_gltf.h"

#include "cli/command.h"
#include "host/files.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

namespace gpgp::cli {

void writeGlb(const std::filesystem::path& file, const std::vector<std::vector<glm::vec3>>& corners,
              const std::function<std::string(uint32_t)>& name, const std::function<glm::vec3(uint32_t)>& colour) {
  size_t total = 0;
  for (const auto& bucket : corners) total += bucket.size() * sizeof(glm::vec3);
  if (total > 0xf0000000u) throw Failure(file.string() + ": more triangles than a glTF binary file holds (4 GiB)");

  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "gpgp";
  model.buffers.emplace_back().data.resize(std::max<size_t>(total, 4));
  tinygltf::Scene& scene = model.scenes.emplace_back();
  model.defaultScene = 0;
  size_t offset = 0;
  for (uint32_t bucket = 0; bucket < corners.size(); ++bucket) {
    if (corners[bucket].empty()) continue;
    glm::vec3 low = corners[bucket][0], high = low;
    for (const glm::vec3& p : corners[bucket]) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    const int index = static_cast<int>(model.meshes.size());
    tinygltf::BufferView& view = model.bufferViews.emplace_back();
    view.buffer = 0;
    view.byteOffset = offset;
    view.byteLength = corners[bucket].size() * sizeof(glm::vec3);
    view.target = TINYGLTF_TARGET_ARRAY_BUFFER;
    std::memcpy(model.buffers[0].data.data() + offset, corners[bucket].data(), view.byteLength);
    offset += view.byteLength;
    tinygltf::Accessor& accessor = model.accessors.emplace_back();
    accessor.bufferView = index;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    accessor.type = TINYGLTF_TYPE_VEC3;
    accessor.count = corners[bucket].size();
    accessor.minValues = {low.x, low.y, low.z};
    accessor.maxValues = {high.x, high.y, high.z};
    tinygltf::Material& material = model.materials.emplace_back();
    material.name = name(bucket);
    material.doubleSided = true;
    const glm::vec3 c = colour(bucket);
    const auto linear = [](float v) { return std::pow(static_cast<double>(v), 2.2); };
    material.pbrMetallicRoughness.baseColorFactor = {linear(c.x), linear(c.y), linear(c.z), 1.0};
    material.pbrMetallicRoughness.metallicFactor = 0;
    tinygltf::Primitive primitive;
    primitive.attributes["POSITION"] = index;
    primitive.material = index;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    tinygltf::Mesh& mesh = model.meshes.emplace_back();
    mesh.name = material.name;
    mesh.primitives.push_back(primitive);
    tinygltf::Node& node = model.nodes.emplace_back();
    node.mesh = index;
    scene.nodes.push_back(index);
  }
  std::ostringstream stream;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&model, stream, false, true))
    throw Failure(file.string() + ": cannot be written as glTF");
  host::writeFile(file, stream.view());
}

} // namespace gpgp::cli
