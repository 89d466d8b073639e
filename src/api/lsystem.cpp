// The C functions of lsystem.h that belong to the run time.
#include "api/check.h"
#include "spawn/lsystem/recorder.h"

#include <gpgp/lsystem.h>

#include <algorithm>

using namespace gpgp;
using namespace gpgp::api;
using spawn::lsystem::Lsystem;
using spawn::lsystem::LsystemRecorder;

GpgpResult GPGP_CALL gpgpCreateLsystem(GpgpContext handle, const GpgpLsystemCreateInfo* info, GpgpAsset* lsystem) {
  return guarded("gpgpCreateLsystem", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_LSYSTEM_CREATE_INFO, "info"); !ok) return ok;
    if (!lsystem) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "lsystem is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    if (!info->data == !info->filePath)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "exactly one of data and filePath must be set");
    const auto given = givenBytes(**context, info->data, info->size, info->filePath);
    if (!given) return given.error();
    auto made = Lsystem::create(**context, info->label, given->bytes);
    if (!made) return made.error();
    *lsystem = adopt<GpgpAsset>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetLsystemTerminals(GpgpAsset handle, uint32_t* count, GpgpGrammarTerminal* terminals) {
  return guarded("gpgpGetLsystemTerminals", [&](Call& call) -> Result<void> {
    const auto lsystem = resolve<Lsystem>(call, handle, Kind::lsystem, "lsystem");
    if (!lsystem) return lsystem.error();
    if (!count) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "count is NULL");
    const auto& table = (*lsystem)->table;
    const uint32_t all = table.count(shader::kLsysSectionTerminals);
    const uint32_t written = terminals ? std::min(*count, all) : 0;
    for (uint32_t i = 0; i < written; ++i) {
      const uint32_t* t = table.terminal(i);
      terminals[i] = {table.name(t[shader::kTerminalNameAt]), t[shader::kTerminalKind], i, i};
    }
    *count = all;
    if (terminals && written < all) return makeError(GPGP_INCOMPLETE, "terminals is too small");
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetLsystemSymbols(GpgpAsset handle, uint32_t* count, GpgpLsystemSymbol* symbols) {
  return guarded("gpgpGetLsystemSymbols", [&](Call& call) -> Result<void> {
    const auto lsystem = resolve<Lsystem>(call, handle, Kind::lsystem, "lsystem");
    if (!lsystem) return lsystem.error();
    if (!count) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "count is NULL");
    const auto& table = (*lsystem)->table;
    const uint32_t all = table.count(shader::kLsysSectionSymbols);
    const uint32_t written = symbols ? std::min(*count, all) : 0;
    for (uint32_t i = 0; i < written; ++i)
      symbols[i] = {table.name(table.symbol(i)[shader::kSymbolName]), table.symbol(i)[shader::kSymbolArity]};
    *count = all;
    if (symbols && written < all) return makeError(GPGP_INCOMPLETE, "symbols is too small");
    return {};
  });
}

GpgpResult GPGP_CALL gpgpCreateLsystemRecorder(GpgpContext handle, const GpgpLsystemRecorderCreateInfo* info,
                                               GpgpRecorder* recorder) {
  return guarded("gpgpCreateLsystemRecorder", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_LSYSTEM_RECORDER_CREATE_INFO, "info"); !ok) return ok;
    if (!recorder) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "recorder is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    if (info->flags & ~GPGP_LSYSTEM_RECORDER_CONTEXTS)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "flags has unknown bits");
    if (info->maxModules > shader::kLsysMostModules)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxModules is at most %u", shader::kLsysMostModules);
    if (info->maxParameters > (1u << 26))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxParameters is at most 67108864");
    if (info->maxSteps > shader::kLsysMostSteps || info->maxRounds > 1024)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxSteps and maxRounds are at most 1024");
    if (info->maxHostAxioms > (1u << 20))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxHostAxioms is at most 1048576");
    auto made = LsystemRecorder::create(**context, *info);
    if (!made) return made.error();
    *recorder = adopt<GpgpRecorder>(**context, std::move(*made));
    return {};
  });
}

