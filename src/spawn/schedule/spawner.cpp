#include "spawn/schedule/spawner.h"

#include "core/turns.h"
#include "spawn/schedule/camera.h"
#include "spawn/schedule/checks.h"
#include "spawn/schedule/fields.h"
#include "spawn/schedule/fits.h"
#include "spawn/schedule/measuring.h"
#include "spawn/shared/layout.h"
#include "spawn/shared/shape.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

namespace gpgp::spawn {
namespace {

// The shaders read and write these as uvec4[6].
static_assert(sizeof(GpgpAxiom) == 96 && offsetof(GpgpAxiom, size) == 48 && offsetof(GpgpAxiom, id) == 64);
static_assert(sizeof(GpgpAxiomRange) == 4 * shader::kRangeWords && offsetof(GpgpAxiomRange, capacity) == 4 &&
              offsetof(GpgpAxiomRange, count) == 8);
static_assert(sizeof(GpgpInstance) == 96 && offsetof(GpgpInstance, bucket) == 48 && offsetof(GpgpInstance, size) == 80);
static_assert(sizeof(GpgpCompactInstance) == 32 && offsetof(GpgpCompactInstance, scale) == 16 &&
              offsetof(GpgpCompactInstance, rotation) == 24);
static_assert(offsetof(shader::SpawnConstants, view) % 16 == 0 && offsetof(shader::SpawnConstants, fields) % 16 == 0 &&
                  sizeof(shader::FieldGrid) == 32,
              "std140 aligns structs so");
static_assert(sizeof(VkDrawIndexedIndirectCommand) == 4 * shader::kDrawWords);

/// Shared memory of derive.glsl: for each invocation a parent's fan and two sums; with queues their lists.
uint32_t sharedBytes(const KernelInfo& info) {
  const uint32_t bytes = info.fit.groupSize * 16 + 64;
  if (info.queues == Queues::mixed) return bytes;
  return bytes + 4 * (info.fit.stackShapes + shader::kMostQueues + info.fit.groupSize);
}
constexpr uint32_t kDefaultShapes = 131072, kDefaultTerminals = 524288, kDefaultDepth = 64, kDefaultRounds = 4,
                   kSoftwareRounds = 32;
/// Where it is known how much there is to begin with: one round more would be another empty one for most.
constexpr uint32_t kKnownRounds = 3;

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

/// Queries of an invocation that look at every collider stay below that many iterations.
constexpr uint32_t kMostColliders = 1u << 24, kMostSoftwareColliders = 8192;
/// The most quads that 16-bit indices reach, without 65535, which could restart a primitive.
constexpr uint32_t kShortQuads = 65535 / 4;

template <class Element> uint32_t elementsIn(const GpgpBuffer& buffer) {
  return static_cast<uint32_t>(buffer.buffer ? buffer.size / sizeof(Element) : 0);
}

} // namespace

core::Result<core::Unique<Spawner>> Spawner::create(core::Context& context, const GpgpSpawnerCreateInfo& info) {
  if (auto ok = checkCreateInfo(info); !ok) return ok.error();
  VertexLayout layout;
  if (info.vertices) {
    auto checked = layoutOf(*info.vertices);
    if (!checked) return checked.error();
    layout = *checked;
  }
  auto spawner = core::makeUnique<Spawner>(context.host(), context, info.base);
  SpawnerSizes& sizes = spawner->sizes_;
  sizes.maxShapes = info.maxShapes ? info.maxShapes : kDefaultShapes;
  sizes.maxTerminals = info.maxTerminals ? info.maxTerminals : kDefaultTerminals;
  sizes.maxColliders = info.maxColliders;
  sizes.maxHostAxioms = info.maxHostAxioms;
  sizes.maxMeasuredAxioms = info.maxMeasuredAxioms;
  sizes.maxOccupancyWords = info.maxMeasuredAxioms ? info.maxOccupancyWords : 0;
  sizes.rounds = info.maxRounds ? info.maxRounds : context.device.software ? kSoftwareRounds : kDefaultRounds;
  sizes.ordered = info.flags & GPGP_SPAWNER_ORDERED;
  sizes.compact = info.flags & GPGP_SPAWNER_COMPACT;
  sizes.interprets = !(info.flags & GPGP_SPAWNER_KERNELS_ONLY);
  sizes.layout = layout;
  spawner->maxDepth_ = info.maxDepth ? info.maxDepth : kDefaultDepth;
  spawner->roundsGiven_ = info.maxRounds != 0;
  const uint32_t mostColliders = context.device.software ? kMostSoftwareColliders : kMostColliders;
  if (sizes.maxColliders > mostColliders)
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "maxColliders is %u; this device takes at most %u",
                           sizes.maxColliders, mostColliders);
  SpawnPasses passes = describePasses(sizes, context.device, &context.host());
  spawner->derive_ = passes.derive;
  spawner->deriveColliding_ = passes.deriveColliding;
  if (auto ok = spawner->init(std::move(passes.list)); !ok) return ok.error();
  if (sizes.maxMeasuredAxioms) spawner->measuring_.resize(sizeof(shader::Measuring) / 4 + sizes.gridRoom());
  return spawner;
}

