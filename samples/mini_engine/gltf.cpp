// glTF 2 through tinygltf: the triangles of every node of the scene, with normals, placed by the nodes' transforms. A
// file with more than that, such as skins or compressed meshes, is refused by name.
#include "scene.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <tiny_gltf.h>

#include <cstring>
#include <fstream>
#include <map>
#include <stdexcept>

namespace mini {
namespace {

/// Reads an accessor's elements one by one; every read is checked against the buffer's size.
class Reader {
public:
  Reader(const tinygltf::Model& gltf, int index) : accessor_(gltf.accessors.at(static_cast<size_t>(index))) {
    const tinygltf::BufferView& view = gltf.bufferViews.at(static_cast<size_t>(accessor_.bufferView));
    bytes_ = &gltf.buffers.at(static_cast<size_t>(view.buffer)).data;
    begin_ = view.byteOffset + accessor_.byteOffset;
    const int stride = accessor_.ByteStride(view);
    if (stride <= 0) throw std::runtime_error("an accessor has no stride");
    stride_ = static_cast<size_t>(stride);
  }
  size_t count() const { return accessor_.count; }
  bool isVec3() const {
    return accessor_.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT && accessor_.type == TINYGLTF_TYPE_VEC3;
  }
  glm::vec3 vec3(size_t i) const { return read<glm::vec3>(i); }
  uint32_t index(size_t i) const {
    switch (accessor_.componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return read<uint8_t>(i);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return read<uint16_t>(i);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return read<uint32_t>(i);
    default: throw std::runtime_error("indices of an unknown type");
    }
  }

private:
  template <class T> T read(size_t i) const {
    const size_t offset = begin_ + i * stride_;
    if (offset + sizeof(T) > bytes_->size()) throw std::runtime_error("an accessor reaches past its buffer");
    T value;
    std::memcpy(&value, bytes_->data() + offset, sizeof value);
    return value;
  }
  const tinygltf::Accessor& accessor_;
  const std::vector<unsigned char>* bytes_ = nullptr;
  size_t begin_ = 0, stride_ = 0;
};

glm::mat4 transformOf(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::mat4(glm::make_mat4(node.matrix.data()));
  glm::mat4 result(1.0f);
  if (node.rotation.size() == 4)
    result = glm::mat4_cast(glm::quat(static_cast<float>(node.rotation[3]), static_cast<float>(node.rotation[0]),
                                      static_cast<float>(node.rotation[1]), static_cast<float>(node.rotation[2])));
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<size_t>(axis);
    if (node.scale.size() == 3) result[axis] *= static_cast<float>(node.scale[i]);
    if (node.translation.size() == 3) result[3][axis] = static_cast<float>(node.translation[i]);
  }
  return result;
}

/// Appends a primitive; false where it holds no triangles.
bool append(Model& model, const tinygltf::Model& gltf, const tinygltf::Primitive& primitive) {
  const auto position = primitive.attributes.find("POSITION");
  if (primitive.mode != TINYGLTF_MODE_TRIANGLES || primitive.indices < 0 || position == primitive.attributes.end())
    return false;
  const Reader positions(gltf, position->second), indices(gltf, primitive.indices);
  if (!positions.isVec3()) return false;
  GpgpMesh mesh{static_cast<uint32_t>(model.indices.size()), static_cast<uint32_t>(indices.count() / 3 * 3),
                static_cast<uint32_t>(model.positions.size() / 3)};
  const auto normal = primitive.attributes.find("NORMAL");
  for (size_t i = 0; i < positions.count(); ++i) {
    const glm::vec3 p = positions.vec3(i);
    const glm::vec3 n = normal != primitive.attributes.end() ? Reader(gltf, normal->second).vec3(i) : glm::vec3(0.0f);
    model.positions.insert(model.positions.end(), {p.x, p.y, p.z});
    model.normals.insert(model.normals.end(), {n.x, n.y, n.z}); // none: the fragment shader takes the surface's slope
  }
  for (uint32_t i = 0; i < mesh.indexCount; ++i) {
    const uint32_t index = indices.index(i);
    if (index >= positions.count()) throw std::runtime_error("an index names no vertex");
    model.indices.push_back(index);
  }
  if (mesh.indexCount == 0) return false;
  model.meshes.push_back(mesh);
  return true;
}

void visit(Model& model, const tinygltf::Model& gltf, int index, const glm::mat4& parent,
           std::map<int, std::vector<uint32_t>>& known, size_t depth) {
  if (depth > gltf.nodes.size()) throw std::runtime_error("a node is its own ancestor");
  const tinygltf::Node& node = gltf.nodes.at(static_cast<size_t>(index));
  const glm::mat4 world = parent * transformOf(node);
  if (node.mesh >= 0) {
    const auto [entry, isNew] = known.try_emplace(node.mesh);
    if (isNew)
      for (const tinygltf::Primitive& primitive : gltf.meshes.at(static_cast<size_t>(node.mesh)).primitives)
        if (append(model, gltf, primitive)) entry->second.push_back(static_cast<uint32_t>(model.meshes.size() - 1));
    for (const uint32_t mesh : entry->second) model.addDraw(mesh, world);
  }
  for (const int child : node.children) visit(model, gltf, child, world, known, depth + 1);
}

/// Throws where the file is of another version or has what this reader leaves out, and would look different without.
void refuseOthers(const tinygltf::Model& gltf) {
  if (gltf.asset.version.rfind("2.", 0) != 0) throw std::runtime_error("is of glTF version " + gltf.asset.version);
  const auto refuse = [](bool has, const char* what) {
    if (has) throw std::runtime_error(std::string("has ") + what + ", which the mini-engine does not read");
  };
  for (const std::string& extension : gltf.extensionsUsed)
    refuse(extension.rfind("KHR_materials_", 0) != 0 && extension.rfind("KHR_texture_", 0) != 0, extension.c_str());
  refuse(!gltf.skins.empty(), "skins");
  for (const tinygltf::Accessor& accessor : gltf.accessors)
    refuse(accessor.sparse.isSparse || accessor.bufferView < 0, "accessors that are sparse or have no bytes");
  for (const tinygltf::Mesh& mesh : gltf.meshes)
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      refuse(!primitive.targets.empty(), "morph targets");
      refuse(primitive.mode != TINYGLTF_MODE_TRIANGLES || primitive.indices < 0,
             "primitives that are no indexed triangles");
    }
  for (const tinygltf::Material& material : gltf.materials)
    refuse(material.alphaMode == "MASK", "alpha-tested materials");
}

