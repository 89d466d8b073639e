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

/// A node for each terminal, of its name, with a mesh of triangles with normals, uv and a material of the terminal's
/// colour. perInstance: below it a node for each of its instances, which share the meshes of unit shapes; those that no
/// node can place (sheared, mirrored or without extent along an axis) stay triangles of the terminal's. Throws where it
/// would be larger than the 4 GiB that the format holds, or cannot be written.
void writeGlb(const std::filesystem::path& file, const spawn::Graph& graph, const Spawned& spawned, bool perInstance);

} // namespace gpgp::cli
