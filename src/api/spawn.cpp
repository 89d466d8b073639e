// The C functions of spawn.h that belong to the run time.
#include "api/check.h"
#include "spawn/outputs/measure.h"
#include "spawn/schedule/spawner.h"

#include <gpgp/spawn.h>

#include <algorithm>
#include <cstring>

using namespace gpgp;
using namespace gpgp::api;

GpgpResult GPGP_CALL gpgpCreateGrammar(GpgpContext handle, const GpgpGrammarCreateInfo* info, GpgpAsset* grammar) {
  return guarded("gpgpCreateGrammar", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_GRAMMAR_CREATE_INFO, "info"); !ok) return ok;
    if (!grammar) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "grammar is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    if (!info->data == !info->filePath)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "exactly one of data and filePath must be set");
    const auto given = givenBytes(**context, info->data, info->size, info->filePath);
    if (!given) return given.error();
    auto made = spawn::Grammar::create(**context, info->label, given->bytes);
    if (!made) return made.error();
    *grammar = adopt<GpgpAsset>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetGrammarTerminals(GpgpAsset handle, uint32_t* count, GpgpGrammarTerminal* terminals) {
  return guarded("gpgpGetGrammarTerminals", [&](Call& call) -> Result<void> {
    const auto grammar = resolve<spawn::Grammar>(call, handle, Kind::grammar, "grammar");
    if (!grammar) return grammar.error();
    if (!count) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "count is NULL");
    const spawn::Graph& graph = (*grammar)->graph;
    const uint32_t all = static_cast<uint32_t>(graph.terminals.size());
    const uint32_t written = terminals ? std::min(*count, all) : 0;
    for (uint32_t i = 0; i < written; ++i) {
      const spawn::Terminal& t = graph.terminals[i];
      terminals[i] = {graph.nameAt(t.name), t.kind, t.index, t.bucket};
    }
    *count = all;
    if (terminals && written < all) return makeError(GPGP_INCOMPLETE, "terminals is too small");
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetGrammarStarts(GpgpAsset handle, uint32_t* count, GpgpGrammarStart* starts) {
  return guarded("gpgpGetGrammarStarts", [&](Call& call) -> Result<void> {
    const auto grammar = resolve<spawn::Grammar>(call, handle, Kind::grammar, "grammar");
    if (!grammar) return grammar.error();
    if (!count) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "count is NULL");
    const spawn::Graph& graph = (*grammar)->graph;
    const uint32_t all = spawn::startCount(graph);
    const uint32_t written = starts ? std::min(*count, all) : 0;
    for (uint32_t i = 0; i < written; ++i) {
      const spawn::Start start = spawn::startAt(graph, i);
      starts[i] = {start.name, start.axiom->shape, i >= graph.rules.size()};
    }
    *count = all;
    if (starts && written < all) return makeError(GPGP_INCOMPLETE, "starts is too small");
    return {};
  });
}

GpgpResult GPGP_CALL gpgpFindGrammarStart(GpgpAsset handle, const char* name, uint32_t* rule) {
  return guarded("gpgpFindGrammarStart", [&](Call& call) -> Result<void> {
    const auto grammar = resolve<spawn::Grammar>(call, handle, Kind::grammar, "grammar");
    if (!grammar) return grammar.error();
    if (!name || !rule) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s is NULL", name ? "rule" : "name");
    const spawn::Graph& graph = (*grammar)->graph;
    for (uint32_t i = 0; i < spawn::startCount(graph); ++i) {
      if (std::strcmp(spawn::startAt(graph, i).name, name) != 0) continue;
      *rule = i;
      return {};
    }
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the grammar has no start \"%s\"", name);
  });
}