/// As the reader of any .glb must (glTF 2.0, 4.4.2); tinygltf does not look.
void checkContainer(const std::string& file) {
  char header[8] = {};
  std::ifstream(file, std::ios::binary).read(header, sizeof header);
  uint32_t version = 0;
  std::memcpy(&version, header + 4, 4);
  if (std::memcmp(header, "glTF", 4) == 0 && version != 2)
    throw std::runtime_error("is of container version " + std::to_string(version) + ", not 2");
}

} // namespace

Model loadGltf(const std::string& file) try {
  checkContainer(file);
  tinygltf::TinyGLTF loader;
  tinygltf::Model gltf;
  std::string error, warning;
  if (!loader.LoadBinaryFromFile(&gltf, &error, &warning, file)) throw std::runtime_error(error);
  refuseOthers(gltf);
  Model model;
  model.name = file.substr(file.find_last_of('/') + 1);
  std::map<int, std::vector<uint32_t>> known;
  const size_t scene = gltf.defaultScene < 0 ? 0 : static_cast<size_t>(gltf.defaultScene);
  for (const int node : gltf.scenes.at(scene).nodes) visit(model, gltf, node, glm::mat4(1.0f), known, 0);
  if (model.triangleCount == 0) throw std::runtime_error("holds no triangles");
  return model;
} catch (const std::exception& problem) {
  throw std::runtime_error(file + ": " + problem.what());
}

} // namespace mini
