// The CPU reference of the atlas recorder: the shaders' functions (shaders/visibility/atlas/atlas.h) in plain loops.
//
// Guarantees: state, blocks, lists, tiles and counts equal the GPU's bit for bit. For tests and tools; never part of
// the library.
#pragma once
#include "visibility/atlas/layout.h"
#include "visibility/shared/layout.h"

#include <array>
#include <span>
#include <vector>

namespace gpgp::visibility {

/// What a recording is given, word for word; params as atlasParamsOf makes them.
struct CpuAtlasInput {
  shader::AtlasParams params{};
  std::span<const uint32_t> bits;
  std::span<const uint32_t> sizes; ///< GpgpTriangleSize as bits
  std::span<const shader::Draw> draws;
  std::span<const shader::Mesh> meshes;
  std::span<const uint32_t> indices;
  std::span<const uint32_t> buckets;   ///< with params.hasBuckets
  std::span<const uint32_t> shadeBits; ///< with params.hasShade
};

/// The history's words.
using CpuAtlas = std::vector<uint32_t>;

struct CpuAtlasResult {
  std::vector<uint32_t> blocks;               ///< a word for each triangle
  std::vector<std::array<uint32_t, 2>> tiles; ///< no budget
  std::vector<uint32_t> dispatches;           ///< kArgumentWords for each bucket
  std::vector<uint32_t> added, changed, gone; ///< triangles; no budget
  shader::AtlasCounters counters{};           ///< the report's part
};

CpuAtlasResult allocate(const CpuAtlasInput& input, CpuAtlas& atlas);

} // namespace gpgp::visibility
