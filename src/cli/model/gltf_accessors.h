// Numbers of glTF 2 accessors: any component type, normalized, strided, sparse.
#pragma once
#include <tiny_gltf.h>

#include <cstddef>
#include <vector>

namespace gpgp::cli {

constexpr size_t kMostVertices = (size_t{1} << 32) / 12; ///< positions in a buffer of 4 GiB

/// Throws std::runtime_error where there is no such accessor.
const tinygltf::Accessor& accessorOf(const tinygltf::Model& gltf, int index);
/// An accessor's numbers, element after element; sparse ones are what replaces them (glTF 2.0, 3.6.2.3). Throws
/// std::runtime_error where it reaches beyond its bytes.
std::vector<double> numbersOf(const tinygltf::Model& gltf, const tinygltf::Accessor& accessor);

} // namespace gpgp::cli