/// All rounds but the last one only spread the work, of which a workgroup makes kGrowth times as many shapes, or in the
/// round that is enough, or the last but one, as many as kGrowing batches hold
/// (shaders/spawn/derive/derive_steps.glsl). In uneven derivations they even it out as well, and nobody knows how much
/// there is behind a counter, or in later phases.
uint32_t Spawner::roundsFor(const GpgpSpawnInfo& info, const Grammar& grammar, const Fit& fit) const {
  const bool known = !info.axiomCounter.buffer && grammar.graph.phases <= 1;
  if (roundsGiven_ || context.device.software || !known) return sizes_.rounds;
  const uint32_t mostRounds = std::min(sizes_.rounds, kKnownRounds);
  if (grammar.uneven) return mostRounds;
  uint32_t rounds = 1;
  const uint64_t most = shader::kGrowing * fit.groupSize;
  for (uint64_t shapes = std::max(info.axiomCount, 1u); shapes < fit.spread && rounds < mostRounds; ++rounds)
    shapes *= shapes * most < fit.spread ? shader::kGrowth : most;
  return rounds;
}

core::Result<void> Spawner::measure(const GpgpSpawnInfo& info, const Grammar& grammar, core::Record& record) {
  const GpgpMeasureInfo& measures = *info.measures;
  if (info.axiomCount > sizes_.maxMeasuredAxioms)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                           "axiomCount is %u, with measures; the spawner was made with maxMeasuredAxioms %u",
                           info.axiomCount, sizes_.maxMeasuredAxioms);
  auto measuring = measuringOf(measures, static_cast<uint32_t>(grammar.graph.terminals.size()));
  if (!measuring) return measuring.error();
  if (measuring->gridWords > sizes_.maxOccupancyWords)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                           "measures->occupancy has %u words; the spawner was made with maxOccupancyWords %u",
                           measuring->gridWords, sizes_.maxOccupancyWords);
  const uint32_t measured = info.axiomCount - info.contextCount;
  measuring->axioms = measured;
  measuring->firstGrid = shader::kMeasuredWords * sizes_.maxMeasuredAxioms;
  std::memcpy(measuring_.data(), &*measuring, sizeof *measuring);
  if (measuring->gridWords)
    std::memcpy(measuring_.data() + sizeof *measuring / 4, measures.occupancy->target, 4 * measuring->gridWords);
  record.bindings[shader::kBindMeasuring].hostData = std::as_bytes(std::span(measuring_));
  record.groups[kMeasureGroups] = {std::min((sizes_.maxTerminals - 1) / shader::kSpawnGroupSize + 1, 65535u), 1, 1};
  record.groups[kMeasuredGroups] = {std::clamp(measured, 1u, 65535u), 1, 1};
  record.conditions[kMeasured] = true;
  record.readBackBytes = static_cast<uint32_t>(sizeof(GpgpAxiomMeasures)) * measured;
  return {};
}

