// glTF 2 by tinygltf: the triangles, strips and fans of every node of the scene, placed by the node's transform. No
// skins, no morph targets: the bind pose.
#include "cli/model_formats.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <type_traits>

namespace gpgp::cli {
namespace {

constexpr const char* kQuantization = "KHR_mesh_quantization"; // positions of integers
constexpr size_t kMostVertices = (size_t{1} << 32) / 12;       // positions in a buffer of 4 GiB

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

/// Where an accessor's elements lie, and how many bytes each is behind the one before it.
struct Elements {
  const unsigned char* first = nullptr;
  size_t step = 0;
};

/// `count` elements of `size` bytes from `offset` on, all of them within their buffer view and its buffer.
Elements elementsOf(const tinygltf::Model& gltf, int index, size_t offset, size_t count, size_t size) {
  const std::string name = "buffer view " + std::to_string(index);
  if (index < 0 || static_cast<size_t>(index) >= gltf.bufferViews.size())
    fail("there is no " + name + ", which an accessor names");
  const tinygltf::BufferView& view = gltf.bufferViews[static_cast<size_t>(index)];
  if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= gltf.buffers.size()) fail(name + " names no buffer");
  const std::vector<unsigned char>& bytes = gltf.buffers[static_cast<size_t>(view.buffer)].data;
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
    fail(name + " reaches beyond its buffer");
  const size_t step = view.byteStride ? view.byteStride : size;
  if (offset > view.byteLength ||
      (count && (size > view.byteLength - offset || count - 1 > (view.byteLength - offset - size) / step)))
    fail("an accessor reaches beyond " + name);
  return {bytes.data() + view.byteOffset + offset, step};
}

/// A component as what it stands for: normalized integers are -1 to 1 or 0 to 1.
double numberAt(const unsigned char* bytes, int type, bool normalized) {
  const auto read = [&](auto value) -> double {
    std::memcpy(&value, bytes, sizeof value);
    using Value = decltype(value);
    if (!normalized || !std::is_integral_v<Value>) return static_cast<double>(value);
    return std::max(static_cast<double>(value) / static_cast<double>(std::numeric_limits<Value>::max()), -1.0);
  };
  switch (type) {
  case TINYGLTF_COMPONENT_TYPE_BYTE: return read(int8_t{});
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return read(uint8_t{});
  case TINYGLTF_COMPONENT_TYPE_SHORT: return read(int16_t{});
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return read(uint16_t{});
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return read(uint32_t{});
  case TINYGLTF_COMPONENT_TYPE_FLOAT: return read(float{});
  default: fail("an accessor has an unknown type");
  }
}

/// An accessor's numbers, element after element; sparse ones are what replaces them (glTF 2.0, 3.6.2.3).
std::vector<double> numbersOf(const tinygltf::Model& gltf, const tinygltf::Accessor& accessor) {
  const auto components = static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
  const auto bytesOf = [](int type) {
    return static_cast<size_t>(std::max(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(type)), 1));
  };
  const size_t each = bytesOf(accessor.componentType), size = each * components;
  std::vector<double> numbers;
  const auto copy = [&](const Elements& from, size_t i, size_t to) {
    for (size_t c = 0; c < components; ++c)
      numbers[to * components + c] =
          numberAt(from.first + i * from.step + c * each, accessor.componentType, accessor.normalized);
  };
  if (accessor.bufferView >= 0) {
    const Elements from = elementsOf(gltf, accessor.bufferView, accessor.byteOffset, accessor.count, size);
    numbers.resize(accessor.count * components);
    for (size_t i = 0; i < accessor.count; ++i) copy(from, i, i);
  } else { // all of them 0 (3.6.2.3): no bytes bound their number
    if (accessor.count > kMostVertices) fail("an accessor without buffer view has more elements than a buffer holds");
    numbers.resize(accessor.count * components);
  }
  if (!accessor.sparse.isSparse) return numbers;
  const auto& indices = accessor.sparse.indices;
  const auto& values = accessor.sparse.values;
  if (accessor.sparse.count < 0 || indices.byteOffset < 0 || values.byteOffset < 0)
    fail("a sparse accessor has a negative number");
  const auto replaced = static_cast<size_t>(accessor.sparse.count);
  const Elements places = elementsOf(gltf, indices.bufferView, static_cast<size_t>(indices.byteOffset), replaced,
                                     bytesOf(indices.componentType));
  const Elements from = elementsOf(gltf, values.bufferView, static_cast<size_t>(values.byteOffset), replaced, size);
  for (size_t i = 0; i < replaced; ++i) {
    const double place = numberAt(places.first + i * places.step, indices.componentType, false);
    if (!(place >= 0 && place < static_cast<double>(accessor.count))) fail("a sparse accessor's index is out of range");
    copy(from, i, static_cast<size_t>(place));
  }
  return numbers;
}

