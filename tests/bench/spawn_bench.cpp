// What derivation costs by schedule: the tables of thesis chapter 4, a city, and curves over the number of axioms.
//
// Prints tables in Markdown, row by row: medians of GPU timestamps of a warm device, and ratios. The baselines, in the
// same process: the CPU evaluator on one thread, and the default schedule. Kernels and pipelines are made on all
// processors while those that are ready are measured, and their times can be kept for another run. Asserts nothing
// about time, but fails where a derivation differs from the evaluator's.
#include "arguments.h"
#include "cli/shared/processors.h"
#include "cli/spawn/axioms.h"
#include "cli/tune/tuner.h"
#include "host/files.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/graph/heuristics.h"

#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <thread>
#include <tuple>

namespace {
using namespace gpgp;
using namespace gpgp::cli;
using Clock = std::chrono::steady_clock;

struct Options {
  uint32_t repeat = 20, pairs = 384, samples = 40;
  uint32_t exhaustive = 64;
  double share = 1, seconds = 0, tuning = TuneSettings().seconds;
  bool quick = false;
  std::string device, keep, published;
  std::vector<std::string> tables;

  bool wants(const std::string& table, const std::string& row = {}) const {
    for (const std::string& wanted : tables) {
      const size_t colon = wanted.find(':');
      if (wanted.substr(0, colon) == table &&
          (row.empty() || colon == std::string::npos || row.find(wanted.substr(colon + 1)) != std::string::npos))
        return true;
    }
    return false;
  }
};

/// Of what is compared by turns: the fastest median counts.
constexpr uint32_t kTurns = 3;

double secondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// A table's time, and what it has no time for.
class Budget {
public:
  explicit Budget(double seconds) : seconds_(seconds > 0 ? seconds : std::numeric_limits<double>::infinity()) {}
  double left() const { return seconds_ - secondsSince(begin_); }
  bool allows(double seconds) const { return left() > seconds; }
  /// Whether there is time for something that takes about that long; what: its name, for the list of what was left out.
  bool allows(double seconds, const std::string& what) {
    if (allows(seconds)) return true;
    leftOut_ += (leftOut_.empty() ? "" : ", ") + what;
    return false;
  }
  void print(const char* table) const {
    std::printf("\n(%s: %.1f s", table, secondsSince(begin_));
    if (!leftOut_.empty()) std::printf("; left out for lack of time: %s", leftOut_.c_str());
    std::printf(")\n");
  }

private:
  Clock::time_point begin_ = Clock::now();
  double seconds_;
  std::string leftOut_;
};

// ---------------------------------------------------------------- cases

struct Case {
  std::string name;
  uint32_t axioms = 0;
  std::array<float, 3> size{};
  float spacing = 0;
  std::string folder = GPGP_SAMPLE_GRAMMARS;
};

std::vector<Case> readCases() {
  std::vector<Case> cases;
  std::istringstream lines(host::readText(GPGP_SAMPLE_GRAMMARS "/cases.txt"));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    Case c;
    std::istringstream row(line);
    row >> c.name >> c.axioms >> c.size[0] >> c.size[1] >> c.size[2] >> c.spacing;
    if (row) cases.push_back(c);
  }
  return cases;
}
/// Those that were published with the 2016 paper, as far as they are in the folder.
std::vector<Case> publishedCases(const std::string& folder) {
  std::vector<Case> cases;
  if (folder.empty()) return cases;
  for (const Case& c :
       {Case{"menger_sponge_3", 256, {27, 27, 27}, 40, folder}, Case{"3d_tree_4_3", 1, {16, 16, 16}, 20, folder},
        Case{"3d_tree_8_3", 1, {16, 16, 16}, 20, folder}, Case{"mc_skyscraper", 512, {30, 90, 30}, 40, folder},
        Case{"balcony", 256, {24, 34, 24}, 38, folder}, Case{"commercial", 256, {30, 45, 30}, 44, folder}})
    if (std::filesystem::exists(folder + "/" + c.name + ".pga")) cases.push_back(c);
  return cases;
}
const Case& caseOf(const std::vector<Case>& cases, const std::string& name) {
  for (const Case& c : cases)
    if (c.name == name) return c;
  throw Failure("cases.txt has no " + name);
}
std::vector<GpgpAxiom> axiomsOf(const Case& c, uint32_t count) { return axiomGrid(count, c.spacing, {c.size, 1}); }
BakedGraph grammarOf(const Case& c) { return bakeGraph({c.folder + "/" + c.name + ".pga"}, {}); }
uint32_t shareOf(const Options& options, uint32_t axioms) {
  return std::max(1u, static_cast<uint32_t>(options.share * axioms));
}

/// What the evaluator derives, and its milliseconds on one thread, output included.
struct Reference {
  spawn::Derivation result;
  double milliseconds = 0;
};
Reference evaluate(const BakedGraph& grammar, const std::vector<GpgpAxiom>& axioms, bool vertices = false) {
  const auto layout = spawn::layoutOf(Deriver::layout());
  spawn::DeriveOptions options;
  if (vertices) options.vertices = &*layout;
  options.maxShapes = UINT64_MAX;
  const auto begin = Clock::now();
  Reference reference{spawn::derive(grammar.words, axioms, options)};
  reference.milliseconds = 1e3 * secondsSince(begin);
  reference.result.instances = {};
  reference.result.vertexWords = {};
  return reference;
}
/// Throws where the device derived something else and did not say that it dropped any.
void compare(const spawn::Derivation& cpu, const GpgpSpawnReport& gpu, const std::string& what) {
  if (gpu.droppedShapes) return;
  if (cpu.terminals != gpu.terminals || std::memcmp(cpu.keyHash, gpu.keyHash, sizeof cpu.keyHash) != 0)
    throw Failure(what + ": the device derived something else than the CPU evaluator");
}

// ---------------------------------------------------------------- kernels

/// Kernels of one grammar, each made once: schedules that wait at the same nodes have the same one.
class Kernels {
public:
  Kernels(const BakedGraph& grammar, const host::HeadlessDevice& device, bool matching = false)
      : grammar_(grammar), device_(device), matching_(matching) {}
  /// Its number.
  size_t add(const spawn::Schedule& schedule) {
    const auto [at, isNew] = known_.try_emplace(
        {schedule.waits, matching_ ? schedule.roots : spawn::Roots(), schedule.queues}, schedules_.size());
    if (isNew) schedules_.push_back(schedule);
    return at->second;
  }
  size_t size() const { return schedules_.size(); }
  const BakedGraph& grammar() const { return grammar_; }
  const spawn::Schedule& schedule(size_t kernel) const { return schedules_[kernel]; }
  /// As words behind the graph. Any thread.
  std::pmr::vector<uint32_t> compile(size_t kernel) const {
    const spawn::Schedule& schedule = schedules_[kernel];
    const auto code = compileKernels(grammar_.graph, std::span(&schedule, 1), device_, matching_);
    const auto target = targetFor(device_, grammar_.graph, schedule.queues);
    return kernelWords(grammar_, kernelInfo(schedule, target), code[0]);
  }
  /// What tells it from all others, of other grammars as well.
  std::string key(size_t kernel) const {
    uint64_t hash = 0xcbf29ce484222325;
    const auto add = [&](uint64_t word) { hash = (hash ^ word) * 0x100000001b3; };
    for (const uint32_t word : grammar_.words) add(word);
    for (const bool waits : schedules_[kernel].waits) add(waits);
    if (matching_)
      for (const uint32_t root : schedules_[kernel].roots) add(root);
    if (schedules_[kernel].queues == spawn::Queues::groups) add(1);
    char text[24];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
  }

private:
  const BakedGraph& grammar_;
  const host::HeadlessDevice& device_;
  bool matching_;
  std::map<std::tuple<std::vector<bool>, spawn::Roots, spawn::Queues>, size_t> known_;
  std::vector<spawn::Schedule> schedules_;
};

