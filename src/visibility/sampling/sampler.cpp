// The passes of the sampler, the checks of a record, and what a record fills in.
#include "visibility/sampling/sampler.h"

#include "shaders/visibility_allot.spv.h"
#include "shaders/visibility_big.spv.h"
#include "shaders/visibility_chunks.spv.h"
#include "shaders/visibility_clear.spv.h"
#include "shaders/visibility_draw_count.spv.h"
#include "shaders/visibility_draw_list.spv.h"
#include "shaders/visibility_draw_place.spv.h"
#include "shaders/visibility_expand.spv.h"
#include "shaders/visibility_extents.spv.h"
#include "shaders/visibility_finish.spv.h"
#include "shaders/visibility_gather.spv.h"
#include "shaders/visibility_hide.spv.h"
#include "shaders/visibility_ids.spv.h"
#include "shaders/visibility_large.spv.h"
#include "shaders/visibility_left.spv.h"
#include "shaders/visibility_list.spv.h"
#include "shaders/visibility_measure.spv.h"
#include "shaders/visibility_medium.spv.h"
#include "shaders/visibility_overlap.spv.h"
#include "shaders/visibility_overlap_big.spv.h"
#include "shaders/visibility_pick.spv.h"
#include "shaders/visibility_pick_unfold.spv.h"
#include "shaders/visibility_place.spv.h"
#include "shaders/visibility_plan.spv.h"
#include "shaders/visibility_resolve.spv.h"
#include "shaders/visibility_resolve_long.spv.h"
#include "shaders/visibility_small.spv.h"
#include "shaders/visibility_surfaces.spv.h"
#include "shaders/visibility_unfold.spv.h"
#include "visibility/conservative.h"
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
static_assert(GPGP_DRAW_TWO_SIDED == shader::kTwoSided && GPGP_DRAW_CLOCKWISE == shader::kClockwise);
static_assert(GPGP_SAMPLING_EXACT == shader::kExact && GPGP_SAMPLING_CONSERVATIVE == shader::kConservative);
static_assert(GPGP_HEURISTIC_IN_CIRCLE == shader::kInCircle && GPGP_HEURISTIC_DEPTH == shader::kDepths &&
              GPGP_HEURISTIC_KEEP_FRONT == shader::kKeepFront);

// Room for triangles that are made once for both phases, at most a quarter of all; more are made again by each
// workgroup that draws them.
constexpr uint32_t kMediumRecords = 65536, kLargeRecords = 32768;
constexpr VkDeviceSize kRecordBytes = 80; // TriangleRecord of records.glsl

// Workgroup counts of a record.
constexpr uint32_t kOneGroup = 0, kClearGroups = 1, kPixelGroups = 2, kWordGroups = 3, kTileGroups = 4,
                   kEntryGroups = 5, kEachPixelGroups = 6, kChunkGroups = 7;
// Condition of a record.
constexpr uint32_t kIfExact = 0, kIfCommands = 1, kIfDraws = 2, kIfExtents = 3, kIfConservative = 4, kIfSampling = 5,
                   kIfMeasuring = 6;

constexpr uint32_t kMaxBig = 1 << 20; // entries for candidates of more than 8 x 8 pixels
constexpr uint32_t kTruthSamples = 64;
constexpr uint32_t kMaxRefinements = 4;
constexpr uint32_t kCommandBytes = sizeof(VkDrawIndexedIndirectCommand);

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

/// What lies in a vertex: shader::kFloats and so on, and a number's bytes; 0 for formats that are not read.
struct PositionFormat {
  uint32_t kind = shader::kFloats, bytes = 0;
};
PositionFormat formatOf(VkFormat format) {
  switch (format) {
  case VK_FORMAT_UNDEFINED:
  case VK_FORMAT_R32G32B32_SFLOAT:
  case VK_FORMAT_R32G32B32A32_SFLOAT: return {shader::kFloats, 4};
  case VK_FORMAT_R16G16B16_SFLOAT:
  case VK_FORMAT_R16G16B16A16_SFLOAT: return {shader::kHalves, 2};
  case VK_FORMAT_R16G16B16_SNORM:
  case VK_FORMAT_R16G16B16A16_SNORM: return {shader::kSnorms, 2};
  default: return {};
  }
}

/// Vertices that a range holds, the last one without its padding.
uint32_t verticesIn(VkDeviceSize bytes, uint32_t offset, uint32_t position, uint32_t stride) {
  const uint64_t first = uint64_t(offset) + position;
  return bytes < first ? 0 : static_cast<uint32_t>(std::min<VkDeviceSize>((bytes - first) / stride + 1, UINT32_MAX));
}
} // namespace

