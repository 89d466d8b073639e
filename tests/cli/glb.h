// Reads the binary glTF files that `gpgp spawn --out` writes, as a viewer would.
#pragma once
#include "host/files.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace gpgp::test {

using Vector = std::array<double, 3>;
inline Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// A triangle in the world, with the node that has its mesh, or that node's parent.
struct GlbTriangle {
  std::string node;
  std::array<Vector, 3> corners, normals;
  std::array<std::array<double, 2>, 3> uv;
};
struct Glb {
  nlohmann::json model;
  std::vector<GlbTriangle> triangles;
  std::vector<nlohmann::json> placed; ///< nodes, one for each instance of EXT_mesh_gpu_instancing
};

class GlbReader {
public:
  explicit GlbReader(const std::string& file) : bytes_(host::readText(file)) {
    if (bytes_.substr(0, 4) != "glTF" || word(8) != bytes_.size())
      throw std::runtime_error(file + " is no binary glTF");
    glb_.model = nlohmann::json::parse(bytes_.substr(20, word(12)));
    binary_ = 20 + word(12) + 8;
    for (const size_t root : glb_.model["scenes"][0].value("nodes", std::vector<size_t>{})) {
      const auto& node = glb_.model["nodes"][root];
      addNode(node, node.value("name", ""));
      for (const size_t child : node.value("children", std::vector<size_t>{}))
        addNode(glb_.model["nodes"][child], node.value("name", ""));
    }
  }
  Glb take() { return std::move(glb_); }

private:
  uint32_t word(size_t at) const {
    uint32_t value = 0;
    std::memcpy(&value, bytes_.data() + at, 4);
    return value;
  }
  /// Component c of element i.
  uint32_t element(const nlohmann::json& accessor, size_t i, size_t c, size_t components) const {
    const auto& view = glb_.model["bufferViews"][accessor["bufferView"].get<size_t>()];
    const size_t stride = view.value("byteStride", 4 * components);
    return word(binary_ + view.value("byteOffset", size_t{0}) + accessor.value("byteOffset", size_t{0}) + i * stride +
                4 * c);
  }
  template <size_t N> std::array<double, N> vector(const nlohmann::json& accessor, size_t i) const {
    std::array<double, N> result{};
    for (size_t c = 0; c < N; ++c) {
      const uint32_t bits = element(accessor, i, c, N);
      float value;
      std::memcpy(&value, &bits, 4);
      result[c] = value;
    }
    return result;
  }
  static Vector turned(const std::array<double, 4>& q, const Vector& v) {
    const Vector axis{q[0], q[1], q[2]}, first = cross(axis, v);
    const Vector second = cross(axis, first);
    return {v[0] + 2 * (q[3] * first[0] + second[0]), v[1] + 2 * (q[3] * first[1] + second[1]),
            v[2] + 2 * (q[3] * first[2] + second[2])};
  }
  void addNode(const nlohmann::json& node, const std::string& name) {
    if (!node.contains("mesh")) return;
    if (!node.contains("extensions")) return addMesh(node, name);
    const auto& instancing = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    const auto attribute = [&](const char* key) { return glb_.model["accessors"][instancing[key].get<size_t>()]; };
    const auto translations = attribute("TRANSLATION"), rotations = attribute("ROTATION"), scales = attribute("SCALE");
    for (size_t i = 0; i < translations["count"].get<size_t>(); ++i) {
      nlohmann::json placed = node;
      placed["translation"] = vector<3>(translations, i);
      placed["rotation"] = vector<4>(rotations, i);
      placed["scale"] = vector<3>(scales, i);
      glb_.placed.push_back(placed);
      addMesh(placed, name);
    }
  }
  void addMesh(const nlohmann::json& node, const std::string& name) {
    const auto translation = node.value("translation", Vector{0, 0, 0}), scale = node.value("scale", Vector{1, 1, 1});
    const auto rotation = node.value("rotation", std::array<double, 4>{0, 0, 0, 1});
    const auto& primitive = glb_.model["meshes"][node["mesh"].get<size_t>()]["primitives"][0];
    const auto accessor = [&](const nlohmann::json& index) { return glb_.model["accessors"][index.get<size_t>()]; };
    const auto positions = accessor(primitive["attributes"]["POSITION"]),
               normals = accessor(primitive["attributes"]["NORMAL"]),
               uvs = accessor(primitive["attributes"]["TEXCOORD_0"]), indices = accessor(primitive["indices"]);
    for (size_t i = 0; i < indices["count"].get<size_t>(); i += 3) {
      GlbTriangle triangle;
      triangle.node = name;
      for (size_t c = 0; c < 3; ++c) {
        const uint32_t index = element(indices, i + c, 0, 1);
        Vector p = vector<3>(positions, index), n = vector<3>(normals, index);
        for (size_t k = 0; k < 3; ++k) {
          p[k] *= scale[k];
          n[k] /= scale[k];
        }
        p = turned(rotation, p);
        n = turned(rotation, n);
        for (size_t k = 0; k < 3; ++k) p[k] += translation[k];
        const double length = std::sqrt(dot(n, n));
        for (double& v : n) v /= length;
        triangle.corners[c] = p;
        triangle.normals[c] = n;
        triangle.uv[c] = vector<2>(uvs, index);
      }
      glb_.triangles.push_back(triangle);
    }
  }

  std::string bytes_;
  size_t binary_ = 0;
  Glb glb_;
};
inline Glb readGlb(const std::string& file) { return GlbReader(file).take(); }

inline double volumeOf(const std::vector<GlbTriangle>& triangles) {
  double volume = 0;
  for (const auto& t : triangles) volume += dot(t.corners[0], cross(t.corners[1], t.corners[2])) / 6;
  return volume;
}

} // namespace gpgp::test
