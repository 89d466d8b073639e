#include "cli/tune/tuner.h"

#include "cli/shared/processors.h"
#include "cli/shared/progress.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace gpgp::cli {
namespace {

constexpr uint32_t kFewAxioms = 16;

/// Sizes and counts of workgroups that are worth a try. Stacks share what a spawner has by default; no two of them have
/// the same pipeline.
std::vector<spawn::Fit> fits(spawn::KernelTarget target, bool software, bool balances, uint32_t axioms) {
  // Workgroups are subgroups there. With another size than lavapipe's usual one the library skips these kernels, and
  // those stay that name no fit.
  if (target == spawn::KernelTarget::software) return {{8, 16, 2048, 512}, {8, 128, 2048, 512}};
  const uint32_t spread = software ? 512 : balances ? 4096 : 2048;
  using List = std::vector<uint32_t>;
  // What comes of few axioms may be less work than to spread it, and then large workgroups have it done first.
  const bool few = axioms <= kFewAxioms;
  std::vector<spawn::Fit> all;
  for (const uint32_t groupSize : software ? List{32, 64} : few ? List{32, 64, 128, 256} : List{32, 64, 128})
    for (const uint32_t groups : software ? List{16} : few ? List{512, 2048} : List{1024, 2048, 4096}) {
      const uint32_t stack = std::min(524288 / groups, 1024u);
      if (stack >= 2 * groupSize) all.push_back({groupSize, groups, stack, spread, 0, balances});
    }
  return all;
}
/// The same pipeline with other numbers.
std::vector<spawn::Fit> variants(const spawn::Fit& fit, bool software) {
  std::vector<spawn::Fit> all;
  for (const uint32_t spread :
       software ? std::vector<uint32_t>{64, 512} : std::vector<uint32_t>{256, 1024, 2048, 4096, 16384})
    for (const uint32_t balances : {0, 1}) {
      if (spread == fit.spread && balances == fit.balances) continue;
      all.push_back(fit);
      all.back().spread = spread;
      all.back().balances = balances;
    }
  return all;
}

/// Candidates that take this many times the fastest one's time after a few derivations are measured no further.
constexpr double kHopeless = 1.3;
constexpr uint32_t kFirstLook = 3;
/// The shares of the time after which no more schedules, sizes and numbers are begun, so that some is left.
constexpr double kForSchedules = 0.6, kForSizes = 0.8, kForNumbers = 0.9;
/// And one measurement, as far as that leaves it a few derivations.
constexpr double kForMeasurement = 0.02;
/// Candidates of the first part, which says how long a candidate takes; one where the interpreter took this share of
/// the time.
constexpr size_t kFirstPart = 4;
constexpr double kLittleTime = 0.1;
/// Schedules that are tried with queues; devices whose kernels with queues derive another way lose time on more.
constexpr size_t kQueued = 4, kSoftwareQueued = 1;
/// That are measured once more at the end.
constexpr size_t kFinalists = 4;
/// Of the finalists, whose fastest counts.
constexpr uint32_t kTurns = 3;

class Tuner {
public:
  Tuner(Session& session, const BakedGraph& grammar, const std::vector<GpgpAxiom>& axioms, const TuneSettings& settings)
      : session_(session), grammar_(grammar), settings_(settings), axioms_(static_cast<uint32_t>(axioms.size())),
        software_(session.device().isSoftware()) {
    findSchedules();
    deriver_.emplace(session, grammar, axioms, settings.derive);
  }

