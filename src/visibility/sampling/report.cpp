// What the GPU counted, as the engine reads it.
#include "visibility/sampling/recorder.h"

#include <algorithm>
#include <cstring>

namespace gpgp::visibility {

bool VisibilityRecorder::takeSampleReport(GpgpVisibilityReport& report) {
  core::RawReport raw;
  if (!takeReport(raw)) return false;
  shader::Counters counters{};
  std::memcpy(&counters, raw.words.data(), std::min(raw.words.size_bytes(), sizeof counters));
  report.base = raw.header;
  report.triangles = counters.triangles;
  report.visible = counters.visible;
  report.listed = counters.listed;
  report.coveredPixels = counters.coveredPixels;
  report.appeared = counters.appeared;
  report.disappeared = counters.disappeared;
  report.neededTriangles = counters.items;
  report.skippedTriangles = counters.skippedTriangles;
  report.skippedDraws = counters.skippedDraws;
  report.neededNonOpaque = counters.nonOpaque;
  report.changed = counters.changed;
  report.neededCandidates = counters.candidates;
  report.neededPairs = counters.pairs;
  report.maxTriangles = budgets_.maxTriangles;
  report.maxCandidates = budgets_.maxCandidates;
  report.maxPairs = budgets_.maxPairs;
  report.unresolved = counters.unresolved;
  report.decided = counters.decided;
  report.reused = counters.reused;
  report.decidedPixels = counters.decidedPixels;
  report.neededDraws = counters.draws;
  report.draws = counters.drawsGiven;
  report.neededDrawTriangles = counters.drawTriangles;
  report.drawTriangles = counters.drawListed;
  report.reference = counters.reference;
  report.falsePositives = counters.falsePositives;
  report.falseNegatives = counters.reference - counters.found;
  const auto share = [](double part, double whole) { return whole > 0 ? static_cast<float>(part / whole) : 0.0f; };
  const auto wide = [](const uint32_t* words) { return static_cast<double>(uint64_t(words[1]) << 32 | words[0]); };
  report.coverage = share(counters.found, counters.reference);
  report.overestimation = share(counters.falsePositives, counters.reference);
  report.coverageArea = share(wide(counters.foundArea), wide(counters.referenceArea));
  report.overestimationArea = share(counters.falsePositives, wide(counters.referenceArea));
  const bool tooMany = counters.items > budgets_.maxTriangles || counters.nonOpaque > budgets_.maxNonOpaque ||
                       counters.unresolved ||
                       ((counters.hasList & 2) && counters.changed < counters.appeared + counters.disappeared) ||
                       ((counters.hasList & 1) && counters.listed < counters.visible) ||
                       counters.drawsGiven < counters.draws || counters.drawListed < counters.drawTriangles;
  if (report.base.status == GPGP_SUCCESS && tooMany) report.base.status = GPGP_BUDGET_EXCEEDED;
  if (report.base.status != GPGP_NOT_EXECUTED && counters.ended) report.base.status = GPGP_ERROR_UNSUPPORTED;
  return true;
}

} // namespace gpgp::visibility
