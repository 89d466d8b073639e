// What the readers of the single formats share.
#pragma once
#include "cli/model.h"

#include <array>

namespace gpgp::cli {

using Rows = std::array<float, 12>; ///< rows of a 3x4 matrix
constexpr Rows kIdentityRows = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

Model loadObj(const std::filesystem::path& file);
Model loadGltf(const std::filesystem::path& file, bool binary);
/// Appends a mesh and one draw of it; both are left out where the mesh has no triangle.
void addDraw(Model& model, const GpgpMesh& mesh, const Rows& rows, uint32_t flags = 0);

} // namespace gpgp::cli
