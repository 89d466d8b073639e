// The passes of the sampler, the checks of a record, and what a record fills in.
#include "visibility/sampling/sampler.h"

#include "shaders/visibility_allot.spv.h"
#include "shaders/visibility_big.spv.h"
#include "shaders/visibility_clear.spv.h"
#include "shaders/visibility_finish.spv.h"
#include "shaders/visibility_gather.spv.h"
#include "shaders/visibility_hide.spv.h"
#include "shaders/visibility_large.spv.h"
#include "shaders/visibility_left.spv.h"
#include "shaders/visibility_list.spv.h"
#include "shaders/visibility_medium.spv.h"
#include "shaders/visibility_pick.spv.h"
#include "shaders/visibility_pick_unfold.spv.h"
#include "shaders/visibility_place.spv.h"
#include "shaders/visibility_plan.spv.h"
#include "shaders/visibility_resolve.spv.h"
#include "shaders/visibility_small.spv.h"
#include "shaders/visibility_unfold.spv.h"
#include "visibility/layout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace gpgp::visibility {
namespace {
using core::makeError;
using core::Result;
using shader::Counters;
using shader::Params;

static_assert(sizeof(GpgpMesh) == sizeof(shader::Mesh) && sizeof(GpgpVisibilityDraw) == sizeof(shader::Draw));
static_assert(offsetof(GpgpVisibilityDraw, flags) == offsetof(shader::Draw, flags));
static_assert(GPGP_DRAW_TWO_SIDED == shader::kTwoSided && GPGP_SAMPLING_EXACT == shader::kExact);

// Room for triangles that are made once for both phases, at most a quarter of all; more are made again by each
// workgroup that draws them.
constexpr uint32_t kMediumRecords = 65536, kLargeRecords = 32768;
constexpr VkDeviceSize kRecordBytes = 80; // TriangleRecord of records.glsl

// Workgroup counts of a record.
constexpr uint32_t kOneGroup = 0, kClearGroups = 1, kPixelGroups = 2, kWordGroups = 3, kTileGroups = 4;
// Condition of a record.
constexpr uint32_t kIfExact = 0;

constexpr uint32_t kMaxBig = 1 << 20; // entries for candidates of more than 8 x 8 pixels
constexpr uint32_t kTruthSamples = 64;

/// Workgroups of 256 for a number of items; shaders stride beyond the limit.
uint32_t groupsOf256(uint64_t items) {
  return static_cast<uint32_t>(std::min<uint64_t>((items + 255) / 256, shader::kMaxGroups));
}

Result<void> checkSize(const char* name, const GpgpBuffer& buffer, uint64_t needed, const char* why) {
  if (!buffer.buffer) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.buffer is NULL", name);
  if (buffer.size < needed)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.size is %llu; %s needs %llu", name,
                     static_cast<unsigned long long>(buffer.size), why, static_cast<unsigned long long>(needed));
  return {};
}

/// Pixels in whole tiles of 8 x 8.
uint64_t slotsOf(uint32_t width, uint32_t height) { return uint64_t((width + 7) / 8) * ((height + 7) / 8) * 64; }

/// Vertices that a range holds, the last one without its padding.
uint32_t verticesIn(VkDeviceSize bytes, uint32_t stride) {
  return bytes < 12 ? 0 : static_cast<uint32_t>(std::min<VkDeviceSize>((bytes - 12) / stride + 1, UINT32_MAX));
}
} // namespace

Sampler::Sampler(core::Context& owner, const GpgpSamplerCreateInfo& info)
    : Worker(owner, core::Kind::sampler, info.base, GPGP_SERVICE_VISIBILITY),
      maxWidth_(info.maxWidth ? info.maxWidth : 2048), maxHeight_(info.maxHeight ? info.maxHeight : 2048),
      maxDraws_(info.maxDraws ? info.maxDraws : 65536), maxTriangles_(info.maxTriangles ? info.maxTriangles : 1u << 22),
      maxSamples_(std::max(info.maxSamples, 1u)), methods_(info.methods ? info.methods : GPGP_SAMPLING_STANDARD_BIT),
      maxCandidates_(info.maxCandidates ? info.maxCandidates : std::max(maxTriangles_ / 4, 65536u)),
      maxPairs_(info.maxPairs ? info.maxPairs : defaultPairs()) {}

