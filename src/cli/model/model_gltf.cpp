// glTF 2: the triangles, strips and fans of every node of the scene, depth first in the file's order, placed by the
// node's transform or once for each of its instances (EXT_mesh_gpu_instancing). Animations are not played: nodes, morph
// targets and skins are as the file has them at rest.
#include "cli/model/gltf_accessors.h"
#include "cli/model/gltf_file.h"
#include "cli/model/gltf_mesh.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tuple>

namespace gpgp::cli {
namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

/// numbers, or what they are where they are not given.
template <class Vector> Vector vectorOf(const std::vector<double>& numbers, const Vector& otherwise) {
  if (numbers.empty()) return otherwise;
  if (numbers.size() != static_cast<size_t>(Vector::length()))
    fail("a node's transform has too many or too few numbers");
  Vector vector;
  for (int i = 0; i < Vector::length(); ++i) vector[i] = numbers[static_cast<size_t>(i)];
  return vector;
}

glm::dmat4 localTransform(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
  if (!node.matrix.empty()) fail("a node's matrix has " + std::to_string(node.matrix.size()) + " numbers, not 16");
  const glm::dvec3 scale = vectorOf(node.scale, glm::dvec3(1)), translation = vectorOf(node.translation, glm::dvec3(0));
  const glm::dvec4 rotation = vectorOf(node.rotation, glm::dvec4(0, 0, 0, 1));
  glm::dmat4 result = glm::mat4_cast(glm::dquat(rotation.w, rotation.x, rotation.y, rotation.z));
  for (int axis = 0; axis < 3; ++axis) result[axis] *= scale[axis];
  result[3] = glm::dvec4(translation, 1);
  return result;
}

/// Whether a model looks the same in shape without that extension.
bool isHarmless(const std::string& extension) {
  for (const char* prefix : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "EXT_lights_", "KHR_xmp",
                             "KHR_animation_"}) // variants, and animations, are counted where they are
    if (extension.rfind(prefix, 0) == 0) return true;
  return false;
}

bool isRead(const std::string& extension) {
  return isHarmless(extension) || extension == "KHR_mesh_quantization" || extension == kInstancing;
}

/// The transforms of a node's instances; without the extension its own alone.
std::vector<glm::dmat4> instancesOf(const tinygltf::Model& gltf, const tinygltf::Node& node) {
  const auto extension = node.extensions.find(kInstancing);
  if (extension == node.extensions.end()) return {glm::dmat4(1)};
  std::array<std::vector<double>, 3> numbers;
  constexpr const char* kNames[] = {"TRANSLATION", "ROTATION", "SCALE"};
  size_t count = SIZE_MAX;
  const tinygltf::Value& attributes = extension->second.Get("attributes");
  for (size_t i = 0; i < 3; ++i) {
    const tinygltf::Value& index = attributes.Get(kNames[i]);
    if (!index.IsInt()) continue;
    const tinygltf::Accessor& accessor = accessorOf(gltf, index.GetNumberAsInt());
    if (accessor.type != (i == 1 ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3))
      fail(std::string("the instances' ") + kNames[i] + " has too many or too few numbers");
    if (count != SIZE_MAX && count != accessor.count) fail("the instances' attributes are of different numbers");
    count = accessor.count;
    numbers[i] = numbersOf(gltf, accessor);
  }
  if (count == SIZE_MAX)
    fail(std::string("the instances of ") + kInstancing + " have no TRANSLATION, ROTATION or SCALE");
  std::vector<glm::dmat4> instances;
  tinygltf::Node one; // of an instance: as a node's transform
  for (size_t i = 0; i < count; ++i) {
    const auto part = [&](size_t attribute, size_t size) {
      const auto begin = numbers[attribute].begin() + static_cast<std::ptrdiff_t>(i * size);
      return numbers[attribute].empty() ? std::vector<double>()
                                        : std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(size));
    };
    one.translation = part(0, 3), one.rotation = part(1, 4), one.scale = part(2, 3);
    instances.push_back(localTransform(one));
  }
  return instances;
}

class Reader {
public:
  Reader(Model& model, const tinygltf::Model& gltf, const std::filesystem::path& folder)
      : model_(model), gltf_(gltf), alphaTests_(model, gltf, folder), parents_(gltf.nodes.size(), -1) {
    for (size_t node = 0; node < gltf.nodes.size(); ++node)
      for (const int child : gltf.nodes[node].children)
        if (child >= 0 && static_cast<size_t>(child) < parents_.size())
          parents_[static_cast<size_t>(child)] = static_cast<int>(node);
  }