  Tuned run() {
    measureInterpreter();
    std::vector<Candidate> all;
    for (size_t i = 0; i < tuned_.schedules.size(); ++i) all.push_back({i});
    all = measured(std::move(all), "schedules", kForSchedules);
    tuned_.complete = tuned_.complete && tuned_.omitted == 0;
    if (settings_.mixed && settings_.grouped) measureQueues(all);
    while (!settings_.search && !tuned_.complete && measureNeighbours(all)) {
    }
    tuned_.measured = all;
    if (!std::isfinite(all.front().milliseconds))
      throw Failure("no schedule fits this device's budgets; use fewer axioms");
    if (!settings_.schedulesOnly) {
      // Two schedules are enough for the numbers: what is behind them now hardly wins by them.
      std::vector<Candidate> sizes;
      for (size_t i = 0; i < std::min<size_t>(2, all.size()); ++i)
        for (const spawn::Fit& fit : fits(targetOf(all[i]), software_, isUneven(grammar_.graph), axioms_))
          sizes.push_back({all[i].schedule, fit});
      addAll(all, measured(std::move(sizes), "sizes", kForSizes));
      if (const Candidate& best = all.front(); best.fit.groupSize) {
        std::vector<Candidate> spreads;
        for (const spawn::Fit& fit : variants(best.fit, software_)) spreads.push_back({best.schedule, fit});
        addAll(all, measured(std::move(spreads), "numbers", kForNumbers));
      }
    }
    choose(all);
    tuned_.seconds = secondsPassed();
    return std::move(tuned_);
  }

private:
  double secondsPassed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  spawn::KernelTarget targetOf(const Candidate& candidate) const {
    return targetFor(session_.device(), grammar_.graph, tuned_.schedules[candidate.schedule].queues);
  }
  spawn::KernelInfo infoOf(const Candidate& candidate) const {
    spawn::KernelInfo info = kernelInfo(tuned_.schedules[candidate.schedule], targetOf(candidate));
    info.fit = candidate.fit;
    return info;
  }
  static void sort(std::vector<Candidate>& list) {
    std::stable_sort(list.begin(), list.end(),
                     [](const Candidate& a, const Candidate& b) { return a.milliseconds < b.milliseconds; });
  }
  static void addAll(std::vector<Candidate>& list, const std::vector<Candidate>& more) {
    list.insert(list.end(), more.begin(), more.end());
    sort(list);
  }

  void findSchedules() {
    searchAll();
    if (settings_.mixed) return;
    for (spawn::Schedule& schedule : tuned_.schedules) schedule = withQueues(std::move(schedule));
  }
  void searchAll() {
    const auto search = [&](spawn::Search kind, size_t limit) {
      return searchSchedules(grammar_.graph, kind, limit, settings_.seed, tuned_.complete, settings_.heuristics);
    };
    tuned_.schedules = search(settings_.search.value_or(spawn::Search::exhaustive), settings_.samples);
    if (settings_.search || tuned_.complete) return;
    const size_t most = std::max<size_t>(settings_.samples / 2, std::size(spawn::kScheduleNames));
    tuned_.schedules = search(spawn::Search::heuristic, most * 3 / 4); // coins leave few choices in some grammars
    for (spawn::Schedule& schedule : search(spawn::Search::random, most))
      if (tuned_.schedules.size() < most && isNew(schedule)) tuned_.schedules.push_back(std::move(schedule));
  }
  bool isNew(const spawn::Schedule& schedule) const {
    return std::none_of(tuned_.schedules.begin(), tuned_.schedules.end(), [&](const spawn::Schedule& s) {
      return s.waits == schedule.waits && s.queues == schedule.queues;
    });
  }

  /// The best few with queues as well.
  void measureQueues(std::vector<Candidate>& all) {
    std::vector<Candidate> list;
    for (size_t i = 0; i < std::min(software_ ? kSoftwareQueued : kQueued, all.size()); ++i) {
      list.push_back({tuned_.schedules.size()});
      tuned_.schedules.push_back(withQueues(tuned_.schedules[all[i].schedule]));
    }
    addAll(all, measured(std::move(list), "queues", kForSchedules));
  }

  /// Whether one of those near the best is better.
  bool measureNeighbours(std::vector<Candidate>& all) {
    const size_t first = tuned_.schedules.size();
    if (first >= settings_.samples) return false;
    const size_t most = affordable(std::min(settings_.samples - first, atOnce()), kForSchedules);
    std::vector<spawn::Schedule> near = neighbours(grammar_.graph, tuned_.schedules[all.front().schedule]);
    std::shuffle(near.begin(), near.end(), std::mt19937(settings_.seed));
    std::vector<Candidate> list;
    for (spawn::Schedule& schedule : near)
      if (list.size() < most && isNew(schedule)) {
        list.push_back({tuned_.schedules.size()});
        tuned_.schedules.push_back(std::move(schedule));
      }
    if (list.empty()) return false;
    addAll(all, measured(std::move(list), "schedules near the best", kForSchedules));
    return all.front().schedule >= first;
  }

