#include "cli/shared/common.h"
#include "cli/spawn/cga.h"
#include "host/files.h"
#include "host/picture.h"

#include <glm/glm.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <tuple>

namespace gpgp::cli {

namespace {

using spawn::cga::Vertex;
static_assert(sizeof(Vertex) == 32);

struct Batch {
  std::vector<Vertex> vertices;
  std::vector<uint32_t> indices;
};

class Writer {
public:
  Writer() {
    model_.asset.version = "2.0";
    model_.asset.generator = "gpgp";
    model_.scenes.emplace_back().name = "spawned";
    model_.defaultScene = 0;
    model_.buffers.emplace_back();
  }
  int material(const glm::vec4& colour, const std::string& texture) {
    tinygltf::Material& material = model_.materials.emplace_back();
    material.name = texture.empty() ? "colour" : texture;
    using host::linearFromSrgb;
    material.pbrMetallicRoughness.baseColorFactor = {linearFromSrgb(colour.x), linearFromSrgb(colour.y),
                                                     linearFromSrgb(colour.z), static_cast<double>(colour.w)};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.doubleSided = true; // open surfaces are seen from behind as well
    if (colour.w < 1) material.alphaMode = "BLEND";
    if (!texture.empty()) material.extras = tinygltf::Value({{"texture", tinygltf::Value(texture)}});
    return static_cast<int>(model_.materials.size()) - 1;
  }
  void node(const std::string& name, const std::vector<std::pair<int, const Batch*>>& batches) {
    tinygltf::Mesh& mesh = model_.meshes.emplace_back();
    mesh.name = name;
    for (const auto& [material, batch] : batches) mesh.primitives.push_back(primitive(*batch, material));
    tinygltf::Node& node = model_.nodes.emplace_back();
    node.name = name;
    node.mesh = static_cast<int>(model_.meshes.size()) - 1;
    model_.scenes[0].nodes.push_back(static_cast<int>(model_.nodes.size()) - 1);
  }
  void write(const std::string& file) {
    if (model_.meshes.empty()) model_.buffers.clear();
    std::ostringstream stream;
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, stream, false, true))
      throw Failure(file + ": the file cannot be written");
    host::writeFile(file, stream.view());
  }

private:
  tinygltf::Primitive primitive(const Batch& batch, int material) {
    const int vertices = view(batch.vertices.data(), batch.vertices.size() * sizeof(Vertex), true);
    const int indices = view(batch.indices.data(), batch.indices.size() * sizeof(uint32_t), false);
    tinygltf::Primitive result;
    const size_t count = batch.vertices.size();
    result.attributes["POSITION"] = accessor(vertices, offsetof(Vertex, position), TINYGLTF_TYPE_VEC3, count);
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const Vertex& v : batch.vertices) {
      low = glm::min(low, v.position);
      high = glm::max(high, v.position);
    }
    model_.accessors.back().minValues = {low.x, low.y, low.z};
    model_.accessors.back().maxValues = {high.x, high.y, high.z};
    result.attributes["NORMAL"] = accessor(vertices, offsetof(Vertex, normal), TINYGLTF_TYPE_VEC3, count);
    result.attributes["TEXCOORD_0"] = accessor(vertices, offsetof(Vertex, uv), TINYGLTF_TYPE_VEC2, count);
    result.indices = accessor(indices, 0, TINYGLTF_TYPE_SCALAR, batch.indices.size());
    model_.accessors.back().componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    result.material = material;
    result.mode = TINYGLTF_MODE_TRIANGLES;
    return result;
  }
  int view(const void* data, size_t bytes, bool isVertices) {
    std::vector<unsigned char>& all = model_.buffers[0].data;
    tinygltf::BufferView& view = model_.bufferViews.emplace_back();
    view.buffer = 0;
    view.byteOffset = all.size();
    view.byteLength = bytes;
    view.byteStride = isVertices ? sizeof(Vertex) : 0;
    view.target = isVertices ? TINYGLTF_TARGET_ARRAY_BUFFER : TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER;
    const auto* begin = static_cast<const unsigned char*>(data);
    all.insert(all.end(), begin, begin + bytes);
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }
  int accessor(int view, size_t offset, int type, size_t count) {
    tinygltf::Accessor& accessor = model_.accessors.emplace_back();
    accessor.bufferView = view;
    accessor.byteOffset = offset;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    accessor.type = type;
    accessor.count = count;
    return static_cast<int>(model_.accessors.size()) - 1;
  }
  tinygltf::Model model_;
};

} // namespace

void writeGlb(const std::string& file, const spawn::cga::Derivation& derivation) {
  using Look = std::tuple<float, float, float, float, uint32_t>;
  std::map<uint32_t, std::map<Look, Batch>> rules;
  for (const spawn::cga::Leaf& leaf : derivation.leaves) {
    if (leaf.indexCount == 0) continue;
    const glm::vec4& c = leaf.color;
    Batch& batch = rules[leaf.name][{c.x, c.y, c.z, c.w, leaf.texture}];
    const auto begin = derivation.indices.begin() + leaf.firstIndex;
    // A leaf's vertices lie one behind the other.
    const auto [low, high] = std::minmax_element(begin, begin + leaf.indexCount);
    const uint32_t first = *low, moved = static_cast<uint32_t>(batch.vertices.size());
    batch.vertices.insert(batch.vertices.end(), derivation.vertices.begin() + *low,
                          derivation.vertices.begin() + *high + 1);
    for (auto it = begin; it != begin + leaf.indexCount; ++it) batch.indices.push_back(*it - first + moved);
  }
  Writer writer;
  std::map<Look, int> materials;
  for (const auto& [name, looks] : rules) {
    std::vector<std::pair<int, const Batch*>> batches;
    for (const auto& [look, batch] : looks) {
      const auto [found, isNew] = materials.try_emplace(look, 0);
      const auto& [r, g, b, a, texture] = look;
      if (isNew) found->second = writer.material({r, g, b, a}, derivation.names[texture]);
      batches.push_back({found->second, &batch});
    }
    writer.node(derivation.names[name], batches);
  }
  writer.write(file);
}

} // namespace gpgp::cli
