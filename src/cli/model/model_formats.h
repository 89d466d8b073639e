// What the readers of the single formats share.
#pragma once
#include "cli/model/model.h"

#include <array>

namespace gpgp::cli {

using Rows = std::array<float, 12>; ///< rows of a 3x4 matrix
constexpr Rows kIdentityRows = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// Readers count positions from the model's origin.
void loadObj(const std::filesystem::path& file, Model& model);
void loadGltf(const std::filesystem::path& file, Model& model);
constexpr uint32_t kNoMesh = UINT32_MAX;
/// Appends a mesh and returns its number; kNoMesh where it has no triangle.
uint32_t addMesh(Model& model, const GpgpMesh& mesh);
/// Appends a draw of a mesh; of kNoMesh there is none. Throws std::runtime_error where the model would have more than
/// 2^32 - 1 triangles.
void addDraw(Model& model, uint32_t mesh, const Rows& rows, uint32_t flags = 0);

} // namespace gpgp::cli
