#include "spawn/lsystem/recorder.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace gpgp::spawn::lsystem {
namespace {

using namespace shader;

static_assert(sizeof(LsysState) == 4 * kLsysArgsAt);
static_assert(sizeof(GpgpLsystemModule) == 16 && sizeof(GpgpLsystemCorner) == 16);
constexpr uint32_t kDefaultModules = 1u << 18, kDefaultSteps = 64, kDefaultRounds = 64;

template <class Element> uint32_t elementsIn(const GpgpBuffer& buffer) {
  return static_cast<uint32_t>(buffer.buffer ? std::min<VkDeviceSize>(buffer.size / sizeof(Element), UINT32_MAX) : 0);
}

} // namespace

core::Result<core::Unique<Lsystem>> Lsystem::create(core::Context& context, const char* label,
                                                    std::span<const std::byte> bytes) {
  auto table = Table::load(bytes, &context.host());
  if (!table) return table.error();
  auto lsystem = core::makeUnique<Lsystem>(context.host(), context, label, std::move(*table));
  const auto words = std::as_bytes(lsystem->table.words());
  if (auto ok = lsystem->makeResident(GPGP_SERVICE_SPAWN,
                                      std::pmr::vector<std::byte>(words.begin(), words.end(), &context.host()));
      !ok)
    return ok.error();
  return lsystem;
}

core::Result<core::Unique<LsystemRecorder>> LsystemRecorder::create(core::Context& context,
                                                                    const GpgpLsystemRecorderCreateInfo& info) {
  auto recorder = core::makeUnique<LsystemRecorder>(context.host(), context, info.base);
  Sizes& sizes = recorder->sizes_;
  sizes.maxModules = info.maxModules ? info.maxModules : kDefaultModules;
  sizes.maxParameters = info.maxParameters ? info.maxParameters : sizes.maxModules;
  sizes.maxSteps = info.maxSteps ? info.maxSteps : kDefaultSteps;
  sizes.maxHostAxioms = info.maxHostAxioms;
  sizes.rounds = info.maxRounds ? info.maxRounds : kDefaultRounds;
  sizes.contexts = info.flags & GPGP_LSYSTEM_RECORDER_CONTEXTS;
  if (auto ok = recorder->init(describePasses(sizes, &context.host())); !ok) return ok.error();
  return recorder;
}

core::Result<void> LsystemRecorder::prepare(VkCommandBuffer commandBuffer, const GpgpLsystemInfo& info,
                                            const Lsystem& lsystem) {
  const Table& table = lsystem.table;
  const uint32_t iterations = info.iterations == 0                            ? table.head(kLsysHeadIterations)
                              : info.iterations == GPGP_LSYSTEM_NO_ITERATIONS ? 0
                                                                              : info.iterations;
  const uint32_t steps = table.stepCount(iterations);
  if (steps > sizes_.maxSteps)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "%u iterations of this L-system take %u steps; maxSteps is %u",
                           iterations, steps, sizes_.maxSteps);
  const bool structured = table.has(kLsysContexts) || table.has(kLsysCuts);
  if (structured && !sizes_.contexts)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "the L-system has contexts or cuts; the recorder was created "
                                                        "without GPGP_LSYSTEM_RECORDER_CONTEXTS");
  LsysConstants constants{};
  constants.axiomCount = info.axiomCount;
  constants.steps = steps;
  constants.maxModules = sizes_.maxModules;
  constants.maxParameters = sizes_.maxParameters;
  constants.leaves = sizes_.leaves();
  constants.instanceCapacity = elementsIn<GpgpInstance>(info.instances);
  constants.cornerCapacity = elementsIn<GpgpLsystemCorner>(info.corners);
  constants.drawCapacity = elementsIn<VkDrawIndexedIndirectCommand>(info.draws);
  constants.moduleCapacity = elementsIn<GpgpLsystemModule>(info.modules);
  constants.parameterCapacity = elementsIn<float>(info.parameters);
  constants.writesCount = info.count.buffer ? 1 : 0;
  constants.rounds = sizes_.rounds;
  constants.maxBranches = sizes_.maxBranches();
  constants.structured = structured;
  for (uint32_t step = 0; step < steps; ++step)
    constants.phases[step / 64][static_cast<int>(step / 16 % 4)] |= table.phaseOf(step, iterations)
                                                                    << (2 * (step % 16));
  core::Record record;
  record.commandBuffer = commandBuffer;
  record.info = &info.base;
  record.bindings[kLsysBindTable].ownBuffer = lsystem.buffer();
  record.bindings[kLsysBindTable].ownSize = lsystem.size();
  record.bindings[kLsysBindAxioms].engineBuffer = &info.axioms;
  if (info.hostAxioms)
    record.bindings[kLsysBindAxioms].hostData = std::as_bytes(std::span(info.hostAxioms, info.axiomCount));
  record.bindings[kLsysBindInstances].engineBuffer = &info.instances;
  record.bindings[kLsysBindDraws].engineBuffer = &info.draws;
  record.bindings[kLsysBindCorners].engineBuffer = &info.corners;
  record.bindings[kLsysBindModulesOut].engineBuffer = &info.modules;
  record.bindings[kLsysBindParametersOut].engineBuffer = &info.parameters;
  record.bindings[kLsysBindCount].engineBuffer = &info.count;
  record.groups[kOneGroup] = {1, 1, 1};
  record.groups[kAxiomGroups] = {std::max((info.axiomCount + 63) / 64, 1u), 1, 1};
  record.groups[kNodeGroups] = {std::max((sizes_.leaves() >> 8) / kLsysTile, 1u), 1, 1};
  record.groups[kTopNodeGroups] = {std::max((sizes_.leaves() >> 16) / kLsysTile, 1u), 1, 1};
  record.groups[kRowGroups] = {kLsysDigits, 1, 1};
  const bool walks = table.has(kLsysWalks), polygons = table.has(kLsysPolygons), cylinders = table.has(kLsysCylinders);
  record.conditions[kStructured] = structured;
  record.conditions[kScanned] = !walks;
  record.conditions[kWalked] = walks;
  record.conditions[kWithPolygons] = polygons;
  record.conditions[kWithCylinders] = cylinders;
  record.conditions[kWithPaths] = polygons || cylinders;
  record.levels = steps + 1;
  record.constants[0] = std::as_bytes(std::span(&constants, 1));
  if (auto ok = check(record); !ok) return ok;
  return Recorder::record(record);
}

bool LsystemRecorder::takeReport(GpgpLsystemReport& report) {
  core::RawReport raw;
  if (!Recorder::takeReport(raw)) return false;
  report.base = raw.header;
  LsysState state{};
  std::memcpy(&state, raw.words.data(), sizeof state);
  report.modules = state.modules;
  report.parameters = state.parameters;
  report.steps = state.steps;
  report.modulesNeeded = state.modulesNeeded;
  report.parametersNeeded = state.parametersNeeded;
  report.instances = state.instances;
  report.instancesWritten = state.instancesWritten;
  report.corners = state.polygonCorners + state.sections;
  report.cornersWritten = state.cornersWritten;
  report.depth = state.depth;
  report.unfinishedBranches = state.unwalked;
  report.stringHash[0] = state.hashX;
  report.stringHash[1] = state.hashY;
  const bool exceeded = state.stoppedAt != UINT32_MAX || state.unwalked || state.depthExceeded ||
                        report.instancesWritten < report.instances || report.cornersWritten < report.corners;
  if (report.base.status == GPGP_SUCCESS && exceeded) report.base.status = GPGP_BUDGET_EXCEEDED;
  return true;
}

} // namespace gpgp::spawn::lsystem