/// A kernel's pipeline.
struct Made {
  size_t kernel = 0;
  Grammar grammar;
};

/// Makes kernels on all processors, each by itself, while the caller measures those that are ready; for a device that
/// needs the processors itself, while the caller waits. Begins none that would probably end too late.
class Workshop {
public:
  Workshop(Session& session, const Kernels& kernels, std::vector<size_t> wanted, const Budget& budget)
      : session_(session), kernels_(kernels), wanted_(std::move(wanted)), budget_(budget),
        deriver_(session, kernels.grammar(), {spawn::makeAxiom(1, 1, 1)}, {}), alone_(session.device().isSoftware()) {
    const size_t most = std::min<size_t>(wanted_.size(), std::max(1u, std::thread::hardware_concurrency()));
    for (size_t i = 0; i < most; ++i) threads_.emplace_back([this] { work(); });
  }
  ~Workshop() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  /// One that is ready, in about their order; nothing where none is left, or no time.
  std::optional<Made> next() {
    std::unique_lock lock(mutex_);
    mayWork_ = true;
    wake_.notify_all();
    for (;;) {
      if (error_) std::rethrow_exception(error_);
      if (alone_ && !made_.empty()) mayWork_ = false;
      if (!compiled_.empty()) { // only the context's thread, this one, makes assets
        const auto [kernel, words] = std::move(compiled_.front());
        compiled_.pop_front();
        lock.unlock();
        Grammar grammar = deriver_.load(words);
        lock.lock();
        loaded_.push_back({kernel, std::move(grammar)});
        wake_.notify_one();
      } else if (!made_.empty() && (mayWork_ || busy_ == 0)) {
        Made made = std::move(made_.front());
        made_.pop_front();
        ++taken_;
        wake_.notify_one();
        lock.unlock();
        session_.upload();
        return made;
      } else if (taken_ == begun_ && !mayBegin()) {
        return std::nullopt;
      } else if (ready_.wait_for(lock, std::chrono::milliseconds(2)) == std::cv_status::timeout) {
        lock.unlock();
        session_.keepBusy();
        lock.lock();
      }
    }
  }
  /// Seconds of processors, for each kernel taken.
  double compiling() const { return compiling_ / double(std::max<size_t>(taken_, 1)); }
  double pipelines() const { return pipelines_ / double(std::max<size_t>(taken_, 1)); }

private:
  bool mayBegin() const { return begun_ < wanted_.size() && budget_.allows(longest_); }
  void work() {
    std::unique_lock lock(mutex_);
    const auto did = [&](double& sum, const std::function<void()>& step) {
      ++busy_;
      lock.unlock();
      const auto begin = Clock::now();
      step();
      const double seconds = secondsSince(begin);
      lock.lock();
      --busy_;
      sum += seconds;
      return seconds;
    };
    try {
      while (!stopped_) {
        if (mayWork_ && !loaded_.empty()) {
          Made made = std::move(loaded_.front());
          loaded_.pop_front();
          GpgpResult result = GPGP_SUCCESS;
          const double seconds = did(pipelines_, [&] { result = deriver_.prewarm(made.grammar); });
          if (result < 0) throw Failure(std::string("gpgpPrewarmGrammar: ") + gpgpResultString(result));
          longest_ = std::max(longest_, seconds + compiling_ / double(begun_));
          made_.push_back(std::move(made));
          ready_.notify_one();
        } else if (mayWork_ && made_.size() < 2 * threads_.size() && mayBegin()) {
          const size_t kernel = wanted_[begun_++];
          std::pmr::vector<uint32_t> words;
          did(compiling_, [&] { words = kernels_.compile(kernel); });
          compiled_.push_back({kernel, std::move(words)});
          ready_.notify_one();
        } else {
          wake_.wait_for(lock, std::chrono::seconds(1));
        }
      }
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      if (!error_) error_ = std::current_exception();
      stopped_ = true;
    }
  }

  Session& session_;
  const Kernels& kernels_;
  const std::vector<size_t> wanted_;
  const Budget& budget_;
  Deriver deriver_;
  std::mutex mutex_;
  std::condition_variable wake_, ready_; // the threads; the caller
  std::deque<std::pair<size_t, std::pmr::vector<uint32_t>>> compiled_;
  std::deque<Made> loaded_, made_; // without a pipeline, and with it
  const bool alone_;               // nothing is made while the caller measures
  bool mayWork_ = true;            // make something
  size_t busy_ = 0;                // threads that do
  size_t begun_ = 0, taken_ = 0;
  double compiling_ = 0, pipelines_ = 0, longest_ = 0; // seconds
  bool stopped_ = false;
  std::exception_ptr error_;
  std::vector<std::thread> threads_;
};

