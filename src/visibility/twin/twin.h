// The CPU twin of the sampler: the same functions as the shaders (shaders/visibility/*.h), run in plain loops.
//
// Guarantees: ids, depth, bits and counts equal the GPU's bit for bit. For tests and tools; never part of the library.
#pragma once
#include "visibility/layout.h"
#include "visibility/triangle.h"

#include <span>
#include <vector>

namespace gpgp::visibility {

/// What the GPU finds in its buffers, word for word.
struct TwinInput {
  shader::Params params{};
  std::span<const uint32_t> positions; ///< floats as bits
  std::span<const uint32_t> indices;   ///< 16-bit indices: two a word
  std::span<const shader::Draw> draws;
  std::span<const shader::Mesh> meshes;
  std::span<const uint32_t> previousBits; ///< the view's, empty at its first record
};

struct TwinResult {
  std::vector<uint32_t> depth, ids; ///< a word a pixel, rows from the top
  std::vector<uint32_t> bits;
  std::vector<uint32_t> list; ///< every visible triangle, ascending; no budget
  shader::Counters counters{};
};

/// What became of one triangle, and what it is on the grid.
struct TwinTriangle {
  uint32_t fate = shader::kOutside;
  std::vector<shader::ScreenTriangle> pieces;
};
TwinTriangle placeTriangle(const TwinInput& input, const shader::Draw& draw, uint32_t localTriangle);

/// Which samples a record draws.
shader::Grid gridOf(const shader::Params& params);

/// Methods standard and truth: the samples of params' grid.
TwinResult sampleOnCpu(const TwinInput& input);

/// Method exact. depth: at the pixels' centres; ids: empty. counters.candidates and .pairs have no budget.
TwinResult sampleExactOnCpu(const TwinInput& input);

/// The union of all slices of method truth with samples x samples a pixel and the centre; sizes: samples per triangle.
TwinResult truthOnCpu(TwinInput input, uint32_t samples, std::vector<uint32_t>& sizes);

/// What follows the bits: list and counts.
void finish(const TwinInput& input, TwinResult& result);

} // namespace gpgp::visibility
