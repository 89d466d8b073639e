#include "cli/tune/deriver.h"

#include "cli/shared/processors.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

namespace gpgp::cli {
namespace {

constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr GpgpAccess kRead{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                           VK_IMAGE_LAYOUT_UNDEFINED};
// The library's defaults, and what it takes at most.
constexpr uint32_t kDefaultShapes = 131072, kDefaultRounds = 4, kSoftwareRounds = 32, kMostRounds = 256,
                   kMostShapes = 1u << 24;
constexpr uint32_t kDefaultTerminals = 524288, kMostTerminals = 1u << 24;
constexpr uint32_t kMostColliders = 1u << 24, kMostSoftwareColliders = 8192;
constexpr uint64_t kShapeBytes = 96, kStackFactor = 4; // of a spawner's largest buffer: stacks for 4 * maxShapes

} // namespace

GpgpVertexLayout Deriver::layout() {
  GpgpVertexLayout layout{};
  layout.stride = sizeof(SpawnedVertex);
  const auto add = [&](GpgpVertexSemantic semantic, VkFormat format, size_t offset) {
    layout.attributes[layout.attributeCount++] = {semantic, format, static_cast<uint32_t>(offset)};
  };
  add(GPGP_VERTEX_POSITION, VK_FORMAT_R32G32B32_SFLOAT, offsetof(SpawnedVertex, position));
  add(GPGP_VERTEX_NORMAL, VK_FORMAT_R8G8B8A8_SNORM, offsetof(SpawnedVertex, normal));
  add(GPGP_VERTEX_UV, VK_FORMAT_R32G32_SFLOAT, offsetof(SpawnedVertex, uv));
  add(GPGP_VERTEX_TERMINAL, VK_FORMAT_R32_UINT, offsetof(SpawnedVertex, terminal));
  add(GPGP_VERTEX_AXIOM_ID, VK_FORMAT_R32_UINT, offsetof(SpawnedVertex, axiom));
  return layout;
}

Deriver::Deriver(Session& session, const BakedGraph& grammar, const std::vector<GpgpAxiom>& axioms,
                 const DeriverOptions& options)
    : session_(session), grammar_(grammar), options_(options),
      maxShapes_(options.maxShapes ? options.maxShapes : kDefaultShapes),
      maxRounds_(session.device().isSoftware() ? kSoftwareRounds : kDefaultRounds),
      maxTerminals_(options.vertices ? kDefaultTerminals : 1), // instances that are not sorted make no records
      maxColliders_(options.maxColliders   ? options.maxColliders
                    : grammar.graph.phases ? kMostSoftwareColliders
                                           : 0),
      firstShapes_(maxShapes_), firstRounds_(maxRounds_), interprets_(!options.kernelsOnly) {
  const size_t buckets = std::max(grammar.graph.buckets, 1u);
  draws_ = host::makeBuffer(session.device(), std::vector<VkDrawIndexedIndirectCommand>(buckets),
                            kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, "draws");
  count_ = host::Buffer(session.device(), 4, kStorage);
  if (options.bounds) bounds_ = host::Buffer(session.device(), buckets * sizeof(GpgpSpawnBounds), kStorage);
  if (!options.fieldValues.empty())
    fieldValues_ = host::makeBuffer(session.device(), options.fieldValues, kStorage, "fields");
  setAxioms(axioms);
  makeOutput(options.maxInstances ? options.maxInstances : std::max<uint64_t>(options.expected, 1));
  makeSpawner();
}

uint64_t Deriver::mostAxioms(Session& session) {
  return session.device().properties().limits.maxStorageBufferRange / sizeof(GpgpAxiom);
}

void Deriver::setAxioms(const std::vector<GpgpAxiom>& axioms) {
  if (axioms.size() > mostAxioms(session_))
    throw Failure(std::to_string(axioms.size()) + " axioms are more than this device binds: at most " +
                  std::to_string(mostAxioms(session_)));
  axioms_ = host::makeBuffer(session_.device(), axioms, kStorage, "axioms");
  axiomCount_ = static_cast<uint32_t>(axioms.size());
}

Spawner Deriver::newSpawner(uint32_t rounds) {
  GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
  info.base = session_.recorderInfo("spawner");
  const GpgpVertexLayout vertices = layout();
  if (options_.vertices) info.vertices = &vertices;
  info.maxShapes = maxShapes_;
  if (options_.sorted) maxTerminals_ = static_cast<uint32_t>(std::min<uint64_t>(elements_, kMostTerminals));
  info.maxTerminals = maxTerminals_;
  info.maxDepth = options_.maxDepth;
  info.maxRounds = rounds == maxRounds_ && rounds == firstRounds_ ? 0 : rounds; // 0: fewer where fewer are enough
  info.maxColliders = maxColliders_;
  if (!interprets_) info.flags = GPGP_SPAWNER_KERNELS_ONLY;
  Spawner spawner = session_.take(Spawner::create(session_.context(), info), "gpgpCreateSpawner");
  session_.check(spawner.prewarm(), "gpgpPrewarm");
  return spawner;
}

void Deriver::makeSpawner() {
  limited_.clear();
  spawner_.reset(); // before: scratch may fill the device
  spawner_.emplace(newSpawner(maxRounds_));
}

void Deriver::resetBudgets() {
  if (maxShapes_ == firstShapes_ && maxRounds_ == firstRounds_) return;
  maxShapes_ = firstShapes_;
  maxRounds_ = firstRounds_;
  makeSpawner();
}

uint64_t Deriver::mostElements() const {
  const uint64_t range = session_.device().properties().limits.maxStorageBufferRange;
  if (!options_.vertices) return std::min<uint64_t>(range / sizeof(GpgpInstance), 1u << 30);
  return std::min<uint64_t>(range / sizeof(SpawnedVertex), range / 6) / 4 * 4; // 6 indices of 4 bytes for 4 vertices
}

uint32_t Deriver::mostColliders() const {
  return session_.device().isSoftware() ? kMostSoftwareColliders : kMostColliders;
}

uint32_t Deriver::mostShapes() const {
  const uint64_t range = session_.device().properties().limits.maxStorageBufferRange;
  return static_cast<uint32_t>(std::min<uint64_t>(range / (kShapeBytes * kStackFactor), kMostShapes));
}

void Deriver::makeOutput(uint64_t elements) {
  elements_ = std::min(elements, mostElements());
  if (!options_.vertices) {
    instances_ = {};
    instances_ =
        host::Buffer(session_.device(), elements_ * sizeof(GpgpInstance), kStorage, host::Memory::device, "instances");
    return;
  }
  elements_ = std::max<uint64_t>((elements_ + 3) / 4 * 4, 4);
  vertices_ = {};
  indices_ = {};
  vertices_ =
      host::Buffer(session_.device(), elements_ * sizeof(SpawnedVertex), kStorage, host::Memory::device, "vertices");
  indices_ = host::Buffer(session_.device(), elements_ * 6, kStorage, host::Memory::device, "indices");
}

Grammar Deriver::load(const std::pmr::vector<uint32_t>& kernel) {
  std::pmr::vector<uint32_t> all(grammar_.words);
  all.insert(all.end(), kernel.begin(), kernel.end());
  GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
  info.label = "grammar";
  info.data = all.data();
  info.size = all.size() * 4;
  return session_.take(Grammar::create(session_.context(), info), "gpgpCreateGrammar");
}

std::vector<Grammar> Deriver::prepare(std::span<const std::pmr::vector<uint32_t>> kernels) {
  std::vector<Grammar> grammars;
  for (const auto& kernel : kernels) grammars.push_back(load(kernel));
  std::vector<GpgpResult> results(grammars.size());
  onAllProcessors(grammars.size(), [&](size_t i) { results[i] = prewarm(grammars[i]); });
  if (!interprets_ && std::ranges::count(results, GPGP_ERROR_UNSUPPORTED) > 0) { // no kernel fits this device
    session_.dropError();
    interprets_ = true;
    makeSpawner();
    for (size_t i = 0; i < grammars.size(); ++i)
      if (results[i] == GPGP_ERROR_UNSUPPORTED) results[i] = prewarm(grammars[i]);
  }
  for (const GpgpResult result : results) session_.check(result, "gpgpPrewarmGrammar");
  session_.upload();
  return grammars;
}

Grammar Deriver::prepare(const std::pmr::vector<uint32_t>& kernel) {
  return std::move(prepare(std::span(&kernel, 1)).front());
}

void Deriver::setWorld(GpgpSpawnInfo& info) const {
  if (options_.camera) info.camera = &*options_.camera;
  if (options_.fields.empty()) return;
  info.fields = options_.fields.data();
  info.fieldCount = static_cast<uint32_t>(options_.fields.size());
  info.fieldValues = fieldValues_.range();
}

Measured<GpgpSpawnReport> Deriver::measure(const Grammar& grammar, uint32_t repeat, uint32_t rounds) {
  const bool fewer = rounds && rounds < maxRounds_;
  if (fewer && !limited_.contains(rounds)) limited_.emplace(rounds, newSpawner(rounds));
  Spawner& spawner = fewer ? limited_.at(rounds) : *spawner_;
  GpgpVertexOutput output{};
  output.indexType = VK_INDEX_TYPE_UINT32;
  if (options_.vertices) {
    output.vertices = vertices_.range({}, kRead);
    output.indices = indices_.range({}, kRead);
  }
  return session_.measure(spawner, "deriving", repeat,
                          [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
                            GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
                            info.base = base;
                            info.grammar = grammar.get();
                            info.axioms = axioms_.range();
                            info.axiomCount = axiomCount_;
                            info.count = count_.range({}, kRead);
                            if (options_.vertices)
                              info.vertices = &output;
                            else
                              info.instances = instances_.range({}, kRead);
                            if (options_.sorted) info.draws = draws_.range({}, kRead);
                            if (options_.bounds) info.bounds = bounds_.range({}, kRead);
                            setWorld(info);
                            return spawner.recordPrepare(commands, frame, info);
                          });
}

/// Ranges come back with their counts.
Measured<GpgpSpawnReport> Deriver::measureRanges(const Grammar& grammar, const std::vector<GpgpAxiom>& axioms,
                                                 std::vector<GpgpAxiomRange>& ranges, uint32_t repeat) {
  const host::Buffer from = host::makeBuffer(session_.device(), axioms, kStorage, "axioms");
  const host::Buffer zeroed = host::makeBuffer(session_.device(), ranges, kStorage, "ranges at first");
  const host::Buffer own(session_.device(), zeroed.size(), kStorage, host::Memory::device, "ranges");
  const GpgpAccess copied{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                          VK_IMAGE_LAYOUT_UNDEFINED};
  auto measured =
      session_.measure(*spawner_, "deriving", repeat,
                       [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
                         const VkBufferCopy all{0, 0, own.size()};
                         session_.device().vk().vkCmdCopyBuffer(commands, zeroed.handle(), own.handle(), 1, &all);
                         GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
                         info.base = base;
                         info.grammar = grammar.get();
                         info.axioms = from.range();
                         info.axiomCount = static_cast<uint32_t>(axioms.size());
                         info.instances = instances_.range({}, kRead);
                         info.ranges = own.range(copied, kRead);
                         setWorld(info);
                         return spawner_->recordPrepare(commands, frame, info);
                       });
  ranges = host::download<GpgpAxiomRange>(session_.device(), own, ranges.size());
  return measured;
}

Changes Deriver::change(const Grammar& grammar, const std::vector<GpgpAxiom>& axioms,
                        const std::map<uint32_t, GpgpAxiom>& changed, uint32_t repeat) {
  std::vector<GpgpAxiom> others;
  for (const auto& [number, axiom] : changed) others.push_back(axiom);
  // Counted first, with ranges that hold nothing; then each range holds either of its axioms.
  std::vector<GpgpAxiomRange> ranges(axioms.size()), part(others.size());
  measureRanges(grammar, axioms, ranges, 1);
  measureRanges(grammar, others, part, 1);
  size_t next = 0;
  for (const auto& [number, axiom] : changed) ranges[number].count = std::max(ranges[number].count, part[next++].count);
  uint64_t size = 0;
  for (GpgpAxiomRange& range : ranges) {
    range = {static_cast<uint32_t>(size), range.count, 0, 0};
    size += range.capacity;
  }
  if (size > mostElements()) throw Failure("this device does not bind " + std::to_string(size) + " instances at once");
  makeOutput(std::max<uint64_t>(size, 1));
  Changes changes;
  changes.instances = size;
  std::vector<GpgpAxiomRange> all = ranges;
  changes.whole = measureRanges(grammar, axioms, all, repeat).times;
  const auto before = host::download<GpgpInstance>(session_.device(), instances_, size);
  next = 0;
  for (const auto& [number, axiom] : changed) part[next++] = ranges[number];
  changes.part = measureRanges(grammar, others, part, repeat).times;
  const auto after = host::download<GpgpInstance>(session_.device(), instances_, size);
  next = 0;
  for (uint32_t i = 0; i < axioms.size(); ++i) {
    const bool isChanged = changed.contains(i);
    const uint32_t count = isChanged ? part[next++].count : all[i].count;
    if (isChanged) changes.changed += count;
    for (uint32_t k = ranges[i].first; k < ranges[i].first + count; ++k) {
      if (isChanged)
        changes.foreign += after[k].axiomId != axioms[i].id;
      else
        changes.moved += std::memcmp(&before[k], &after[k], sizeof after[k]) != 0;
    }
  }
  return changes;
}

GpgpSpawnReport Deriver::fit(const Grammar& grammar) {
  const uint64_t range = session_.device().properties().limits.maxStorageBufferRange;
  for (;;) {
    const GpgpSpawnReport report = measure(grammar, 1).report;
    bool again = false, another = false; // spawner
    if (report.droppedShapes && !options_.maxShapes && report.peakShapes > maxShapes_ && maxShapes_ < mostShapes()) {
      maxShapes_ = static_cast<uint32_t>(std::min<uint64_t>(
          std::max<uint64_t>(2 * uint64_t{maxShapes_}, std::bit_ceil(uint64_t{report.peakShapes})), mostShapes()));
      another = true;
    }
    const bool allTaken =
        maxRounds_ == firstRounds_ ? !another : report.rounds >= maxRounds_; // the library may take fewer
    if (report.droppedShapes && allTaken && maxRounds_ < kMostRounds) {
      maxRounds_ *= 2;
      another = true;
    }
    if (report.colliders > maxColliders_ && !options_.maxColliders && maxColliders_ < mostColliders()) {
      maxColliders_ = std::min(report.colliders, mostColliders());
      another = true;
    }
    const uint64_t wanted = options_.vertices ? report.vertices : report.terminals;
    if (!options_.maxInstances && wanted > elements_ && elements_ < mostElements()) {
      makeOutput(wanted);
      again = true;
      another = another || options_.sorted;
    }
    const uint64_t mostTerminals = std::min<uint64_t>(range / kShapeBytes, kMostTerminals);
    if (options_.vertices && report.terminals > maxTerminals_ && maxTerminals_ < mostTerminals) {
      maxTerminals_ = static_cast<uint32_t>(std::min<uint64_t>(report.terminals, mostTerminals));
      another = true;
    }
    if (!again && !another) return report;
    if (another) makeSpawner();
  }
}

std::vector<GpgpInstance> Deriver::instances() {
  return host::download<GpgpInstance>(session_.device(), instances_, count());
}
uint32_t Deriver::count() { return host::download<uint32_t>(session_.device(), count_, 1)[0]; }
std::vector<uint32_t> Deriver::indices() { return host::download<uint32_t>(session_.device(), indices_, count()); }
std::vector<SpawnedVertex> Deriver::vertices() {
  return host::download<SpawnedVertex>(session_.device(), vertices_, size_t{count()} / 6 * 4);
}
uint64_t Deriver::bytesWritten() {
  const uint64_t written = count();
  return options_.vertices ? written / 6 * 4 * sizeof(SpawnedVertex) + written * 4 : written * sizeof(GpgpInstance);
}

} // namespace gpgp::cli