uint32_t Sampler::defaultPairs() const {
  const uint64_t wanted = (uint64_t(maxWidth_) * maxHeight_ + maxCandidates_) * 4;
  return static_cast<uint32_t>(
      std::min<uint64_t>(wanted, context.device.limits.maxStorageBufferRange / sizeof(shader::Pair)));
}

uint32_t Sampler::mediumRecords() const { return std::clamp(maxTriangles_ / 4, 1u, kMediumRecords); }
uint32_t Sampler::largeRecords() const { return std::clamp(maxTriangles_ / 4, 1u, kLargeRecords); }

Result<core::Unique<Sampler>> Sampler::create(core::Context& context, const GpgpSamplerCreateInfo& info) {
  auto sampler = core::makeUnique<Sampler>(context.host(), context, info);
  if (auto ok = sampler->init(sampler->describe()); !ok) return ok.error();
  return sampler;
}

core::PassList Sampler::describe() const {
  using enum core::ResourceKind;
  using enum core::UseKind;
  core::PassList list(&context.host());
  const VkDeviceSize pixelBytes = VkDeviceSize(maxWidth_) * maxHeight_ * maxSamples_ * maxSamples_ * 4;
  // In the order of shader::kBind...
  const auto params = list.add({"camera", constants, sizeof(Params)});
  const auto positions = list.add({"positions", buffer, 0, true});
  const auto indices = list.add({"indices", buffer, 0, true});
  const auto draws = list.add({"draws", buffer, 0, true});
  const auto meshes = list.add({"geometrySet", buffer});
  const auto starts = list.add({"draw starts", scratch, VkDeviceSize(maxDraws_) * 8});
  const auto queue = list.add({"queue", scratch, VkDeviceSize(maxTriangles_) * 4});
  const auto depth = list.add({"depth", scratch, pixelBytes});
  const auto ids = list.add({"ids", scratch, pixelBytes});
  const auto counters = list.add({"counters", scratch, sizeof(Counters)});
  const auto bits = list.add({"visibleBits", buffer, 0, true});
  const auto visible = list.add({"visibleList", buffer, 0, true});
  const auto count = list.add({"visibleCount", buffer, 0, true});
  const auto view = list.add({"view", buffer, 0, true});
  const auto records = list.add({"records", scratch, (mediumRecords() + largeRecords()) * kRecordBytes});
  const auto sizes = list.add({"pixelCounts", buffer, 0, true});
  const auto limits =
      list.add({"limits", scratch, methods_ & GPGP_SAMPLING_EXACT_BIT ? slotsOf(maxWidth_, maxHeight_) * 4 : 4});

  const auto shader = [&](const char* name, std::span<const uint32_t> spirv, uint32_t phase = 0) {
    core::ShaderDesc desc{name, spirv};
    desc.specialization[0] = phase;
    desc.specializationCount = 1;
    return list.add(desc);
  };

  list.dispatch("clear", shader("clear", visibility_clear),
                {{params, read},
                 {depth, write},
                 {ids, write},
                 {counters, write},
                 {bits, write},
                 {sizes, write},
                 {limits, readWrite}},
                kClearGroups);
  list.dispatch("plan", shader("plan", visibility_plan),
                {{params, read}, {draws, read}, {meshes, read}, {starts, write}, {counters, readWrite}}, kOneGroup);
  const char* const names[2][4] = {{"depth small", "depth medium", "depth large", "depth left"},
                                   {"ids small", "ids medium", "ids large", "ids left"}};
  for (uint32_t phase = 0; phase < 2; ++phase) {
    list.dispatchIndirect(names[phase][0], shader("small", visibility_small, phase),
                          {{params, read},
                           {positions, read},
                           {indices, read},
                           {draws, read},
                           {meshes, read},
                           {starts, read},
                           {queue, write},
                           {depth, readWrite},
                           {ids, readWrite},
                           {limits, readWrite},
                           {counters, readWrite}},
                          counters, offsetof(Counters, smallArgs));
    if (phase == 0)
      list.dispatchIndirect("unfold", shader("unfold", visibility_unfold),
                            {{params, read},
                             {positions, read},
                             {indices, read},
                             {draws, read},
                             {meshes, read},
                             {starts, read},
                             {queue, readWrite},
                             {records, write},
                             {counters, readWrite}},
                            counters, offsetof(Counters, unfoldArgs));
    list.dispatchIndirect(
        names[phase][1], shader("medium", visibility_medium, phase),
        {{params, read}, {records, read}, {depth, readWrite}, {ids, readWrite}, {limits, readWrite}, {counters, read}},
        counters, offsetof(Counters, mediumArgs));
    list.dispatchIndirect(
        names[phase][2], shader("large", visibility_large, phase),
        {{params, read}, {records, read}, {depth, readWrite}, {ids, readWrite}, {limits, readWrite}, {counters, read}},
        counters, offsetof(Counters, largeArgs));
    list.dispatchIndirect(names[phase][3], shader("left", visibility_left, phase),
                          {{params, read},
                           {positions, read},
                           {indices, read},
                           {draws, read},
                           {meshes, read},
                           {starts, read},
                           {queue, read},
                           {depth, readWrite},
                           {ids, readWrite},
                           {limits, readWrite},
                           {counters, read}},
                          counters, offsetof(Counters, leftArgs));
  }
  list.dispatch("gather", shader("gather", visibility_gather),
                {{params, read}, {ids, read}, {counters, readWrite}, {bits, readWrite}, {sizes, readWrite}},
                kPixelGroups);
  if (methods_ & GPGP_SAMPLING_EXACT_BIT) describeExact(list);
  list.dispatch("list", shader("list", visibility_list),
                {{params, read}, {counters, readWrite}, {bits, read}, {visible, write}, {view, readWrite}},
                kWordGroups);
  list.dispatch("finish", shader("finish", visibility_finish), {{params, read}, {counters, readWrite}, {count, write}},
                kOneGroup);
  list.report = counters;
  list.reportBytes = shader::kReportWords * 4;
  return list;
}

