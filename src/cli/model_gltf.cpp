// glTF 2 by tinygltf: every triangle primitive of every node of the scene, placed by the node's transform. No skins, no
// morph targets: the bind pose.
#include "cli/model_formats.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <tiny_gltf.h>

#include <cstring>
#include <map>
#include <stdexcept>

namespace gpgp::cli {
namespace {

/// The bytes of element i of an accessor, checked against its buffer. Null where there are none.
const unsigned char* element(const tinygltf::Model& gltf, const tinygltf::Accessor& accessor, size_t i, size_t size) {
  if (accessor.bufferView < 0 || static_cast<size_t>(accessor.bufferView) >= gltf.bufferViews.size()) return nullptr;
  const tinygltf::BufferView& view = gltf.bufferViews[static_cast<size_t>(accessor.bufferView)];
  const int stride = accessor.ByteStride(view);
  if (stride <= 0 || view.buffer < 0 || static_cast<size_t>(view.buffer) >= gltf.buffers.size()) return nullptr;
  const std::vector<unsigned char>& bytes = gltf.buffers[static_cast<size_t>(view.buffer)].data;
  const size_t offset = view.byteOffset + accessor.byteOffset + i * static_cast<size_t>(stride);
  return offset + size <= bytes.size() ? bytes.data() + offset : nullptr;
}

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

const tinygltf::Accessor& accessorOf(const tinygltf::Model& gltf, int index) {
  if (index < 0 || static_cast<size_t>(index) >= gltf.accessors.size()) fail("a primitive names no accessor");
  return gltf.accessors[static_cast<size_t>(index)];
}

uint32_t indexAt(const tinygltf::Model& gltf, const tinygltf::Accessor& accessor, size_t i) {
  const auto read = [&](auto value) -> uint32_t {
    const unsigned char* bytes = element(gltf, accessor, i, sizeof value);
    if (!bytes) fail("an index lies outside its buffer");
    std::memcpy(&value, bytes, sizeof value);
    return value;
  };
  switch (accessor.componentType) {
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return read(uint8_t{});
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return read(uint16_t{});
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return read(uint32_t{});
  default: fail("an index accessor has an unknown type");
  }
}

/// Appends a primitive's vertices and indices; no triangles: an empty mesh.
GpgpMesh addPrimitive(Model& model, const tinygltf::Model& gltf, const tinygltf::Primitive& primitive) {
  GpgpMesh mesh{static_cast<uint32_t>(model.indices.size()), 0, static_cast<uint32_t>(model.positions.size() / 3)};
  const auto position = primitive.attributes.find("POSITION");
  if (primitive.mode != TINYGLTF_MODE_TRIANGLES || position == primitive.attributes.end()) {
    ++model.leftOut;
    return mesh;
  }
  const tinygltf::Accessor& positions = accessorOf(gltf, position->second);
  if (positions.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT || positions.type != TINYGLTF_TYPE_VEC3)
    fail("positions are not three floats");
  for (size_t i = 0; i < positions.count; ++i) {
    float xyz[3];
    const unsigned char* bytes = element(gltf, positions, i, sizeof xyz);
    if (!bytes) fail("a position lies outside its buffer");
    std::memcpy(xyz, bytes, sizeof xyz);
    model.positions.insert(model.positions.end(), xyz, xyz + 3);
  }
  const size_t count = primitive.indices < 0 ? positions.count : accessorOf(gltf, primitive.indices).count;
  for (size_t i = 0; i < count - count % 3; ++i) {
    const uint32_t index =
        primitive.indices < 0 ? static_cast<uint32_t>(i) : indexAt(gltf, accessorOf(gltf, primitive.indices), i);
    if (index >= positions.count) fail("an index names no vertex");
    model.indices.push_back(index);
  }
  mesh.indexCount = static_cast<uint32_t>(model.indices.size()) - mesh.firstIndex;
  return mesh;
}

glm::mat4 localTransform(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::mat4(glm::make_mat4(node.matrix.data()));
  const auto value = [](const std::vector<double>& values, size_t i, float otherwise) {
    return i < values.size() ? static_cast<float>(values[i]) : otherwise;
  };
  glm::mat4 result(1.0f);
  for (int axis = 0; axis < 3; ++axis) {
    result[axis][axis] = value(node.scale, static_cast<size_t>(axis), 1.0f);
    result[3][axis] = value(node.translation, static_cast<size_t>(axis), 0.0f);
  }
  const glm::quat rotation(value(node.rotation, 3, 1.0f), value(node.rotation, 0, 0.0f), value(node.rotation, 1, 0.0f),
                           value(node.rotation, 2, 0.0f));
  glm::mat4 turned = glm::mat4_cast(rotation);
  for (int axis = 0; axis < 3; ++axis) turned[axis] *= result[axis][axis];
  turned[3] = result[3];
  return turned;
}

} // namespace

Model loadGltf(const std::filesystem::path& file, bool binary) {
  tinygltf::TinyGLTF loader;
  tinygltf::Model gltf;
  std::string error, warning;
  const bool loaded = binary ? loader.LoadBinaryFromFile(&gltf, &error, &warning, file.string())
                             : loader.LoadASCIIFromFile(&gltf, &error, &warning, file.string());
  if (!loaded) fail(file.string() + ": " + (error.empty() ? "is no glTF 2 file" : error));

  Model model;
  try {
    std::map<int, std::vector<GpgpMesh>> meshes; // by glTF mesh, each primitive
    struct Visit {
      int node;
      glm::mat4 parent;
    };
    std::vector<Visit> stack;
    std::vector<bool> reached(gltf.nodes.size());
    const size_t scene = gltf.defaultScene < 0 ? 0 : static_cast<size_t>(gltf.defaultScene);
    if (scene < gltf.scenes.size())
      for (const int node : gltf.scenes[scene].nodes) stack.push_back({node, glm::mat4(1.0f)});
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      const auto index = static_cast<size_t>(visit.node);
      if (visit.node < 0 || index >= gltf.nodes.size())
        fail("there is no node " + std::to_string(visit.node) + ", which the scene or a node names");
      const tinygltf::Node& node = gltf.nodes[index];
      if (reached[index]) // glTF 2.0, 3.5.2; a few nodes with two ways to each could be visited without end
        fail("node " + std::to_string(index) + (node.name.empty() ? "" : " (" + node.name + ")") +
             " has two parents or is its own ancestor; the nodes of a glTF are a strict tree");
      reached[index] = true;
      const glm::mat4 world = visit.parent * localTransform(node);
      for (const int child : node.children) stack.push_back({child, world});
      if (node.mesh < 0 || static_cast<size_t>(node.mesh) >= gltf.meshes.size()) continue;
      auto [known, isNew] = meshes.try_emplace(node.mesh);
      if (isNew)
        for (const tinygltf::Primitive& primitive : gltf.meshes[static_cast<size_t>(node.mesh)].primitives)
          known->second.push_back(addPrimitive(model, gltf, primitive));
      Rows rows{};
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) rows[static_cast<size_t>(row * 4 + column)] = world[column][row];
      for (const GpgpMesh& mesh : known->second) addDraw(model, mesh, rows);
    }
  } catch (const std::runtime_error& problem) {
    fail(file.string() + ": " + problem.what());
  }
  return model;
}

} // namespace gpgp::cli