const tinygltf::Accessor& accessorOf(const tinygltf::Model& gltf, int index) {
  if (index < 0 || static_cast<size_t>(index) >= gltf.accessors.size()) fail("a primitive names no accessor");
  return gltf.accessors[static_cast<size_t>(index)];
}

std::vector<double> positionsOf(const tinygltf::Model& gltf, int index) {
  const tinygltf::Accessor& accessor = accessorOf(gltf, index);
  const auto& required = gltf.extensionsRequired;
  const bool mayBeIntegers = std::find(required.begin(), required.end(), kQuantization) != required.end();
  const bool isInteger = accessor.componentType >= TINYGLTF_COMPONENT_TYPE_BYTE &&
                         accessor.componentType <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  if (accessor.type != TINYGLTF_TYPE_VEC3 ||
      (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !(mayBeIntegers && isInteger)))
    fail("positions are not three floats");
  return numbersOf(gltf, accessor);
}

/// Without an accessor: all vertices in order.
std::vector<uint32_t> indicesOf(const tinygltf::Model& gltf, int index, size_t vertices) {
  if (index < 0) {
    std::vector<uint32_t> all(vertices);
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }
  const tinygltf::Accessor& accessor = accessorOf(gltf, index);
  if (accessor.type != TINYGLTF_TYPE_SCALAR || (accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                                                accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                                                accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
    fail("an index accessor has an unknown type");
  std::vector<uint32_t> indices;
  for (const double number : numbersOf(gltf, accessor)) {
    if (number >= static_cast<double>(vertices)) fail("an index names no vertex");
    indices.push_back(static_cast<uint32_t>(number));
  }
  return indices;
}

struct Part {
  GpgpMesh mesh;
  uint32_t flags; ///< of its draws
};

/// Appends a primitive's vertices and indices; no triangles: an empty mesh.
Part addPrimitive(Model& model, const tinygltf::Model& gltf, const tinygltf::Primitive& primitive) {
  Part part{{static_cast<uint32_t>(model.indices.size()), 0, static_cast<uint32_t>(model.positions.size() / 3)}, 0};
  const bool isList = primitive.mode == TINYGLTF_MODE_TRIANGLES,
             isStrip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
  const auto position = primitive.attributes.find("POSITION");
  if ((!isList && !isStrip && primitive.mode != TINYGLTF_MODE_TRIANGLE_FAN) || position == primitive.attributes.end()) {
    ++model.leftOut;
    return part;
  }
  if (primitive.material >= 0) {
    if (static_cast<size_t>(primitive.material) >= gltf.materials.size()) fail("a primitive names no material");
    if (gltf.materials[static_cast<size_t>(primitive.material)].doubleSided) part.flags = GPGP_DRAW_TWO_SIDED;
  }
  const std::vector<double> positions = positionsOf(gltf, position->second);
  for (const double coordinate : positions) model.positions.push_back(static_cast<float>(coordinate));
  const std::vector<uint32_t> corners = indicesOf(gltf, primitive.indices, positions.size() / 3);
  if (isList && corners.size() % 3)
    fail("a list of triangles has " + std::to_string(corners.size()) + " corners, which is no multiple of 3");
  const size_t triangles = isList ? corners.size() / 3 : std::max<size_t>(corners.size(), 2) - 2;
  for (size_t t = 0; t < triangles; ++t) { // glTF 2.0, 3.7.2.1
    const std::array<size_t, 3> list{3 * t, 3 * t + 1, 3 * t + 2}, fan{t + 1, t + 2, 0};
    const std::array<size_t, 3> strip{t, t + 1 + t % 2, t + 2 - t % 2};
    for (const size_t corner : isList ? list : isStrip ? strip : fan) model.indices.push_back(corners[corner]);
  }
  part.mesh.indexCount = static_cast<uint32_t>(model.indices.size()) - part.mesh.firstIndex;
  return part;
}

/// numbers, or what they are where they are not given.
template <class Vector> Vector vectorOf(const std::vector<double>& numbers, const Vector& otherwise) {
  if (numbers.empty()) return otherwise;
  if (numbers.size() != static_cast<size_t>(Vector::length()))
    fail("a node's transform has too many or too few numbers");
  Vector vector;
  for (int i = 0; i < Vector::length(); ++i) vector[i] = static_cast<float>(numbers[static_cast<size_t>(i)]);
  return vector;
}

glm::mat4 localTransform(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::mat4(glm::make_mat4(node.matrix.data()));
  if (!node.matrix.empty()) fail("a node's matrix has " + std::to_string(node.matrix.size()) + " numbers, not 16");
  const glm::vec3 scale = vectorOf(node.scale, glm::vec3(1)), translation = vectorOf(node.translation, glm::vec3(0));
  const glm::vec4 rotation = vectorOf(node.rotation, glm::vec4(0, 0, 0, 1));
  glm::mat4 result = glm::mat4_cast(glm::quat(rotation.w, rotation.x, rotation.y, rotation.z));
  for (int axis = 0; axis < 3; ++axis) result[axis] *= scale[axis];
  result[3] = glm::vec4(translation, 1);
  return result;
}

/// Whether a model looks the same in shape without that extension, or it is one that is read.
bool isHarmless(const std::string& extension) {
  for (const char* prefix : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "EXT_lights_", "KHR_xmp"})
    if (extension.rfind(prefix, 0) == 0) return true;
  return extension == kQuantization;
}

/// Version and extensions; the first that are missing are in a model that is not read to its end, too.
void checkHeader(const tinygltf::Model& gltf, bool loaded) {
  for (const std::string& extension : gltf.extensionsRequired)
    if (!isHarmless(extension)) fail("requires the extension " + extension + ", which is not supported");
  if (loaded && gltf.asset.version.rfind("2.", 0) != 0) fail("is of glTF version '" + gltf.asset.version + "', not 2");
}

} // namespace