/// Times of kernels in a file, a line each as they are measured: what another run of the same program on such a device
/// has measured is not measured again.
class Kept {
public:
  Kept(const std::string& file, const std::string& device) {
    if (file.empty()) return;
    const bool isNew = !std::filesystem::exists(file);
    if (!isNew) {
      std::istringstream lines(host::readText(file));
      std::string line;
      if (std::getline(lines, line); line != device) throw Failure(file + " holds times of " + line);
      while (std::getline(lines, line))
        if (const size_t space = line.find_last_of(' '); space != std::string::npos)
          times_[line.substr(0, space)] = std::strtod(line.c_str() + space, nullptr);
    }
    file_.reset(std::fopen(file.c_str(), "a"));
    if (!file_) throw Failure(file + " cannot be written");
    if (isNew) std::fprintf(file_.get(), "%s\n", device.c_str());
  }
  std::optional<double> find(const std::string& key) const {
    const auto at = times_.find(key);
    return at == times_.end() ? std::nullopt : std::optional(at->second);
  }
  void add(const std::string& key, double milliseconds) {
    times_[key] = milliseconds;
    if (!file_) return;
    std::fprintf(file_.get(), "%s %.6g\n", key.c_str(), milliseconds);
    std::fflush(file_.get());
  }

private:
  struct Close {
    void operator()(FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<FILE, Close> file_;
  std::map<std::string, double> times_;
};

/// Median milliseconds; infinity where the device's budgets are too small.
double timeOf(Deriver& deriver, const Grammar& grammar, const spawn::Derivation& cpu, const std::string& what,
              uint32_t repeat) {
  deriver.resetBudgets();
  const GpgpSpawnReport report = deriver.fit(grammar);
  compare(cpu, report, what);
  if (report.droppedShapes) return std::numeric_limits<double>::infinity();
  return deriver.measure(grammar, repeat).times.median();
}
std::string shown(double milliseconds) {
  if (std::isnan(milliseconds)) return "–";
  if (!std::isfinite(milliseconds)) return "too large";
  char text[32];
  std::snprintf(text, sizeof text, milliseconds < 10 ? "%.3f" : "%.1f", milliseconds);
  return text;
}

/// Numbers of axioms that kernels of a grammar are measured with.
struct Place {
  uint32_t axioms = 0;
  Deriver* deriver = nullptr;
  const spawn::Derivation* cpu = nullptr;
};

/// Times of a grammar's kernels, as far as there is time for them.
class Times {
public:
  /// name: the grammar's, in messages.
  Times(Session& session, const Kernels& kernels, std::vector<Place> places, std::string name, uint32_t repeat,
        Kept& kept)
      : session_(session), kernels_(kernels), places_(std::move(places)), name_(std::move(name)), repeat_(repeat),
        kept_(kept) {}
  /// Measures those that have been added, but for those that were kept. Whether there was time for all.
  bool measureNew(const Budget& budget) {
    std::vector<size_t> wanted;
    for (size_t kernel = times_.size(); kernel < kernels_.size(); ++kernel) {
      times_.emplace_back(places_.size(), std::numeric_limits<double>::quiet_NaN());
      bool known = true;
      for (size_t p = 0; p < places_.size(); ++p)
        if (const auto time = kept_.find(keyOf(kernel, p)))
          times_[kernel][p] = *time;
        else
          known = false;
      if (!known) wanted.push_back(kernel);
    }
    if (wanted.empty()) return true;
    const auto begin = Clock::now();
    Workshop workshop(session_, kernels_, wanted, budget);
    size_t count = 0;
    double measuring = 0;
    for (; const auto made = workshop.next(); ++count) {
      const auto beginMeasuring = Clock::now();
      for (size_t p = 0; p < places_.size(); ++p) {
        const Place& place = places_[p];
        const double time = timeOf(*place.deriver, made->grammar, *place.cpu,
                                   name_ + " " + kernels_.schedule(made->kernel).name, repeat_);
        times_[made->kernel][p] = time;
        kept_.add(keyOf(made->kernel, p), time);
      }
      measuring += secondsSince(beginMeasuring);
    }
    std::fprintf(stderr, "%s: %zu of %zu kernels in %.1f s; each: compiled %.2f s, pipeline %.2f s, measured %.3f s\n",
                 name_.c_str(), count, wanted.size(), secondsSince(begin), workshop.compiling(), workshop.pipelines(),
                 measuring / double(std::max<size_t>(count, 1)));
    return count == wanted.size();
  }
  /// Not a number: there was no time.
  double operator()(size_t kernel, size_t place) const {
    return kernel < times_.size() ? times_[kernel][place] : std::numeric_limits<double>::quiet_NaN();
  }
  double operator[](size_t kernel) const { return (*this)(kernel, 0); }
  double best() const { return (*this)[fastest()]; }
  /// A kernel's number; 0 where there are no times.
  size_t fastest() const {
    size_t fastest = 0;
    for (size_t kernel = 1; kernel < times_.size(); ++kernel)
      if (std::isnan((*this)[fastest]) || (*this)[kernel] < (*this)[fastest]) fastest = kernel;
    return fastest;
  }
  /// With times.
  size_t measured() const {
    return static_cast<size_t>(
        std::count_if(times_.begin(), times_.end(), [](const auto& times) { return !std::isnan(times[0]); }));
  }

private:
  std::string keyOf(size_t kernel, size_t place) const {
    return name_ + " " + std::to_string(places_[place].axioms) + " " + kernels_.key(kernel);
  }
  Session& session_;
  const Kernels& kernels_;
  std::vector<Place> places_;
  std::string name_;
  uint32_t repeat_;
  Kept& kept_;
  std::vector<std::vector<double>> times_; // by kernel
};

/// A grammar on the device with several numbers of axioms.
class Places {
public:
  Places(Session& session, const Case& c, const BakedGraph& grammar, const std::vector<uint32_t>& counts) {
    for (const uint32_t count : counts) {
      const auto axioms = axiomsOf(c, count);
      auto& one = all_.emplace_back(std::make_unique<One>());
      one->cpu = evaluate(grammar, axioms).result;
      one->deriver.emplace(session, grammar, axioms, DeriverOptions{});
      list_.push_back({count, &*one->deriver, &one->cpu});
    }
  }
  const std::vector<Place>& list() const { return list_; }

private:
  struct One {
    spawn::Derivation cpu;
    std::optional<Deriver> deriver;
  };
  std::vector<std::unique_ptr<One>> all_;
  std::vector<Place> list_;
};

// ---------------------------------------------------------------- table 4.1

/// Two-sided p of Student's t: the integral of its density, by Simpson's rule.
double pOf(double t, double freedom) {
  const double scale =
      std::exp(std::lgamma((freedom + 1) / 2) - std::lgamma(freedom / 2)) / std::sqrt(freedom * 3.14159265358979);
  const auto density = [&](double x) { return scale * std::pow(1 + x * x / freedom, -(freedom + 1) / 2); };
  const double end = std::min(std::abs(t), 60.0);
  constexpr int kSteps = 20000;
  double sum = density(0) + density(end);
  for (int i = 1; i < kSteps; ++i) sum += density(end * i / kSteps) * (i % 2 ? 4 : 2);
  return std::max(0.0, 1 - 2 * sum * end / kSteps / 3);
}
struct Mean {
  double mean = 0, deviation = 0;
};
Mean meanOf(const std::vector<double>& values) {
  Mean m;
  for (const double v : values) m.mean += v / static_cast<double>(values.size());
  for (const double v : values) m.deviation += (v - m.mean) * (v - m.mean);
  m.deviation = values.size() > 1 ? std::sqrt(m.deviation / static_cast<double>(values.size() - 1)) : 0;
  return m;
}

/// The edges that a heuristic decides, and what it says of them.
struct Decided {
  std::vector<uint32_t> edges;
  bool isStatic = false;
};
Decided decidedBy(const std::string& heuristic, const spawn::Graph& graph, const spawn::Flow& flow) {
  Decided decided{{}, heuristic != "H2"};
  const auto links = heuristic == "H1"   ? sequenceEdges(graph, flow)
                     : heuristic == "H2" ? divergentEdges(graph, flow)
                                         : constantEdges(graph, flow);
  if (heuristic != "H3") {
    for (const spawn::Link& link : links) decided.edges.push_back(link.edge);
    return decided;
  }
  // H3 makes as many of its edges static as groups of the wanted size take.
  const spawn::Roots roots = heuristicPartition(graph, flow, {false, false, spawn::Heuristics{}.minimumGroupSize});
  for (const spawn::Link& link : links)
    if (roots[link.target] != link.target) decided.edges.push_back(link.edge);
  return decided;
}

void heuristics(Session& session, const std::vector<Case>& cases, const Options& options, Kept& kept, Budget& budget) {
  std::printf("\n## Heuristics (table 4.1): ms with the heuristic (H) and inverted (not H)\n\n");
  std::printf("| test, edges | queues | pairs | pairs that differ | axioms | t | p | H (deviation) | not H | H faster "
              "| not H / H "
              "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  double tests = 0; // that share the time
  for (const char* name : {"H1", "H2", "H3"}) tests += options.wants("heuristics", name);
  for (const auto& [name, grammarName] :
       {std::pair{"H1", "suburban_house"}, std::pair{"H2", "commercial"}, std::pair{"H3", "balcony"}}) {
    if (!options.wants("heuristics", name)) continue;
    const Budget own(std::isfinite(budget.left()) ? std::max(budget.left() / tests--, 1e-3) : 0);
    const Case& c = caseOf(cases, grammarName);
    const BakedGraph grammar = grammarOf(c);
    const spawn::Flow flow = spawn::makeFlow(grammar.graph);
    const Decided decided = decidedBy(name, grammar.graph, flow);
    size_t edges = 0;
    for (const auto& links : flow.out) edges += links.size();
    std::mt19937 random(1);
    Kernels kernels(grammar, session.device());
    std::array<std::vector<std::array<size_t, 2>>, 2> kinds; // mixed, groups
    for (uint32_t i = 0; i < options.pairs; ++i) {
      std::vector<bool> isStatic(grammar.graph.edges.size());
      for (size_t e = 0; e < isStatic.size(); ++e) isStatic[e] = random() & 1;
      std::array<std::array<size_t, 2>, 2> pair{};
      for (const bool inverted : {false, true}) {
        for (const uint32_t edge : decided.edges) isStatic[edge] = decided.isStatic != inverted;
        const auto schedule = scheduleOf(grammar.graph, flow, realise(flow, isStatic), name);
        pair[0][inverted] = kernels.add(schedule);
        pair[1][inverted] = kernels.add(withQueues(schedule));
      }
      kinds[0].push_back(pair[0]);
      kinds[1].push_back(pair[1]);
    }
    const std::vector<uint32_t> counts =
        options.quick ? std::vector<uint32_t>{1, 16} : std::vector<uint32_t>{1, 64, 128, 256};
    const Places places(session, c, grammar, counts);
    Times times(session, kernels, places.list(), grammarName, options.repeat, kept);
    times.measureNew(own);
    for (auto& pairs : kinds)
      std::erase_if(pairs, [&](const auto& pair) { return std::isnan(times[pair[0]]) || std::isnan(times[pair[1]]); });
    if (const auto& pairs = kinds[1]; pairs.size() < options.pairs) // which are measured last
      budget.allows(std::numeric_limits<double>::infinity(),
                    std::to_string(options.pairs - pairs.size()) + " pairs of " + name);
    for (size_t row = 0; row < 2 * counts.size(); ++row) {
      const size_t n = row / 2;
      const auto& pairs = kinds[row % 2];
      std::vector<double> on, off, difference;
      size_t faster = 0, distinct = 0;
      for (const auto& [a, b] : pairs) {
        const double with = times(a, n), inverted = times(b, n);
        if (!std::isfinite(with) || !std::isfinite(inverted)) continue;
        on.push_back(with);
        off.push_back(inverted);
        difference.push_back(with - inverted);
        distinct += a != b;
        faster += with < inverted;
      }
      const Mean h = meanOf(on), notH = meanOf(off), d = meanOf(difference);
      const double t = d.deviation > 0 ? d.mean / (d.deviation / std::sqrt(double(difference.size()))) : 0;
      const double p = pOf(t, double(std::max<size_t>(difference.size(), 2) - 1));
      std::printf("| %s %s, %zu of %zu | %s | %zu | %zu | %u | %.2f | %s%.4f | %s (%.3f) | %s (%.3f) | %.2f | %.2f |\n",
                  name, grammarName, decided.edges.size(), edges, row % 2 ? "groups" : "mixed", difference.size(),
                  distinct, counts[n], t, p < 1e-4 ? "< " : "", std::max(p, 1e-4), shown(h.mean).c_str(), h.deviation,
                  shown(notH.mean).c_str(), notH.deviation, double(faster) / double(std::max<size_t>(distinct, 1)),
                  notH.mean / h.mean);
    }
  }
}

// ---------------------------------------------------------------- table 4.2

/// A case on the device, with what it should derive and its interpreter's time.
struct OnDevice {
  BakedGraph grammar;
  uint32_t count;
  size_t edges = 0;
  Reference reference;
  std::vector<GpgpAxiom> axioms;
  std::optional<Deriver> deriver;
  double interpreter = 0;
  uint64_t bytes = 0; // written

  OnDevice(Session& session, const Case& c, const Options& options)
      : grammar(grammarOf(c)), count(shareOf(options, c.axioms)), axioms(axiomsOf(c, count)) {
    for (const auto& links : spawn::makeFlow(grammar.graph).out) edges += links.size();
    reference = evaluate(grammar, axioms);
    DeriverOptions deriverOptions;
    deriverOptions.expected = reference.result.terminals;
    deriver.emplace(session, grammar, axioms, deriverOptions);
    const Grammar interpreted = deriver->prepare(std::pmr::vector<uint32_t>());
    interpreter = timeOf(*deriver, interpreted, reference.result, c.name, options.repeat);
    bytes = deriver->bytesWritten();
    if (bytes < reference.result.terminals * sizeof(GpgpInstance))
      std::fprintf(stderr, "%s: the device binds fewer instances, %.0f %% are written\n", c.name.c_str(),
                   100.0 * static_cast<double>(bytes) / static_cast<double>(reference.result.terminals) /
                       sizeof(GpgpInstance));
  }
  Place place() { return {count, &*deriver, &reference.result}; }
};

/// "0.97 yes": a ratio, and whether it is at most so much, as it is printed.
std::string judged(double ratio, double most) {
  if (std::isnan(ratio)) return "–";
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %s", ratio, std::round(100 * ratio) <= std::round(100 * most) ? "yes" : "no");
  return text;
}

void schedules(Session& session, const std::vector<Case>& cases, const Options& options, Kept& kept, Budget& budget) {
  std::printf(
      "\n## Schedules (table 4.2): ms\n\n"
      "| case | edges | axioms | terminals | CPU | interpreter | default | SGL (groups) | RW | DGN | heuristic | "
      "tuned | found in s | tuned / best named ≤ 1 | all partitions' best (kernels) | tuned / that ≤ 1.05 | "
      "CPU / tuned | GB/s |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  double longest = 0; // row
  for (const Case& c : cases) {
    if (!options.wants("schedules", c.name) || !budget.allows(longest, c.name)) continue;
    const auto begin = Clock::now();
    OnDevice on(session, c, options);
    const spawn::Graph& graph = on.grammar.graph;
    Kernels kernels(on.grammar, session.device());
    std::map<std::string, size_t> named;
    for (const char* name : spawn::kScheduleNames) named[name] = kernels.add(*spawn::namedSchedule(graph, name));
    Times times(session, kernels, {on.place()}, c.name, options.repeat, kept);
    times.measureNew(budget);
    double bestNamed = times.best();

    double tuned = std::numeric_limits<double>::quiet_NaN(), tuningSeconds = tuned;
    std::optional<Grammar> prepared; // tuned
    // By turns, as clocks rise and fall by some hundredths; and the least of many kernels' times is so by luck as well.
    const auto byTurns = [&](size_t kernel, double first) {
      if (!std::isfinite(first) || !prepared || !std::isfinite(tuned)) return first;
      const Grammar rival = on.deriver->prepare(kernels.compile(kernel));
      double best = std::numeric_limits<double>::infinity();
      for (uint32_t turn = 0; turn < kTurns; ++turn) {
        best = std::min(best, timeOf(*on.deriver, rival, on.reference.result, c.name, options.repeat));
        tuned = std::min(tuned, timeOf(*on.deriver, *prepared, on.reference.result, c.name, options.repeat));
      }
      return best;
    };
    TuneSettings settings;
    if (options.quick) settings.samples = 6;
    settings.repeat = std::min(settings.repeat, options.repeat);
    if (budget.allows(0)) {
      settings.seconds = std::min(options.tuning, budget.left());
      const Tuned found = tuneGrammar(session, on.grammar, on.axioms, settings);
      tuningSeconds = found.seconds;
      const spawn::Fit& fit = found.info.fit;
      std::fprintf(stderr,
                   "%s: tuned is schedule %s, invocations %u, workgroups %u, spread %u, balances %u, rounds %u;",
                   c.name.c_str(), found.schedule().name.c_str(), fit.groupSize, fit.maxGroups, fit.spread,
                   fit.balances, fit.rounds);
      std::fprintf(stderr, " of %zu, not tried %zu; schedules alone:", found.candidates, found.omitted);
      for (const Candidate& candidate : std::span(found.measured).first(std::min<size_t>(4, found.measured.size())))
        std::fprintf(stderr, " %s %s", found.schedules[candidate.schedule].name.c_str(),
                     shown(candidate.milliseconds).c_str());
      std::fprintf(stderr, "\n");
      prepared = on.deriver->prepare(kernelWords(on.grammar, found.info, found.code));
      tuned = timeOf(*on.deriver, *prepared, on.reference.result, c.name + " tuned", options.repeat);
      bestNamed = byTurns(times.fastest(), bestNamed);
    }
    double exhaustive = std::numeric_limits<double>::quiet_NaN();
    bool complete = false;
    const auto all = searchSchedules(graph, spawn::Search::exhaustive, options.exhaustive + 1, 1, complete);
    std::string searched = "more than " + std::to_string(options.exhaustive);
    if (complete && all.size() <= options.exhaustive) {
      for (const spawn::Schedule& schedule : all) kernels.add(schedule);
      const bool inTime = times.measureNew(budget);
      exhaustive = byTurns(times.fastest(), times.best());
      searched = (inTime ? "" : std::to_string(times.measured()) + " of ") + std::to_string(kernels.size());
    }
    std::printf(
        "| %s | %zu | %u | %llu | %s | %s | %s | %s (%zu) | %s | %s | %s | %s | %.1f | %s | %s (%s) | %s | %.2f | "
        "%.1f |\n",
        c.name.c_str(), on.edges, on.count, static_cast<unsigned long long>(on.reference.result.terminals),
        shown(on.reference.milliseconds).c_str(), shown(on.interpreter).c_str(), shown(times[named["default"]]).c_str(),
        shown(times[named["sgl"]]).c_str(), spawn::namedSchedule(graph, "sgl")->groups,
        shown(times[named["rw"]]).c_str(), shown(times[named["rules"]]).c_str(),
        shown(times[named["heuristic"]]).c_str(), shown(tuned).c_str(), tuningSeconds,
        judged(tuned / bestNamed, 1).c_str(), shown(exhaustive).c_str(), searched.c_str(),
        judged(tuned / exhaustive, 1.05).c_str(), on.reference.milliseconds / tuned,
        static_cast<double>(on.bytes) / tuned * 1e-6);
    longest = std::max(longest, secondsSince(begin));
  }
}

/// The named schedules with either kind of queues.
void queues(Session& session, const std::vector<Case>& cases, const Options& options, Kept& kept, Budget& budget) {
  std::printf("\n## Queues: ms of each named schedule with one stack a workgroup / with a queue for each execution "
              "group (its groups)\n\n| case | axioms | terminals |");
  for (const char* name : spawn::kScheduleNames) std::printf(" %s |", name);
  std::printf(" best / best |\n|---|---|---|%s---|\n", "---|---|---|---|---|");
  std::vector<Case> all = cases;
  for (const Case& c : publishedCases(options.published)) all.push_back(c);
  double longest = 0; // row
  for (const Case& c : all) {
    if (!options.wants("queues", c.name) || !budget.allows(longest, c.name)) continue;
    const auto begin = Clock::now();
    OnDevice on(session, c, options);
    const spawn::Graph& graph = on.grammar.graph;
    Kernels kernels(on.grammar, session.device());
    std::vector<std::array<size_t, 2>> pairs;
    for (const char* name : spawn::kScheduleNames) {
      const auto schedule = *spawn::namedSchedule(graph, name);
      pairs.push_back({kernels.add(schedule), kernels.add(withQueues(schedule))});
    }
    Times times(session, kernels, {on.place()}, c.name, options.repeat, kept);
    times.measureNew(budget);
    const bool published = c.folder != GPGP_SAMPLE_GRAMMARS;
    std::printf("| %s%s | %u | %llu |", published ? "published " : "", c.name.c_str(), on.count,
                static_cast<unsigned long long>(on.reference.result.terminals));
    std::array<double, 2> best;
    best.fill(std::numeric_limits<double>::infinity());
    for (const auto& pair : pairs) {
      std::printf(" %s / %s (%zu) |", shown(times[pair[0]]).c_str(), shown(times[pair[1]]).c_str(),
                  kernels.schedule(pair[0]).groups);
      for (size_t kind = 0; kind < 2; ++kind) best[kind] = std::fmin(best[kind], times[pair[kind]]);
    }
    std::printf(" %.2f |\n", best[0] / best[1]);
    longest = std::max(longest, secondsSince(begin));
  }
}

void searches(Session& session, const std::vector<Case>& cases, const Options& options, Kept& kept, Budget& budget) {
  std::printf(
      "\n## Searches (table 4.2): ms of the best of %u schedules, the named ones among them; s: for both searches; "
      "M: with matching\n\n"
      "| case | edges | axioms | default | OPTs | OPTH | s (kernels) | OPTs,M | OPTH,M | s (kernels) | "
      "default / best |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
      options.samples);
  double longest = 0; // row
  for (const Case& c : cases) {
    if (!options.wants("searches", c.name) || !budget.allows(longest, c.name)) continue;
    const auto rowBegin = Clock::now();
    OnDevice on(session, c, options);
    double usual = std::numeric_limits<double>::quiet_NaN(), best = std::numeric_limits<double>::infinity();
    std::string columns;
    for (const bool matching : {false, true}) {
      const auto begin = Clock::now();
      Kernels kernels(on.grammar, session.device(), matching);
      std::array<std::vector<size_t>, 2> met; // random, heuristic
      for (const spawn::Search search : {spawn::Search::random, spawn::Search::heuristic}) {
        bool complete = false;
        for (const spawn::Schedule& s : searchSchedules(on.grammar.graph, search, options.samples, 1, complete))
          met[search == spawn::Search::heuristic].push_back(kernels.add(s));
      }
      Times times(session, kernels, {on.place()}, c.name, options.repeat, kept);
      times.measureNew(budget);
      if (!matching) usual = times[0];
      for (const std::vector<size_t>& search : met) {
        double fastest = std::numeric_limits<double>::infinity();
        for (const size_t kernel : search) fastest = std::fmin(fastest, times[kernel]); // without those left out
        columns += " " + shown(fastest) + " |";
        best = std::min(best, fastest);
      }
      columns += " " + shown(secondsSince(begin)) + " (" +
                 (times.measured() < kernels.size() ? std::to_string(times.measured()) + " of " : "") +
                 std::to_string(kernels.size()) + ") |";
    }
    std::printf("| %s | %zu | %u | %s |%s %.2f |\n", c.name.c_str(), on.edges, on.count, shown(usual).c_str(),
                columns.c_str(), usual / best);
    longest = std::max(longest, secondsSince(rowBegin));
  }
}

// ---------------------------------------------------------------- figure 4.7

void partitions(Session& session, const std::vector<Case>& cases, const Options& options, Kept& kept, Budget& budget) {
  const Case& c = caseOf(cases, "menger_sponge_3");
  const BakedGraph grammar = grammarOf(c);
  const spawn::Flow flow = spawn::makeFlow(grammar.graph);
  const std::vector<uint32_t> counts =
      options.quick ? std::vector<uint32_t>{1} : std::vector<uint32_t>{1, shareOf(options, 16), shareOf(options, 256)};
  struct Row {
    size_t groups, kernel;
  };
  std::vector<Row> rows;
  Kernels kernels(grammar, session.device());
  spawn::PartitionEnumerator enumerator(flow);
  do {
    const auto schedule = scheduleOf(grammar.graph, flow, enumerator.roots(), std::to_string(rows.size()));
    rows.push_back({schedule.groups, kernels.add(schedule)});
  } while (enumerator.next());
  std::printf("\n## Partitions of the Menger sponge (figure 4.7): %zu valid ones, %zu kernels; ms\n\n| partition | "
              "execution groups | kernel |",
              rows.size(), kernels.size());
  for (const uint32_t count : counts) std::printf(" %u axioms |", count);
  std::printf("\n|---|---|---|%s\n", counts.size() == 1 ? "---|" : "---|---|---|");
  const Places places(session, c, grammar, counts);
  Times times(session, kernels, places.list(), c.name, options.repeat, kept);
  times.measureNew(budget);
  for (size_t i = 0; i < rows.size(); ++i) {
    if (std::isnan(times[rows[i].kernel])) {
      budget.allows(std::numeric_limits<double>::infinity(), "partition " + std::to_string(i));
      continue;
    }
    std::printf("| %zu | %zu | %zu |", i, rows[i].groups, rows[i].kernel);
    for (size_t n = 0; n < counts.size(); ++n) std::printf(" %s |", shown(times(rows[i].kernel, n)).c_str());
    std::printf("\n");
  }
}

// ---------------------------------------------------------------- vertices, and the city

void vertices(Session& session, const std::vector<Case>& cases, const Options& options, Kept&, Budget& budget) {
  std::printf(
      "\n## Vertices of 32 bytes with 32-bit indices, default schedule (city: figure 4.1)\n\n"
      "| case | axioms | terminals | vertices | triangles | bytes | ms | GB/s | CPU evaluator ms | CPU / GPU |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  double longest = 0; // row
  for (const Case& c : cases) {
    if (!options.wants("vertices", c.name) || !budget.allows(longest, c.name)) continue;
    const auto begin = Clock::now();
    const BakedGraph grammar = grammarOf(c);
    uint32_t count = shareOf(options, c.axioms);
    DeriverOptions deriverOptions;
    deriverOptions.vertices = true;
    Deriver deriver(session, grammar, axiomsOf(c, count), deriverOptions);
    const spawn::Schedule schedule = *spawn::namedSchedule(grammar.graph, "default");
    const spawn::KernelTarget target = targetFor(session.device(), grammar.graph);
    const auto code = compileKernels(grammar.graph, std::span(&schedule, 1), session.device(), false);
    const Grammar prepared = deriver.prepare(kernelWords(grammar, kernelInfo(schedule, target), code[0]));
    GpgpSpawnReport report = deriver.fit(prepared);
    while (report.verticesWritten < report.vertices && count > 1) { // fewer, where the device binds less
      count = static_cast<uint32_t>(0.95 * count * report.verticesWritten / report.vertices);
      deriver.setAxioms(axiomsOf(c, count));
      report = deriver.fit(prepared);
    }
    const Reference reference = evaluate(grammar, axiomsOf(c, count), true);
    const double time = timeOf(deriver, prepared, reference.result, c.name, options.repeat);
    const double bytes = static_cast<double>(deriver.bytesWritten());
    std::printf("| %s | %u | %u | %u | %u | %.0f | %s | %.0f | %s | %.2f |\n", c.name.c_str(), count, report.terminals,
                report.vertices, report.vertices / 2, bytes, shown(time).c_str(), bytes / time * 1e-6,
                shown(reference.milliseconds).c_str(), reference.milliseconds / time);
    longest = std::max(longest, secondsSince(begin));
  }
}

// ---------------------------------------------------------------- bounds

void bounds(Session& session, const std::vector<Case>& cases, const Options& options, Kept&, Budget& budget) {
  std::printf("\n## Boxes around each bucket (GpgpSpawnInfo::bounds), default schedule: ms, by turns\n\n"
              "| case | buckets | terminals | instances | with bounds | µs more | vertices | with bounds | µs more |\n"
              "|---|---|---|---|---|---|---|---|---|\n");
  double longest = 0; // row
  for (const Case& c : cases) {
    if (!options.wants("bounds", c.name) || !budget.allows(longest, c.name)) continue;
    const auto begin = Clock::now();
    const BakedGraph grammar = grammarOf(c);
    const auto axioms = axiomsOf(c, shareOf(options, c.axioms));
    const spawn::Schedule schedule = *spawn::namedSchedule(grammar.graph, "default");
    const spawn::KernelTarget target = targetFor(session.device(), grammar.graph);
    const auto code = compileKernels(grammar.graph, std::span(&schedule, 1), session.device(), false);
    std::printf("| %s | %u |", c.name.c_str(), grammar.graph.buckets);
    for (const bool asVertices : {false, true}) {
      DeriverOptions deriverOptions;
      deriverOptions.vertices = asVertices;
      Deriver without(session, grammar, axioms, deriverOptions);
      deriverOptions.bounds = true;
      Deriver with(session, grammar, axioms, deriverOptions);
      const Grammar prepared = without.prepare(kernelWords(grammar, kernelInfo(schedule, target), code[0]));
      const GpgpSpawnReport report = without.fit(prepared);
      with.fit(prepared);
      std::array<double, 2> best;
      best.fill(std::numeric_limits<double>::infinity());
      for (uint32_t turn = 0; turn < kTurns; ++turn) {
        best[0] = std::min(best[0], without.measure(prepared, options.repeat).times.median());
        best[1] = std::min(best[1], with.measure(prepared, options.repeat).times.median());
      }
      if (!asVertices) std::printf(" %u |", report.terminals);
      std::printf(" %s | %s | %.1f |", shown(best[0]).c_str(), shown(best[1]).c_str(), 1e3 * (best[1] - best[0]));
    }
    std::printf("\n");
    longest = std::max(longest, secondsSince(begin));
  }
}

// ---------------------------------------------------------------- rivals

/// The scenes of samples/rivals, as instances: of the best named schedule of either kind of queues.
void rivals(Session& session, const std::vector<Case>&, const Options& options, Kept& kept, Budget& budget) {
  const std::string folder = GPGP_SAMPLE_GRAMMARS "/../rivals/";
  std::printf(
      "\n## Scenes that are derived every frame: instances of 96 bytes, the best of the named schedules\n\n"
      "| scene | axioms | terminals | interpreter ms | one stack ms | queues ms | ns a terminal | scratch MiB | "
      "instances MiB | grammar KiB | CPU / GPU |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string name : {"market", "wood"}) {
    if (!options.wants("rivals", name) || !budget.allows(0, name)) continue;
    const BakedGraph grammar = bakeGraph({folder + name + ".pga"}, {});
    const auto axioms = name == "wood" ? readAxioms(folder + "wood.csv", grammar.namedStarts(), {})
                                       : axiomGrid(1, 0, {{120, 16, 120}, 1});
    const Reference reference = evaluate(grammar, axioms);
    DeriverOptions deriverOptions;
    deriverOptions.expected = reference.result.terminals;
    Deriver deriver(session, grammar, axioms, deriverOptions);
    const Grammar interpreted = deriver.prepare(std::pmr::vector<uint32_t>());
    const double interpreter = timeOf(deriver, interpreted, reference.result, name, options.repeat);
    const double bytes = static_cast<double>(deriver.bytesWritten());
    GpgpMemoryReport memory = GPGP_MEMORY_REPORT_INIT;
    session.check(gpgpGetMemoryReport(session.context(), &memory), "gpgpGetMemoryReport");
    Kernels kernels(grammar, session.device());
    for (const char* schedule : spawn::kScheduleNames) {
      kernels.add(*spawn::namedSchedule(grammar.graph, schedule));
      kernels.add(withQueues(*spawn::namedSchedule(grammar.graph, schedule)));
    }
    Times times(session, kernels, {{static_cast<uint32_t>(axioms.size()), &deriver, &reference.result}}, name,
                options.repeat, kept);
    times.measureNew(budget);
    std::array<double, 2> best;
    best.fill(std::numeric_limits<double>::infinity());
    for (size_t kernel = 0; kernel < kernels.size(); ++kernel) {
      double& least = best[kernels.schedule(kernel).queues == spawn::Queues::groups];
      least = std::fmin(least, times[kernel]);
    }
    const double least = std::min(best[0], best[1]);
    constexpr double kMiB = 1 << 20;
    std::printf("| %s | %zu | %llu | %s | %s | %s | %.2f | %.1f | %.1f | %.0f | %.1f |\n", name.c_str(), axioms.size(),
                static_cast<unsigned long long>(reference.result.terminals), shown(interpreter).c_str(),
                shown(best[0]).c_str(), shown(best[1]).c_str(),
                least * 1e6 / static_cast<double>(reference.result.terminals),
                static_cast<double>(memory.services[GPGP_SERVICE_SPAWN].deviceBytes) / kMiB, bytes / kMiB,
                static_cast<double>(grammar.words.size()) / 256, reference.milliseconds / least);
  }
}

// ---------------------------------------------------------------- curves

void curves(Session& session, const std::vector<Case>& cases, const Options& options, Kept&, Budget& budget) {
  std::printf(
      "\n## Curves: default schedule, instances; records: that the axioms are shared out to\n\n"
      "| case | axioms | records | terminals | ms | ns a terminal | GB/s | scratch MB | output MB | CPU / GPU |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Case& c : cases) {
    const bool usual = c.name == "mc_spaceship" || c.name == "city";
    if (!options.wants("curves", c.name) || (!usual && options.wants("curves", "mc_spaceship"))) continue;
    const BakedGraph grammar = grammarOf(c);
    const spawn::Schedule schedule = *spawn::namedSchedule(grammar.graph, "default");
    const spawn::KernelTarget target = targetFor(session.device(), grammar.graph);
    const auto code = compileKernels(grammar.graph, std::span(&schedule, 1), session.device(), false);
    Deriver deriver(session, grammar, axiomsOf(c, 1), {});
    const Grammar prepared = deriver.prepare(kernelWords(grammar, kernelInfo(schedule, target), code[0]));
    const VkDeviceSize range = session.device().properties().limits.maxStorageBufferRange;
    uint32_t records = 1;
    // Seconds of ten times fewer: all, and what grows with their number; ten records have ten threads.
    double before = 0, work = 0;
    for (uint32_t count = 10; count <= (options.quick ? 100u : 10000000u); count *= 10) {
      if (!budget.allows(before + 10 * work, c.name + " from " + std::to_string(count) + " axioms on")) break;
      const auto begin = Clock::now();
      const auto all = axiomsOf(c, count);
      const auto part = [&](uint32_t i) {
        const size_t each = count / records;
        return std::vector<GpgpAxiom>(all.begin() + std::ptrdiff_t(i * each),
                                      all.begin() + std::ptrdiff_t((i + 1) * each));
      };
      const auto fits = [&] {
        if (uint64_t{count} / records * sizeof(GpgpAxiom) > range) return false;
        deriver.setAxioms(part(0));
        const GpgpSpawnReport report = deriver.fit(prepared);
        return report.instancesWritten == report.terminals;
      };
      while (!fits() && records < count)
        records *= 10;                            // what fits one may be too much for the next: part(0) is typical
      std::vector<Reference> references(records); // of each record on one thread, beside each other
      const auto beginEvaluating = Clock::now();
      onAllProcessors(records, [&](size_t i) { references[i] = evaluate(grammar, part(static_cast<uint32_t>(i))); });
      const double evaluating = secondsSince(beginEvaluating);
      double time = 0, cpu = 0, bytes = 0;
      uint64_t terminals = 0;
      for (uint32_t i = 0; i < records; ++i) {
        deriver.setAxioms(part(i));
        time += timeOf(deriver, prepared, references[i].result, c.name, options.repeat);
        cpu += references[i].milliseconds;
        terminals += references[i].result.terminals;
        bytes += static_cast<double>(deriver.bytesWritten());
      }
      if (bytes < static_cast<double>(terminals * sizeof(GpgpInstance)))
        std::fprintf(stderr, "%s: some records have more instances than the device binds\n", c.name.c_str());
      GpgpMemoryReport memory = GPGP_MEMORY_REPORT_INIT;
      session.check(gpgpGetMemoryReport(session.context(), &memory), "gpgpGetMemoryReport");
      std::printf("| %s | %u | %u | %llu | %s | %.2f | %.1f | %.0f | %.1f | %.2f |\n", c.name.c_str(), count, records,
                  static_cast<unsigned long long>(terminals), shown(time).c_str(),
                  time * 1e6 / static_cast<double>(terminals), bytes / time * 1e-6,
                  static_cast<double>(memory.services[GPGP_SERVICE_SPAWN].deviceBytes) * 1e-6, bytes * 1e-6,
                  cpu / time);
      before = secondsSince(begin);
      work = evaluating / std::max(1u, std::min(10u, std::thread::hardware_concurrency() / records)) +
             1e-3 * time * (2 * options.repeat + 1);
    }
  }
}

const char* const kUsage =
    R"(spawn_bench [--device D] [--seconds N] [--tuning N] [--repeat N] [--pairs N] [--samples N] [--share F]
            [--exhaustive N] [--keep FILE] [--published FOLDER] [--quick] [TABLE[:ROW]]...
TABLE is one of
  schedules   table 4.2: every case of samples/grammars/cases.txt by the interpreter, the named schedules (DGN: rules)
              and what `gpgp tune` finds, in how many seconds; that against the best named schedule, and against the
              best of all partitions, where there are few, all with the device's usual numbers. What was tuned to goes
              to standard error. Rows: the cases' names
  searches    its other columns: the best that random and heuristic searches of --samples N schedules find, with and
              without matching. Rows: the cases' names
  partitions  figure 4.7: every valid partition of the Menger sponge at 1, 16 and 256 axioms. Those that differ only
              in the edges into operators that multiply have the same kernel, which is measured once
  vertices    cases as vertices of 32 bytes and 32-bit indices. Rows: the cases' names; `city` is figure 4.1
  bounds      cases as instances and as vertices, each with and without a box around each bucket. Rows: the cases'
              names
  curves      time and memory from 10 to 10^7 axioms; what the device does not bind at once is derived in parts, a
              record each. Rows: the cases' names
  queues      table 4.2's named schedules with one stack for all shapes of a workgroup, and with a queue for each
              execution group. Rows: the cases' names; --published FOLDER: also the grammars of the 2016 paper there
  rivals      samples/rivals: scenes of the kind that GPU work graphs derive every frame. Rows: market wood
  heuristics  table 4.1, with one stack and with queues: pairs of schedules, a heuristic's edges as it says against
              inverted, all others random, with a paired t-test, at 1, 64, 128 and 256 axioms. Rows: H1 H2 H3.
              --pairs N (default 384, as published)
ROW is a part of a row's name. --share F takes that part of each case's axioms; --quick is a short form of all.
--exhaustive N (default 64): the most kernels of a case that `schedules` measures all of; overview has 577,
simple_house 257, menger_sponge_3 21. --seconds N bounds each table: what would probably take longer is left out and
named below it; --tuning N (default 50) what tuning a case takes. --keep FILE: times of single kernels are written
there as they are measured, and those that it holds are not measured again, so that `schedules`, `searches`,
`partitions` and `heuristics` go on where another run of the same program ended, on such a device.
)";

int run(bench::Arguments arguments) {
  std::setvbuf(stdout, nullptr, _IOLBF, 1 << 16); // a run that is ended has printed every row that it had
  Options options;
  bool pairs = false, samples = false, repeat = false;
  const std::vector<std::string> known = {"schedules",  "vertices", "partitions", "bounds", "curves",
                                          "heuristics", "searches", "queues",     "rivals"};
  while (arguments.next()) {
    const std::string& word = arguments.word();
    if (word == "--repeat")
      options.repeat = arguments.number(), repeat = true;
    else if (word == "--pairs")
      options.pairs = arguments.number(), pairs = true;
    else if (word == "--samples")
      options.samples = arguments.number(5), samples = true;
    else if (word == "--share")
      options.share = arguments.real(0, 1);
    else if (word == "--seconds")
      options.seconds = arguments.real(0, 1e9);
    else if (word == "--exhaustive")
      options.exhaustive = arguments.number();
    else if (word == "--tuning")
      options.tuning = arguments.real(1, 1e9);
    else if (word == "--device")
      options.device = arguments.value();
    else if (word == "--keep")
      options.keep = arguments.value();
    else if (word == "--published")
      options.published = arguments.value();
    else if (word == "--quick")
      options.quick = true;
    else if (std::find(known.begin(), known.end(), word.substr(0, word.find(':'))) != known.end())
      options.tables.push_back(word);
    else
      throw bench::Usage("there is no table '" + arguments.name() + "'");
  }
  if (options.tables.empty()) options.tables = known;
  if (options.quick) { // what was not asked for
    if (!pairs) options.pairs = 4;
    if (!samples) options.samples = 6;
    if (!repeat) options.repeat = 3;
  }
  CommonOptions common;
  common.device = options.device;
  const std::vector<Case> cases = readCases();
  Session session(common);
  std::printf("Device %s, %u processors; medians of %u derivations by GPU timestamps.\n",
              session.device().name().c_str(), std::thread::hardware_concurrency(), options.repeat);
  using Table = void (*)(Session&, const std::vector<Case>&, const Options&, Kept&, Budget&);
  Kept kept(options.keep, session.device().name());
  for (const auto& [name, table] : {std::pair<const char*, Table>{"schedules", schedules},
                                    {"vertices", vertices},
                                    {"partitions", partitions},
                                    {"queues", queues},
                                    {"rivals", rivals},
                                    {"bounds", bounds},
                                    {"curves", curves},
                                    {"heuristics", heuristics},
                                    {"searches", searches}}) {
    if (!options.wants(name)) continue;
    Budget budget(options.seconds);
    table(session, cases, options, kept, budget);
    budget.print(name);
  }
  return 0;
}
} // namespace

int main(int argc, char** argv) { return bench::benchMain(argc, argv, kUsage, run); }
