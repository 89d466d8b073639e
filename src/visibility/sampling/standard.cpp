// Chapter 6, method "standard" (6.1.1), in compute: two phases draw depth, then ids, and a pass gathers the bits. With
// atomics of 64 bits the first phase draws both.
#include "visibility/sampling/passes.h"

#include "shaders/visibility_chunks.spv.h"
#include "shaders/visibility_clear.spv.h"
#include "shaders/visibility_clip.spv.h"
#include "shaders/visibility_clusters.spv.h"
#include "shaders/visibility_expand_commands.spv.h"
#include "shaders/visibility_gather.spv.h"
#include "shaders/visibility_ids.spv.h"
#include "shaders/visibility_large.spv.h"
#include "shaders/visibility_large_int64.spv.h"
#include "shaders/visibility_medium.spv.h"
#include "shaders/visibility_medium_int64.spv.h"
#include "shaders/visibility_non_opaque.spv.h"
#include "shaders/visibility_non_opaque_alpha.spv.h"
#include "shaders/visibility_non_opaque_int64.spv.h"
#include "shaders/visibility_non_opaque_int64_alpha.spv.h"
#include "shaders/visibility_overflow.spv.h"
#include "shaders/visibility_overflow_int64.spv.h"
#include "shaders/visibility_plan.spv.h"
#include "shaders/visibility_small.spv.h"
#include "shaders/visibility_small_int64.spv.h"
#include "shaders/visibility_surfaces.spv.h"

#include <cstddef>