Sampler::Sampler(core::Context& owner, const GpgpSamplerCreateInfo& info)
    : Worker(owner, core::Kind::sampler, info.base, GPGP_SERVICE_VISIBILITY),
      maxWidth_(info.maxWidth ? info.maxWidth : 2048), maxHeight_(info.maxHeight ? info.maxHeight : 2048),
      maxCameras_(std::max(info.maxCameras, 1u)), maxDraws_(info.maxDraws ? info.maxDraws : 65536),
      maxTriangles_(info.maxTriangles ? info.maxTriangles : 1u << 22), maxSamples_(std::max(info.maxSamples, 1u)),
      methods_(info.methods ? info.methods : GPGP_SAMPLING_STANDARD_BIT),
      maxCandidates_(info.maxCandidates ? info.maxCandidates : std::max(maxTriangles_ / 4, 65536u)),
      maxPairs_(info.maxPairs ? info.maxPairs : defaultPairs()) {}

uint32_t Sampler::defaultPairs() const {
  const uint64_t wanted = (uint64_t(maxWidth_) * maxHeight_ * maxCameras_ + maxCandidates_) * 4;
  return static_cast<uint32_t>(
      std::min<uint64_t>(wanted, context.device.limits.maxStorageBufferRange / shader::kPairBytes));
}

