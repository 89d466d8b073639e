#include "spawn/schedule/spawner.h"

#include "core/turns.h"
#include "shaders/spawn_bounds.spv.h"
#include "shaders/spawn_derive.spv.h"
#include "shaders/spawn_derive_colliders.spv.h"
#include "shaders/spawn_derive_colliders_subgroups.spv.h"
#include "shaders/spawn_derive_software.spv.h"
#include "shaders/spawn_derive_subgroups.spv.h"
#include "shaders/spawn_emit.spv.h"
#include "shaders/spawn_expand.spv.h"
#include "shaders/spawn_expand_subgroups.spv.h"
#include "shaders/spawn_link.spv.h"
#include "shaders/spawn_order.spv.h"
#include "shaders/spawn_place.spv.h"
#include "spawn/shared/layout.h"
#include "spawn/shared/shape.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

namespace gpgp::spawn {
namespace {

// Workgroup counts of a record.
constexpr uint32_t kOneGroup = 0, kAxiomGroups = 1, kLinkGroups = 2, kPartGroups = 3, kExpandGroups = 4,
                   kRoundGroups = 5, kBoundGroups = 6;
// Conditions of a record; kPhases and on: there are more phases than 1, 2 ...
constexpr uint32_t kSorted = 0, kBucketed = 1, kOrdered = 2, kColliding = 3, kExpanded = 4, kPlaced = 5, kBounded = 6,
                   kPhases = 7;

// The shaders read and write these as uvec4[6].
static_assert(sizeof(GpgpAxiom) == 96 && offsetof(GpgpAxiom, size) == 48 && offsetof(GpgpAxiom, id) == 64);
static_assert(sizeof(GpgpInstance) == 96 && offsetof(GpgpInstance, bucket) == 48 && offsetof(GpgpInstance, size) == 80);
static_assert(sizeof(VkDrawIndexedIndirectCommand) == 4 * shader::kDrawWords);

constexpr VkDeviceSize kShapeBytes = 16 * shader::kShapePlanes;
/// Shared memory of derive.glsl for each invocation: a parent's fan, two sums.
constexpr uint32_t kSharedBytesEach = 16;
constexpr uint32_t kDefaultShapes = 131072, kDefaultTerminals = 524288, kDefaultDepth = 64, kDefaultRounds = 4,
                   kSoftwareRounds = 32;
/// Where it is known how much there is to begin with: one round more would be another empty one for most.
constexpr uint32_t kKnownRounds = 3;

/// What fits a kind of device.
struct Limits {
  Fit fit;               // of kernels that name none
  Fit uneven;            // of those whose derivations are uneven (isUneven): more at work on what is left at the end
  uint32_t expandGroups; // workgroups at most
};
constexpr Limits kHardware{{32, 2048, 256, 2048}, {128, 1024, 512, 4096, 0, 1}, 2048},
    kSoftware{{64, 256, 1024, 512}, {64, 256, 1024, 512}, 65535};
const Limits& limitsOf(const core::Device& device) { return device.software ? kSoftware : kHardware; }

/// Whether shaders/spawn/derive/derive_batches.glsl can run.
bool takesBatches(const core::Device& device) {
  return device.software && device.subgroupArithmetic && device.subgroupSize;
}
bool canRun(const core::Device& device, KernelTarget target) {
  return target == KernelTarget::any ||
         (target == KernelTarget::software ? takesBatches(device) : device.subgroupArithmetic);
}
/// A kernel's own, or what fits it.
Fit fitOf(const core::Device& device, const KernelInfo& info, bool uneven) {
  if (info.fit.groupSize) return info.fit;
  Fit fit = uneven ? limitsOf(device).uneven : limitsOf(device).fit;
  if (info.target == KernelTarget::software) fit = {device.subgroupSize, 256, 1024, 512};
  fit.rounds = info.fit.rounds;
  return fit;
}
/// For batches: stacks below this many have no room for them. Workgroups that are worth it, and axioms for each of
/// more.
constexpr uint32_t kLeastBatches = 16, kBatchGroups = 64, kStepGroups = 16, kBatchAxioms = 512;
constexpr const char* kTooManyTurns = "one operator of this grammar may take %u turns of loops, in its expressions "
                                      "and over its successors; this device has room for %u";
/// Turns of loops for a chain from which on few shapes are all that a workgroup has turns for in a round.
constexpr uint32_t kLongTurns = 4096;
/// Where devices do not count turns: a step counts as so many, a query as what it looks at; after the steps, and after
/// what queries of one step looked at, others get their turn.
constexpr uint32_t kStepTurns = 32, kMostSteps = 16384, kMostQueried = 4096;

/// The interpreter, for grammars with colliders or without.
KernelInfo interpreterFor(const core::Device& device, bool colliders) {
  KernelInfo info;
  info.target = takesBatches(device) && !colliders ? KernelTarget::software
                : device.subgroupArithmetic        ? KernelTarget::subgroups
                                                   : KernelTarget::any;
  return info;
}
/// Whether a kernel's workgroups are one subgroup each and know of it (shaders/spawn/derive/derive.glsl). Those write
/// the report.
bool isOneSubgroup(const core::Device& device, KernelTarget target, const Fit& fit) {
  return target != KernelTarget::any && fit.groupSize == device.subgroupSize;
}

/// Queries of an invocation that look at every collider stay below that many iterations.
constexpr uint32_t kMostColliders = 1u << 24, kMostSoftwareColliders = 8192;
/// Cells that colliders are linked in.
uint32_t cellsOf(uint32_t maxColliders) { return std::bit_ceil(2 * maxColliders); }

/// Shapes on the stacks of all workgroups.
uint32_t stackShapesOf(uint32_t maxShapes) { return std::max(4 * maxShapes, 65536u); }

/// Of shaders/spawn/derive/derive.glsl.
constexpr uint32_t kDeriveConstants = 5;
std::array<uint32_t, core::kMaxSpecialization> specialization(const core::Device& device, const Fit& fit,
                                                              uint32_t table = 0) {
  return {fit.groupSize, fit.stackShapes, table, fit.groupSize == device.subgroupSize, device.software};
}

/// Of shaders/spawn/outputs/expand.comp: the stride, all attributes, and whether turns of loops count.
std::array<uint32_t, core::kMaxSpecialization> specialization(const core::Device& device, const VertexLayout& layout) {
  std::array<uint32_t, core::kMaxSpecialization> all;
  all.fill(shader::kNoAttribute);
  all[0] = layout.strideWords;
  std::copy_n(layout.attributes.begin(), layout.attributeCount, all.begin() + 1);
  all.back() = device.software;
  return all;
}
static_assert(core::kMaxSpecialization == 2 + shader::kMaxVertexAttributes);

/// The most quads that 16-bit indices reach, without 65535, which could restart a primitive.
constexpr uint32_t kShortQuads = 65535 / 4;

template <class Element> uint32_t elementsIn(const GpgpBuffer& buffer) {
  return static_cast<uint32_t>(buffer.buffer ? buffer.size / sizeof(Element) : 0);
}

} // namespace

core::Result<core::Unique<Spawner>> Spawner::create(core::Context& context, const GpgpSpawnerCreateInfo& info) {
  VertexLayout layout;
  if (info.vertices) {
    auto checked = layoutOf(*info.vertices);
    if (!checked) return checked.error();
    layout = *checked;
  }
  auto spawner = core::makeUnique<Spawner>(context.host(), context, info.base);
  const uint32_t maxShapes = spawner->maxShapes_ = info.maxShapes ? info.maxShapes : kDefaultShapes;
  const uint32_t maxTerminals = spawner->maxTerminals_ = info.maxTerminals ? info.maxTerminals : kDefaultTerminals;
  const uint32_t maxColliders = spawner->maxColliders_ = info.maxColliders;
  spawner->maxHostAxioms_ = info.maxHostAxioms;
  spawner->stride_ = 4 * layout.strideWords;
  const bool vertices = spawner->vertices();
  const bool ordered = spawner->ordered_ = info.flags & GPGP_SPAWNER_ORDERED;
  spawner->maxDepth_ = info.maxDepth ? info.maxDepth : kDefaultDepth;
  spawner->roundsGiven_ = info.maxRounds != 0;
  spawner->rounds_ = info.maxRounds ? info.maxRounds : context.device.software ? kSoftwareRounds : kDefaultRounds;
  const uint32_t mostColliders = context.device.software ? kMostSoftwareColliders : kMostColliders;
  if (maxColliders > mostColliders)
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "maxColliders is %u; this device takes at most %u", maxColliders,
                           mostColliders);

