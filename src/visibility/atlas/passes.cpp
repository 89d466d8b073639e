// The pass list of the atlas recorder.
#include "visibility/atlas/passes.h"

#include "shaders/visibility_atlas_assign.spv.h"
#include "shaders/visibility_atlas_finish.spv.h"
#include "shaders/visibility_atlas_measure.spv.h"
#include "shaders/visibility_atlas_pairs.spv.h"
#include "shaders/visibility_atlas_provision.spv.h"
#include "shaders/visibility_atlas_request.spv.h"
#include "shaders/visibility_atlas_resolve.spv.h"
#include "shaders/visibility_atlas_scan.spv.h"
#include "shaders/visibility_atlas_superblocks.spv.h"
#include "shaders/visibility_atlas_tiles.spv.h"

#include <cassert>

namespace gpgp::visibility {
namespace {
using core::ResourceKind;

/// In the order of shader::kAtlas...
void addResources(core::PassList& list, const AtlasBudgets& budgets) {
  const auto engine = [&](const char* name) { list.add({name, ResourceKind::buffer, 0, true}); };
  const auto own = [&](const char* name, VkDeviceSize bytes) { list.add({name, ResourceKind::scratch, bytes}); };
  list.add({"params", ResourceKind::uniforms, sizeof(shader::AtlasParams)});
  list.add({"atlas", ResourceKind::buffer, 0, false});
  engine("visibleBits");
  engine("triangleSizes");
  engine("draws");
  engine("geometrySet");
  engine("indices");
  engine("buckets");
  engine("shadeBits");
  own("counters", sizeof(shader::AtlasCounters));
  own("pairs", (VkDeviceSize(budgets.maxTriangles) + 15) / 16 * 4);
  own("plans", VkDeviceSize(budgets.maxTriangles) * 4);
  own("rows", budgets.rowWords() * 4);
  own("superblocks", VkDeviceSize(shader::kMaxSupers) * shader::kSuperWords * 4);
  own("lists", VkDeviceSize(shader::kMaxSupers) * (shader::kClasses + 1) * 8);
  own("histogram", VkDeviceSize(shader::kKeys) * shader::kVariants * 4);
  engine("blocks");
  engine("tiles");
  engine("dispatches");
  engine("newBlocks");
  engine("changedBlocks");
  engine("goneBlocks");
  engine("counts");
  assert(list.resources.size() == shader::kAtlasBindings);
}
} // namespace

core::PassList describeAtlasPasses(const AtlasBudgets& budgets, std::pmr::memory_resource* memory) {
  using namespace shader;
  using enum core::UseKind;
  core::PassList list(memory);
  addResources(list, budgets);
  const auto add = [&](const char* name, const core::ShaderCode& spirv) {
    return list.add(core::ShaderDesc{name, spirv});
  };
  list.fill("clear pairs", kAtlasCodes, 0).condition = kIfPairs;
  list.fill("clear counters", kAtlasCounters, 0);
  list.fill("clear superblocks", kAtlasSupers, 0);
  list.fill("clear histogram", kAtlasHistogram, 0);
  list.dispatch("pairs", add("pairs", visibility_atlas_pairs),
                {{kAtlasParams, read},
                 {kAtlasDraws, read},
                 {kAtlasMeshes, read},
                 {kAtlasIndices, read},
                 {kAtlasCodes, readWrite}},
                kAtlasDrawGroups)
      .condition = kIfPairs;
  list.dispatch("measure", add("measure", visibility_atlas_measure),
                {{kAtlasParams, read},
                 {kAtlasBits, read},
                 {kAtlasSizes, read},
                 {kAtlasCodes, read},
                 {kAtlasHistory, readWrite},
                 {kAtlasPlans, write},
                 {kAtlasHistogram, readWrite}},
                kAtlasTriangleGroups);
  list.dispatch("resolve", add("resolve", visibility_atlas_resolve),
                {{kAtlasParams, read}, {kAtlasHistogram, read}, {kAtlasHistory, readWrite}, {kAtlasCounters, write}},
                kAtlasOneGroup);
  list.dispatch("request", add("request", visibility_atlas_request),
                {{kAtlasParams, read},
                 {kAtlasHistory, read},
                 {kAtlasPlans, readWrite},
                 {kAtlasSupers, readWrite},
                 {kAtlasRows, write},
                 {kAtlasCounters, readWrite}},
                kAtlasTriangleGroups);
  const uint32_t scan = add("scan", visibility_atlas_scan);
  list.dispatch("scan requests", scan, {{kAtlasParams, read}, {kAtlasRows, readWrite}}, kAtlasRequestRows, {0});
  list.dispatch("superblocks", add("superblocks", visibility_atlas_superblocks),
                {{kAtlasParams, read}, {kAtlasSupers, read}, {kAtlasLists, write}, {kAtlasCounters, readWrite}},
                kAtlasClassGroups);
  list.dispatch("provision", add("provision", visibility_atlas_provision),
                {{kAtlasRows, read}, {kAtlasCounters, readWrite}, {kAtlasHistory, readWrite}}, kAtlasOneGroup);
  list.dispatch("assign", add("assign", visibility_atlas_assign),
                {{kAtlasParams, read},
                 {kAtlasCounters, read},
                 {kAtlasLists, read},
                 {kAtlasSupers, read},
                 {kAtlasBuckets, read},
                 {kAtlasShade, read},
                 {kAtlasHistory, readWrite},
                 {kAtlasPlans, readWrite},
                 {kAtlasRows, readWrite},
                 {kAtlasBlocks, write},
                 {kAtlasNew, write},
                 {kAtlasChanged, write},
                 {kAtlasGone, write}},
                kAtlasTriangleGroups);
  list.dispatch("scan tiles", scan, {{kAtlasParams, read}, {kAtlasRows, readWrite}}, kAtlasTileRows, {kRowTiles});
  list.dispatch("finish", add("finish", visibility_atlas_finish),
                {{kAtlasParams, read},
                 {kAtlasRows, readWrite},
                 {kAtlasCounters, readWrite},
                 {kAtlasArguments, write},
                 {kAtlasCounts, write}},
                kAtlasOneGroup);
  list.dispatch(
          "tiles", add("tiles", visibility_atlas_tiles),
          {{kAtlasParams, read}, {kAtlasPlans, read}, {kAtlasRows, read}, {kAtlasBuckets, read}, {kAtlasTiles, write}},
          kAtlasTriangleGroups)
      .condition = kIfTiles;
  list.report = kAtlasCounters;
  list.reportBytes = kAtlasReportWords * 4;
  return list;
}

} // namespace gpgp::visibility