uint64_t Sampler::chunkCapacity() const { return uint64_t(maxTriangles_) / shader::kChunk + maxDraws_ + 1; }
uint64_t Sampler::slotCapacity() const { return slotsOf(maxWidth_, maxHeight_ * maxCameras_); }
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
  const bool exact = methods_ & GPGP_SAMPLING_EXACT_BIT, conservative = methods_ & GPGP_SAMPLING_CONSERVATIVE_BIT;
  const VkDeviceSize pixels = VkDeviceSize(maxWidth_) * maxHeight_ * maxCameras_;
  const VkDeviceSize pixelBytes = pixels * maxSamples_ * maxSamples_ * 4;
  const auto largest = [](VkDeviceSize a, bool other, VkDeviceSize b) { return other ? std::max(a, b) : a; };
  // In the order of shader::kBind...
  const auto params = list.add({"camera", constants, sizeof(Params)});
  const auto positions = list.add({"positions", buffer, 0, true});
  const auto indices = list.add({"indices", buffer, 0, true});
  const auto draws = list.add({"draws", buffer, 0, true});
  const auto meshes = list.add({"geometrySet", buffer, 0, true});
  const auto table =
      list.add({"draw table", scratch, VkDeviceSize(maxDraws_) * shader::kTableWords * 4 + chunkCapacity() * 4});
  const auto queue =
      list.add({"queue", scratch,
                largest(VkDeviceSize(maxTriangles_) * 4, exact,
                        std::max(VkDeviceSize(maxTriangles_) * 8, VkDeviceSize(maxPairs_) * shader::kPairBytes))});
  const auto depth = list.add({"depth", scratch, pixelBytes});
  const auto ids = list.add({"ids", scratch, pixelBytes});
  const auto counters = list.add({"counters", scratch, sizeof(Counters)});
  const auto bits = list.add({"visibleBits", buffer, 0, true});
  const auto visible = list.add({"visibleList", buffer, 0, true});
  const auto count = list.add({"visibleCount", buffer, 0, true});
  const auto view = list.add({"view", buffer, 0, true});
  VkDeviceSize recordBytes = (mediumRecords() + largeRecords()) * kRecordBytes;
  recordBytes = largest(recordBytes, exact, VkDeviceSize(maxCandidates_) * sizeof(shader::Candidate));
  recordBytes = largest(recordBytes, conservative, pixels * sizeof(shader::Surface));
  const auto records = list.add({"records", scratch, recordBytes});
  const auto sizes = list.add({"pixelCounts", buffer, 0, true});
  const auto slots = list.add({"limits", scratch, exact ? slotCapacity() * 8 + VkDeviceSize(kMaxBig) * 8 : 4});
  const auto commands = list.add({"commands", buffer, 0, true});
  const auto commandCount = list.add({"drawCountBuffer", buffer, 0, true});
  list.add({"drawCommands", buffer, 0, true});
  list.add({"drawIndices", buffer, 0, true});
  list.add({"drawTriangles", buffer, 0, true});
  const auto extents = list.add({"triangleSizes", buffer, 0, true});
  list.add({"pairs", scratch,
            largest(exact ? VkDeviceSize(maxPairs_) * shader::kPairBytes : 4, conservative,
                    pixels * shader::kGapWords * 4)});

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
                 {slots, readWrite},
                 {extents, write}},
                kClearGroups);
  list.dispatch("plan", shader("plan", visibility_plan),
                {{params, read},
                 {draws, read},
                 {meshes, read},
                 {commands, read},
                 {commandCount, read},
                 {table, write},
                 {counters, readWrite}},
                kOneGroup);
  list.dispatch("expand", shader("expand", visibility_expand),
                {{params, read}, {commands, read}, {commandCount, read}, {table, readWrite}, {counters, read}},
                kEntryGroups)
      .condition = kIfCommands;
  list.dispatch("chunks", shader("chunks", visibility_chunks), {{params, read}, {table, readWrite}, {counters, read}},
                kChunkGroups);
  const char* const names[2][4] = {{"depth small", "depth medium", "depth large", "depth left"},
                                   {"ids small", "ids medium", "ids large", "ids left"}};
  for (uint32_t phase = 0; phase < 2; ++phase) {
    list.dispatchIndirect(names[phase][0],
                          phase ? shader("ids", visibility_ids, phase) : shader("small", visibility_small, phase),
                          {{params, read},
                           {positions, read},
                           {indices, read},
                           {draws, read},
                           {table, read},
                           {queue, phase ? read : write},
                           {depth, readWrite},
                           {ids, readWrite},
                           {slots, readWrite},
                           {counters, readWrite}},
                          counters, phase ? offsetof(Counters, winnerArgs) : offsetof(Counters, smallArgs));
    if (phase == 0)
      list.dispatchIndirect("unfold", shader("unfold", visibility_unfold),
                            {{params, read},
                             {positions, read},
                             {indices, read},
                             {draws, read},
                             {table, read},
                             {queue, readWrite},
                             {records, write},
                             {counters, readWrite}},
                            counters, offsetof(Counters, unfoldArgs));
    list.dispatchIndirect(
        names[phase][1], shader("medium", visibility_medium, phase),
        {{params, read}, {records, read}, {depth, readWrite}, {ids, readWrite}, {slots, readWrite}, {counters, read}},
        counters, offsetof(Counters, mediumArgs));
    list.dispatchIndirect(
        names[phase][2], shader("large", visibility_large, phase),
        {{params, read}, {records, read}, {depth, readWrite}, {ids, readWrite}, {slots, readWrite}, {counters, read}},
        counters, offsetof(Counters, largeArgs));
    list.dispatchIndirect(names[phase][3], shader("left", visibility_left, phase),
                          {{params, read},
                           {positions, read},
                           {indices, read},
                           {draws, read},
                           {table, read},
                           {queue, read},
                           {depth, readWrite},
                           {ids, readWrite},
                           {slots, readWrite},
                           {counters, read}},
                          counters, offsetof(Counters, leftArgs));
  }
  if (conservative)
    list.dispatch("surfaces", list.add({"surfaces", visibility_surfaces}),
                  {{params, read},
                   {positions, read},
                   {indices, read},
                   {draws, read},
                   {table, read},
                   {ids, readWrite},
                   {records, write}},
                  kEachPixelGroups)
        .condition = kIfConservative;
  list.dispatch("gather", shader("gather", visibility_gather),
                {{params, read}, {ids, read}, {counters, readWrite}, {bits, readWrite}, {sizes, readWrite}},
                kPixelGroups);
  if (methods_ & GPGP_SAMPLING_EXACT_BIT) describeExact(list);
  if (conservative) describeConservative(list);
  describeDraws(list);
  list.dispatch("list", shader("list", visibility_list),
                {{params, read}, {counters, readWrite}, {bits, read}, {visible, write}, {view, readWrite}},
                kWordGroups);
  list.dispatch("finish", shader("finish", visibility_finish), {{params, read}, {counters, readWrite}, {count, write}},
                kOneGroup);
  for (core::Pass& pass : list.passes)
    if (pass.condition == UINT32_MAX) pass.condition = kIfSampling;
  describeMetrics(list);
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
             table = bound(shader::kBindTable), queue = bound(shader::kBindQueue), open = bound(shader::kBindOpen),
             counters = bound(shader::kBindCounters), bits = bound(shader::kBindBits),
             slots = bound(shader::kBindSlots), candidates = bound(shader::kBindCandidates),
             pairs = bound(shader::kBindPairs), entries = bound(shader::kBindEntries);
  const auto shader = [&](const char* name, std::span<const uint32_t> spirv, uint32_t phase = 0) {
    core::ShaderDesc desc{name, spirv};
    desc.specialization[0] = phase;
    desc.specializationCount = 1;
    return list.add(desc);
  };
  const size_t first = list.passes.size();
  list.fill("clear lists", slots, 0, slotCapacity() * 4, slotCapacity() * 4);
  list.dispatchIndirect("pick", shader("pick", visibility_pick),
                        {{params, read},
                         {positions, read},
                         {indices, read},
                         {draws, read},
                         {table, read},
                         {queue, readWrite},
                         {slots, readWrite},
                         {counters, readWrite},
                         {bits, readWrite},
                         {candidates, readWrite},
                         {pairs, write}},
                        counters, offsetof(Counters, onScreenArgs));
  list.dispatchIndirect("pick unfold", shader("pick unfold", visibility_pick_unfold),
                        {{params, read},
                         {positions, read},
                         {indices, read},
                         {draws, read},
                         {table, read},
                         {queue, read},
                         {counters, readWrite},
                         {bits, readWrite},
                         {candidates, write},
                         {slots, readWrite}},
                        counters, offsetof(Counters, bigUnfoldArgs));
  const auto addBig = [&](const char* name, uint32_t phase) {
    list.dispatchIndirect(name, shader("big", visibility_big, phase),
                          {{params, read},
                           {slots, readWrite},
                           {counters, readWrite},
                           {bits, readWrite},
                           {candidates, readWrite},
                           {pairs, write}},
                          counters, offsetof(Counters, bigArgs));
  };
  addBig("pick big", 0);
  list.dispatchIndirect("hide", shader("hide", visibility_hide),
                        {{params, read},
                         {positions, read},
                         {indices, read},
                         {draws, read},
                         {table, read},
                         {queue, read},
                         {slots, readWrite},
                         {counters, readWrite},
                         {bits, readWrite},
                         {candidates, readWrite},
                         {pairs, write}},
                        counters, offsetof(Counters, seenArgs));
  addBig("hide big", 1);
  list.dispatch("allot", shader("allot", visibility_allot),
                {{params, read}, {counters, readWrite}, {slots, readWrite}, {open, write}}, kTileGroups);
  list.dispatchIndirect("place", shader("place", visibility_place),
                        {{params, read}, {counters, read}, {slots, readWrite}, {pairs, read}, {entries, write}},
                        counters, offsetof(Counters, placeArgs));
  const auto addResolve = [&](const char* name, std::span<const uint32_t> spirv, size_t arguments) {
    list.dispatchIndirect(name, shader(name, spirv),
                          {{params, read},
                           {slots, readWrite},
                           {counters, readWrite},
                           {bits, readWrite},
                           {open, read},
                           {candidates, read},
                           {entries, readWrite}},
                          counters, arguments);
  };
  addResolve("resolve", visibility_resolve, offsetof(Counters, openArgs));
  addResolve("resolve long", visibility_resolve_long, offsetof(Counters, longArgs));
  for (size_t i = first; i < list.passes.size(); ++i) list.passes[i].condition = kIfExact;
}