  core::PassList list(&context.host());
  using enum core::ResourceKind;
  list.add({"grammar", buffer});
  list.add({"axioms", buffer, sizeof(GpgpAxiom) * VkDeviceSize(info.maxHostAxioms), true});
  list.add({"instances", buffer, 0, true});
  list.add({"draws", buffer, 0, true});
  list.add({"count", buffer, 0, true});
  list.add({"queues", scratch, (maxColliders ? 3 : 2) * kShapeBytes * maxShapes});
  list.add({"stacks", scratch, kShapeBytes * stackShapesOf(maxShapes)});
  list.add({"records", scratch, kShapeBytes * maxTerminals});
  const auto roundAt = [](uint32_t round) { return sizeof(shader::SpawnState) + sizeof(shader::SpawnRound) * round; };
  // Of each phase its rounds and what the last one left; emission.
  const uint32_t phases = maxColliders ? shader::kMaxPhases : 1;
  const uint32_t rounds = phases * spawner->phaseStride() + 1;
  list.add({"counters", scratch, roundAt(rounds)});
  list.add({"buckets", scratch, sizeof(uint32_t) * shader::kBucketWords});
  list.add({"constants", uniforms, sizeof(shader::SpawnConstants)});
  list.add({"vertices", buffer, 0, true});
  list.add({"indices", buffer, 0, true});
  list.add({"needed", buffer, 0, true});
  list.add({"colliders", scratch, VkDeviceSize(64) * std::max(maxColliders, 1u)});
  list.add({"collider cells", scratch, VkDeviceSize(4) * (cellsOf(maxColliders) + maxColliders)});
  list.add({"order", scratch,
            sizeof(uint32_t) * (ordered ? shader::kOrderWords * VkDeviceSize(maxTerminals) + shader::kOrderParts : 1)});
  list.add({"axiomCounter", buffer, 0, true});
  list.add({"bounds", buffer, 0, true});
  list.add({"bound keys", scratch, sizeof(uint32_t) * shader::kMaxBuckets * shader::kBoundWords});
  list.add({"report", core::ResourceKind::report});