  void readScene() {
    struct Visit {
      int node;
      glm::dmat4 parent;
    };
    std::vector<Visit> stack;
    const auto push = [&stack](const std::vector<int>& nodes, const glm::dmat4& parent) { // the first comes out first
      for (size_t i = nodes.size(); i-- > 0;) stack.push_back({nodes[i], parent});
    };
    std::vector<bool> reached(gltf_.nodes.size());
    const size_t scene = gltf_.defaultScene < 0 ? 0 : static_cast<size_t>(gltf_.defaultScene);
    if (scene < gltf_.scenes.size()) push(gltf_.scenes[scene].nodes, glm::dmat4(1));
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      const auto index = static_cast<size_t>(visit.node);
      if (visit.node < 0 || index >= gltf_.nodes.size())
        fail("there is no node " + std::to_string(visit.node) + ", which the scene or a node names");
      const tinygltf::Node& node = gltf_.nodes[index];
      if (reached[index]) // glTF 2.0, 3.5.2; a few nodes with two ways to each could be visited without end
        fail("node " + std::to_string(index) + (node.name.empty() ? "" : " (" + excerpt(node.name) + ")") +
             " has two parents or is its own ancestor; the nodes of a glTF are a strict tree");
      reached[index] = true;
      const glm::dmat4 world = visit.parent * localTransform(node);
      push(node.children, world);
      if (node.mesh >= 0) readNode(index, world);
    }
  }

  /// What is not shown as the file means it.
  void writeNotes() {
    if (!gltf_.animations.empty()) note("animations are not played", gltf_.animations.size());
    if (!gltf_.cameras.empty()) note("cameras of the file are not used; --camera gives one", gltf_.cameras.size());
    if (gltf_.scenes.size() > 1) note("scenes beside the file's default one are not read", gltf_.scenes.size() - 1);
    for (const auto& [text, count] : remarks_) note(text, count);
    for (const std::string& extension : gltf_.extensionsUsed)
      if (!isRead(extension) && extension.find("_compression") == std::string::npos) // those were read without
        model_.notes.push_back("the extension " + excerpt(extension) + " is not read");
  }

private:
  void note(const std::string& text, size_t count) { model_.notes.push_back(std::to_string(count) + " " + text); }

  void readNode(size_t index, const glm::dmat4& world) {
    const tinygltf::Node& node = gltf_.nodes[index];
    if (static_cast<size_t>(node.mesh) >= gltf_.meshes.size())
      fail("node " + std::to_string(index) + " names mesh " + std::to_string(node.mesh) + ", which does not exist");
    const tinygltf::Mesh& mesh = gltf_.meshes[static_cast<size_t>(node.mesh)];
    Pose pose;
    pose.skinned = node.skin >= 0;
    pose.weights = node.weights.empty() ? mesh.weights : node.weights;
    const auto [known, isNew] =
        parts_.try_emplace({node.mesh, node.skin, std::vector<double>(pose.weights.begin(), pose.weights.end())});
    if (isNew) {
      const std::vector<glm::dmat4> joints = pose.skinned ? jointsOf(node.skin) : std::vector<glm::dmat4>();
      pose.joints = joints;
      for (const tinygltf::Primitive& primitive : mesh.primitives)
        known->second.push_back(addPrimitive(model_, gltf_, primitive, pose, alphaTests_, remarks_));
    }
    // The transform of a skinned mesh's node moves nothing (3.7.3.3).
    for (const glm::dmat4& instance : instancesOf(gltf_, node)) {
      const glm::dmat4 placed =
          pose.skinned ? toOrigin_ * instance * glm::inverse(toOrigin_) : toOrigin_ * world * instance;
      Rows rows{};
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
          rows[static_cast<size_t>(row * 4 + column)] = static_cast<float>(placed[column][row]);
      for (const Part& part : known->second) addDraw(model_, part.mesh, rows, part.flags);
    }
  }

  /// From where a skin's vertices are to the world, for each of its joints.
  std::vector<glm::dmat4> jointsOf(int index) {
    if (static_cast<size_t>(index) >= gltf_.skins.size()) fail("a node names no skin");
    const tinygltf::Skin& skin = gltf_.skins[static_cast<size_t>(index)];
    std::vector<double> inverses;
    if (skin.inverseBindMatrices >= 0) {
      const tinygltf::Accessor& accessor = accessorOf(gltf_, skin.inverseBindMatrices);
      if (accessor.type != TINYGLTF_TYPE_MAT4 || accessor.count < skin.joints.size())
        fail("skin " + std::to_string(index) + " has no inverse bind matrix for each joint");
      inverses = numbersOf(gltf_, accessor);
    }
    std::vector<glm::dmat4> joints;
    for (const int joint : skin.joints) {
      joints.push_back(toOrigin_ * worldOf(joint));
      if (!inverses.empty()) joints.back() *= glm::make_mat4(&inverses[(joints.size() - 1) * 16]);
    }
    return joints;
  }

  glm::dmat4 worldOf(int node) const {
    glm::dmat4 world(1);
    for (size_t steps = 0; node >= 0; node = parents_[static_cast<size_t>(node)]) {
      if (static_cast<size_t>(node) >= parents_.size() || ++steps > parents_.size())
        fail("a skin names a node that is not there, or is its own ancestor");
      world = localTransform(gltf_.nodes[static_cast<size_t>(node)]) * world;
    }
    return world;
  }

  Model& model_;
  const tinygltf::Model& gltf_;
  const glm::dmat4 toOrigin_ = glm::translate(glm::dmat4(1), -model_.origin); ///< from the world
  AlphaTests alphaTests_;
  std::vector<int> parents_;
  std::map<std::tuple<int, int, std::vector<double>>, std::vector<Part>> parts_; // by mesh, skin, weights
  Remarks remarks_;
};

} // namespace

void loadGltf(const std::filesystem::path& file, Model& model) {
  try {
    const tinygltf::Model gltf = readGltf(file, isRead);
    Reader reader(model, gltf, file.parent_path());
    reader.readScene();
    reader.writeNotes();
  } catch (const std::runtime_error& problem) {
    fail(file.string() + ": " + problem.what());
  }
}

} // namespace gpgp::cli