GpgpResult GPGP_CALL gpgpCreateSpawner(GpgpContext handle, const GpgpSpawnerCreateInfo* info, GpgpRecorder* spawner) {
  return guarded("gpgpCreateSpawner", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_SPAWNER_CREATE_INFO, "info"); !ok) return ok;
    if (!spawner) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "spawner is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    if (info->flags & ~(GPGP_SPAWNER_ORDERED | GPGP_SPAWNER_COMPACT))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "flags has unknown bits");
    if ((info->flags & GPGP_SPAWNER_COMPACT) && info->vertices)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "flags has GPGP_SPAWNER_COMPACT, but vertices is set");
    if (info->maxShapes > (1u << 24) || info->maxTerminals > (1u << 24))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxShapes and maxTerminals are at most 16777216");
    if (info->maxDepth > 65535) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxDepth is at most 65535");
    if (info->maxHostAxioms > (1u << 24))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxHostAxioms is at most 16777216");
    if (info->maxRounds > 256) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxRounds is at most 256");
    if (info->maxMeasuredAxioms > (1u << 20))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxMeasuredAxioms is at most 1048576");
    if (info->maxOccupancyWords > shader::kMostGridWords)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxOccupancyWords is at most %u", shader::kMostGridWords);
    auto made = spawn::Spawner::create(**context, *info);
    if (!made) return made.error();
    *spawner = adopt<GpgpRecorder>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpPrewarmGrammar(GpgpRecorder handle, GpgpAsset grammarHandle) {
  return guarded("gpgpPrewarmGrammar", [&](Call& call) -> Result<void> {
    const auto spawner = resolve<spawn::Spawner>(call, handle, Kind::spawner, "spawner");
    if (!spawner) return spawner.error();
    const auto grammar = resolve<spawn::Grammar>(call, grammarHandle, Kind::grammar, "grammar", &(*spawner)->context);
    if (!grammar) return grammar.error();
    if (auto ok = (*spawner)->context.checkAlive(); !ok) return ok;
    return (*spawner)->prewarm(**grammar);
  });
}

namespace {
/// Where terminals go, and what is read and written for that.
Result<void> checkOutput(const spawn::Spawner& spawner, const GpgpSpawnInfo& info, uint32_t buckets) {
  const bool regions = info.flags & GPGP_SPAWN_REGIONS;
  bool counts = !info.instances.buffer;
  if (info.flags & ~GPGP_SPAWN_REGIONS) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "flags has unknown bits");
  if (spawner.vertices()) {
    if (!info.vertices)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices is NULL; the spawner was made for vertices");
    if (info.instances.buffer)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "instances.buffer is set; the spawner was made for vertices");
    const GpgpVertexOutput& output = *info.vertices;
    counts = !output.vertices.buffer;
    if (!counts) {
      if (output.indexType != VK_INDEX_TYPE_UINT16 && output.indexType != VK_INDEX_TYPE_UINT32)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices->indexType is neither UINT16 nor UINT32");
    } else if (output.indices.buffer) {
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices->vertices.buffer is NULL, indices.buffer is not");
    }
  } else if (info.vertices) {
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices is set; the spawner was made for instances");
  }
  if (info.instances.buffer && info.instances.size < spawner.instanceBytes())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "instances.size is below one instance (%u bytes)",
                     spawner.instanceBytes());
  if (regions && spawner.compact() && !spawner.ordered())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "GPGP_SPAWN_REGIONS is set; a spawner for compact instances has "
                                                  "regions only with GPGP_SPAWNER_ORDERED");
  if (info.ranges.buffer) {
    if (spawner.vertices() || spawner.ordered() || spawner.compact())
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "ranges.buffer is set; spawners that are ordered, compact or for "
                                                    "vertices have no ranges");
    if (counts || regions || info.draws.buffer || info.bounds.buffer)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "ranges.buffer is set, and %s",
                       counts ? "instances.buffer is NULL" : "so are draws.buffer, bounds.buffer or regions");
    if (info.ranges.size / sizeof(GpgpAxiomRange) < info.axiomCount)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "ranges.size is %llu bytes, axiomCount %u needs %llu",
                       static_cast<unsigned long long>(info.ranges.size), info.axiomCount,
                       static_cast<unsigned long long>(info.axiomCount) * sizeof(GpgpAxiomRange));
  }
  if (info.firstInstance && (regions || spawner.vertices()))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "firstInstance is %u; with %s it must be 0", info.firstInstance,
                     regions ? "GPGP_SPAWN_REGIONS" : "vertices");
  if (info.measures && (info.ranges.buffer || (regions && !spawner.ordered()) || (spawner.vertices() && counts)))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "measures is set, and %s",
                     info.ranges.buffer ? "so is ranges.buffer"
                     : regions          ? "GPGP_SPAWN_REGIONS, of a spawner that is not ordered"
                                        : "vertices->vertices.buffer is NULL");
  if (counts && !info.draws.buffer && !info.measures)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.buffer is NULL, and draws.buffer, where a recording could count",
                     spawner.vertices() ? "vertices->vertices" : "instances");
  if (regions && counts)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "GPGP_SPAWN_REGIONS is set, but nothing is written to them");
  if (regions && !info.draws.buffer)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "GPGP_SPAWN_REGIONS is set, draws.buffer is NULL");
  const uint64_t draws = spawner.vertices() && !regions && !counts ? 1 : buckets;
  const uint64_t drawBytes = draws * sizeof(VkDrawIndexedIndirectCommand);
  if (info.draws.buffer && info.draws.size < drawBytes)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "draws.size is %llu bytes, the grammar's %u buckets need %llu",
                     static_cast<unsigned long long>(info.draws.size), buckets,
                     static_cast<unsigned long long>(drawBytes));
  if (info.needed.buffer && !regions && !counts)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "needed.buffer is set, but there are no regions to fill");
  if (info.needed.buffer && info.needed.size < 4ull * buckets)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "needed.size is %llu bytes, the grammar's %u buckets need %llu",
                     static_cast<unsigned long long>(info.needed.size), buckets, 4ull * buckets);
  if (info.bounds.buffer && counts)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "bounds.buffer is set, but the recording only counts");
  if (info.bounds.buffer && info.bounds.size < sizeof(GpgpSpawnBounds) * buckets)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "bounds.size is %llu bytes, the grammar's %u buckets need %zu",
                     static_cast<unsigned long long>(info.bounds.size), buckets, sizeof(GpgpSpawnBounds) * buckets);
  if (info.count.buffer && info.count.size < 4)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "count.size is below 4 bytes");
  return {};
}
} // namespace

