// The C functions of spawn.h that belong to the run time.
#include "api/check.h"
#include "api/deliver.h"
#include "spawn/schedule/checks.h"

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
    const spawn::Graph& graph = (*grammar)->graph;
    return deliver(static_cast<uint32_t>(graph.terminals.size()), count, terminals, "terminals",
                   [&](uint32_t i) -> GpgpGrammarTerminal {
                     const spawn::Terminal& t = graph.terminals[i];
                     return {graph.nameAt(t.name), t.kind, t.index, t.bucket};
                   });
  });
}

GpgpResult GPGP_CALL gpgpGetGrammarStarts(GpgpAsset handle, uint32_t* count, GpgpGrammarStart* starts) {
  return guarded("gpgpGetGrammarStarts", [&](Call& call) -> Result<void> {
    const auto grammar = resolve<spawn::Grammar>(call, handle, Kind::grammar, "grammar");
    if (!grammar) return grammar.error();
    const spawn::Graph& graph = (*grammar)->graph;
    return deliver(spawn::startCount(graph), count, starts, "starts", [&](uint32_t i) -> GpgpGrammarStart {
      const spawn::Start start = spawn::startAt(graph, i);
      return {start.name, start.axiom->shape, i >= graph.rules.size()};
    });
  });
}

GpgpResult GPGP_CALL gpgpGetGrammarFields(GpgpAsset handle, uint32_t* count, const char** names) {
  return guarded("gpgpGetGrammarFields", [&](Call& call) -> Result<void> {
    const auto grammar = resolve<spawn::Grammar>(call, handle, Kind::grammar, "grammar");
    if (!grammar) return grammar.error();
    const spawn::Graph& graph = (*grammar)->graph;
    return deliver(static_cast<uint32_t>(graph.fields.size()), count, names, "names",
                   [&](uint32_t i) { return graph.nameAt(graph.fields[i]); });
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
    if (auto ok = spawn::checkSpawnInfo(*info, **spawner, (*grammar)->graph.buckets); !ok) return ok;
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