Model loadGltf(const std::filesystem::path& file, bool binary) {
  tinygltf::TinyGLTF loader;
  // Images are not looked at, and what cannot be decoded does no harm.
  loader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                           void*) { return true; },
                        nullptr);
  tinygltf::Model gltf;
  std::string error, warning;
  const bool loaded = binary ? loader.LoadBinaryFromFile(&gltf, &error, &warning, file.string())
                             : loader.LoadASCIIFromFile(&gltf, &error, &warning, file.string());
  Model model;
  try {
    checkHeader(gltf, loaded);
    if (!loaded) fail(error.empty() ? "is no glTF 2 file" : error);
    std::map<int, std::vector<Part>> meshes; // by glTF mesh, each primitive
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
      if (node.mesh < 0) continue;
      if (static_cast<size_t>(node.mesh) >= gltf.meshes.size())
        fail("node " + std::to_string(index) + " names mesh " + std::to_string(node.mesh) + ", which is not there");
      auto [known, isNew] = meshes.try_emplace(node.mesh);
      if (isNew)
        for (const tinygltf::Primitive& primitive : gltf.meshes[static_cast<size_t>(node.mesh)].primitives)
          known->second.push_back(addPrimitive(model, gltf, primitive));
      Rows rows{};
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) rows[static_cast<size_t>(row * 4 + column)] = world[column][row];
      for (const Part& part : known->second) addDraw(model, part.mesh, rows, part.flags);
    }
  } catch (const std::runtime_error& problem) {
    fail(file.string() + ": " + problem.what());
  }
  return model;
}

} // namespace gpgp::cli
