#include "cli/spawn/spawned_gltf.h"

#include "cli/shared/common.h"
#include "cli/shared/painter.h"
#include "cli/spawn/unit_shapes.h"
#include "host/files.h"
#include "host/picture.h"

#include <glm/gtc/quaternion.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>

namespace gpgp::cli {
namespace {

static_assert(sizeof(UnitVertex) == 32);

/// A mesh on its way into the file.
struct Mesh {
  std::vector<UnitVertex> vertices;
  std::vector<uint32_t> indices;

  void add(const UnitShape& shape) {
    vertices.insert(vertices.end(), shape.vertices.begin(), shape.vertices.end());
    for (const auto& t : shape.triangles) indices.insert(indices.end(), t.begin(), t.end());
  }
  void add(const UnitShape& shape, const GpgpInstance& instance) {
    const uint32_t first = static_cast<uint32_t>(vertices.size());
    for (const UnitVertex& v : shape.vertices) vertices.push_back(placed(instance, v));
    const bool mirrored = isMirrored(instance);
    for (const auto& t : shape.triangles)
      indices.insert(indices.end(), {first + t[0], first + t[mirrored ? 2 : 1], first + t[mirrored ? 1 : 2]});
  }
};

/// A node's transform.
struct Placement {
  glm::vec3 translation, scale;
  glm::quat rotation;
};
/// None where the matrix is no translation, rotation and scale.
std::optional<Placement> placementOf(const GpgpInstance& instance) {
  if (isMirrored(instance)) return std::nullopt; // not every reader turns triangles then
  const float* m = instance.transform;
  glm::dmat3 axes(m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]);
  Placement result;
  result.translation = {m[3], m[7], m[11]};
  for (int i = 0; i < 3; ++i) {
    const double length = glm::length(axes[i]);
    if (!(length > 0)) return std::nullopt;
    result.scale[i] = static_cast<float>(length);
    axes[i] /= length;
  }
  constexpr double kRight = 1e-5; // cosines of angles that are right ones but for rounding
  if (std::abs(glm::dot(axes[0], axes[1])) > kRight || std::abs(glm::dot(axes[1], axes[2])) > kRight ||
      std::abs(glm::dot(axes[2], axes[0])) > kRight)
    return std::nullopt;
  result.rotation = glm::normalize(glm::quat(glm::quat_cast(axes)));
  return result;
}

class Writer {
public:
  explicit Writer(const std::filesystem::path& file) : file_(file) {
    model_.asset.version = "2.0";
    model_.asset.generator = "gpgp";
    model_.scenes.emplace_back().name = "spawned"; // an object also where it has no nodes
    model_.defaultScene = 0;
  }