/// Conservative sampling: what follows standard sampling. Each sweep over the triangles is two passes.
void Sampler::describeConservative(core::PassList& list) const {
  using enum core::UseKind;
  using core::ResourceIndex;
  constexpr auto bound = [](int binding) { return static_cast<ResourceIndex>(binding); };
  const auto counters = bound(shader::kBindCounters), gaps = bound(shader::kBindGaps);
  struct Sweep {
    uint32_t small, big; // shaders
    const char *smallName, *bigName;
  };
  const auto makeSweep = [&](uint32_t phase, const char* smallName, const char* bigName) {
    core::ShaderDesc small{smallName, visibility_overlap}, big{bigName, visibility_overlap_big};
    small.specialization[0] = big.specialization[0] = phase;
    small.specializationCount = big.specializationCount = 1;
    const uint32_t first = list.add(small);
    return Sweep{first, list.add(big), smallName, bigName};
  };
  const size_t first = list.passes.size();
  uint32_t level = 0;
  const auto addFill = [&](const char* name, ResourceIndex target, uint32_t value, VkDeviceSize offset,
                           VkDeviceSize size) { list.fill(name, target, value, offset, size).level = level; };
  const auto addSweep = [&](const Sweep& sweep) {
    addFill("clear overlap", counters, 0, offsetof(Counters, overlapCount), 8);
    const std::initializer_list<core::Use> uses = {
        {bound(shader::kBindParams), read},     {bound(shader::kBindPositions), read},
        {bound(shader::kBindIndices), read},    {bound(shader::kBindDraws), read},
        {bound(shader::kBindTable), read},      {counters, readWrite},
        {bound(shader::kBindQueue), readWrite}, {bound(shader::kBindIds), read},
        {bound(shader::kBindSurfaces), read},   {gaps, readWrite},
        {bound(shader::kBindBits), readWrite}};
    list.dispatchIndirect(sweep.smallName, sweep.small, uses, counters, offsetof(Counters, smallArgs)).level = level;
    list.dispatchIndirect(sweep.bigName, sweep.big, uses, counters, offsetof(Counters, overlapArgs)).level = level;
  };
  addSweep(makeSweep(0, "overlap", "overlap big"));
  const Sweep cover = makeSweep(1, "cover", "cover big"), nearest = makeSweep(2, "nearest", "nearest big"),
              take = makeSweep(3, "take", "take big");
  const VkDeviceSize pixels = VkDeviceSize(maxWidth_) * maxHeight_ * maxCameras_;
  for (level = 1; level <= kMaxRefinements; ++level) {
    if (level == 1) addFill("clear gaps", gaps, 0, 0, pixels * 8);
    addFill("clear nearest", gaps, shader::kFarthest, pixels * 8, pixels * shader::kQuarters * 4);
    addSweep(cover);
    addSweep(nearest);
    addSweep(take);
  }
  for (size_t i = first; i < list.passes.size(); ++i) list.passes[i].condition = kIfConservative;
}