  const auto interpreter = [&](bool colliders, std::span<const uint32_t> spirv) {
    const Fit fit = fitOf(context.device, interpreterFor(context.device, colliders), false);
    return core::ShaderDesc{"derive", spirv, specialization(context.device, fit), kDeriveConstants};
  };
  const bool subgroups = context.device.subgroupArithmetic;
  const uint32_t derive = spawner->derive_ =
      list.add(interpreter(false, takesBatches(context.device) ? std::span<const uint32_t>(spawn_derive_software)
                                  : subgroups                  ? std::span<const uint32_t>(spawn_derive_subgroups)
                                                               : std::span<const uint32_t>(spawn_derive)));
  const uint32_t place = list.add(core::ShaderDesc{"place", spawn_place, {vertices}, 1});
  uint32_t link = 0;
  if (maxColliders) {
    spawner->deriveColliding_ = // takes the other's place in records that need it
        list.add(interpreter(true, subgroups ? std::span<const uint32_t>(spawn_derive_colliders_subgroups)
                                             : std::span<const uint32_t>(spawn_derive_colliders)));
    link = list.add(core::ShaderDesc{"link", spawn_link});
  }

  using enum core::UseKind;
  list.fill("clear counters", shader::kBindCounters, 0);
  list.fill("clear buckets", shader::kBindBuckets, 0).condition = kBucketed;
  list.fill("clear bounds", shader::kBindBoundKeys, 0).condition = kBounded;
  if (maxColliders) list.fill("clear cells", shader::kBindColliderCells, 0).condition = kColliding;
  const auto uses = {
      core::Use{shader::kBindGraph, read}, {shader::kBindAxioms, read},         {shader::kBindInstances, write},
      {shader::kBindDraws, readWrite},     {shader::kBindQueues, readWrite},    {shader::kBindStacks, readWrite},
      {shader::kBindRecords, write},       {shader::kBindCounters, readWrite},  {shader::kBindBuckets, readWrite},
      {shader::kBindConstants, read},      {shader::kBindColliders, readWrite}, {shader::kBindColliderCells, read},
      {shader::kBindCount, write},         {shader::kBindAxiomCounter, read},   {shader::kBindReport, write}};
  for (uint32_t phase = 0; phase < phases; ++phase) {
    const uint32_t first = phase * spawner->phaseStride();
    if (phase == 0)
      list.dispatch("derive", derive, uses, kAxiomGroups, {0, 0, 0});
    else
      list.dispatch("link", link,
                    {{shader::kBindAxioms, read},
                     {shader::kBindCounters, readWrite},
                     {shader::kBindConstants, read},
                     {shader::kBindColliders, read},
                     {shader::kBindColliderCells, readWrite}},
                    kLinkGroups, {first, first - spawner->phaseStride()})
          .condition = kPhases + phase - 1;
    for (uint32_t round = phase ? 0 : 1; round < spawner->rounds_; ++round) {
      // Where there is work for a second round, it is for all; those behind it are mostly empty.
      const std::initializer_list<uint32_t> pushed = {first + round, phase, first};
      core::Pass& pass = first + round == 1 ? list.dispatch("derive", derive, uses, kRoundGroups, pushed)
                                            : list.dispatchIndirect("derive", derive, uses, shader::kBindCounters,
                                                                    roundAt(first + round), pushed);
      pass.level = round;
      if (phase) pass.condition = kPhases + phase - 1;
    }
  }
  const VkDeviceSize perRecord = roundAt(rounds - 1); // dispatch arguments
  const auto order = [&](const char* name, uint32_t number) {
    const uint32_t shader = list.add(core::ShaderDesc{name, spawn_order, {number}, 1});
    const auto orderUses = {core::Use{shader::kBindGraph, read}, {shader::kBindRecords, read},
                            {shader::kBindCounters, readWrite},  {shader::kBindBuckets, readWrite},
                            {shader::kBindConstants, read},      {shader::kBindOrder, readWrite}};
    const bool perPart = number == shader::kOrderSum || number == shader::kOrderStarts ||
                         number == shader::kOrderQuadSum || number == shader::kOrderQuadStarts;
    core::Pass& pass = number == shader::kOrderBuckets ? list.dispatch(name, shader, orderUses, kOneGroup)
                       : perPart                       ? list.dispatch(name, shader, orderUses, kPartGroups)
                                 : list.dispatchIndirect(name, shader, orderUses, shader::kBindCounters, perRecord);
    pass.condition = kOrdered;
  };
  const auto orderRecords = [&] {
    list.fill("clear bins", shader::kBindOrder, 0, 0, sizeof(uint32_t) * maxTerminals).condition = kOrdered;
    order("count bins", shader::kOrderCount);
    order("sum bins", shader::kOrderSum);
    order("place bins", shader::kOrderStarts);
    order("fill bins", shader::kOrderFill);
    order("rank", shader::kOrderRank);
  };
  if (vertices && ordered) {
    order("place buckets", shader::kOrderBuckets);
    orderRecords();
    order("sum quads", shader::kOrderQuadSum);
    order("place quads", shader::kOrderQuadStarts);
  }
  if (vertices) {
    const auto spirv =
        subgroups ? std::span<const uint32_t>(spawn_expand_subgroups) : std::span<const uint32_t>(spawn_expand);
    const uint32_t expand =
        list.add(core::ShaderDesc{"expand", spirv, specialization(context.device, layout), core::kMaxSpecialization});
    list.dispatch("expand", expand,
                  {{shader::kBindGraph, read},
                   {shader::kBindAxioms, read},
                   {shader::kBindDraws, read},
                   {shader::kBindRecords, read},
                   {shader::kBindCounters, readWrite},
                   {shader::kBindBuckets, readWrite},
                   {shader::kBindConstants, read},
                   {shader::kBindVertices, write},
                   {shader::kBindIndices, write},
                   {shader::kBindOrder, read}},
                  kExpandGroups)
        .condition = kExpanded;
  }
  list.dispatch("place", place,
                {{shader::kBindGraph, read},
                 {shader::kBindDraws, readWrite},
                 {shader::kBindCount, write},
                 {shader::kBindCounters, readWrite},
                 {shader::kBindBuckets, readWrite},
                 {shader::kBindConstants, read},
                 {shader::kBindNeeded, write},
                 {shader::kBindOrder, read}},
                kOneGroup)
      .condition = kPlaced;
  if (!vertices) {
    if (ordered) orderRecords();
    const uint32_t emit = list.add(core::ShaderDesc{"emit", spawn_emit, {ordered}, 1});
    list.dispatchIndirect("emit", emit,
                          {{shader::kBindGraph, read},
                           {shader::kBindAxioms, read},
                           {shader::kBindRecords, read},
                           {shader::kBindInstances, write},
                           {shader::kBindDraws, read},
                           {shader::kBindCounters, read},
                           {shader::kBindBuckets, readWrite},
                           {shader::kBindConstants, read},
                           {shader::kBindOrder, read}},
                          shader::kBindCounters, perRecord)
        .condition = kSorted;
  }
  const auto bounds = [&](const char* name, uint32_t decodes, std::initializer_list<core::Use> used, uint32_t groups) {
    const uint32_t shader = list.add(core::ShaderDesc{name, spawn_bounds, {decodes}, 1});
    list.dispatch(name, shader, used, groups).condition = kBounded;
  };
  bounds("bounds", 0,
         {{shader::kBindGraph, read},
          {shader::kBindAxioms, read},
          {shader::kBindInstances, read},
          {shader::kBindDraws, read},
          {shader::kBindRecords, read},
          {shader::kBindCounters, read},
          {shader::kBindBuckets, read},
          {shader::kBindConstants, read},
          {shader::kBindBoundKeys, readWrite}},
         kBoundGroups);
  bounds("write bounds", 1, {{shader::kBindGraph, read}, {shader::kBindBoundKeys, read}, {shader::kBindBounds, write}},
         kOneGroup);
  list.report = shader::kBindCounters;
  list.reportBytes = sizeof(shader::SpawnState);
  if (auto ok = spawner->init(std::move(list)); !ok) return ok.error();
  return spawner;
}