  int addMaterial(const std::string& name, const glm::vec3& colour) {
    tinygltf::Material& material = model_.materials.emplace_back();
    material.name = name;
    using host::linearFromSrgb;
    material.pbrMetallicRoughness.baseColorFactor = {linearFromSrgb(colour.x), linearFromSrgb(colour.y),
                                                     linearFromSrgb(colour.z), 1.0};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.doubleSided = true; // polygons are seen from behind as well
    return static_cast<int>(model_.materials.size()) - 1;
  }
  int addMesh(const std::string& name, int material, const Mesh& mesh) {
    const int vertices = addView(mesh.vertices.data(), mesh.vertices.size() * sizeof(UnitVertex), sizeof(UnitVertex),
                                 TINYGLTF_TARGET_ARRAY_BUFFER);
    const int indices =
        addView(mesh.indices.data(), mesh.indices.size() * sizeof(uint32_t), 0, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    tinygltf::Primitive primitive;
    const size_t count = mesh.vertices.size();
    primitive.attributes["POSITION"] = addAccessor(vertices, offsetof(UnitVertex, position), TINYGLTF_TYPE_VEC3, count);
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const UnitVertex& v : mesh.vertices) {
      low = glm::min(low, v.position);
      high = glm::max(high, v.position);
    }
    model_.accessors.back().minValues = {low.x, low.y, low.z};
    model_.accessors.back().maxValues = {high.x, high.y, high.z};
    primitive.attributes["NORMAL"] = addAccessor(vertices, offsetof(UnitVertex, normal), TINYGLTF_TYPE_VEC3, count);
    primitive.attributes["TEXCOORD_0"] = addAccessor(vertices, offsetof(UnitVertex, uv), TINYGLTF_TYPE_VEC2, count);
    primitive.indices = addAccessor(indices, 0, TINYGLTF_TYPE_SCALAR, mesh.indices.size());
    model_.accessors.back().componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    primitive.material = material;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    tinygltf::Mesh& result = model_.meshes.emplace_back();
    result.name = name;
    result.primitives.push_back(primitive);
    return static_cast<int>(model_.meshes.size()) - 1;
  }
  /// mesh: or -1. Returns its number.
  int addNode(const std::string& name, int mesh) {
    tinygltf::Node& node = model_.nodes.emplace_back();
    node.name = name;
    node.mesh = mesh;
    const int number = static_cast<int>(model_.nodes.size()) - 1;
    model_.scenes[0].nodes.push_back(number);
    return number;
  }
  void addInstance(int parent, int mesh, const Placement& at) {
    tinygltf::Node node;
    node.mesh = mesh;
    node.translation = {at.translation.x, at.translation.y, at.translation.z};
    node.rotation = {at.rotation.x, at.rotation.y, at.rotation.z, at.rotation.w};
    node.scale = {at.scale.x, at.scale.y, at.scale.z};
    model_.nodes[static_cast<size_t>(parent)].children.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(std::move(node));
  }

  /// A node with a mesh in many places.
  void addInstances(int parent, const std::string& name, int mesh, const std::vector<Placement>& places) {
    std::vector<glm::vec3> translations, scales;
    std::vector<glm::vec4> rotations;
    for (const Placement& at : places) {
      translations.push_back(at.translation);
      rotations.push_back({at.rotation.x, at.rotation.y, at.rotation.z, at.rotation.w});
      scales.push_back(at.scale);
    }
    tinygltf::Value::Object attributes;
    const auto add = [&](const char* attribute, const auto& values, int type) {
      const int view = addView(values.data(), values.size() * sizeof values[0], 0, 0);
      attributes[attribute] = tinygltf::Value(addAccessor(view, 0, type, values.size()));
    };
    add("TRANSLATION", translations, TINYGLTF_TYPE_VEC3);
    add("ROTATION", rotations, TINYGLTF_TYPE_VEC4);
    add("SCALE", scales, TINYGLTF_TYPE_VEC3);
    tinygltf::Node node;
    node.name = name;
    node.mesh = mesh;
    node.extensions[kInstancing] =
        tinygltf::Value(tinygltf::Value::Object{{"attributes", tinygltf::Value(std::move(attributes))}});
    model_.nodes[static_cast<size_t>(parent)].children.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(std::move(node));
    model_.extensionsUsed = model_.extensionsRequired = {kInstancing};
  }

  void write() {
    if (!bytes_.empty()) model_.buffers.emplace_back().data = std::move(bytes_);
    std::ostringstream stream;
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model_, stream, false, true))
      throw Failure(file_.string() + ": cannot be written as glTF");
    host::writeFile(file_, stream.view());
  }

private:
  static constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

  /// target: or 0.
  int addView(const void* data, size_t size, size_t stride, int target) {
    if (bytes_.size() + size > 0xf0000000u)
      throw Failure(file_.string() + ": more triangles than a glTF binary file holds (4 GiB)");
    tinygltf::BufferView& view = model_.bufferViews.emplace_back();
    view.buffer = 0;
    view.byteOffset = bytes_.size();
    view.byteLength = size;
    view.byteStride = stride;
    view.target = target;
    bytes_.resize(bytes_.size() + size);
    std::memcpy(bytes_.data() + view.byteOffset, data, size);
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }
  int addAccessor(int view, size_t offset, int type, size_t count) {
    tinygltf::Accessor& accessor = model_.accessors.emplace_back();
    accessor.bufferView = view;
    accessor.byteOffset = offset;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    accessor.type = type;
    accessor.count = count;
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  const std::filesystem::path& file_;
  tinygltf::Model model_;
  std::vector<unsigned char> bytes_;
};