/// What follows the bits, of draws: lists and commands, and triangles' sizes.
void Sampler::describeDraws(core::PassList& list) const {
  using enum core::UseKind;
  using core::ResourceIndex;
  constexpr auto bound = [](int binding) { return static_cast<ResourceIndex>(binding); };
  const auto params = bound(shader::kBindParams), positions = bound(shader::kBindPositions),
             indices = bound(shader::kBindIndices), draws = bound(shader::kBindDraws),
             table = bound(shader::kBindTable), counters = bound(shader::kBindCounters),
             bits = bound(shader::kBindBits);
  list.dispatchIndirect("extents", list.add({"extents", visibility_extents}),
                        {{params, read},
                         {positions, read},
                         {indices, read},
                         {draws, read},
                         {table, read},
                         {counters, readWrite},
                         {bits, read},
                         {bound(shader::kBindExtents), readWrite}},
                        counters, offsetof(Counters, smallArgs))
      .condition = kIfExtents;
  list.dispatchIndirect("draw count", list.add({"draw count", visibility_draw_count}),
                        {{params, read},
                         {positions, read},
                         {indices, read},
                         {draws, read},
                         {table, readWrite},
                         {counters, readWrite},
                         {bits, read}},
                        counters, offsetof(Counters, smallArgs))
      .condition = kIfDraws;
  list.dispatch("draw place", list.add({"draw place", visibility_draw_place}),
                {{params, read}, {counters, readWrite}, {table, readWrite}, {bound(shader::kBindDrawCommands), write}},
                kOneGroup)
      .condition = kIfDraws;
  list.dispatchIndirect("draw list", list.add({"draw list", visibility_draw_list}),
                        {{params, read},
                         {positions, read},
                         {indices, read},
                         {draws, read},
                         {table, readWrite},
                         {counters, readWrite},
                         {bits, read},
                         {bound(shader::kBindDrawIndices), write},
                         {bound(shader::kBindDrawTriangles), write}},
                        counters, offsetof(Counters, smallArgs))
      .condition = kIfDraws;
}

/// Records that measure have these passes only.
void Sampler::describeMetrics(core::PassList& list) const {
  using enum core::UseKind;
  using core::ResourceIndex;
  constexpr auto bound = [](int binding) { return static_cast<ResourceIndex>(binding); };
  list.fill("clear metrics", bound(shader::kBindCounters), 0).condition = kIfMeasuring;
  list.dispatch("measure", list.add({"measure", visibility_measure}),
                {{bound(shader::kBindParams), read},
                 {bound(shader::kBindBits), read},
                 {bound(shader::kBindTruth), read},
                 {bound(shader::kBindTruthCounts), read},
                 {bound(shader::kBindRecheck), read},
                 {bound(shader::kBindFalsePositives), write},
                 {bound(shader::kBindFalseNegatives), write},
                 {bound(shader::kBindCounters), readWrite}},
                kWordGroups)
      .condition = kIfMeasuring;
}

