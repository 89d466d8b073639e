#include "cli/spawn/fit_scorer.h"

#include "spawn/schedule/measuring.h"

#include <algorithm>

namespace gpgp::cli {
namespace {
constexpr uint32_t kMostShapes = 1u << 22, kFirstTerminals = 131072, kRecordBytes = 96;
}

FitScorer::FitScorer(Session& session, const BakedGraph& grammar, const GpgpMeasureInfo& measures,
                     const DeriverOptions& how)
    : session_(session), measures_(measures), how_(how), occupancyWords_(spawn::gridWords(measures)) {
  const uint32_t range = session.device().properties().limits.maxStorageBufferRange;
  mostTerminals_ = std::min(range / kRecordBytes, 1u << 24);
  maxTerminals_ = std::min(kFirstTerminals, mostTerminals_);
  const uint32_t each = static_cast<uint32_t>(sizeof(GpgpAxiomMeasures)) + 4 * occupancyWords_;
  mostAxioms_ = std::min(mostAxioms_, range / each);
  auto info = init<GpgpGrammarCreateInfo>();
  info.data = grammar.words.data();
  info.size = grammar.words.size() * 4;
  grammar_ = session.take(Grammar::create(session.context(), info), "gpgpCreateGrammar");
  session.upload();
  if (!how.fieldValues.empty())
    fieldValues_ = host::makeBuffer(session.device(), how.fieldValues, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "fields");
  makeSpawner();
}

void FitScorer::makeSpawner() {
  auto info = init<GpgpSpawnerCreateInfo>();
  info.base = session_.recorderInfo("fit");
  info.maxShapes = maxShapes_;
  info.maxTerminals = maxTerminals_;
  info.maxDepth = how_.maxDepth;
  info.maxHostAxioms = info.maxMeasuredAxioms = mostAxioms_;
  info.maxOccupancyWords = occupancyWords_;
  spawner_.reset();
  spawner_ = session_.take(Spawner::create(session_.context(), info), "gpgpCreateSpawner");
  session_.check(spawner_->prewarm(), "gpgpPrewarm");
}

uint32_t FitScorer::startNamed(const std::string& name) {
  return session_.take(grammar_.start(name.c_str()), "gpgpFindGrammarStart");
}

std::vector<GpgpAxiomMeasures> FitScorer::measure(const std::vector<GpgpAxiom>& axioms) {
  std::vector<GpgpAxiomMeasures> all;
  all.reserve(axioms.size());
  while (all.size() < axioms.size()) {
    auto info = init<GpgpSpawnInfo>();
    info.grammar = grammar_.get();
    info.hostAxioms = axioms.data() + all.size();
    info.axiomCount = static_cast<uint32_t>(std::min<size_t>(axioms.size() - all.size(), mostAxioms_));
    info.measures = &measures_;
    if (how_.camera) info.camera = &*how_.camera;
    if (!how_.fields.empty()) {
      info.fields = how_.fields.data();
      info.fieldCount = static_cast<uint32_t>(how_.fields.size());
      info.fieldValues = fieldValues_.range();
    }
    const auto measured = session_.measure(
        *spawner_, "fit", 1, [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
          info.base = base;
          return spawner_->recordPrepare(commands, frame, info);
        });
    const GpgpSpawnReport& report = measured.report;
    ++recordings_;
    if (!measured.times.totals.empty()) milliseconds_ += measured.times.totals.back();
    if (report.base.status < GPGP_SUCCESS)
      throw Failure(statusName(report.base.status) + ": the device ended loops of a shader before their time");
    if (report.unfinishedShapes)
      throw Failure("some rules nest deeper than --max-depth, which is what the derivation is measured for");
    if (report.terminals > maxTerminals_ && maxTerminals_ < mostTerminals_) {
      maxTerminals_ = std::min(std::max(report.terminals, 2 * maxTerminals_), mostTerminals_);
      makeSpawner();
    } else if (report.droppedShapes && report.peakShapes > maxShapes_ && maxShapes_ < kMostShapes) {
      maxShapes_ = std::min(std::max(report.peakShapes, 2 * maxShapes_), kMostShapes);
      makeSpawner();
    } else if (report.base.status == GPGP_BUDGET_EXCEEDED) {
      if (info.axiomCount == 1)
        throw Failure("one axiom alone becomes " + std::to_string(report.terminals) + " terminals, of which " +
                      std::to_string(report.droppedShapes) +
                      " shapes were dropped; this device has no room to measure it");
      mostAxioms_ = info.axiomCount / 2;
    } else {
      all.insert(all.end(), report.axioms, report.axioms + report.axiomCount);
      terminals_ += report.terminals;
    }
  }
  return all;
}

} // namespace gpgp::cli