/// The triangles of each terminal that vertices say.
void addVertices(std::vector<Mesh>& meshes, const Spawned& spawned) {
  constexpr uint32_t kNone = UINT32_MAX;
  std::vector<uint32_t> places(spawned.vertices.size(), kNone); // in their mesh
  for (size_t i = 0; i + 2 < spawned.indices.size(); i += 3) {
    const auto at = [&](size_t corner) {
      const float* p = spawned.vertices[spawned.indices[i + corner]].position;
      return glm::vec3(p[0], p[1], p[2]);
    };
    if (at(0) == at(1) || at(1) == at(2) || at(2) == at(0)) continue; // an odd polygon's last one
    for (size_t corner = 0; corner < 3; ++corner) {
      const uint32_t index = spawned.indices[i + corner];
      const SpawnedVertex& v = spawned.vertices[index];
      Mesh& mesh = meshes.at(v.terminal);
      if (places[index] == kNone) {
        places[index] = static_cast<uint32_t>(mesh.vertices.size());
        const glm::vec3 normal(v.normal[0], v.normal[1], v.normal[2]);
        const float length = glm::length(normal);
        mesh.vertices.push_back({{v.position[0], v.position[1], v.position[2]},
                                 length > 0 ? normal / length : glm::vec3(0, 1, 0),
                                 {v.uv[0], v.uv[1]}});
      }
      mesh.indices.push_back(places[index]);
    }
  }
}
} // namespace

void writeGlb(const std::filesystem::path& file, const spawn::Graph& graph, const Spawned& spawned,
              GlbInstances instances) {
  std::vector<UnitShape> shapes;
  for (uint32_t shape = 0; shape <= GPGP_SHAPE_SPHERE; ++shape) shapes.push_back(unitShape(shape));
  std::vector<Mesh> meshes(graph.terminals.size());
  std::vector<std::vector<const GpgpInstance*>> own(graph.terminals.size()); // that have nodes
  if (!spawned.vertices.empty()) {
    addVertices(meshes, spawned);
  } else {
    for (const GpgpInstance& instance : spawned.instances) {
      if (instance.shape > GPGP_SHAPE_SPHERE) // a form of its own
        meshes.at(instance.terminal).add(unitShape(instance.shape), instance);
      else if (instances != GlbInstances::triangles && placementOf(instance))
        own.at(instance.terminal).push_back(&instance);
      else
        meshes.at(instance.terminal).add(shapes.at(instance.shape), instance);
    }
  }
  Writer writer(file);
  for (size_t t = 0; t < graph.terminals.size(); ++t) {
    if (meshes[t].indices.empty() && own[t].empty()) continue;
    const std::string name = graph.nameAt(graph.terminals[t].name);
    const int material = writer.addMaterial(name, paletteColour(graph.terminals[t].index));
    const int node = writer.addNode(name, meshes[t].indices.empty() ? -1 : writer.addMesh(name, material, meshes[t]));
    meshes[t] = {};
    std::map<uint32_t, int> units; // meshes by shape
    std::map<uint32_t, std::vector<Placement>> places;
    for (const GpgpInstance* instance : own[t]) {
      const auto [unit, isNew] = units.try_emplace(instance->shape);
      if (isNew) {
        Mesh mesh;
        mesh.add(shapes.at(instance->shape));
        unit->second = writer.addMesh(name + " " + spawn::shapeName(instance->shape), material, mesh);
      }
      if (instances == GlbInstances::instanced)
        places[instance->shape].push_back(*placementOf(*instance));
      else
        writer.addInstance(node, unit->second, *placementOf(*instance));
    }
    for (const auto& [shape, all] : places)
      writer.addInstances(node, name + " " + spawn::shapeName(shape), units.at(shape), all);
  }
  writer.write();
}

} // namespace gpgp::cli