namespace {
Result<void> checkOutput(const GpgpLsystemInfo& info, const Lsystem& lsystem) {
  struct Output {
    const char* name;
    const GpgpBuffer* buffer;
    size_t least;
  };
  const size_t draws = sizeof(VkDrawIndexedIndirectCommand) * lsystem.table.count(shader::kLsysSectionTerminals);
  for (const Output& output : {Output{"instances", &info.instances, sizeof(GpgpInstance)},
                               {"draws", &info.draws, draws},
                               {"corners", &info.corners, sizeof(GpgpLsystemCorner)},
                               {"modules", &info.modules, sizeof(GpgpLsystemModule)},
                               {"parameters", &info.parameters, sizeof(float)},
                               {"count", &info.count, sizeof(uint32_t)}})
    if (output.buffer->buffer && output.buffer->size < output.least)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.size is %llu bytes; at least %zu are needed", output.name,
                       static_cast<unsigned long long>(output.buffer->size), output.least);
  return {};
}
} // namespace

GpgpResult GPGP_CALL gpgpRecordPrepareLsystem(GpgpRecorder handle, VkCommandBuffer commandBuffer,
                                              const GpgpFrame* frame, const GpgpLsystemInfo* info) {
  return guarded("gpgpRecordPrepareLsystem", [&](Call& call) -> Result<void> {
    const auto recorder = resolve<LsystemRecorder>(call, handle, Kind::lsystemRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_LSYSTEM_INFO, "info"); !ok) return ok;
    const auto lsystem = resolve<Lsystem>(call, info->lsystem, Kind::lsystem, "info->lsystem", &(*recorder)->context);
    if (!lsystem) return lsystem.error();
    if (info->hostAxioms && info->axioms.buffer)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "both hostAxioms and axioms.buffer are set");
    if (info->axiomCount && !info->hostAxioms && !info->axioms.buffer)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axioms.buffer and hostAxioms are NULL, axiomCount is %u",
                       info->axiomCount);
    if (info->axioms.buffer && info->axioms.size / sizeof(GpgpAxiom) < info->axiomCount)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axioms.size is %llu bytes, axiomCount %u needs %llu",
                       static_cast<unsigned long long>(info->axioms.size), info->axiomCount,
                       static_cast<unsigned long long>(info->axiomCount) * sizeof(GpgpAxiom));
    if (info->axiomCount > (1u << 22))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axiomCount is %u; at most 4194304 are taken", info->axiomCount);
    if (info->iterations > spawn::lsystem::kMostIterations && info->iterations != GPGP_LSYSTEM_NO_ITERATIONS)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "iterations is %u; at most 1000 are taken", info->iterations);
    if (auto ok = checkOutput(*info, **lsystem); !ok) return ok;
    const core::RecorderUse use(**recorder);
    if (!use) return core::RecorderUse::error();
    if (auto ok = checkRecord(**recorder, frame); !ok) return ok;
    if (!(*lsystem)->resident()) return makeError(GPGP_NOT_READY, "the L-system is not resident");
    return (*recorder)->prepare(commandBuffer, *info, **lsystem);
  });
}

GpgpResult GPGP_CALL gpgpGetLsystemReport(GpgpRecorder handle, GpgpLsystemReport* report) {
  return guarded("gpgpGetLsystemReport", [&](Call& call) -> Result<void> {
    const auto recorder = resolve<LsystemRecorder>(call, handle, Kind::lsystemRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (auto ok = checkStruct(report, GPGP_STRUCTURE_LSYSTEM_REPORT, "report"); !ok) return ok;
    const core::RecorderUse use(**recorder);
    if (!use) return core::RecorderUse::error();
    if (!(*recorder)->takeReport(*report)) return noReport();
    return {};
  });
}