/// Exact sampling: what follows standard sampling.
void Sampler::describeExact(core::PassList& list) const {
  using enum core::ResourceKind;
  using enum core::UseKind;
  using core::ResourceIndex;
  constexpr auto bound = [](int binding) { return static_cast<ResourceIndex>(binding); };
  const auto params = bound(shader::kBindParams), positions = bound(shader::kBindPositions),
             indices = bound(shader::kBindIndices), draws = bound(shader::kBindDraws),
             meshes = bound(shader::kBindMeshes), starts = bound(shader::kBindStarts),
             queue = bound(shader::kBindQueue), open = bound(shader::kBindOpen),
             counters = bound(shader::kBindCounters), bits = bound(shader::kBindBits),
             limits = bound(shader::kBindLimits);
  const auto candidates = list.add({"candidates", scratch, VkDeviceSize(maxCandidates_) * sizeof(shader::Candidate)});
  const auto bigs = list.add({"big candidates", scratch, VkDeviceSize(kMaxBig) * 8});
  const auto lengths = list.add({"list lengths", scratch, slotsOf(maxWidth_, maxHeight_) * 4});
  const auto pairs = list.add({"pairs", scratch, VkDeviceSize(maxPairs_) * sizeof(shader::Pair)});
  const auto entries = list.add({"list entries", scratch, VkDeviceSize(maxPairs_) * sizeof(shader::Entry)});
  const auto shader = [&](const char* name, std::span<const uint32_t> spirv, uint32_t phase = 0) {
    core::ShaderDesc desc{name, spirv};
    desc.specialization[0] = phase;
    desc.specializationCount = 1;
    return list.add(desc);
  };
  const size_t first = list.passes.size();
  list.fill("clear lists", lengths, 0);
  list.dispatchIndirect("pick", shader("pick", visibility_pick),
                        {{params, read},
                         {positions, read},
                         {indices, read},
                         {draws, read},
                         {meshes, read},
                         {starts, read},
                         {queue, write},
                         {limits, readWrite},
                         {counters, readWrite},
                         {bits, readWrite},
                         {candidates, readWrite},
                         {lengths, readWrite},
                         {pairs, write}},
                        counters, offsetof(Counters, smallArgs));
  list.dispatchIndirect("pick unfold", shader("pick unfold", visibility_pick_unfold),
                        {{params, read},
                         {positions, read},
                         {indices, read},
                         {draws, read},
                         {meshes, read},
                         {starts, read},
                         {queue, read},
                         {counters, readWrite},
                         {bits, readWrite},
                         {candidates, write},
                         {bigs, write}},
                        counters, offsetof(Counters, bigUnfoldArgs));
  const auto addBig = [&](const char* name, uint32_t phase) {
    list.dispatchIndirect(name, shader("big", visibility_big, phase),
                          {{params, read},
                           {limits, readWrite},
                           {counters, readWrite},
                           {bits, readWrite},
                           {candidates, readWrite},
                           {bigs, read},
                           {lengths, readWrite},
                           {pairs, write}},
                          counters, offsetof(Counters, bigArgs));
  };
  addBig("pick big", 0);
  list.dispatchIndirect("hide", shader("hide", visibility_hide),
                        {{params, read},
                         {positions, read},
                         {indices, read},
                         {draws, read},
                         {meshes, read},
                         {starts, read},
                         {queue, read},
                         {limits, readWrite},
                         {counters, readWrite},
                         {bits, readWrite},
                         {candidates, readWrite},
                         {lengths, readWrite},
                         {pairs, write}},
                        counters, offsetof(Counters, seenArgs));
  addBig("hide big", 1);
  list.dispatch("allot", shader("allot", visibility_allot),
                {{params, read}, {counters, readWrite}, {lengths, read}, {limits, readWrite}, {open, write}},
                kTileGroups);
  list.dispatchIndirect("place", shader("place", visibility_place),
                        {{params, read}, {counters, read}, {limits, read}, {pairs, read}, {entries, write}}, counters,
                        offsetof(Counters, placeArgs));
  list.dispatchIndirect("resolve", shader("resolve", visibility_resolve),
                        {{params, read},
                         {limits, readWrite},
                         {counters, readWrite},
                         {lengths, read},
                         {bits, readWrite},
                         {open, read},
                         {candidates, read},
                         {entries, read}},
                        counters, offsetof(Counters, openArgs));
  for (size_t i = first; i < list.passes.size(); ++i) list.passes[i].condition = kIfExact;
}

