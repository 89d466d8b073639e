// What was derived as a glTF 2 binary file.
#pragma once
#include "cli/tune/deriver.h"
#include "spawn/graph/graph.h"

#include <filesystem>
#include <span>

namespace gpgp::cli {

/// What was derived: instances, or where there are vertices, these and their indices.
struct Spawned {
  std::span<const GpgpInstance> instances;
  std::span<const SpawnedVertex> vertices;
  std::span<const uint32_t> indices;
};

/// How instances come into the file. Those that no node can place (sheared, mirrored or without extent along an axis)
/// are always triangles.
enum class GlbInstances {
  triangles, ///< all in the mesh of their terminal
  nodes,     ///< a node each, below their terminal's; they share the meshes of unit shapes
  instanced ///< a node for each shape that a terminal has, with EXT_mesh_gpu_instancing: three arrays of all its places
};

/// A node for each terminal, of its name, with a mesh of triangles with normals, uv and a material of the terminal's
/// colour. Throws where it would be larger than the 4 GiB that the format holds, or cannot be written.
void writeGlb(const std::filesystem::path& file, const spawn::Graph& graph, const Spawned& spawned,
              GlbInstances instances);

} // namespace gpgp::cli
