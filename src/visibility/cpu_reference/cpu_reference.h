// The CPU reference of the recorder: the same functions as the shaders (shaders/visibility/*.h), run in plain loops.
//
// Guarantees: ids, depth, bits and counts equal the GPU's bit for bit. For tests and tools; never part of the library.
#pragma once
#include "visibility/shared/layout.h"
#include "visibility/shared/texture.h"
#include "visibility/shared/triangle.h"

#include <functional>
#include <span>
#include <vector>

namespace gpgp::visibility {

/// What the GPU finds in its buffers, word for word.
struct CpuInput {
  shader::Params params{};
  std::span<const uint32_t> positions; ///< floats as bits
  std::span<const uint32_t> indices;   ///< 16-bit indices: two a word
  std::span<const shader::Draw> draws;
  std::span<const shader::Mesh> meshes;
  std::span<const uint32_t> commands;    ///< params.commandWords each
  std::span<const uint32_t> numbers;     ///< with params.hasNumbers: triangles' numbers
  std::span<const uint32_t> coordinates; ///< texture coordinates, as params say
  /// The alpha of a test's texture at a place.
  std::function<float(uint32_t test, glm::vec2 place)> alphaAt;
  uint32_t drawCount = UINT32_MAX;        ///< what the buffer of the draw or command count holds
  std::span<const uint32_t> previousBits; ///< the history's, empty at its first recording
};

struct CpuResult {
  std::vector<uint32_t> depth, ids; ///< a word a pixel, rows from the top
  std::vector<uint32_t> bits;
  std::vector<uint32_t> list;          ///< every visible triangle, ascending; no budget
  std::vector<uint32_t> changed;       ///< that appeared, then that disappeared, each ascending
  std::vector<uint32_t> sizes;         ///< samples per triangle
  std::vector<uint32_t> drawCommands;  ///< 5 words a draw; no budget
  std::vector<uint32_t> drawIndices;   ///< of each draw's triangles, ascending
  std::vector<uint32_t> drawTriangles; ///< their numbers
  std::vector<uint32_t> extents;       ///< GpgpTriangleSize per triangle, as bits
  shader::Counters counters{};
};

/// What became of one triangle, and what it is on the grid.
struct CpuTriangle {
  uint32_t fate = shader::kOutside;
  bool wasClipped = false; ///< and what was left faces away, or nothing was
  std::vector<shader::ScreenTriangle> pieces;
  glm::vec3 world[3] = {};
  glm::vec4 clip[3] = {};
  std::vector<glm::vec3> depths; ///< of each piece's corners, as conservative sampling interpolates them
};
CpuTriangle placeTriangle(const CpuInput& input, const shader::DrawEntry& entry, uint32_t localTriangle);
/// Of one of the input's draws, for the first camera.
CpuTriangle placeTriangle(const CpuInput& input, const shader::Draw& draw, uint32_t localTriangle);

/// The number of a draw's triangle; false where there is none below triangleCount.
bool numberOf(const CpuInput& input, const shader::DrawEntry& entry, uint32_t localTriangle, uint32_t& id);

/// Of one camera, but for `skipped`.
struct CpuEntries {
  uint64_t draws = 0, items = 0, skipped = 0;
  uint32_t given = 0;
};
/// The draw table: the draws of all cameras.
std::vector<shader::DrawEntry> entriesOf(const CpuInput& input, CpuEntries& about);
/// Whether a camera samples a draw's entry.
bool isSampled(const CpuInput& input, const shader::DrawEntry& entry);
/// Where a vertex lies; false where an index or the vertex that it names lies outside its range.
bool fetchPlace(const CpuInput& input, const shader::DrawEntry& entry, uint32_t index, uint32_t& vertex);

/// Of a triangle that is not opaque.
struct CpuNonOpaque {
  uint32_t flags = 0;
  shader::TexturePlane plane{};
};
CpuNonOpaque nonOpaqueOf(const CpuInput& input, const shader::DrawEntry& entry, uint32_t localTriangle,
                         const CpuTriangle& placed);
/// Whether it is there at a point in units.
bool passesAlpha(const CpuInput& input, const CpuNonOpaque& triangle, glm::ivec2 point);
/// Once depths are there: samples that show triangles which hide nothing.
void showThrough(const CpuInput& input, CpuResult& result);

/// All work items up to the budget: entry, triangle of it, item.
void forEachTriangle(const CpuInput& input,
                     const std::function<void(const shader::DrawEntry&, uint32_t, uint32_t)>& visit);

/// Which samples a recording draws.
shader::Grid gridOf(const shader::Params& params, uint32_t camera = 0);

/// Methods standard and reference: the samples of params' grid.
CpuResult sampleOnCpu(const CpuInput& input);

/// Method exact. depth: at the pixels' centres; ids: empty. counters.candidates and .pairs have no budget.
CpuResult sampleExactOnCpu(CpuInput input);

/// Method nearby; what CpuResult::ids shows is standard sampling's.
CpuResult sampleNearbyOnCpu(const CpuInput& input);

/// Method conservative, with params.heuristics and epsilons, and at most `refinements` further passes.
CpuResult sampleConservativelyOnCpu(const CpuInput& input, uint32_t refinements = 0);

/// The union of all slices of method reference with samples x samples a pixel and the centre; sizes: samples per
/// triangle.
CpuResult referenceOnCpu(CpuInput input, uint32_t samples, std::vector<uint32_t>& sizes);

/// From ids to bits and samples per triangle.
void gather(const CpuInput& input, CpuResult& result);
/// What follows the bits: lists, sizes and counts.
void finish(const CpuInput& input, CpuResult& result);

} // namespace gpgp::visibility
