#include "cli/model/gltf_mesh.h"

#include "cli/model/gltf_accessors.h"
#include "cli/model/gltf_file.h"
#include "host/picture.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

namespace gpgp::cli {
namespace {

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

std::vector<double> positionsOf(const tinygltf::Model& gltf, int index) {
  const tinygltf::Accessor& accessor = accessorOf(gltf, index);
  const auto& required = gltf.extensionsRequired;
  const bool mayBeIntegers = std::find(required.begin(), required.end(), "KHR_mesh_quantization") != required.end();
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

/// Adds each target's moves, weighted (glTF 2.0, 3.7.2.2).
void morph(std::vector<double>& positions, const tinygltf::Model& gltf, const tinygltf::Primitive& primitive,
           std::span<const double> weights) {
  for (size_t target = 0; target < std::min(primitive.targets.size(), weights.size()); ++target) {
    const auto moves = primitive.targets[target].find("POSITION");
    if (weights[target] == 0 || moves == primitive.targets[target].end()) continue;
    const std::vector<double> by = positionsOf(gltf, moves->second);
    if (by.size() != positions.size())
      fail("a morph target has " + std::to_string(by.size() / 3) + " vertices, its primitive " +
           std::to_string(positions.size() / 3));
    for (size_t i = 0; i < positions.size(); ++i) positions[i] += weights[target] * by[i];
  }
}

std::vector<double> fours(const tinygltf::Model& gltf, const tinygltf::Primitive& primitive, const std::string& name,
                          size_t vertices) {
  const auto attribute = primitive.attributes.find(name);
  if (attribute == primitive.attributes.end()) return {};
  const tinygltf::Accessor& accessor = accessorOf(gltf, attribute->second);
  if (accessor.type != TINYGLTF_TYPE_VEC4 || accessor.count != vertices) fail(name + " has not four numbers a vertex");
  return numbersOf(gltf, accessor);
}

/// Vertices where their joints hold them (3.7.3.3), in the world; false where the primitive names no joints.
bool skin(std::vector<double>& positions, const tinygltf::Model& gltf, const tinygltf::Primitive& primitive,
          std::span<const glm::dmat4> joints) {
  const size_t vertices = positions.size() / 3;
  std::vector<glm::dvec3> sums(vertices, glm::dvec3(0));
  bool any = false;
  for (int set = 0;; ++set) {
    const std::vector<double> names = fours(gltf, primitive, "JOINTS_" + std::to_string(set), vertices);
    const std::vector<double> weights = fours(gltf, primitive, "WEIGHTS_" + std::to_string(set), vertices);
    if (names.empty() != weights.empty()) fail("has JOINTS without WEIGHTS or the reverse");
    if (names.empty()) break;
    any = true;
    for (size_t i = 0; i < names.size(); ++i) {
      if (weights[i] == 0) continue;
      if (!(names[i] < static_cast<double>(joints.size())))
        fail("a vertex names joint " + std::to_string(static_cast<uint64_t>(names[i])) + ", which its skin has not");
      const double* p = &positions[i / 4 * 3];
      sums[i / 4] += weights[i] * glm::dvec3(joints[static_cast<size_t>(names[i])] * glm::dvec4(p[0], p[1], p[2], 1));
    }
  }
  for (size_t i = 0; any && i < vertices; ++i)
    for (int axis = 0; axis < 3; ++axis) positions[i * 3 + static_cast<size_t>(axis)] = sums[i][axis];
  return any;
}

/// Texture coordinates of a primitive's vertices; empty where it has none.
std::vector<double> coordinatesOf(const tinygltf::Model& gltf, const tinygltf::Primitive& primitive, int set,
                                  size_t vertices) {
  const auto attribute = primitive.attributes.find("TEXCOORD_" + std::to_string(set));
  if (attribute == primitive.attributes.end()) return {};
  const tinygltf::Accessor& accessor = accessorOf(gltf, attribute->second);
  if (accessor.type != TINYGLTF_TYPE_VEC2 || accessor.count != vertices)
    fail("TEXCOORD_" + std::to_string(set) + " has not two numbers a vertex");
  return numbersOf(gltf, accessor);
}

/// What a primitive's alpha means for its draws (glTF 2.0, 3.9.6).
struct Alpha {
  bool any = true; ///< false: nothing of it is ever seen
  uint32_t flags = 0;
};

Alpha alphaOf(const tinygltf::Primitive& primitive, const tinygltf::Material& material, AlphaTests& tests,
              Remarks& remarks) {
  Alpha alpha;
  const bool blends = material.alphaMode == "BLEND", masks = material.alphaMode == "MASK";
  if (!blends && !masks) return alpha;
  const auto& base = material.pbrMetallicRoughness;
  const double factor = base.baseColorFactor.size() == 4 ? base.baseColorFactor[3] : 1;
  // Of what is blended, what is transparent altogether is not there.
  const double cutoff = masks ? material.alphaCutoff : 1 / 512.0;
  if (blends) alpha.flags = GPGP_DRAW_SEE_THROUGH;
  if (primitive.attributes.contains("COLOR_0"))
    ++remarks["primitives have colours by vertex, whose alpha was taken as 1"];
  if (cutoff <= 0) return alpha;
  if (factor < cutoff) {
    ++remarks[masks ? "primitives have less alpha than their alpha test's cutoff (alphaMode MASK) and were left out"
                    : "primitives are fully transparent (alphaMode BLEND) and were left out"];
    alpha.any = false;
  } else if (base.baseColorTexture.index >= 0) {
    if (base.baseColorTexture.extensions.contains("KHR_texture_transform"))
      ++remarks["primitives are alpha-tested by a texture that is moved (KHR_texture_transform), which was not done"];
    alpha.flags |= tests.flagsOf(base.baseColorTexture.index, static_cast<float>(cutoff / factor), remarks);
  }
  return alpha;
}

} // namespace

uint32_t AlphaTests::flagsOf(int texture, float cutoff, Remarks& remarks) {
  constexpr size_t kMostTests = 16;
  const auto [known, isNew] = known_.try_emplace({texture, cutoff});
  if (!isNew) return known->second;
  if (static_cast<size_t>(texture) >= gltf_.textures.size()) fail("a material names no texture");
  const tinygltf::Texture& from = gltf_.textures[static_cast<size_t>(texture)];
  if (model_.alphaTests.size() == kMostTests) {
    ++remarks
        ["pairs of a texture and a cutoff are beyond the 16 alpha tests that are read; their triangles were taken as "
         "opaque"];
    return 0;
  }
  int source = from.source;
  if (const auto webp = from.extensions.find("EXT_texture_webp"); source < 0 && webp != from.extensions.end())
    if (webp->second.Get("source").IsInt()) source = webp->second.Get("source").GetNumberAsInt();
  const host::Picture picture = source < 0 ? host::Picture() : host::decodePicture(imageBytes(gltf_, source, folder_));
  if (picture.rgba.empty()) {
    ++remarks["textures of alpha tests are not readable as PNG, JPEG or WebP; their triangles were taken as opaque"];
    return 0;
  }
  AlphaTexture made;
  made.width = picture.width, made.height = picture.height, made.cutoff = cutoff;
  for (size_t i = 3; i < picture.rgba.size(); i += 4) made.alpha.push_back(picture.rgba[i]);
  if (from.sampler >= 0 && static_cast<size_t>(from.sampler) < gltf_.samplers.size()) {
    const tinygltf::Sampler& sampler = gltf_.samplers[static_cast<size_t>(from.sampler)];
    const auto wrapOf = [](int wrap) {
      return wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? AlphaTexture::Wrap::clamp
             : wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? AlphaTexture::Wrap::mirror
                                                             : AlphaTexture::Wrap::repeat;
    };
    made.wrapU = wrapOf(sampler.wrapS), made.wrapV = wrapOf(sampler.wrapT);
    made.linear = sampler.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  known->second = GPGP_DRAW_ALPHA_TEST(static_cast<uint32_t>(model_.alphaTests.size()));
  model_.alphaTests.push_back(std::move(made));
  return known->second;
}

Part addPrimitive(Model& model, const tinygltf::Model& gltf, const tinygltf::Primitive& primitive, const Pose& pose,
                  AlphaTests& alphaTests, Remarks& remarks) {
  Part part;
  GpgpMesh mesh{static_cast<uint32_t>(model.indices.size()), 0, static_cast<uint32_t>(model.positions.size() / 3)};
  const bool isList = primitive.mode == TINYGLTF_MODE_TRIANGLES,
             isStrip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
  if (!isList && !isStrip && primitive.mode != TINYGLTF_MODE_TRIANGLE_FAN) {
    ++model.omitted;
    return part;
  }
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) {
    ++remarks["primitives have no positions and were left out"];
    return part;
  }
  int coordinateSet = 0;
  if (primitive.material >= 0) {
    if (static_cast<size_t>(primitive.material) >= gltf.materials.size()) fail("a primitive names no material");
    const tinygltf::Material& material = gltf.materials[static_cast<size_t>(primitive.material)];
    if (material.doubleSided) part.flags = GPGP_DRAW_TWO_SIDED;
    const Alpha alpha = alphaOf(primitive, material, alphaTests, remarks);
    if (!alpha.any) return part;
    part.flags |= alpha.flags;
    coordinateSet = material.pbrMetallicRoughness.baseColorTexture.texCoord;
  }
  if (primitive.extensions.contains("KHR_materials_variants"))
    ++remarks["primitives have variants of their material (KHR_materials_variants); the one without was taken"];
  std::vector<double> positions = positionsOf(gltf, position->second);
  morph(positions, gltf, primitive, pose.weights);
  if (pose.skinned && !skin(positions, gltf, primitive, pose.joints))
    ++remarks["primitives with a skin name no joints; neither these nor their node's transform move them"];
  const std::vector<uint32_t> corners = indicesOf(gltf, primitive.indices, positions.size() / 3);
  if (isList && corners.size() % 3)
    fail("a list of triangles has " + std::to_string(corners.size()) + " corners, which is not a multiple of 3");
  const size_t triangles = isList ? corners.size() / 3 : std::max<size_t>(corners.size(), 2) - 2;
  if ((model.positions.size() + positions.size()) / 3 > kMostVertices ||
      model.indices.size() + triangles * 3 > UINT32_MAX)
    fail("its meshes have more vertices or indices than a buffer of 4 GiB holds");
  if (part.flags >> 8) { // alpha-tested
    const std::vector<double> at = coordinatesOf(gltf, primitive, coordinateSet, positions.size() / 3);
    if (at.empty()) ++remarks["primitives are alpha-tested but have no texture coordinates, which were taken as 0"];
    model.coordinates.resize(model.positions.size() / 3 * 2);
    for (const double coordinate : at) model.coordinates.push_back(static_cast<float>(coordinate));
  }
  for (const double coordinate : positions) model.positions.push_back(static_cast<float>(coordinate));
  for (size_t t = 0; t < triangles; ++t) { // glTF 2.0, 3.7.2.1
    const std::array<size_t, 3> list{3 * t, 3 * t + 1, 3 * t + 2}, fan{t + 1, t + 2, 0};
    const std::array<size_t, 3> strip{t, t + 1 + t % 2, t + 2 - t % 2};
    for (const size_t corner : isList ? list : isStrip ? strip : fan) model.indices.push_back(corners[corner]);
  }
  mesh.indexCount = static_cast<uint32_t>(triangles * 3);
  part.mesh = addMesh(model, mesh);
  return part;
}

} // namespace gpgp::cli