Result<void> Sampler::checkInfo(const GpgpSampleInfo& info, const CameraView* view) const {
  if (info.width == 0 || info.height == 0 || info.width > maxWidth_ || info.height > maxHeight_)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the viewport is %u x %u; the sampler was made for 1 x 1 to %u x %u",
                     info.width, info.height, maxWidth_, maxHeight_);
  const uint32_t method = info.method < 0 || info.method > 31 ? 0 : 1u << info.method;
  if (!(methods_ & method))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "method is %d; the sampler was made for methods 0x%x", info.method,
                     methods_);
  const uint32_t samples = samplesOf(info), perSide = samples / std::min(samples, maxSamples_);
  if (!std::has_single_bit(samples) || samples > 256)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "samples is %u; expected a power of two up to 256", samples);
  if (info.method == GPGP_SAMPLING_STANDARD && samples > maxSamples_)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "samples is %u; the sampler was made for %u", samples, maxSamples_);
  if (info.method == GPGP_SAMPLING_TRUTH && info.slice > perSide * perSide)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "slice is %u; %u samples are taken in slices 0 to %u", info.slice,
                     samples, perSide * perSide);
  if (info.drawCount > maxDraws_)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "drawCount is %u; the sampler was made for %u", info.drawCount,
                     maxDraws_);
  if (info.triangleCount > 1u << 31)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "triangleCount is %u; at most 2147483648", info.triangleCount);
  if (view && info.triangleCount > view->maxTriangles())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "triangleCount is %u; the view was made for %u", info.triangleCount,
                     view->maxTriangles());
  if (info.indexType != VK_INDEX_TYPE_UINT16 && info.indexType != VK_INDEX_TYPE_UINT32)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "indexType is %d; expected UINT16 or UINT32", info.indexType);
  if (info.positionStride % 4 || (info.positionStride && info.positionStride < 12))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "positionStride is %u; expected a multiple of 4 from 12 on",
                     info.positionStride);
  if (info.drawCount) {
    if (auto ok = checkSize("draws", info.draws, uint64_t(info.drawCount) * sizeof(GpgpVisibilityDraw), "drawCount");
        !ok)
      return ok;
    if (auto ok = checkSize("positions", info.positions, 4, "a vertex"); !ok) return ok;
    if (auto ok = checkSize("indices", info.indices, 4, "an index"); !ok) return ok;
    if (info.indices.size % 4)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "indices.size is %llu; expected a multiple of 4",
                       static_cast<unsigned long long>(info.indices.size));
  }
  if (info.triangleCount)
    if (auto ok =
            checkSize("visibleBits", info.visibleBits, (uint64_t(info.triangleCount) + 31) / 32 * 4, "triangleCount");
        !ok)
      return ok;
  if (info.pixelCounts.buffer)
    if (auto ok = checkSize("pixelCounts", info.pixelCounts, std::max<uint64_t>(uint64_t(info.triangleCount) * 4, 4),
                            "triangleCount");
        !ok)
      return ok;
  if (info.visibleList.buffer)
    if (auto ok = checkSize("visibleList", info.visibleList, 4, "one triangle"); !ok) return ok;
  if (info.visibleCount.buffer)
    if (auto ok = checkSize("visibleCount", info.visibleCount, 16, "the count and the arguments"); !ok) return ok;
  return {};
}