namespace gpgp::visibility {

void addStandard(core::PassList& list, const Budgets& budgets, const core::Device& device) {
  using namespace shader;
  using enum core::UseKind;
  const bool single = device.has(GPGP_FEATURE_BUFFER_INT64_ATOMICS);
  const auto choose = [&](const core::ShaderCode& whole, const core::ShaderCode& others) {
    return single ? whole : others;
  };
  list.dispatch("clear", addShader(list, "clear", visibility_clear),
                {{kBindParams, read},
                 {kBindSamples, write},
                 {kBindCounters, write},
                 {kBindBits, write},
                 {kBindSizes, write},
                 {kBindSlots, readWrite},
                 {kBindExtents, write}},
                kClearGroups);
  fetchesTriangles(list.dispatch("clusters", addShader(list, "clusters", visibility_clusters), {{kBindClusters, write}},
                                 kClusterGroups))
      .condition = kIfClusters;
  list.dispatch("plan", addShader(list, "plan", visibility_plan),
                {{kBindParams, read},
                 {kBindDraws, read},
                 {kBindMeshes, read},
                 {kBindCommands, read},
                 {kBindCommandCount, read},
                 {kBindTable, write},
                 {kBindCounters, readWrite}},
                kOneGroup);
  list.dispatch("expand commands", addShader(list, "expand commands", visibility_expand_commands),
                {{kBindParams, read},
                 {kBindCommands, read},
                 {kBindCommandCount, read},
                 {kBindTable, readWrite},
                 {kBindCounters, read}},
                kEntryGroups)
      .condition = kIfCommands;
  list.dispatch("chunks", addShader(list, "chunks", visibility_chunks),
                {{kBindParams, read},
                 {kBindDraws, read},
                 {kBindMeshes, read},
                 {kBindClusters, read},
                 {kBindTable, readWrite},
                 {kBindCounters, readWrite}},
                kChunkGroups);

  const uint32_t margins = budgets.methods & (GPGP_SAMPLING_EXACT_BIT | GPGP_SAMPLING_REFERENCE_BIT) ? 1 : 0;
  // Triangles that are not opaque, in one of three phases; with textures or without.
  const auto addNonOpaque = [&](const char* name, uint32_t phase, bool beside) {
    if (!budgets.maxNonOpaque) return;
    for (const bool alpha : {false, true}) {
      const core::ShaderCode& spirv = alpha ? choose(visibility_non_opaque_int64_alpha, visibility_non_opaque_alpha)
                                            : choose(visibility_non_opaque_int64, visibility_non_opaque);
      core::Pass& pass =
          fetchesTriangles(list.dispatchIndirect(name, addShader(list, "non opaque", spirv, {phase, 0, margins}),
                                                 {{kBindQueue, read},
                                                  {kBindSamples, phase == 2 ? read : readWrite},
                                                  {kBindTextureCoordinates, read},
                                                  {kBindCounters, read},
                                                  {kBindBits, phase == 2 ? readWrite : read},
                                                  {kBindSizes, phase == 2 ? readWrite : read}},
                                                 kBindCounters, offsetof(Counters, nonOpaqueArgs)));
      pass.condition = alpha ? kIfAlphaTests : kIfNonOpaque;
      pass.beside = beside || alpha;
    }
  };
  const char* const names[2][4] = {{"depth small", "depth medium", "depth large", "depth overflow"},
                                   {"ids small", "ids medium", "ids large", "ids overflow"}};
  const uint32_t limits = budgets.methods & GPGP_SAMPLING_EXACT_BIT ? 1 : 0;
  for (uint32_t phase = 0; phase < (single ? 1 : 2); ++phase) {
    // Draws triangles that it makes itself, or those that have a record.
    const auto addMaking = [&](const char* name, uint32_t shader, core::UseKind queue,
                               size_t arguments) -> core::Pass& {
      return fetchesTriangles(list.dispatchIndirect(name, shader,
                                                    {{kBindQueue, queue},
                                                     {kBindSamples, readWrite},
                                                     {kBindSlots, readWrite},
                                                     {kBindBits, queue == write ? readWrite : read},
                                                     {kBindCounters, readWrite}},
                                                    kBindCounters, arguments));
    };
    const auto addRecorded = [&](const char* name, uint32_t shader, size_t arguments) -> core::Pass& {
      return list.dispatchIndirect(name, shader,
                                   {{kBindParams, read},
                                    {kBindRecords, read},
                                    {kBindSamples, readWrite},
                                    {kBindSlots, readWrite},
                                    {kBindCounters, read}},
                                   kBindCounters, arguments);
    };
    if (phase == 0) {
      addMaking(names[0][0],
                addShader(list, "small", choose(visibility_small_int64, visibility_small), {phase, limits, margins}),
                write, offsetof(Counters, keptArgs));
      fetchesTriangles(
          list.dispatchIndirect("clip", addShader(list, "clip", visibility_clip, {0, limits, margins}),
                                {{kBindQueue, readWrite}, {kBindRecords, write}, {kBindCounters, readWrite}},
                                kBindCounters, offsetof(Counters, unfoldArgs)));
    } else {
      addMaking(names[1][0], addShader(list, "ids", visibility_ids, {phase, limits, margins}), read,
                offsetof(Counters, winnerArgs));
    }
    // Minima do not depend on order: what draws goes beside what draws. Ids of all need the depth of all.
    addRecorded(names[phase][1],
                addShader(list, "medium", choose(visibility_medium_int64, visibility_medium), {phase, limits, margins}),
                offsetof(Counters, mediumArgs))
        .beside = phase == 1;
    addRecorded(names[phase][2],
                addShader(list, "large", choose(visibility_large_int64, visibility_large), {phase, limits, margins}),
                offsetof(Counters, largeArgs))
        .beside = true;
    addMaking(
        names[phase][3],
        addShader(list, "overflow", choose(visibility_overflow_int64, visibility_overflow), {phase, limits, margins}),
        read, offsetof(Counters, leftArgs))
        .beside = true;
    addNonOpaque(phase ? "ids non-opaque" : "depth non-opaque", phase, true);
  }
  if (budgets.methods & GPGP_SAMPLING_CONSERVATIVE_BIT)
    fetchesTriangles(list.dispatch("surfaces", addShader(list, "surfaces", visibility_surfaces),
                                   {{kBindSamples, readWrite}, {kBindRecords, write}}, kEachPixelGroups))
        .condition = kIfConservative;
  addNonOpaque("see-through", 2, false);
  list.dispatch("gather", addShader(list, "gather", visibility_gather),
                {{kBindParams, read},
                 {kBindSamples, read},
                 {kBindCounters, readWrite},
                 {kBindBits, readWrite},
                 {kBindSizes, readWrite}},
                kPixelGroups);
}

} // namespace gpgp::visibility