GpgpResult GPGP_CALL gpgpRecordPrepareSpawn(GpgpRecorder handle, VkCommandBuffer commandBuffer, const GpgpFrame* frame,
                                            const GpgpSpawnInfo* info) {
  return guarded("gpgpRecordPrepareSpawn", [&](Call& call) -> Result<void> {
    const auto spawner = resolve<spawn::Spawner>(call, handle, Kind::spawner, "spawner");
    if (!spawner) return spawner.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_SPAWN_INFO, "info"); !ok) return ok;
    const auto grammar =
        resolve<spawn::Grammar>(call, info->grammar, Kind::grammar, "info->grammar", &(*spawner)->context);
    if (!grammar) return grammar.error();
    if (info->hostAxioms && info->axioms.buffer)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "both hostAxioms and axioms.buffer are set");
    if (info->axiomCount && !info->hostAxioms && !info->axioms.buffer)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axioms.buffer and hostAxioms are NULL, axiomCount is %u",
                       info->axiomCount);
    if (info->axioms.buffer && info->axioms.size / sizeof(GpgpAxiom) < info->axiomCount)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axioms.size is %llu bytes, axiomCount %u needs %llu",
                       static_cast<unsigned long long>(info->axioms.size), info->axiomCount,
                       static_cast<unsigned long long>(info->axiomCount) * sizeof(GpgpAxiom));
    if (info->axiomCounter.buffer && info->axiomCounter.size < 4)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axiomCounter.size is below 4 bytes");
    if (info->axiomCounter.buffer && !info->axiomCount)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axiomCounter.buffer is set, and axiomCount, the most, is 0");
    if (auto ok = checkOutput(**spawner, *info, (*grammar)->graph.buckets); !ok) return ok;
    const core::RecorderUse use(**spawner);
    if (!use) return core::RecorderUse::error();
    if (auto ok = checkRecord(**spawner, frame); !ok) return ok;
    if (!(*grammar)->resident()) return makeError(GPGP_NOT_READY, "the grammar is not resident");
    return (*spawner)->prepare(commandBuffer, *info, **grammar);
  });
}

GpgpResult GPGP_CALL gpgpGetSpawnReport(GpgpRecorder handle, GpgpSpawnReport* report) {
  return guarded("gpgpGetSpawnReport", [&](Call& call) -> Result<void> {
    const auto spawner = resolve<spawn::Spawner>(call, handle, Kind::spawner, "spawner");
    if (!spawner) return spawner.error();
    if (auto ok = checkStruct(report, GPGP_STRUCTURE_SPAWN_REPORT, "report"); !ok) return ok;
    const core::RecorderUse use(**spawner);
    if (!use) return core::RecorderUse::error();
    if (!(*spawner)->takeReport(*report)) return noReport();
    return {};
  });
}