Result<void> Sampler::measure(VkCommandBuffer commandBuffer, const GpgpVisibilityMetricsInfo& info) {
  if (info.triangleCount > 1u << 31)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "triangleCount is %u; at most 2147483648", info.triangleCount);
  const uint64_t words = (uint64_t(info.triangleCount) + 31) / 32;
  Params params{};
  params.triangleCount = info.triangleCount;
  core::Record record;
  const auto bind = [&](int binding, const char* name, const GpgpBuffer& buffer, uint32_t flag,
                        uint64_t bytes) -> Result<void> {
    if (!info.triangleCount || (flag && !buffer.buffer)) return {};
    if (auto ok = checkSize(name, buffer, bytes, "triangleCount"); !ok) return ok;
    record.bindings[static_cast<size_t>(binding)].engineBuffer = &buffer;
    record.bindings[static_cast<size_t>(binding)].name = name;
    params.metricBuffers |= flag;
    return {};
  };
  if (auto ok = bind(shader::kBindBits, "visibleBits", info.visibleBits, 0, words * 4); !ok) return ok;
  if (auto ok = bind(shader::kBindTruth, "truthBits", info.truthBits, 0, words * 4); !ok) return ok;
  if (auto ok = bind(shader::kBindTruthCounts, "truthCounts", info.truthCounts, shader::kHasTruthCounts,
                     uint64_t(info.triangleCount) * 4);
      !ok)
    return ok;
  if (auto ok = bind(shader::kBindRecheck, "recheckBits", info.recheckBits, shader::kHasRecheck, words * 4); !ok)
    return ok;
  if (auto ok = bind(shader::kBindFalsePositives, "falsePositives", info.falsePositives, shader::kHasFalsePositives,
                     words * 4);
      !ok)
    return ok;
  if (auto ok = bind(shader::kBindFalseNegatives, "falseNegatives", info.falseNegatives, shader::kHasFalseNegatives,
                     words * 4);
      !ok)
    return ok;
  record.commandBuffer = commandBuffer;
  record.info = &info.base;
  record.groups[kWordGroups] = {std::max(groupsOf256(words), 1u), 1, 1};
  record.conditions[kIfMeasuring] = true;
  record.constants = std::as_bytes(std::span(&params, 1));
  if (auto ok = check(record); !ok) return ok;
  return Worker::record(record);
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
  const uint32_t cameras = info.moreCameraCount < maxCameras_ ? info.moreCameraCount + 1 : 0;
  if (!cameras)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "moreCameraCount is %u; the sampler was made for %u cameras in all",
                     info.moreCameraCount, maxCameras_);
  for (uint32_t i = 0; i < info.moreCameraCount; ++i)
    if (!info.moreCameras[i].reversedDepth != !info.camera.reversedDepth)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "moreCameras[%u].reversedDepth is not the first camera's", i);
  const bool commands = info.commands.buffer && info.commandCount;
  if (!commands && uint64_t(info.drawCount) * cameras > maxDraws_)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "drawCount is %u for %u cameras; the sampler was made for %u",
                     info.drawCount, cameras, maxDraws_);
  if (commands && info.commandCount > maxDraws_)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "commandCount is %u; the sampler was made for %u", info.commandCount,
                     maxDraws_);
  if (commands && cameras > maxDraws_)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "there are %u cameras; the sampler was made for %u draws of all",
                     cameras, maxDraws_);
  if (info.method == GPGP_SAMPLING_CONSERVATIVE) {
    if (info.resolution != 0 && !(info.resolution >= 0.25f && info.resolution <= 1))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "resolution is %g; expected 0.25 to 1",
                       static_cast<double>(info.resolution));
    if (info.heuristics & ~(GPGP_HEURISTICS_THESIS | GPGP_HEURISTIC_KEEP_FRONT))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "heuristics is 0x%x; it has unknown bits", info.heuristics);
    if (!(info.epsilonStatic >= 0 && info.epsilonStatic < 1e30f && info.epsilonDynamic >= 0 &&
          info.epsilonDynamic < 1e30f))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "epsilonStatic, epsilonDynamic are %g, %g; expected 0 to 1e30",
                       static_cast<double>(info.epsilonStatic), static_cast<double>(info.epsilonDynamic));
    if (info.refinements > kMaxRefinements)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "refinements is %u; at most %u", info.refinements, kMaxRefinements);
  }
  if (info.triangleCount > 1u << 31)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "triangleCount is %u; at most 2147483648", info.triangleCount);
  if (view && info.triangleCount > view->maxTriangles())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "triangleCount is %u; the view was made for %u", info.triangleCount,
                     view->maxTriangles());
  if (info.indexType != VK_INDEX_TYPE_UINT16 && info.indexType != VK_INDEX_TYPE_UINT32)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "indexType is %d; expected UINT16 or UINT32", info.indexType);
  const uint32_t number = formatOf(info.positionFormat).bytes;
  if (!number)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "positionFormat is %d; expected three floats, halves or snorm16",
                     info.positionFormat);
  if (info.positionStride % number || (info.positionStride && info.positionStride < number * 3))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "positionStride is %u; expected a multiple of %u from %u on",
                     info.positionStride, number, number * 3);
  if (info.positionOffset % number)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "positionOffset is %u; expected a multiple of %u",
                     info.positionOffset, number);
  if (info.drawCount) {
    if (auto ok = checkSize("draws", info.draws, uint64_t(info.drawCount) * sizeof(GpgpVisibilityDraw), "drawCount");
        !ok)
      return ok;
    if (auto ok = checkSize("positions", info.positions, 4, "a vertex"); !ok) return ok;
    if (auto ok = checkSize("indices", info.indices, 4, "an index"); !ok) return ok;
    if (number == 2 && info.positions.size % 4)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "positions.size is %llu; expected a multiple of 4",
                       static_cast<unsigned long long>(info.positions.size));
    if (info.indices.size % 4)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "indices.size is %llu; expected a multiple of 4",
                       static_cast<unsigned long long>(info.indices.size));
  }
  if (info.commands.buffer) {
    const uint32_t stride = info.commandStride ? info.commandStride : kCommandBytes;
    if (stride % 4 || stride < kCommandBytes)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "commandStride is %u; expected a multiple of 4 from 20 on",
                       info.commandStride);
    if (info.commandCount)
      if (auto ok = checkSize("commands", info.commands, uint64_t(info.commandCount - 1) * stride + kCommandBytes,
                              "commandCount");
          !ok)
        return ok;
  }
  if (info.drawCountBuffer.buffer)
    if (auto ok = checkSize("drawCountBuffer", info.drawCountBuffer, 4, "the number of draws"); !ok) return ok;
  if (info.drawCommands.buffer) {
    const bool counted = info.commands.buffer || info.drawCountBuffer.buffer;
    const uint64_t needed = counted ? 1 : std::max(info.drawCount, 1u);
    if (auto ok = checkSize("drawCommands", info.drawCommands, needed * kCommandBytes, "drawCount"); !ok) return ok;
  }
  if (info.drawIndices.buffer)
    if (auto ok = checkSize("drawIndices", info.drawIndices, 12, "one triangle"); !ok) return ok;
  if (info.drawTriangles.buffer)
    if (auto ok = checkSize("drawTriangles", info.drawTriangles, 4, "one triangle"); !ok) return ok;
  if (info.triangleSizes.buffer)
    if (auto ok = checkSize("triangleSizes", info.triangleSizes,
                            std::max(info.triangleCount, 1u) * uint64_t(sizeof(GpgpTriangleSize)), "triangleCount");
        !ok)
      return ok;
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
    if (auto ok = checkSize("visibleCount", info.visibleCount, info.drawCommands.buffer ? 20 : 16,
                            "the count and the arguments");
        !ok)
      return ok;
  return {};
}

