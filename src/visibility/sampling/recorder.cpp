// A recording: what is bound, how many workgroups run, and which passes.
#include "visibility/sampling/recorder.h"

#include "visibility/nearby/nearby.h"
#include "visibility/sampling/checks.h"
#include "visibility/sampling/parameters.h"
#include "visibility/shared/cluster.h"

#include <algorithm>

namespace gpgp::visibility {
using core::Result;

namespace {
void setBindings(core::Record& record, const GpgpVisibilityInfo& info, const shader::Params& params,
                 const GeometrySet& geometry, const CameraHistory* history) {
  const auto bind = [&](int binding, const GpgpBuffer& buffer) {
    record.bindings[static_cast<size_t>(binding)].engineBuffer = &buffer;
  };
  const auto bindOwn = [&](int binding, const core::Resident& resident) {
    record.bindings[static_cast<size_t>(binding)].ownBuffer = resident.buffer();
    record.bindings[static_cast<size_t>(binding)].ownSize = resident.size();
  };
  if (info.drawCount) {
    bind(shader::kBindPositions, info.positions);
    bind(shader::kBindIndices, info.indices);
    bind(shader::kBindDraws, info.draws);
  }
  if (params.alphaTestCount) bind(shader::kBindTextureCoordinates, info.textureCoordinates);
  // Shaders name all textures, so those that are not there are bound to the first one.
  for (uint32_t i = 0; i < shader::kMaxAlphaTests && params.alphaTestCount; ++i) {
    const GpgpAlphaTest& from = info.alphaTests[i < info.alphaTestCount ? i : 0];
    record.bindings[shader::kBindTextures + i].texture = {from.sampler, from.view, from.layout};
  }
  if (params.hasCommands) bind(shader::kBindCommands, info.commands);
  if (params.clusterCount) {
    bind(shader::kBindClusters, info.clusters);
    record.bindings[shader::kBindClusters].name = "clusters";
  }
  if (params.hasDrawCount) bind(shader::kBindCommandCount, info.drawCountBuffer);
  if (info.drawCommands.buffer) bind(shader::kBindDrawCommands, info.drawCommands);
  if (params.hasDrawIndices) bind(shader::kBindDrawIndices, info.drawIndices);
  if (params.hasDrawTriangles) bind(shader::kBindDrawTriangles, info.drawTriangles);
  if (params.hasExtents) bind(shader::kBindExtents, info.triangleSizes);
  if (params.hasNumbers)
    bind(shader::kBindNumbers, info.triangleNumbers);
  else
    bindOwn(shader::kBindMeshes, geometry);
  if (info.triangleCount) bind(shader::kBindBits, info.visibleBits);
  if (params.hasSizes) bind(shader::kBindSizes, info.pixelCounts);
  if (params.hasList & 1) bind(shader::kBindList, info.visibleList);
  if (params.hasList & 2) bind(shader::kBindChanged, info.changedList);
  if (params.writeCount) bind(shader::kBindCount, info.visibleCount);
  if (history) bindOwn(shader::kBindView, *history);
}

void setGroups(core::Record& record, const shader::Params& params, const Budgets& budgets) {
  const uint32_t rows = params.height * params.cameraCount;
  const uint64_t pixels = uint64_t(params.width) * rows << (16 - 2 * params.gridShift);
  const uint64_t words = (uint64_t(params.triangleCount) + 31) / 32;
  const uint64_t slots =
      params.method == shader::kExact ? slotsOf(params.width, params.height) * params.cameraCount : 0;
  record.groups[kListGroups] = {shader::kListBlocks, 1, 1};
  record.groups[kOneGroup] = {1, 1, 1};
  record.groups[kClearGroups] = {
      groupsOf256(
          std::max({pixels, slots, words, params.hasSizes || params.hasExtents ? uint64_t(params.triangleCount) : 0})),
      1, 1};
  record.groups[kPixelGroups] = {groupsOf256((pixels + 7) / 8), 1, 1};
  record.groups[kWordGroups] = {groupsOf256(std::max<uint64_t>(words, params.viewWords)), 1, 1};
  record.groups[kTileGroups] = {static_cast<uint32_t>(std::min<uint64_t>(slots / 64, shader::kMaxGroups)), 1, 1};
  record.groups[kAllocateGroups] = {groupsOf256(slots / 64), 1, 1};
  record.groups[kEntryGroups] = {groupsOf256(params.entryCount), 1, 1};
  record.groups[kChunkGroups] = {groupsOf256(budgets.chunks()), 1, 1};
  record.groups[kClusterGroups] = {std::min(params.clusterCount, shader::kMaxGroups), 1, 1};
  const uint32_t side = shader::tileSide(params.width, params.height, 0);
  record.groups[kScreenTileGroups] = {(params.width + side - 1) / side, shader::kMaxTiles * params.cameraCount, 1};
  record.groups[kEachPixelGroups] = {groupsOf256(uint64_t(params.width) * rows), 1, 1};
}
} // namespace

VisibilityRecorder::VisibilityRecorder(core::Context& owner, const GpgpVisibilityRecorderCreateInfo& info)
    : Recorder(owner, core::Kind::visibilityRecorder, info.base, GPGP_SERVICE_VISIBILITY),
      budgets_(info, owner.device.limits) {}

Result<core::Unique<VisibilityRecorder>> VisibilityRecorder::create(core::Context& context,
                                                                    const GpgpVisibilityRecorderCreateInfo& info) {
  if (auto ok = checkCreateInfo(info); !ok) return ok.error();
  auto recorder = core::makeUnique<VisibilityRecorder>(context.host(), context, info);
  if (auto ok = recorder->init(describePasses(recorder->budgets_, context.device, &context.host())); !ok)
    return ok.error();
  return recorder;
}

Result<void> VisibilityRecorder::prepare(VkCommandBuffer commandBuffer, const GpgpVisibilityInfo& info,
                                         const GeometrySet& geometry, const CameraHistory* history) {
  if (auto ok = checkSampleInfo(info, budgets_, history); !ok) return ok;
  if (info.clusters.buffer)
    if (auto ok = checkSize("clusters", info.clusters, uint64_t(geometry.clusterCount()) * shader::kClusterBytes,
                            "the geometry set");
        !ok)
      return ok;
  const shader::Params params = parametersOf(info, budgets_, geometry, history);
  core::Record record;
  record.commandBuffer = commandBuffer;
  record.info = &info.base;
  setBindings(record, info, params, geometry, history);
  setGroups(record, params, budgets_);
  record.levels = params.method == shader::kConservative ? info.refinements + 1 : 1;
  record.conditions[kIfSampling] = true;
  record.conditions[kIfConservative] = params.method == shader::kConservative;
  record.conditions[kIfNearby] = params.method == shader::kNearby;
  record.conditions[kIfExact] = params.method == shader::kExact;
  record.conditions[kIfReuse] = params.reuse != 0;
  record.conditions[kIfAlphaTests] = params.alphaTestCount != 0;
  record.conditions[kIfNonOpaque] = params.alphaTestCount == 0;
  record.conditions[kIfResolve] = params.method == shader::kExact && params.alphaTestCount == 0;
  record.conditions[kIfResolveAlpha] = params.method == shader::kExact && params.alphaTestCount != 0;
  record.conditions[kIfCommands] = params.hasCommands != 0;
  record.conditions[kIfClusters] = params.clusterCount && !info.keepClusters;
  record.conditions[kIfDraws] = info.drawCommands.buffer || params.hasDrawIndices || params.hasDrawTriangles;
  record.conditions[kIfExtents] = params.hasExtents != 0;
  record.constants[0] = std::as_bytes(std::span(&params, 1));
  if (auto ok = check(record); !ok) return ok;
  return Recorder::record(record);
}

} // namespace gpgp::visibility