/// All rounds but the last one only spread the work, of which a workgroup makes kGrowth times as many shapes, or in the
/// round that is enough, or the last but one, as many as kGrowing batches hold
/// (shaders/spawn/derive/derive_steps.glsl). In uneven derivations they even it out as well, and nobody knows how much
/// there is behind a counter, or in later phases.
uint32_t Spawner::roundsFor(const GpgpSpawnInfo& info, const Grammar& grammar, const Fit& fit) const {
  const bool known = !info.axiomCounter.buffer && grammar.graph.phases <= 1;
  if (roundsGiven_ || context.device.software || !known) return rounds_;
  const uint32_t mostRounds = std::min(rounds_, kKnownRounds);
  if (grammar.uneven) return mostRounds;
  uint32_t rounds = 1;
  const uint64_t most = shader::kGrowing * fit.groupSize;
  for (uint64_t shapes = std::max(info.axiomCount, 1u); shapes < fit.spread && rounds < mostRounds; ++rounds)
    shapes *= shapes * most < fit.spread ? shader::kGrowth : most;
  return rounds;
}

core::Result<void> Spawner::prepare(VkCommandBuffer commandBuffer, const GpgpSpawnInfo& info, const Grammar& grammar) {
  if (info.hostAxioms && info.axiomCount > maxHostAxioms_)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                           "axiomCount is %u, of hostAxioms; the spawner was made with maxHostAxioms %u",
                           info.axiomCount, maxHostAxioms_);
  const Limits& limits = limitsOf(context.device);
  const uint32_t phases = std::max(grammar.graph.phases, 1u);
  if (grammar.graph.phases && !maxColliders_)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "grammar has Collider or IfCollides, and maxColliders of the "
                                                        "spawner is 0");
  const Grammar::Ready* kernel = grammar.kernelFor(info.axiomCount);
  const KernelInfo interpreter = interpreterFor(context.device, grammar.graph.phases > 0);
  Fit fit = kernel ? kernel->info.fit : fitOf(context.device, interpreter, false);
  if (!kernel && grammar.uneven) fit.balances = limits.uneven.balances;
  // Rounds were counted for a number of axioms: for more of them, or far fewer, nothing is known. Larger ones may
  // become more shapes than workgroups of one round can end, but not than all that a second one has.
  const bool counted = fit.rounds && !roundsGiven_ && !context.device.software &&
                       (!kernel || kernel->info.axioms == 0 ||
                        (info.axiomCount <= kernel->info.axioms &&
                         std::bit_width(info.axiomCount) == std::bit_width(kernel->info.axioms)));
  uint32_t rounds = roundsFor(info, grammar, fit);
  if (counted) rounds = std::clamp(fit.rounds, std::min(rounds, 2u), rounds_);
  const bool batches = (kernel ? kernel->info : interpreter).target == KernelTarget::software;
  uint32_t maxGroups = std::min(fit.maxGroups, stackShapesOf(maxShapes_) / fit.stackShapes);
  if (context.device.software) {
    const bool isLong = grammar.turns.chain * grammar.turns.passed > kLongTurns;
    const uint32_t least = std::min(isLong ? maxGroups : batches ? kBatchGroups : kStepGroups, maxGroups);
    maxGroups = std::clamp(info.axiomCount / kBatchAxioms, least, maxGroups);
  }
  const bool regions = info.flags & GPGP_SPAWN_REGIONS;
  const bool counts = vertices() ? !info.vertices->vertices.buffer : !info.instances.buffer;
  const bool inOrder = ordered_ && !counts;
  // One bucket is sorted as it is.
  const bool sorted =
      !vertices() && (inOrder || (!counts && !regions && info.draws.buffer && grammar.graph.buckets > 1));
  shader::SpawnConstants constants{};
  constants.axiomCount = info.axiomCount;
  constants.readsAxiomCounter = info.axiomCounter.buffer ? 1 : 0;
  constants.instanceCapacity = elementsIn<GpgpInstance>(info.instances);
  constants.drawCapacity = elementsIn<VkDrawIndexedIndirectCommand>(info.draws);
  constants.writeCount = info.count.buffer ? 1 : 0;
  constants.rounds = (phases - 1) * phaseStride() + rounds;
  constants.phaseRounds = rounds;
  constants.maxColliders = maxColliders_;
  constants.cellMask = cellsOf(maxColliders_) - 1;
  constants.maxGroups = maxGroups;
  constants.maxDepth = maxDepth_;
  constants.spread = fit.spread;
  constants.balances = fit.balances;
  constants.reports = info.axiomCount && phases == 1 && !vertices() && !counts && !sorted && !inOrder && !regions;
  const Expansion expansion =
      context.device.software ? expansionOf(grammar.turns) : Expansion{shader::kSpawnGroupSize, 1};
  constants.recordsAtOnce = expansion.records;
  constants.one = 1;
  if (context.device.software) {
    const TurnsLimit limit = limitTurns(constants, grammar.turns, fit, batches ? fit.groupSize : 0, kernel != nullptr);
    if (!limit) return core::makeError(GPGP_ERROR_UNSUPPORTED, kTooManyTurns, limit.needed, limit.most);
  } else {
    constants.steps = kMostSteps * kStepTurns;
    constants.batchTurns = kStepTurns;
    constants.chainLength = shader::kMaxChain;
    constants.mostQueried = kMostQueried;
    constants.mostLeft = UINT32_MAX;
  }
  constants.maxShapes = maxShapes_;
  constants.maxTerminals = maxTerminals_;
  constants.terminalsTo = counts              ? shader::kToCounts
                          : sorted || inOrder ? shader::kToKeyedRecords
                          : vertices()        ? shader::kToRecords
                                              : shader::kToInstances;
  constants.regions = regions;
  constants.writeNeeded = info.needed.buffer ? 1 : 0;
  constants.quads = vertices() ? 1 : 0;
  if (vertices() && !counts) {
    const GpgpVertexOutput& output = *info.vertices;
    const bool shortIndices = output.indexType == VK_INDEX_TYPE_UINT16;
    const uint32_t indexBytes = shortIndices ? 2 : 4;
    VkDeviceSize quads = output.vertices.size / (4 * stride_);
    if (output.indices.buffer) quads = std::min(quads, output.indices.size / (6 * indexBytes));
    constants.regionQuads = shortIndices ? kShortQuads : UINT32_MAX;
    constants.quadCapacity = static_cast<uint32_t>(quads);
    if (!regions) constants.quadCapacity = std::min(constants.quadCapacity, constants.regionQuads);
    constants.indexWords = output.indices.buffer ? 6 * indexBytes / 4 : 0;
  }
  core::Record record;
  record.commandBuffer = commandBuffer;
  record.info = &info.base;
  record.bindings[shader::kBindGraph].ownBuffer = grammar.buffer();
  record.bindings[shader::kBindGraph].ownSize = grammar.size();
  record.bindings[shader::kBindAxioms].engineBuffer = &info.axioms;
  if (info.hostAxioms)
    record.bindings[shader::kBindAxioms].hostData = std::as_bytes(std::span(info.hostAxioms, info.axiomCount));
  record.bindings[shader::kBindAxiomCounter].engineBuffer = &info.axiomCounter;
  record.bindings[shader::kBindBounds].engineBuffer = &info.bounds;
  record.bindings[shader::kBindInstances].engineBuffer = &info.instances;
  record.bindings[shader::kBindDraws].engineBuffer = &info.draws;
  record.bindings[shader::kBindCount].engineBuffer = &info.count;
  record.bindings[shader::kBindNeeded].engineBuffer = &info.needed;
  if (info.vertices) {
    record.bindings[shader::kBindVertices].engineBuffer = &info.vertices->vertices;
    record.bindings[shader::kBindIndices].engineBuffer = &info.vertices->indices;
  }
  record.groups[kOneGroup] = {1, 1, 1};
  record.groups[kPartGroups] = {shader::kOrderParts, 1, 1};
  record.groups[kAxiomGroups] = {std::min(info.axiomCount, maxGroups), 1, 1};
  record.groups[kBoundGroups] = {256, 1, 1};
  record.groups[kRoundGroups] = {maxGroups, 1, 1};
  record.groups[kLinkGroups] = {std::clamp(maxColliders_ / (4 * shader::kSpawnGroupSize), 1u, 256u), 1, 1};
  const uint32_t expanded = (maxTerminals_ - 1) / (constants.recordsAtOnce * expansion.times) + 1;
  record.groups[kExpandGroups] = {std::min(expanded, limits.expandGroups), 1, 1};
  record.conditions[kSorted] = sorted;
  record.conditions[kExpanded] = vertices() && !counts;
  record.conditions[kOrdered] = inOrder;
  record.conditions[kBucketed] = sorted || regions || counts || vertices();
  record.conditions[kBounded] = info.bounds.buffer != VK_NULL_HANDLE;
  record.conditions[kPlaced] = !constants.reports;
  record.conditions[kColliding] = grammar.graph.phases > 1;
  for (uint32_t phase = 1; phase < phases; ++phase) record.conditions[kPhases + phase - 1] = true;
  record.levels = rounds;
  record.reports =
      constants.reports && isOneSubgroup(context.device, (kernel ? kernel->info : interpreter).target, fit);
  record.constants[0] = std::as_bytes(std::span(&constants, 1));
  if (kernel) {
    record.replacedShader = derive_;
    record.replacement = kernel->pipeline;
  } else if (grammar.graph.phases && ready()) {
    record.replacedShader = derive_;
    record.replacement = pipelineOf(deriveColliding_);
  }
  if (auto ok = check(record); !ok) return ok;
  return Recorder::record(record);
}

