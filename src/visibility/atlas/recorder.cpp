// Creation, a recording, and its report.
#include "visibility/atlas/passes.h"
#include "visibility/sampling/checks.h"

#include <algorithm>
#include <cstring>

namespace gpgp::visibility {
using core::makeError;
using core::Result;

static_assert(GPGP_ATLAS_CLASSES == shader::kClasses);

Atlas::Atlas(core::Context& owner, const GpgpAtlasCreateInfo& info)
    : Resident(owner, core::Kind::atlas, info.label), width_(info.width ? info.width : 4096),
      height_(info.height ? info.height : 4096), maxTriangles_(info.maxTriangles ? info.maxTriangles : 1u << 22) {}

uint64_t Atlas::bytesFor(uint32_t maxTriangles) {
  return (shader::kHeadWords + uint64_t(maxTriangles) + (uint64_t(maxTriangles) + 15) / 16) * 4;
}

namespace {
Result<void> checkTriangles(uint32_t maxTriangles) {
  if (maxTriangles > shader::kMaxAtlasTriangles)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxTriangles is %u; at most %u", maxTriangles,
                     shader::kMaxAtlasTriangles);
  return {};
}
} // namespace

Result<core::Unique<Atlas>> Atlas::create(core::Context& context, const GpgpAtlasCreateInfo& info) {
  if (info.width % shader::kSuperSide || info.height % shader::kSuperSide || info.width > 8192 || info.height > 8192)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "width x height is %u x %u; expected multiples of %u up to 8192",
                     info.width, info.height, shader::kSuperSide);
  if (auto ok = checkTriangles(info.maxTriangles); !ok) return ok.error();
  auto atlas = core::makeUnique<Atlas>(context.host(), context, info);
  std::pmr::vector<std::byte> none(&context.host());
  if (auto ok = atlas->makeResident(GPGP_SERVICE_VISIBILITY, std::move(none), bytesFor(atlas->maxTriangles_)); !ok)
    return ok.error();
  return atlas;
}

AtlasBudgets::AtlasBudgets(const GpgpAtlasRecorderCreateInfo& info)
    : maxTriangles(info.maxTriangles ? info.maxTriangles : 1u << 22), maxBuckets(std::max(info.maxBuckets, 1u)) {}

uint64_t AtlasBudgets::rowWords() const {
  return shader::kRowCounts + uint64_t(shader::kRowTiles + maxBuckets * shader::kClasses) * groups();
}

AtlasRecorder::AtlasRecorder(core::Context& owner, const GpgpAtlasRecorderCreateInfo& info)
    : Recorder(owner, core::Kind::atlasRecorder, info.base, GPGP_SERVICE_VISIBILITY), budgets_(info) {}

Result<core::Unique<AtlasRecorder>> AtlasRecorder::create(core::Context& context,
                                                          const GpgpAtlasRecorderCreateInfo& info) {
  if (auto ok = checkTriangles(info.maxTriangles); !ok) return ok.error();
  if (info.maxBuckets > shader::kMaxBuckets)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxBuckets is %u; at most %u", info.maxBuckets, shader::kMaxBuckets);
  auto recorder = core::makeUnique<AtlasRecorder>(context.host(), context, info);
  if (auto ok = recorder->init(describeAtlasPasses(recorder->budgets_, &context.host())); !ok) return ok.error();
  return recorder;
}