core::Result<void> Spawner::prepare(VkCommandBuffer commandBuffer, const GpgpSpawnInfo& given, const Grammar& grammar) {
  GpgpSpawnInfo info = given;
  if (!grammar.graph.phases) { // nothing collides: what is context alone is not derived
    info.axiomCount -= info.contextCount;
    info.contextCount = 0;
  }
  if (info.hostAxioms && info.axiomCount > sizes_.maxHostAxioms)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                           "axiomCount is %u, of hostAxioms; the spawner was made with maxHostAxioms %u",
                           info.axiomCount, sizes_.maxHostAxioms);
  const Limits& limits = limitsOf(context.device);
  const uint32_t phases = std::max(grammar.graph.phases, 1u);
  if (grammar.graph.phases && !sizes_.maxColliders)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "grammar has Collider or IfCollides, and maxColliders of the "
                                                        "spawner is 0");
  const Grammar::Ready* kernel = grammar.kernelFor(info.axiomCount);
  if (!kernel && !sizes_.interprets) return noKernel(grammar);
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
  if (counted) rounds = std::clamp(fit.rounds, std::min(rounds, 2u), sizes_.rounds);
  const bool batches = (kernel ? kernel->info : interpreter).target == KernelTarget::software;
  uint32_t maxGroups = std::min(fit.maxGroups, sizes_.stackShapes() / fit.stackShapes);
  if (context.device.software) {
    const bool isLong = grammar.turns.chain * grammar.turns.passed > kLongTurns;
    const uint32_t least = std::min(isLong ? maxGroups : batches ? kBatchGroups : kStepGroups, maxGroups);
    maxGroups = std::clamp(info.axiomCount / kBatchAxioms, least, maxGroups);
  }
  const bool regions = info.flags & GPGP_SPAWN_REGIONS;
  const bool counts = vertices() ? !info.vertices->vertices.buffer : !info.instances.buffer;
  const bool inOrder = sizes_.ordered && !counts;
  // One bucket is sorted as it is.
  const bool sorted =
      !vertices() &&
      (inOrder ||
       (!counts && !regions && (sizes_.compact || info.measures || (info.draws.buffer && grammar.graph.buckets > 1))));
  const auto view = viewOf(info.camera);
  if (!view) return view.error();
  const auto fields = bindFields(grammar.graph, {info.fields, info.fieldCount, &info.fieldValues});
  if (!fields) return fields.error();
  shader::SpawnConstants constants{};
  constants.view = *view;
  std::copy(fields->grids.begin(), fields->grids.end(), constants.fields);
  constants.axiomCount = info.axiomCount;
  constants.contextFrom = info.contextCount ? info.axiomCount - info.contextCount : UINT32_MAX;
  constants.readsAxiomCounter = info.axiomCounter.buffer ? 1 : 0;
  constants.instanceCapacity = static_cast<uint32_t>(info.instances.buffer ? info.instances.size / instanceBytes() : 0);
  constants.drawCapacity = elementsIn<VkDrawIndexedIndirectCommand>(info.draws);
  constants.writeCount = info.count.buffer ? 1 : 0;
  constants.rounds = (phases - 1) * sizes_.phaseStride() + rounds;
  constants.phaseRounds = rounds;
  constants.maxColliders = sizes_.maxColliders;
  constants.cellMask = sizes_.cells() - 1;
  constants.maxGroups = maxGroups;
  constants.maxDepth = maxDepth_;
  constants.spread = fit.spread;
  constants.balances = fit.balances;
  constants.reports = info.axiomCount && phases == 1 && !vertices() && !counts && !sorted && !inOrder && !regions &&
                      !info.firstInstance && !info.ranges.buffer;
  constants.byAxiom = info.ranges.buffer ? 1 : 0;
  const Expansion expansion =
      context.device.software ? expansionOf(grammar.turns) : Expansion{shader::kSpawnGroupSize, 1};
  constants.recordsAtOnce = expansion.records;
  constants.one = 1;
  constants.firstInstance = info.firstInstance;
  if (context.device.software) {
    const TurnsLimit limit = limitTurns(constants, grammar.turns, fit, batches ? fit.groupSize : 0, kernel != nullptr,
                                        kernel ? kernel->info.queues : Queues::mixed);
    if (!limit) return core::makeError(GPGP_ERROR_UNSUPPORTED, kTooManyTurns, limit.needed, limit.most);
  } else {
    constants.steps = kMostSteps * kStepTurns;
    constants.batchTurns = kStepTurns;
    constants.chainLength = shader::kMaxChain;
    constants.mostQueried = kMostQueried;
    constants.mostLeft = UINT32_MAX;
  }
  constants.maxShapes = sizes_.maxShapes;
  constants.maxTerminals = sizes_.maxTerminals;
  constants.terminalsTo = counts && info.measures ? shader::kToKeyedRecords // which place tells from sorted ones
                          : counts                ? shader::kToCounts
                          : sorted || inOrder     ? shader::kToKeyedRecords
                          : vertices()            ? shader::kToRecords
                                                  : shader::kToInstances;
  constants.regions = regions;
  constants.writeNeeded = info.needed.buffer ? 1 : 0;
  constants.quads = vertices() ? 1 : 0;
  if (vertices() && !counts) {
    const GpgpVertexOutput& output = *info.vertices;
    const bool shortIndices = output.indexType == VK_INDEX_TYPE_UINT16;
    const uint32_t indexBytes = shortIndices ? 2 : 4;
    VkDeviceSize quads = output.vertices.size / (VkDeviceSize(16) * sizes_.layout.strideWords);
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
  record.bindings[shader::kBindRanges].engineBuffer = &info.ranges;
  record.bindings[shader::kBindFields].engineBuffer = &info.fieldValues;
  if (info.vertices) {
    record.bindings[shader::kBindVertices].engineBuffer = &info.vertices->vertices;
    record.bindings[shader::kBindIndices].engineBuffer = &info.vertices->indices;
  }
  record.groups[kOneGroup] = {1, 1, 1};
  record.groups[kPartGroups] = {shader::kOrderParts, 1, 1};
  record.groups[kAxiomGroups] = {std::min(info.axiomCount, maxGroups), 1, 1};
  record.groups[kBoundGroups] = {256, 1, 1};
  record.groups[kRoundGroups] = {maxGroups, 1, 1};
  record.groups[kLinkGroups] = {std::clamp(sizes_.maxColliders / (4 * shader::kSpawnGroupSize), 1u, 256u), 1, 1};
  const uint32_t expanded = (sizes_.maxTerminals - 1) / (constants.recordsAtOnce * expansion.times) + 1;
  record.groups[kExpandGroups] = {std::min(expanded, limits.expandGroups), 1, 1};
  record.conditions[kSorted] = sorted;
  record.conditions[kExpanded] = vertices() && !counts;
  record.conditions[kOrdered] = inOrder;
  record.conditions[kBucketed] = sorted || regions || counts || vertices();
  record.conditions[kBounded] = info.bounds.buffer != VK_NULL_HANDLE;
  record.note[0] = std::bit_cast<uint32_t>(detailOf(info.camera));
  record.conditions[kPlaced] = !constants.reports;
  record.conditions[kColliding] = grammar.graph.phases > 1;
  for (uint32_t phase = 1; phase < phases; ++phase) record.conditions[kPhases + phase - 1] = true;
  if (info.measures)
    if (auto ok = measure(info, grammar, record); !ok) return ok;
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

core::Error Spawner::noKernel(const Grammar& grammar) {
  if (!grammar.kernels.empty() && !grammar.prewarmed())
    return core::makeError(GPGP_NOT_READY, "call gpgpPrewarmGrammar first: the spawner has no interpreter");
  return core::makeError(
      GPGP_ERROR_UNSUPPORTED,
      grammar.kernels.empty()
          ? "the grammar was baked without kernels, and the spawner has no interpreter "
            "(GPGP_SPAWNER_KERNELS_ONLY)"
          : "none of the grammar's kernels fits the device and the spawner, which has no interpreter "
            "(GPGP_SPAWNER_KERNELS_ONLY)");
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
    if (grammar.isReady(info) || info.fit.stackShapes > sizes_.stackShapes()) continue;
    if ((info.vendor && info.vendor != context.device.vendor) || (info.device && info.device != context.device.model))
      continue; // tuned for another device
    if (info.fit.groupSize > device.maxComputeWorkGroupInvocations ||
        info.fit.groupSize > device.maxComputeWorkGroupSize[0] || sharedBytes(info) > device.maxComputeSharedMemorySize)
      continue;
    shader::SpawnConstants constants{};
    if (context.device.software &&
        !limitTurns(constants, grammar.turns, info.fit, info.target == KernelTarget::software ? info.fit.groupSize : 0,
                    true, info.queues))
      continue; // workgroups and stacks that this device has no turns for
    const auto pipeline =
        createComputePipeline({kernel.info.schedule, kernel.spirv(),
                               specialization(context.device, info.fit, grammar.tableOf(kernel)), kDeriveConstants},
                              derive_);
    if (!pipeline) return pipeline.error();
    grammar.add({info, *pipeline});
  }
  grammar.setPrewarmed();
  if (!sizes_.interprets && grammar.readyCount() == 0) return noKernel(grammar);
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
  report.detail = std::bit_cast<float>(raw.note[0]);
  report.vertices = 4 * state.quads;
  report.verticesWritten = 4 * state.quadsWritten;
  report.colliders = state.colliders;
  report.axiomCount = static_cast<uint32_t>(raw.readBack.size() / sizeof(GpgpAxiomMeasures));
  report.axioms = report.axiomCount ? reinterpret_cast<const GpgpAxiomMeasures*>(raw.readBack.data()) : nullptr;
  report.collidersKept = std::min(report.colliders, sizes_.maxColliders);
  if (report.base.status == GPGP_SUCCESS &&
      (state.exceeded || report.droppedShapes || report.unfinishedShapes || report.colliders > report.collidersKept))
    report.base.status = GPGP_BUDGET_EXCEEDED;
  if (report.base.status != GPGP_NOT_EXECUTED && state.ended) report.base.status = GPGP_ERROR_UNSUPPORTED;
  return true;
}

} // namespace gpgp::spawn
