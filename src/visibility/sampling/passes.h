// The passes of a recorder: which there are, in which order, and which of a recording's numbers they ask for.
//
// One list serves all recordings of a recorder; a recording leaves out what its conditions say.
// docs/internals/visibility.md has the flow. Each part of the list has a file.
#pragma once
#include "core/device.h"
#include "core/passes.h"
#include "visibility/sampling/budgets.h"
#include "visibility/shared/layout.h"

#include <algorithm>

namespace gpgp::visibility {

// Workgroup counts of a recording.
constexpr uint32_t kOneGroup = 0, kClearGroups = 1, kPixelGroups = 2, kWordGroups = 3, kTileGroups = 4,
                   kEntryGroups = 5, kEachPixelGroups = 6, kChunkGroups = 7, kScreenTileGroups = 8, kAllocateGroups = 9,
                   kClusterGroups = 10, kListGroups = 11;
// Conditions of a recording.
constexpr uint32_t kIfExact = 0, kIfCommands = 1, kIfDraws = 2, kIfExtents = 3, kIfConservative = 4, kIfSampling = 5,
                   kIfMeasuring = 6, kIfNearby = 7, kIfClusters = 8, kIfNonOpaque = 9, kIfAlphaTests = 10,
                   kIfResolve = 11, kIfResolveAlpha = 12, kIfReuse = 13;

constexpr uint32_t kMaxLargeCandidates = 1 << 20; ///< entries for candidates of more than 8 x 8 pixels
constexpr uint32_t kMaxRefinements = 4;

/// Workgroups of 256 for a number of items; shaders stride beyond the limit.
inline uint32_t groupsOf256(uint64_t items) {
  return static_cast<uint32_t>(std::min<uint64_t>((items + 255) / 256, shader::kMaxGroups));
}

/// device: chooses the shaders that it can run.
core::PassList describePasses(const Budgets& budgets, const core::Device& device, std::pmr::memory_resource* memory);

// The parts of it.
/// Bits of what is seen at the pixels' samples.
void addStandard(core::PassList& list, const Budgets& budgets, const core::Device& device);
void addExact(core::PassList& list, const Budgets& budgets, const core::Device& device);
void addReuse(core::PassList& list); ///< of exact sampling's passes
void addConservative(core::PassList& list, const Budgets& budgets);
void addNearby(core::PassList& list);
void addOutputs(core::PassList& list); ///< what follows the bits: lists, commands, triangles' sizes
void addMetrics(core::PassList& list); ///< recordings that measure have these passes only

/// constants: specialisation, from 0 on.
uint32_t addShader(core::PassList& list, const char* name, const core::ShaderCode& spirv,
                   std::initializer_list<uint32_t> constants = {});
/// Adds to a pass' uses those of a shader that makes triangles from the draws' items.
core::Pass& fetchesTriangles(core::Pass& pass);

} // namespace gpgp::visibility