namespace {
/// Whether the recording fits the recorder, the atlas and its buffers.
Result<void> checkInfo(const GpgpAtlasInfo& info, const AtlasBudgets& budgets, const Atlas& atlas) {
  if (atlas.maxTriangles() > budgets.maxTriangles)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the atlas was made for %u triangles, the recorder for %u",
                     atlas.maxTriangles(), budgets.maxTriangles);
  if (info.triangleCount > atlas.maxTriangles())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "triangleCount is %u; the atlas was made for %u", info.triangleCount,
                     atlas.maxTriangles());
  if (info.bucketCount > budgets.maxBuckets)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "bucketCount is %u; the recorder was made for %u", info.bucketCount,
                     budgets.maxBuckets);
  if (info.texelsPerPixel != 0 && !(info.texelsPerPixel >= 1.0f / 1024 && info.texelsPerPixel <= 64))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "texelsPerPixel is %g; expected 0.0009765625 to 64",
                     static_cast<double>(info.texelsPerPixel));
  if (info.drawCount > shader::kMaxAtlasDraws)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "drawCount is %u; at most %u", info.drawCount,
                     shader::kMaxAtlasDraws);
  if (info.indexType != VK_INDEX_TYPE_UINT16 && info.indexType != VK_INDEX_TYPE_UINT32)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "indexType is %d; expected UINT16 or UINT32", info.indexType);
  if (info.drawCount && info.indices.size % 4)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "indices.size is %llu; expected a multiple of 4",
                     static_cast<unsigned long long>(info.indices.size));
  const uint64_t triangles = info.triangleCount, words = (triangles + 31) / 32;
  const uint32_t buckets = std::max(info.bucketCount, 1u);
  struct Row {
    const char* name;
    const GpgpBuffer& buffer;
    bool needed;
    uint64_t bytes;
    const char* why;
  };
  for (const Row& row :
       {Row{"visibleBits", info.visibleBits, triangles != 0, words * 4, "triangleCount"},
        {"triangleSizes", info.triangleSizes, triangles != 0, triangles * 12, "triangleCount"},
        {"blocks", info.blocks, triangles != 0, triangles * 4, "triangleCount"},
        {"draws", info.draws, info.drawCount != 0, uint64_t(info.drawCount) * 64, "drawCount"},
        {"indices", info.indices, info.drawCount != 0, 4, "an index"},
        {"buckets", info.buckets, false, (triangles + 3) / 4 * 4, "triangleCount"},
        {"shadeBits", info.shadeBits, false, words * 4, "triangleCount"},
        {"tiles", info.tiles, false, 8, "one tile"},
        {"dispatches", info.dispatches, false, uint64_t(buckets) * shader::kArgumentWords * 4, "bucketCount"},
        {"newBlocks", info.newBlocks, false, 4, "one triangle"},
        {"changedBlocks", info.changedBlocks, false, 4, "one triangle"},
        {"goneBlocks", info.goneBlocks, false, 4, "one triangle"},
        {"counts", info.counts, false, 16, "the counts"}})
    if (row.needed || row.buffer.buffer)
      if (auto ok = checkSize(row.name, row.buffer, row.bytes, row.why); !ok) return ok;
  return {};
}
} // namespace

shader::AtlasParams atlasParamsOf(const GpgpAtlasInfo& info, const Atlas& atlas, const GeometrySet* geometry) {
  const auto room = [](const GpgpBuffer& buffer, uint32_t bytes) {
    return buffer.buffer ? static_cast<uint32_t>(std::min<VkDeviceSize>(buffer.size / bytes, UINT32_MAX)) : 0;
  };
  shader::AtlasParams params{};
  params.triangleCount = info.triangleCount;
  params.maxTriangles = atlas.maxTriangles();
  params.groupCount = (params.maxTriangles + shader::kAtlasGroup - 1) / shader::kAtlasGroup;
  params.superColumns = atlas.superColumns();
  params.superCount = atlas.superCount();
  params.scale = info.texelsPerPixel != 0 ? info.texelsPerPixel : 1;
  params.bucketCount = std::max(info.bucketCount, 1u);
  params.hasBuckets = info.buckets.buffer ? 1 : 0;
  params.hasShade = info.shadeBits.buffer ? 1 : 0;
  if (info.drawCount && geometry) {
    params.findsPairs = 1;
    params.drawCount = info.drawCount;
    params.meshCount = geometry->meshCount();
    params.shortIndices = info.indexType == VK_INDEX_TYPE_UINT16 ? 1 : 0;
    params.indexCount = room(info.indices, params.shortIndices ? 2 : 4);
  }
  params.tileCapacity = room(info.tiles, 8);
  params.newCapacity = room(info.newBlocks, 4);
  params.changedCapacity = room(info.changedBlocks, 4);
  params.goneCapacity = room(info.goneBlocks, 4);
  params.hasCounts = info.counts.buffer ? 1 : 0;
  params.hasArguments = info.dispatches.buffer ? 1 : 0;
  return params;
}

