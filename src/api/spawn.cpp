// The C functions of spawn.h that belong to the run time.
#include "api/check.h"
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
    std::span<const std::byte> bytes(static_cast<const std::byte*>(info->data), info->data ? info->size : 0);
    std::pmr::vector<std::byte> file(&(*context)->host());
    if (info->filePath) {
      auto read = (*context)->readFile(info->filePath);
      if (!read) return read.error();
      file = std::move(*read);
      bytes = file;
    }
    auto made = spawn::Grammar::create(**context, info->label, bytes);
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

GpgpResult GPGP_CALL gpgpCreateSpawner(GpgpContext handle, const GpgpSpawnerCreateInfo* info, GpgpWorker* spawner) {
  return guarded("gpgpCreateSpawner", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_SPAWNER_CREATE_INFO, "info"); !ok) return ok;
    if (!spawner) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "spawner is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    if (info->maxShapes > (1u << 24) || info->maxTerminals > (1u << 24))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxShapes and maxTerminals are at most 16777216");
    if (info->maxDepth > 1024) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxDepth is at most 1024");
    auto made = spawn::Spawner::create(**context, *info);
    if (!made) return made.error();
    *spawner = adopt<GpgpWorker>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpRecordPrepareSpawn(GpgpWorker handle, VkCommandBuffer commandBuffer, const GpgpFrame* frame,
                                            const GpgpSpawnInfo* info) {
  return guarded("gpgpRecordPrepareSpawn", [&](Call& call) -> Result<void> {
    const auto spawner = resolve<spawn::Spawner>(call, handle, Kind::spawner, "spawner");
    if (!spawner) return spawner.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_SPAWN_INFO, "info"); !ok) return ok;
    const auto grammar =
        resolve<spawn::Grammar>(call, info->grammar, Kind::grammar, "info->grammar", &(*spawner)->context);
    if (!grammar) return grammar.error();
    if (info->axiomCount && !info->axioms.buffer)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axioms.buffer is NULL, axiomCount is %u", info->axiomCount);
    if (info->axioms.buffer && info->axioms.size / sizeof(GpgpAxiom) < info->axiomCount)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axioms.size is %llu bytes, axiomCount %u needs %llu",
                       static_cast<unsigned long long>(info->axioms.size), info->axiomCount,
                       static_cast<unsigned long long>(info->axiomCount) * sizeof(GpgpAxiom));
    if (info->instances.buffer && info->instances.size < sizeof(GpgpInstance))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "instances.size is below one GpgpInstance (%zu bytes)",
                       sizeof(GpgpInstance));
    const uint64_t drawBytes = uint64_t((*grammar)->graph.buckets) * sizeof(VkDrawIndexedIndirectCommand);
    if (info->draws.buffer && info->draws.size < drawBytes)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "draws.size is %llu bytes, the grammar's %u buckets need %llu",
                       static_cast<unsigned long long>(info->draws.size), (*grammar)->graph.buckets,
                       static_cast<unsigned long long>(drawBytes));
    if (info->count.buffer && info->count.size < 4)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "count.size is below 4 bytes");
    if (auto ok = checkRecord(**spawner, frame); !ok) return ok;
    if (!(*grammar)->resident()) return makeError(GPGP_NOT_READY, "the grammar is not resident");
    return (*spawner)->prepare(commandBuffer, *info, **grammar);
  });
}

GpgpResult GPGP_CALL gpgpGetSpawnReport(GpgpWorker handle, GpgpSpawnReport* report) {
  return guarded("gpgpGetSpawnReport", [&](Call& call) -> Result<void> {
    const auto spawner = resolve<spawn::Spawner>(call, handle, Kind::spawner, "spawner");
    if (!spawner) return spawner.error();
    if (auto ok = checkStruct(report, GPGP_STRUCTURE_SPAWN_REPORT, "report"); !ok) return ok;
    if (!(*spawner)->takeReport(*report)) return makeError(GPGP_NOT_READY, "no report is ready");
    return {};
  });
}