core::Result<void> Spawner::prewarm(Grammar& grammar) const {
  const VkPhysicalDeviceLimits& device = context.device.limits;
  for (const Kernel& kernel : grammar.kernels) {
    KernelInfo info = kernel.info;
    info.fit = fitOf(context.device, info, grammar.uneven);
    if (grammar.readyCount() == Grammar::kMaxReady) break;
    // Of those that differ only in their target, the first one that can run is made.
    const bool isFirst = std::none_of(grammar.kernels.data(), &kernel, [&](const Kernel& before) {
      KernelInfo other = before.info;
      other.target = kernel.info.target;
      return std::memcmp(&other, &kernel.info, sizeof other) == 0 && canRun(context.device, before.info.target);
    });
    if (!isFirst || !canRun(context.device, info.target)) continue;
    if (info.target == KernelTarget::software && (info.fit.groupSize != context.device.subgroupSize ||
                                                  info.fit.stackShapes < kLeastBatches * info.fit.groupSize))
      continue;
    if (grammar.isReady(info) || info.fit.stackShapes > stackShapesOf(maxShapes_)) continue;
    if ((info.vendor && info.vendor != context.device.vendor) || (info.device && info.device != context.device.model))
      continue; // tuned for another device
    if (info.fit.groupSize > device.maxComputeWorkGroupInvocations ||
        info.fit.groupSize > device.maxComputeWorkGroupSize[0] ||
        info.fit.groupSize * kSharedBytesEach + 64 > device.maxComputeSharedMemorySize)
      continue;
    shader::SpawnConstants constants{};
    if (context.device.software && !limitTurns(constants, grammar.turns, info.fit,
                                               info.target == KernelTarget::software ? info.fit.groupSize : 0, true))
      continue; // workgroups and stacks that this device has no turns for
    const auto pipeline =
        createComputePipeline({kernel.info.schedule, kernel.spirv(),
                               specialization(context.device, info.fit, grammar.tableOf(kernel)), kDeriveConstants});
    if (!pipeline) return pipeline.error();
    grammar.add({info, *pipeline});
  }
  return {};
}