Result<void> AtlasRecorder::prepare(VkCommandBuffer commandBuffer, const GpgpAtlasInfo& info, const Atlas& atlas,
                                    const GeometrySet* geometry) {
  if (auto ok = checkInfo(info, budgets_, atlas); !ok) return ok;
  const shader::AtlasParams params = atlasParamsOf(info, atlas, geometry);
  core::Record record;
  record.commandBuffer = commandBuffer;
  record.info = &info.base;
  const auto bindOwn = [&](int binding, const core::Resident& resident) {
    record.bindings[static_cast<size_t>(binding)].ownBuffer = resident.buffer();
    record.bindings[static_cast<size_t>(binding)].ownSize = resident.size();
  };
  bindOwn(shader::kAtlasHistory, atlas);
  if (params.findsPairs) bindOwn(shader::kAtlasMeshes, *geometry);
  const auto bind = [&](int binding, const GpgpBuffer& buffer) {
    if (buffer.buffer) record.bindings[static_cast<size_t>(binding)].engineBuffer = &buffer;
  };
  if (info.triangleCount) {
    bind(shader::kAtlasBits, info.visibleBits);
    bind(shader::kAtlasSizes, info.triangleSizes);
    bind(shader::kAtlasBuckets, info.buckets);
    bind(shader::kAtlasShade, info.shadeBits);
    bind(shader::kAtlasBlocks, info.blocks);
  }
  if (params.findsPairs) {
    bind(shader::kAtlasDraws, info.draws);
    bind(shader::kAtlasIndices, info.indices);
  }
  bind(shader::kAtlasTiles, info.tiles);
  bind(shader::kAtlasArguments, info.dispatches);
  bind(shader::kAtlasNew, info.newBlocks);
  bind(shader::kAtlasChanged, info.changedBlocks);
  bind(shader::kAtlasGone, info.goneBlocks);
  bind(shader::kAtlasCounts, info.counts);
  record.groups[kAtlasOneGroup] = {1, 1, 1};
  const uint32_t slices = geometry ? std::clamp(geometry->clusterCount() / 128, 1u, 64u) : 1;
  record.groups[kAtlasDrawGroups] = {params.drawCount, slices, 1};
  record.groups[kAtlasTriangleGroups] = {params.groupCount, 1, 1};
  record.groups[kAtlasRequestRows] = {shader::kRowTiles, 1, 1};
  record.groups[kAtlasClassGroups] = {shader::kClasses + 1, 1, 1};
  record.groups[kAtlasTileRows] = {params.bucketCount * shader::kClasses, 1, 1};
  record.conditions[kIfPairs] = params.findsPairs != 0;
  record.conditions[kIfTiles] = info.tiles.buffer != VK_NULL_HANDLE;
  record.constants[0] = std::as_bytes(std::span(&params, 1));
  if (auto ok = check(record); !ok) return ok;
  return Recorder::record(record);
}

bool AtlasRecorder::takeAtlasReport(GpgpAtlasReport& report) {
  core::RawReport raw;
  if (!takeReport(raw)) return false;
  shader::AtlasCounters counters{};
  std::memcpy(&counters, raw.words.data(), std::min(raw.words.size_bytes(), sizeof counters));
  report.base = raw.header;
  report.visibleTriangles = counters.visible;
  report.blocks = counters.blocks;
  std::copy_n(counters.byClass, shader::kClasses, report.blocksByClass);
  report.newBlocks = counters.added;
  report.changedBlocks = counters.changed;
  report.keptBlocks = counters.kept;
  report.goneBlocks = counters.gone;
  report.vacatedBlocks = counters.vacated;
  report.loweredBlocks = counters.lowered;
  report.droppedBlocks = counters.dropped;
  report.droppedTriangles = counters.droppedTriangles;
  report.tiles = counters.tiles;
  report.superblocks = counters.supers;
  report.maxSuperblocks = counters.maxSupers;
  report.pressure = counters.pressure;
  report.repacked = counters.repacked ? VK_TRUE : VK_FALSE;
  const auto share = [](double part, double whole) { return whole > 0 ? static_cast<float>(part / whole) : 0.0f; };
  report.fill = share(counters.texels, double(counters.maxSupers) * shader::kSuperSide * shader::kSuperSide);
  report.fragmentation = share(counters.supers - counters.leastSupers, counters.supers);
  if (report.base.status == GPGP_SUCCESS && (counters.lowered || counters.dropped || counters.listsExceeded))
    report.base.status = GPGP_BUDGET_EXCEEDED;
  return true;
}

} // namespace gpgp::visibility