  void measureInterpreter() {
    const Grammar interpreted = deriver_->prepare(std::pmr::vector<uint32_t>());
    const GpgpSpawnReport& wanted = tuned_.report = deriver_->fit(interpreted);
    if (wanted.unfinishedShapes)
      throw Failure(std::to_string(wanted.unfinishedShapes) +
                    " shapes were not finished: rules nest deeper than the budget; raise --max-depth");
    if (wanted.droppedShapes || wanted.collidersKept < wanted.colliders)
      throw Failure(
          std::to_string(wanted.droppedShapes ? wanted.droppedShapes : wanted.colliders - wanted.collidersKept) +
          (wanted.droppedShapes ? " shapes" : " colliders") + " did not fit the largest budgets of this device" +
          (axioms_ > 1 ? "; use fewer axioms" : "; the derivation of one axiom is too large, or does not end"));
    if (!wanted.terminals) throw Failure("the grammar derives nothing from these axioms");
    tuned_.interpreter = deriver_->measure(interpreted, 1).times.median();
    tuned_.interpreter = deriver_->measure(interpreted, repeats(tuned_.interpreter)).times.median();
  }

  /// What a candidate takes, as it would be kept: with as many rounds as the library takes, or only those that had work
  /// then, and one to spare where rounds even out the work, or may end it. Empty ones cost time on a GPU as well, but
  /// the fewer there are, the less each of them spreads.
  void measure(Candidate& candidate, const Grammar& prepared) {
    const GpgpSpawnReport& wanted = tuned_.report;
    const GpgpSpawnReport r = deriver_->measure(prepared, 1).report;
    if (r.droppedShapes) return;
    const std::string& name = tuned_.schedules[candidate.schedule].name;
    if (r.terminals != wanted.terminals || r.keyHash[0] != wanted.keyHash[0] || r.keyHash[1] != wanted.keyHash[1])
      throw Failure("schedule \"" + name + "\" derives something else than the interpreter: " +
                    std::to_string(r.terminals) + " terminals instead of " + std::to_string(wanted.terminals));
    candidate.milliseconds = timeOf(prepared, 0);
    if (software_) return; // whose rounds are short, and as many as axioms of other sizes may need
    const uint32_t enough = r.rounds + (candidate.fit.balances || isUneven(grammar_.graph) ? 1 : 0);
    if (const double alone = timeOf(prepared, enough); alone < candidate.milliseconds) {
      candidate.milliseconds = alone;
      candidate.rounds = enough;
    }
  }
  /// Milliseconds, with so many rounds; 0: as many as the library takes.
  double timeOf(const Grammar& prepared, uint32_t rounds) {
    double milliseconds = deriver_->measure(prepared, kFirstLook, rounds).times.median();
    const uint32_t repeat = repeats(milliseconds);
    if (kFirstLook < repeat && milliseconds < kHopeless * fastest_)
      milliseconds = deriver_->measure(prepared, repeat, rounds).times.median();
    fastest_ = std::min(fastest_, milliseconds);
    return milliseconds;
  }

  /// Kernels of the candidates' schedules that have none yet.
  void compile(std::span<const Candidate> candidates) {
    kernels_.resize(tuned_.schedules.size());
    std::vector<size_t> missing;
    std::vector<spawn::Schedule> schedules;
    for (const Candidate& c : candidates)
      if (kernels_[c.schedule].empty() && std::find(missing.begin(), missing.end(), c.schedule) == missing.end()) {
        missing.push_back(c.schedule);
        schedules.push_back(tuned_.schedules[c.schedule]);
      }
    auto compiled = compileKernels(grammar_.graph, schedules, session_.device(), settings_.matching);
    for (size_t i = 0; i < missing.size(); ++i) kernels_[missing[i]] = std::move(compiled[i]);
  }
  std::vector<std::pmr::vector<uint32_t>> wordsOf(std::span<const Candidate> candidates) const {
    std::vector<std::pmr::vector<uint32_t>> words;
    for (const Candidate& c : candidates) words.push_back(kernelWords(grammar_, infoOf(c), kernels_[c.schedule]));
    return words;
  }

