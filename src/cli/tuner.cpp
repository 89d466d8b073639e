#include "cli/tuner.h"

#include "cli/progress.h"

#include <algorithm>
#include <cmath>

namespace gpgp::cli {
namespace {

/// The numbers that are worth a try. Stacks share what a spawner has by default.
std::vector<spawn::Fit> fits(bool software) {
  std::vector<spawn::Fit> all;
  for (const uint32_t groupSize : software ? std::vector<uint32_t>{32, 64} : std::vector<uint32_t>{32, 64, 128})
    for (const uint32_t groups : software ? std::vector<uint32_t>{16, 64} : std::vector<uint32_t>{1024, 2048, 4096})
      for (const uint32_t spread :
           software ? std::vector<uint32_t>{64, 512} : std::vector<uint32_t>{2048, 8192, 32768}) {
        const uint32_t stack = std::min(524288 / groups, 1024u);
        if (stack >= 2 * groupSize) all.push_back({groupSize, groups, stack, spread, 0});
      }
  return all;
}

} // namespace

Tuned tuneGrammar(Session& session, const BakedGraph& grammar, const std::vector<GpgpAxiom>& axioms,
                  const TuneSettings& settings) {
  const auto begin = std::chrono::steady_clock::now();
  Tuned tuned;
  tuned.schedules = searchSchedules(grammar.graph, settings.search, settings.samples, settings.seed, tuned.complete);
  const bool subgroups = hasSubgroups(session.device());
  const auto kernels = compileKernels(grammar.graph, tuned.schedules, subgroups, settings.matching);

  Deriver deriver(session, grammar, axioms, {});
  const Grammar interpreted = deriver.prepare(std::pmr::vector<uint32_t>());
  const GpgpSpawnReport wanted = tuned.report = deriver.fit(interpreted);
  if (wanted.droppedShapes || wanted.unfinishedShapes)
    throw Failure("the derivation exceeds the budgets; use fewer axioms");
  if (!wanted.terminals) throw Failure("the grammar derives nothing from these axioms");
  // A kernel that an engine's spawner has no room for would drop shapes there.
  const uint32_t maxRounds = deriver.maxRounds(), maxShapes = deriver.maxShapes();
  tuned.interpreter = deriver.measure(interpreted, settings.repeat).times.median();

  const auto infoOf = [&](const Candidate& candidate) {
    spawn::KernelInfo info = kernelInfo(tuned.schedules[candidate.schedule], subgroups);
    info.fit = candidate.fit;
    return info;
  };
  const auto measureAll = [&](std::vector<Candidate> list, const char* label) {
    constexpr size_t kAtOnce = 32; // pipelines
    Progress progress(label, list.size());
    for (size_t first = 0; first < list.size(); first += kAtOnce) {
      const auto part = std::span(list).subspan(first, std::min(kAtOnce, list.size() - first));
      std::vector<std::pmr::vector<uint32_t>> words;
      for (const Candidate& c : part) words.push_back(kernelWords(grammar, infoOf(c), kernels[c.schedule]));
      const std::vector<Grammar> grammars = deriver.prepare(words);
      for (size_t i = 0; i < part.size(); ++i, progress.advance()) {
        const GpgpSpawnReport r = deriver.fit(grammars[i]);
        if (r.droppedShapes) continue; // with this schedule the device's budgets are too small
        const std::string& name = tuned.schedules[part[i].schedule].name;
        if (r.terminals != wanted.terminals || r.keyHash[0] != wanted.keyHash[0] || r.keyHash[1] != wanted.keyHash[1])
          throw Failure("schedule \"" + name + "\" derives something else than the interpreter: " +
                        std::to_string(r.terminals) + " terminals instead of " + std::to_string(wanted.terminals));
        part[i].milliseconds = deriver.measure(grammars[i], settings.repeat).times.median();
        part[i].rounds = r.rounds;
        part[i].larger = r.rounds > maxRounds || r.peakShapes > maxShapes;
      }
    }
    std::stable_sort(list.begin(), list.end(), [](const Candidate& a, const Candidate& b) {
      return std::pair(a.larger, a.milliseconds) < std::pair(b.larger, b.milliseconds);
    });
    return list;
  };
  std::vector<Candidate> list;
  for (size_t i = 0; i < tuned.schedules.size(); ++i) list.push_back({i});
  tuned.measured = measureAll(std::move(list), "schedules");
  tuned.best = tuned.measured.front();
  size_t numbers = 0;
  if (!settings.schedulesOnly) {
    // Two schedules are enough for the numbers: what is behind them now hardly wins by them.
    list.clear();
    for (size_t i = 0; i < std::min<size_t>(2, tuned.measured.size()); ++i)
      for (const spawn::Fit& fit : fits(session.device().isSoftware()))
        list.push_back({tuned.measured[i].schedule, fit});
    numbers = list.size();
    const Candidate other = measureAll(std::move(list), "numbers").front();
    if (other.milliseconds < tuned.best.milliseconds) tuned.best = other;
  }
  if (!std::isfinite(tuned.best.milliseconds))
    throw Failure("no schedule fits this device's budgets; use fewer axioms");
  tuned.best.fit.rounds = tuned.best.rounds + 1; // one to spare: empty rounds cost time as well
  tuned.candidates = tuned.schedules.size() + numbers;
  const Candidate kept = measureAll({tuned.best}, "best").front();
  if (std::isfinite(kept.milliseconds))
    tuned.best = kept;
  else
    tuned.best.fit.rounds = 0;
  tuned.code = kernels[tuned.best.schedule];
  tuned.info = infoOf(tuned.best);
  tuned.info.vendor = session.device().properties().vendorID;
  tuned.info.device = session.device().properties().deviceID;
  tuned.info.axioms = static_cast<uint32_t>(axioms.size());
  tuned.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return tuned;
}

} // namespace gpgp::cli
