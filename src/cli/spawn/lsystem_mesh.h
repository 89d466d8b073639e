// What an L-system drew as triangles: instances of unit shapes, polygons and generalised cylinders.
#pragma once
#include "cli/tune/deriver.h"

#include <gpgp/lsystem.h>

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace gpgp::cli {

struct LsystemMesh {
  std::vector<SpawnedVertex> vertices;
  std::vector<uint32_t> indices;
  std::vector<float> colours; ///< of triangles: GpgpInstance::attribute
};
LsystemMesh meshOf(std::span<const GpgpInstance> instances, std::span<const GpgpLsystemCorner> corners);

} // namespace gpgp::cli