uint32_t Sampler::samplesOf(const GpgpSampleInfo& info) {
  if (info.method == GPGP_SAMPLING_EXACT || info.method == GPGP_SAMPLING_CONSERVATIVE) return 1;
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
  const uint32_t cameras = info.moreCameraCount + 1;
  for (uint32_t i = 0; i < cameras; ++i)
    std::copy_n((i ? info.moreCameras[i - 1] : info.camera).viewProjection, 16, params.viewProjection + size_t(i) * 16);
  params.cameraCount = cameras;
  params.width = info.width;
  params.height = info.height;
  const bool conservative = info.method == GPGP_SAMPLING_CONSERVATIVE;
  if (conservative) {
    const auto part = [&](uint32_t pixels) {
      const float scaled = static_cast<float>(pixels) * (info.resolution != 0 ? info.resolution : 1.0f);
      return std::max(static_cast<uint32_t>(scaled + 0.5f), 1u);
    };
    params.width = part(info.width);
    params.height = part(info.height);
    params.heuristics = info.heuristics;
    params.epsilonStatic = info.epsilonStatic;
    params.epsilonDynamic = info.epsilonDynamic;
  }
  params.pixelCapacity = maxWidth_ * maxHeight_ * maxCameras_;
  params.reversedDepth = info.camera.reversedDepth ? 1 : 0;
  params.drawCount = info.drawCount;
  params.meshCount = geometry.meshCount();
  params.triangleCount = info.triangleCount;
  params.maxItems = maxTriangles_;
  params.maxEntries = maxDraws_;
  params.hasCommands = info.commands.buffer && info.drawCount ? 1 : 0;
  params.hasDrawCount = info.drawCountBuffer.buffer ? 1 : 0;
  params.entryCount = info.drawCount * cameras;
  if (params.hasCommands) {
    params.commandCount = info.commandCount;
    params.commandWords = (info.commandStride ? info.commandStride : kCommandBytes) / 4;
    params.entryCount = maxDraws_ / cameras * cameras;
  }
  if (info.drawCount) {
    const PositionFormat format = formatOf(info.positionFormat);
    const uint32_t stride = info.positionStride ? info.positionStride : format.bytes * 3;
    params.shortIndices = info.indexType == VK_INDEX_TYPE_UINT16 ? 1 : 0;
    params.indexCount = static_cast<uint32_t>(info.indices.size / (params.shortIndices ? 2 : 4));
    params.vertexCount = verticesIn(info.positions.size, info.positionOffset, format.bytes * 3, stride);
    params.positionFormat = format.kind;
    params.positionOffset = info.positionOffset;
    params.positionStride = stride;
  }
  params.hasList = info.visibleList.buffer ? 1 : 0;
  params.listCapacity =
      params.hasList ? static_cast<uint32_t>(std::min<VkDeviceSize>(info.visibleList.size / 4, UINT32_MAX)) : 0;
  params.writeCount = !info.visibleCount.buffer ? 0 : info.drawCommands.buffer ? 2 : 1;
  const auto room = [](const GpgpBuffer& buffer, uint32_t bytes) {
    return buffer.buffer ? static_cast<uint32_t>(std::min<VkDeviceSize>(buffer.size / bytes, UINT32_MAX)) : UINT32_MAX;
  };
  params.drawCommandCapacity = room(info.drawCommands, kCommandBytes);
  params.drawListCapacity = std::min(room(info.drawIndices, 12), room(info.drawTriangles, 4));
  params.hasDrawIndices = info.drawIndices.buffer ? 1 : 0;
  params.hasDrawTriangles = info.drawTriangles.buffer ? 1 : 0;
  const bool drawLists = info.drawCommands.buffer || params.hasDrawIndices || params.hasDrawTriangles;
  params.hasExtents = info.triangleSizes.buffer ? 1 : 0;
  params.slotCapacity = static_cast<uint32_t>(slotCapacity());
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
  if (params.hasCommands) bind(shader::kBindCommands, info.commands);
  if (params.hasDrawCount) bind(shader::kBindCommandCount, info.drawCountBuffer);
  if (info.drawCommands.buffer) bind(shader::kBindDrawCommands, info.drawCommands);
  if (params.hasDrawIndices) bind(shader::kBindDrawIndices, info.drawIndices);
  if (params.hasDrawTriangles) bind(shader::kBindDrawTriangles, info.drawTriangles);
  if (params.hasExtents) bind(shader::kBindExtents, info.triangleSizes);
  bindOwn(shader::kBindMeshes, geometry);
  if (info.triangleCount) bind(shader::kBindBits, info.visibleBits);
  if (params.hasSizes) bind(shader::kBindSizes, info.pixelCounts);
  if (params.hasList) bind(shader::kBindList, info.visibleList);
  if (params.writeCount) bind(shader::kBindCount, info.visibleCount);
  if (view) bindOwn(shader::kBindView, *view);

  const uint32_t rows = params.height * cameras;
  const uint64_t pixels = uint64_t(params.width) * rows << (16 - 2 * params.gridShift);
  const uint64_t words = (uint64_t(info.triangleCount) + 31) / 32;
  const uint64_t slots = exact ? slotsOf(params.width, rows) : 0;
  record.groups[kOneGroup] = {1, 1, 1};
  record.groups[kClearGroups] = {
      groupsOf256(
          std::max({pixels, slots, words, params.hasSizes || params.hasExtents ? uint64_t(info.triangleCount) : 0})),
      1, 1};
  record.groups[kPixelGroups] = {groupsOf256((pixels + 7) / 8), 1, 1};
  record.groups[kWordGroups] = {groupsOf256(std::max<uint64_t>(words, params.viewWords)), 1, 1};
  record.groups[kTileGroups] = {static_cast<uint32_t>(std::min<uint64_t>(slots / 64, shader::kMaxGroups)), 1, 1};
  record.groups[kEntryGroups] = {groupsOf256(params.entryCount), 1, 1};
  record.groups[kChunkGroups] = {groupsOf256(chunkCapacity()), 1, 1};
  record.groups[kEachPixelGroups] = {groupsOf256(uint64_t(params.width) * rows), 1, 1};
  record.levels = info.refinements + 1;
  record.conditions[kIfSampling] = true;
  record.conditions[kIfConservative] = conservative;
  record.conditions[kIfExact] = exact;
  record.conditions[kIfCommands] = params.hasCommands != 0;
  record.conditions[kIfDraws] = drawLists;
  record.conditions[kIfExtents] = params.hasExtents != 0;
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
  report.neededDraws = counters.draws;
  report.draws = counters.drawsGiven;
  report.neededDrawTriangles = counters.drawTriangles;
  report.drawTriangles = counters.drawListed;
  report.truth = counters.truth;
  report.falsePositives = counters.falsePositives;
  report.falseNegatives = counters.truth - counters.found;
  const auto share = [](double part, double whole) { return whole > 0 ? static_cast<float>(part / whole) : 0.0f; };
  const auto wide = [](const uint32_t* words) { return static_cast<double>(uint64_t(words[1]) << 32 | words[0]); };
  report.coverage = share(counters.found, counters.truth);
  report.overestimation = share(counters.falsePositives, counters.truth);
  report.coverageArea = share(wide(counters.foundArea), wide(counters.truthArea));
  report.overestimationArea = share(counters.falsePositives, wide(counters.truthArea));
  const bool tooMany = counters.items > maxTriangles_ || counters.unresolved ||
                       (counters.hasList && counters.listed < counters.visible) ||
                       counters.drawsGiven < counters.draws || counters.drawListed < counters.drawTriangles;
  if (report.base.status == GPGP_SUCCESS && tooMany) report.base.status = GPGP_BUDGET_EXCEEDED;
  return true;
}

} // namespace gpgp::visibility
