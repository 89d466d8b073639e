#include "spawn/schedule/spawner.h"

#include "shaders/spawn_derive.spv.h"
#include "shaders/spawn_emit.spv.h"
#include "shaders/spawn_place.spv.h"
#include "spawn/layout.h"
#include "spawn/shape.h"

#include <algorithm>
#include <cstddef>

namespace gpgp::spawn {
namespace {

// Resource numbers are the bindings of shaders/spawn/bindings.glsl.
enum : core::ResourceIndex {
  kGraph,
  kAxioms,
  kInstances,
  kDraws,
  kCount,
  kQueues,
  kRecords,
  kState,
  kBuckets,
  kRounds,
  kConstants
};

// Workgroup counts of a record.
constexpr uint32_t kOneGroup = 0, kAxiomGroups = 1;

// The shaders read and write these as uvec4[6].
static_assert(sizeof(GpgpAxiom) == 96 && offsetof(GpgpAxiom, size) == 48 && offsetof(GpgpAxiom, id) == 64);
static_assert(sizeof(GpgpInstance) == 96 && offsetof(GpgpInstance, bucket) == 48 && offsetof(GpgpInstance, size) == 80);
static_assert(sizeof(VkDrawIndexedIndirectCommand) == 4 * shader::kDrawWords);

constexpr VkDeviceSize kShapeBytes = 16 * shader::kShapePlanes;
constexpr uint32_t kDefaultShapes = 262144, kDefaultTerminals = 524288, kDefaultDepth = 64;

/// Workgroups that fill any device; an invocation takes further shapes only where there are more than these. Rounds are
/// dispatched by what there is, so small ones cost little. (Fewer, longer loops would run into software devices' limits
/// on iterations.)
constexpr uint32_t kMaxGroups = 16384;

} // namespace

core::Result<core::Unique<Spawner>> Spawner::create(core::Context& context, const GpgpSpawnerCreateInfo& info) {
  auto spawner = core::makeUnique<Spawner>(context.host(), context, info.base);
  const uint32_t maxShapes = info.maxShapes ? info.maxShapes : kDefaultShapes;
  const uint32_t maxTerminals = info.maxTerminals ? info.maxTerminals : kDefaultTerminals;
  spawner->maxDepth_ = info.maxDepth ? info.maxDepth : kDefaultDepth;

  core::PassList list(&context.host());
  using enum core::ResourceKind;
  list.add({"grammar", buffer});
  list.add({"axioms", buffer, 0, true});
  list.add({"instances", buffer});
  list.add({"draws", buffer, 0, true});
  list.add({"count", buffer, 0, true});
  list.add({"queues", scratch, 2 * kShapeBytes * maxShapes});
  list.add({"records", scratch, kShapeBytes * maxTerminals});
  list.add({"state", scratch, sizeof(shader::SpawnState)});
  list.add({"buckets", scratch, 2 * sizeof(uint32_t) * shader::kMaxBuckets});
  const VkDeviceSize rounds = spawner->maxDepth_ + 2; // the leftover of the last one, and emission
  list.add({"rounds", scratch, sizeof(shader::SpawnRound) * rounds});
  list.add({"constants", constants, sizeof(shader::SpawnConstants)});

  const std::array<uint32_t, 4> budgets{maxShapes, maxTerminals};
  const uint32_t derive = list.add(core::ShaderDesc{"derive", spawn_derive, budgets, 2});
  const uint32_t place = list.add(core::ShaderDesc{"place", spawn_place, budgets, 2});
  const uint32_t emit = list.add(core::ShaderDesc{"emit", spawn_emit, budgets, 2});

  using enum core::UseKind;
  list.fill("clear counters", kState, 0);
  list.fill("clear buckets", kBuckets, 0);
  list.fill("clear rounds", kRounds, 0);
  const auto uses = {core::Use{kGraph, read}, {kAxioms, read},       {kQueues, readWrite}, {kRecords, write},
                     {kState, readWrite},     {kBuckets, readWrite}, {kRounds, readWrite}, {kConstants, read}};
  list.dispatch("derive", derive, uses, kAxiomGroups, {0});
  for (uint32_t round = 1; round < spawner->maxDepth_; ++round)
    list.dispatchIndirect("derive", derive, uses, kRounds, sizeof(shader::SpawnRound) * round, {round}).level = round;
  list.dispatch("place", place,
                {{kGraph, read},
                 {kDraws, readWrite},
                 {kCount, write},
                 {kState, readWrite},
                 {kBuckets, readWrite},
                 {kRounds, readWrite},
                 {kConstants, read}},
                kOneGroup);
  list.dispatchIndirect("emit", emit,
                        {{kGraph, read},
                         {kAxioms, read},
                         {kRecords, read},
                         {kInstances, write},
                         {kState, read},
                         {kBuckets, readWrite},
                         {kConstants, read}},
                        kRounds, sizeof(shader::SpawnRound) * (rounds - 1));
  list.report = kState;
  list.reportBytes = 4 * shader::kSpawnReportWords;
  if (auto ok = spawner->init(std::move(list)); !ok) return ok.error();
  return spawner;
}

core::Result<void> Spawner::prepare(VkCommandBuffer commandBuffer, const GpgpSpawnInfo& info, const Grammar& grammar) {
  const uint32_t rounds = grammar.graph.rounds ? std::min(grammar.graph.rounds, maxDepth_) : maxDepth_;
  const shader::SpawnConstants constants{
      info.axiomCount,
      static_cast<uint32_t>(info.instances.size / sizeof(GpgpInstance)),
      static_cast<uint32_t>(info.draws.buffer ? info.draws.size / sizeof(VkDrawIndexedIndirectCommand) : 0),
      info.count.buffer ? 1u : 0u,
      rounds,
      kMaxGroups};
  core::Record record;
  record.commandBuffer = commandBuffer;
  record.info = &info.base;
  record.bindings[kGraph].ownBuffer = grammar.buffer();
  record.bindings[kGraph].ownSize = grammar.size();
  record.bindings[kAxioms].engineBuffer = &info.axioms;
  record.bindings[kInstances].engineBuffer = &info.instances;
  record.bindings[kDraws].engineBuffer = &info.draws;
  record.bindings[kCount].engineBuffer = &info.count;
  record.groups[kOneGroup] = {1, 1, 1};
  const uint32_t axiomGroups = (info.axiomCount + shader::kSpawnGroupSize - 1) / shader::kSpawnGroupSize;
  record.groups[kAxiomGroups] = {std::min(axiomGroups, kMaxGroups), 1, 1};
  record.levels = rounds;
  record.constants = std::as_bytes(std::span(&constants, 1));
  if (auto ok = check(record); !ok) return ok;
  return Worker::record(record);
}

bool Spawner::takeReport(GpgpSpawnReport& report) {
  core::RawReport raw;
  if (!Worker::takeReport(raw)) return false;
  report.base = raw.header;
  report.terminals = raw.words[0];
  report.instancesWritten = raw.words[1];
  report.peakShapes = raw.words[2];
  report.droppedShapes = raw.words[3];
  report.unfinishedShapes = raw.words[4];
  report.rounds = raw.words[5];
  report.keyHash[0] = raw.words[6];
  report.keyHash[1] = raw.words[7];
  if (report.base.status == GPGP_SUCCESS &&
      (report.instancesWritten < report.terminals || report.droppedShapes || report.unfinishedShapes))
    report.base.status = GPGP_BUDGET_EXCEEDED;
  return true;
}

} // namespace gpgp::spawn