uint32_t Sampler::samplesOf(const GpgpSampleInfo& info) {
  if (info.method == GPGP_SAMPLING_EXACT) return 1;
  return info.samples ? info.samples : info.method == GPGP_SAMPLING_TRUTH ? kTruthSamples : 1;
}

void Sampler::setGrid(const GpgpSampleInfo& info, Params& params) const {
  const uint32_t samples = samplesOf(info), perRecord = std::min(samples, maxSamples_), perSide = samples / perRecord;
  const bool centre = info.method == GPGP_SAMPLING_TRUTH && info.slice == perSide * perSide;
  const uint32_t spacing = 256 / (centre ? 1 : perRecord), part = centre ? 256 : 256 / samples;
  params.gridShift = static_cast<uint32_t>(std::countr_zero(spacing));
  params.gridX = (centre ? 0 : info.slice % perSide) * part + part / 2;
  params.gridY = (centre ? 0 : info.slice / perSide) * part + part / 2;
  if (info.method != GPGP_SAMPLING_TRUTH) params.gridX = params.gridY = spacing / 2;
}

Result<void> Sampler::prepare(VkCommandBuffer commandBuffer, const GpgpSampleInfo& info, const GeometrySet& geometry,
                              const CameraView* view) {
  if (auto ok = checkInfo(info, view); !ok) return ok;
  Params params{};
  std::memcpy(params.viewProjection, info.camera.viewProjection, sizeof params.viewProjection);
  params.width = info.width;
  params.height = info.height;
  params.reversedDepth = info.camera.reversedDepth ? 1 : 0;
  params.drawCount = info.drawCount;
  params.meshCount = geometry.meshCount();
  params.triangleCount = info.triangleCount;
  params.maxItems = maxTriangles_;
  if (info.drawCount) {
    const uint32_t stride = info.positionStride ? info.positionStride : 12;
    params.shortIndices = info.indexType == VK_INDEX_TYPE_UINT16 ? 1 : 0;
    params.indexCount = static_cast<uint32_t>(info.indices.size / (params.shortIndices ? 2 : 4));
    params.vertexCount = verticesIn(info.positions.size, stride);
    params.strideWords = stride / 4;
  }
  params.hasList = info.visibleList.buffer ? 1 : 0;
  params.listCapacity =
      params.hasList ? static_cast<uint32_t>(std::min<VkDeviceSize>(info.visibleList.size / 4, UINT32_MAX)) : 0;
  params.writeCount = info.visibleCount.buffer ? 1 : 0;
  params.viewWords = view ? view->words() : 0;
  params.mediumRecords = mediumRecords();
  params.largeRecords = largeRecords();
  const bool exact = info.method == GPGP_SAMPLING_EXACT;
  setGrid(info, params);
  params.accumulate = info.accumulate ? 1 : 0;
  params.hasSizes = info.pixelCounts.buffer ? 1 : 0;
  params.method = static_cast<uint32_t>(info.method);
  params.maxCandidates = maxCandidates_;
  params.maxBig = kMaxBig;
  params.maxPairs = maxPairs_;

  core::Record record;
  record.commandBuffer = commandBuffer;
  record.info = &info.base;
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
  bindOwn(shader::kBindMeshes, geometry);
  if (info.triangleCount) bind(shader::kBindBits, info.visibleBits);
  if (params.hasSizes) bind(shader::kBindSizes, info.pixelCounts);
  if (params.hasList) bind(shader::kBindList, info.visibleList);
  if (params.writeCount) bind(shader::kBindCount, info.visibleCount);
  if (view) bindOwn(shader::kBindView, *view);

  const uint64_t pixels = uint64_t(info.width) * info.height << (16 - 2 * params.gridShift);
  const uint64_t words = (uint64_t(info.triangleCount) + 31) / 32;
  const uint64_t slots = exact ? slotsOf(info.width, info.height) : 0;
  record.groups[kOneGroup] = {1, 1, 1};
  record.groups[kClearGroups] = {
      groupsOf256(std::max({pixels, slots, words, params.hasSizes ? uint64_t(info.triangleCount) : 0})), 1, 1};
  record.groups[kPixelGroups] = {groupsOf256((pixels + 7) / 8), 1, 1};
  record.groups[kWordGroups] = {groupsOf256(std::max<uint64_t>(words, params.viewWords)), 1, 1};
  record.groups[kTileGroups] = {static_cast<uint32_t>(std::min<uint64_t>(slots / 64, shader::kMaxGroups)), 1, 1};
  record.conditions[kIfExact] = exact;
  record.constants = std::as_bytes(std::span(&params, 1));
  if (auto ok = check(record); !ok) return ok;
  return Worker::record(record);
}

bool Sampler::takeSampleReport(GpgpSampleReport& report) {
  core::RawReport raw;
  if (!takeReport(raw)) return false;
  Counters counters{};
  std::memcpy(&counters, raw.words.data(), std::min(raw.words.size_bytes(), sizeof counters));
  report.base = raw.header;
  report.triangles = counters.triangles;
  report.visible = counters.visible;
  report.listed = counters.listed;
  report.coveredPixels = counters.coveredPixels;
  report.appeared = counters.appeared;
  report.disappeared = counters.disappeared;
  report.neededTriangles = counters.items;
  report.skippedTriangles = counters.skippedTriangles;
  report.skippedDraws = counters.skippedDraws;
  report.neededCandidates = counters.candidates;
  report.neededPairs = counters.pairs;
  report.unresolved = counters.unresolved;
  const bool tooMany =
      counters.items > maxTriangles_ || counters.unresolved || (counters.hasList && counters.listed < counters.visible);
  if (report.base.status == GPGP_SUCCESS && tooMany) report.base.status = GPGP_BUDGET_EXCEEDED;
  return true;
}

} // namespace gpgp::visibility