  static size_t atOnce() { return std::max(1u, std::thread::hardware_concurrency()); }
  /// How many candidates of so many can be measured next.
  size_t affordable(size_t wanted, double share) const {
    if (settings_.seconds == 0) return wanted;
    if (each_ == 0) return secondsPassed() < kLittleTime * settings_.seconds ? std::min(wanted, kFirstPart) : 1;
    // as if a larger part took longer: drivers may compile one after the other
    const double count = (share * settings_.seconds - secondsPassed()) / each_;
    return static_cast<size_t>(std::clamp(count, 0.0, static_cast<double>(wanted)));
  }
  /// How often a derivation that takes so long is measured.
  uint32_t repeats(double milliseconds) const {
    if (settings_.seconds == 0) return settings_.repeat;
    const double count = kForMeasurement * settings_.seconds * 1000 / milliseconds;
    return static_cast<uint32_t>(std::min<double>(std::max<double>(count, kFirstLook), settings_.repeat));
  }
  /// The fastest first, without those that there was no time for. share: of all time, that may have passed at the end.
  std::vector<Candidate> measured(std::vector<Candidate> list, const char* label, double share) {
    Progress progress(label, list.size());
    size_t first = 0;
    while (first < list.size()) {
      const double begin = secondsPassed();
      const size_t count = affordable(std::min(list.size() - first, atOnce()), share);
      if (!count) break;
      const auto part = std::span(list).subspan(first, count);
      compile(part);
      const std::vector<Grammar> grammars = deriver_->prepare(wordsOf(part));
      for (size_t i = 0; i < part.size(); ++i, progress.advance()) measure(part[i], grammars[i]);
      each_ = (secondsPassed() - begin) / static_cast<double>(count);
      first += count;
    }
    tuned_.candidates += first;
    tuned_.omitted += list.size() - first;
    list.resize(first);
    sort(list);
    return list;
  }

  /// The best of the fastest few, measured as they are kept, by turns: whoever was first by luck is not so again, and
  /// clocks that rise and fall are the same for all. Without time for that, the first one, with all rounds.
  void choose(const std::vector<Candidate>& all) {
    const size_t count = affordable(std::min(kFinalists, all.size()), 1);
    std::vector<Candidate> finalists(all.begin(), all.begin() + std::ptrdiff_t(count));
    std::erase_if(finalists, [](const Candidate& c) { return !std::isfinite(c.milliseconds); });
    for (Candidate& c : finalists) c.fit.rounds = c.rounds;
    const std::vector<Grammar> grammars = deriver_->prepare(wordsOf(finalists));
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    std::vector<bool> drops(finalists.size());
    for (Candidate& c : finalists) c.milliseconds = kInfinite;
    for (uint32_t turn = 0; turn < kTurns; ++turn)
      for (size_t i = 0; i < finalists.size(); ++i) {
        const auto times = deriver_->measure(grammars[i], repeats(all[i].milliseconds));
        drops[i] = drops[i] || times.report.droppedShapes;
        finalists[i].milliseconds = drops[i] ? kInfinite : std::min(finalists[i].milliseconds, times.times.median());
      }
    sort(finalists);
    if (finalists.empty() || !std::isfinite(finalists.front().milliseconds)) // more rounds than the first time
      tuned_.best = all.front();
    else
      tuned_.best = finalists.front();
    tuned_.code = kernels_[tuned_.best.schedule];
    tuned_.info = infoOf(tuned_.best);
    tuned_.info.vendor = session_.device().properties().vendorID;
    tuned_.info.device = session_.device().properties().deviceID;
    tuned_.info.axioms = axioms_;
  }

  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  Session& session_;
  const BakedGraph& grammar_;
  const TuneSettings& settings_;
  const uint32_t axioms_;
  const bool software_;
  std::vector<KernelCode> kernels_; // by schedule; empty: not compiled yet
  std::optional<Deriver> deriver_;
  Tuned tuned_;
  double fastest_ = std::numeric_limits<double>::infinity();
  double each_ = 0; // seconds of a candidate in the last part that was measured
};

} // namespace

Tuned tuneGrammar(Session& session, const BakedGraph& grammar, const std::vector<GpgpAxiom>& axioms,
                  const TuneSettings& settings) {
  return Tuner(session, grammar, axioms, settings).run();
}

} // namespace gpgp::cli