bool Spawner::takeReport(GpgpSpawnReport& report) {
  core::RawReport raw;
  if (!Recorder::takeReport(raw)) return false;
  report.base = raw.header;
  shader::SpawnState state{};
  std::memcpy(&state, raw.words.data(), sizeof state);
  report.terminals = state.terminals;
  report.instancesWritten = state.instancesWritten;
  report.peakShapes = state.peakShapes;
  report.droppedShapes = state.droppedShapes;
  report.unfinishedShapes = state.unfinishedShapes;
  report.rounds = state.rounds;
  report.keyHash[0] = state.keyHashX;
  report.keyHash[1] = state.keyHashY;
  report.depth = state.depth;
  report.vertices = 4 * state.quads;
  report.verticesWritten = 4 * state.quadsWritten;
  report.colliders = state.colliders;
  report.collidersKept = std::min(report.colliders, maxColliders_);
  if (report.base.status == GPGP_SUCCESS &&
      (state.exceeded || report.droppedShapes || report.unfinishedShapes || report.colliders > report.collidersKept))
    report.base.status = GPGP_BUDGET_EXCEEDED;
  if (report.base.status != GPGP_NOT_EXECUTED && state.ended) report.base.status = GPGP_ERROR_UNSUPPORTED;
  return true;
}

} // namespace gpgp::spawn
