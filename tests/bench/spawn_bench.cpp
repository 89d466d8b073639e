// What derivation costs by schedule: the tables of thesis chapter 4, a city, and curves over the number of axioms.
//
//   spawn_bench [--device D] [--repeat N] [--pairs N] [--samples N] [--share F] [--quick] [TABLE[:ROW]]...
//
// TABLE is one of
//   heuristics  table 4.1: pairs of schedules, a heuristic's edges as it says against inverted, all others random, with
//   a
//               paired t-test, at 1, 64, 128 and 256 axioms. Rows: H1 H2 H3. --pairs N (default 384, as published)
//   schedules   table 4.2: every case of samples/grammars/cases.txt by interpreter, default, SGL, RW, DGN (rules), and
//               the best that random and heuristic searches of --samples N schedules find, with and without matching.
//               Rows: the cases' names
//   partitions  figure 4.7: every valid partition of the Menger sponge at 1, 16 and 256 axioms. Those that differ only
//               in the edges into operators that multiply have the same kernel
//   vertices    cases as vertices of 32 bytes and 32-bit indices. Rows: the cases' names; `city` is figure 4.1
//   curves      time and memory from 10 to 10^6 axioms, as far as the device binds the result. Rows: the cases' names
// ROW is a part of a row's name. --share F takes that part of each case's axioms; --quick is a short form of all.
//
// Prints tables in Markdown: medians of GPU timestamps of a warm device, and ratios. The baselines, in the same
// process: the CPU evaluator on one thread, and the default schedule. Kernels and pipelines are made on all processors.
// Asserts nothing about time, but fails where a derivation differs from the evaluator's.
#include "cli/axioms.h"
#include "cli/processors.h"
#include "cli/tuner.h"
#include "host/files.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/graph/heuristics.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>

namespace {
using namespace gpgp;
using namespace gpgp::cli;
using Clock = std::chrono::steady_clock;

struct Options {
  uint32_t repeat = 20, pairs = 384, samples = 40;
  double share = 1;
  bool quick = false;
  std::string device;
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

double secondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

// ---------------------------------------------------------------- cases

struct Case {
  std::string name;
  uint32_t axioms = 0;
  std::array<float, 3> size{};
  float spacing = 0;
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
const Case& caseOf(const std::vector<Case>& cases, const std::string& name) {
  for (const Case& c : cases)
    if (c.name == name) return c;
  throw Failure("cases.txt has no " + name);
}
std::vector<GpgpAxiom> axiomsOf(const Case& c, uint32_t count) { return axiomGrid(count, c.spacing, {c.size, 1}); }
BakedGraph grammarOf(const Case& c) { return bakeGraph(GPGP_SAMPLE_GRAMMARS "/" + c.name + ".pga", {}); }
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
  Kernels(const BakedGraph& grammar, bool subgroups, bool matching = false)
      : grammar_(grammar), subgroups_(subgroups), matching_(matching) {}
  /// Its number.
  size_t add(const spawn::Schedule& schedule) {
    const auto [at, isNew] =
        known_.try_emplace({schedule.waits, matching_ ? schedule.roots : spawn::Roots()}, schedules_.size());
    if (isNew) schedules_.push_back(schedule);
    return at->second;
  }
  size_t size() const { return schedules_.size(); }
  const spawn::Schedule& schedule(size_t kernel) const { return schedules_[kernel]; }
  /// Those from a number on, as words behind the graph.
  std::vector<std::pmr::vector<uint32_t>> compile(size_t first = 0) const {
    std::vector<std::pmr::vector<uint32_t>> words;
    const auto part = std::span(schedules_).subspan(first);
    const auto code = compileKernels(grammar_.graph, part, subgroups_, matching_);
    for (size_t i = 0; i < code.size(); ++i)
      words.push_back(kernelWords(grammar_, kernelInfo(part[i], subgroups_), code[i]));
    return words;
  }

private:
  const BakedGraph& grammar_;
  bool subgroups_, matching_;
  std::map<std::pair<std::vector<bool>, spawn::Roots>, size_t> known_;
  std::vector<spawn::Schedule> schedules_;
};

/// Median milliseconds; infinity where the device's budgets are too small.
double timeOf(Deriver& deriver, const Grammar& grammar, const spawn::Derivation& cpu, const std::string& what,
              uint32_t repeat) {
  const GpgpSpawnReport report = deriver.fit(grammar);
  compare(cpu, report, what);
  if (report.droppedShapes) return std::numeric_limits<double>::infinity();
  return deriver.measure(grammar, repeat).times.median();
}
std::string shown(double milliseconds) {
  if (!std::isfinite(milliseconds)) return "too large";
  char text[32];
  std::snprintf(text, sizeof text, milliseconds < 10 ? "%.3f" : "%.1f", milliseconds);
  return text;
}

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

void heuristics(Session& session, const std::vector<Case>& cases, const Options& options) {
  std::printf("\n## Heuristics (table 4.1): ms with the heuristic (H) and inverted (not H), %u pairs\n\n",
              options.pairs);
  std::printf("| test, edges | kernels | axioms | t | p | H (deviation) | not H | H faster | not H / H |\n"
              "|---|---|---|---|---|---|---|---|---|\n");
  const bool subgroups = hasSubgroups(session.device());
  for (const auto& [name, grammarName] :
       {std::pair{"H1", "suburban_house"}, std::pair{"H2", "commercial"}, std::pair{"H3", "balcony"}}) {
    if (!options.wants("heuristics", name)) continue;
    const Case& c = caseOf(cases, grammarName);
    const BakedGraph grammar = grammarOf(c);
    const spawn::Flow flow = spawn::makeFlow(grammar.graph);
    const Decided decided = decidedBy(name, grammar.graph, flow);
    size_t edges = 0;
    for (const auto& links : flow.out) edges += links.size();
    std::mt19937 random(1);
    Kernels kernels(grammar, subgroups);
    std::vector<std::array<size_t, 2>> pairs;
    for (uint32_t i = 0; i < options.pairs; ++i) {
      std::vector<bool> isStatic(grammar.graph.edges.size());
      for (size_t e = 0; e < isStatic.size(); ++e) isStatic[e] = random() & 1;
      std::array<size_t, 2> pair{};
      for (const bool inverted : {false, true}) {
        for (const uint32_t edge : decided.edges) isStatic[edge] = decided.isStatic != inverted;
        pair[inverted] = kernels.add(scheduleOf(grammar.graph, flow, realise(flow, isStatic), name));
      }
      pairs.push_back(pair);
    }
    const auto words = kernels.compile();
    const std::vector<uint32_t> counts =
        options.quick ? std::vector<uint32_t>{1, 16} : std::vector<uint32_t>{1, 64, 128, 256};
    Deriver deriver(session, grammar, axiomsOf(c, counts[0]), {});
    std::vector<spawn::Derivation> references;
    for (const uint32_t count : counts) references.push_back(evaluate(grammar, axiomsOf(c, count)).result);
    std::vector<std::vector<double>> times(counts.size(), std::vector<double>(words.size()));
    constexpr size_t kAtOnce = 64;
    for (size_t first = 0; first < words.size(); first += kAtOnce) {
      const auto part = std::span(words).subspan(first, std::min(kAtOnce, words.size() - first));
      const std::vector<Grammar> grammars = deriver.prepare(part);
      for (size_t n = 0; n < counts.size(); ++n) {
        deriver.setAxioms(axiomsOf(c, counts[n]));
        for (size_t i = 0; i < part.size(); ++i)
          times[n][first + i] = timeOf(deriver, grammars[i], references[n], name, options.repeat);
      }
    }
    for (size_t n = 0; n < counts.size(); ++n) {
      std::vector<double> on, off, difference;
      size_t faster = 0, distinct = 0;
      for (const auto& [a, b] : pairs) {
        if (!std::isfinite(times[n][a]) || !std::isfinite(times[n][b])) continue;
        on.push_back(times[n][a]);
        off.push_back(times[n][b]);
        difference.push_back(times[n][a] - times[n][b]);
        distinct += a != b;
        faster += times[n][a] < times[n][b];
      }
      const Mean h = meanOf(on), notH = meanOf(off), d = meanOf(difference);
      const double t = d.deviation > 0 ? d.mean / (d.deviation / std::sqrt(double(difference.size()))) : 0;
      std::printf(
          "| %s %s, %zu of %zu | %zu, %zu pairs differ | %u | %.2f | %.4f | %s (%.3f) | %s (%.3f) | %.2f | %.2f |\n",
          name, grammarName, decided.edges.size(), edges, kernels.size(), distinct, counts[n], t,
          pOf(t, double(std::max<size_t>(difference.size(), 2) - 1)), shown(h.mean).c_str(), h.deviation,
          shown(notH.mean).c_str(), notH.deviation, double(faster) / double(std::max<size_t>(distinct, 1)),
          notH.mean / h.mean);
      std::fflush(stdout);
    }
  }
}

// ---------------------------------------------------------------- table 4.2

void schedules(Session& session, const std::vector<Case>& cases, const Options& options) {
  std::printf("\n## Schedules (table 4.2): ms; OPT: the best of %u sampled schedules, s: seconds to find it\n\n",
              options.samples);
  std::printf(
      "| case | edges | axioms | terminals | CPU ms | interpreter | default | SGL (groups) | RW | DGN | OPTs (s) | "
      "OPTs,M (s) | OPTH (s) | OPTH,M (s) | default / best | CPU / best | GB/s |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  const bool subgroups = hasSubgroups(session.device());
  for (const Case& c : cases) {
    if (!options.wants("schedules", c.name)) continue;
    const BakedGraph grammar = grammarOf(c);
    const spawn::Flow flow = spawn::makeFlow(grammar.graph);
    size_t edges = 0;
    for (const auto& links : flow.out) edges += links.size();
    const uint32_t count = shareOf(options, c.axioms);
    const auto axioms = axiomsOf(c, count);
    const Reference reference = evaluate(grammar, axioms);
    DeriverOptions deriverOptions;
    deriverOptions.expected = reference.result.terminals;
    Deriver deriver(session, grammar, axioms, deriverOptions);
    const Grammar interpreted = deriver.prepare(std::pmr::vector<uint32_t>());
    const double interpreter = timeOf(deriver, interpreted, reference.result, c.name, options.repeat);
    const uint64_t bytes = deriver.bytesWritten();
    if (bytes < reference.result.terminals * sizeof(GpgpInstance))
      std::printf("(%s: the device binds fewer instances, %.0f %% are written)\n", c.name.c_str(),
                  100.0 * static_cast<double>(bytes) / static_cast<double>(reference.result.terminals) /
                      sizeof(GpgpInstance));

    // Named schedules are measured once for both searches, and each search's seconds hold them.
    std::map<std::string, double> named;
    double best = std::numeric_limits<double>::infinity();
    std::map<spawn::Search, std::string> columns[2];
    for (const bool matching : {false, true}) {
      Kernels kernels(grammar, subgroups, matching);
      std::vector<double> times;
      const auto measureNew = [&] { // those that were added last
        const auto words = kernels.compile(times.size());
        constexpr size_t kAtOnce = 64;
        for (size_t first = 0; first < words.size(); first += kAtOnce) {
          const auto grammars =
              deriver.prepare(std::span(words).subspan(first, std::min(kAtOnce, words.size() - first)));
          for (const Grammar& prepared : grammars) {
            const std::string& name = kernels.schedule(times.size()).name;
            times.push_back(timeOf(deriver, prepared, reference.result, c.name + " " + name, options.repeat));
            if (!matching) named.try_emplace(name, times.back());
          }
        }
      };
      const auto begin = Clock::now();
      for (const char* name : spawn::kScheduleNames) kernels.add(*spawn::namedSchedule(grammar.graph, name));
      measureNew();
      const double namedSeconds = secondsSince(begin);
      for (const spawn::Search search : {spawn::Search::random, spawn::Search::heuristic}) {
        const auto searchBegin = Clock::now();
        bool complete = false;
        std::vector<size_t> met;
        for (const spawn::Schedule& s : searchSchedules(grammar.graph, search, options.samples, 1, complete))
          met.push_back(kernels.add(s));
        measureNew();
        double fastest = std::numeric_limits<double>::infinity();
        for (const size_t kernel : met) fastest = std::min(fastest, times[kernel]);
        columns[matching][search] =
            " " + shown(fastest) + " (" + shown(namedSeconds + secondsSince(searchBegin)) + ") |";
        best = std::min(best, fastest);
      }
    }
    // A named schedule that waits where another one does has the same kernel.
    const auto timeOfNamed = [&](const char* name) {
      const auto wanted = *spawn::namedSchedule(grammar.graph, name);
      for (const char* other : spawn::kScheduleNames)
        if (named.contains(other) && spawn::namedSchedule(grammar.graph, other)->waits == wanted.waits)
          return named[other];
      return std::numeric_limits<double>::quiet_NaN();
    };
    const double usual = timeOfNamed("default");
    std::printf("| %s | %zu | %u | %llu | %s | %s | %s | %s (%zu) | %s | %s |%s %.2f | %.1f | %.0f |\n", c.name.c_str(),
                edges, count, static_cast<unsigned long long>(reference.result.terminals),
                shown(reference.milliseconds).c_str(), shown(interpreter).c_str(), shown(usual).c_str(),
                shown(timeOfNamed("sgl")).c_str(), spawn::namedSchedule(grammar.graph, "sgl")->groups,
                shown(timeOfNamed("rw")).c_str(), shown(timeOfNamed("rules")).c_str(),
                (columns[0][spawn::Search::random] + columns[1][spawn::Search::random] +
                 columns[0][spawn::Search::heuristic] + columns[1][spawn::Search::heuristic])
                    .c_str(),
                usual / best, reference.milliseconds / best, static_cast<double>(bytes) / best * 1e-6);
    std::fflush(stdout);
  }
}

// ---------------------------------------------------------------- figure 4.7

void partitions(Session& session, const std::vector<Case>& cases, const Options& options) {
  const Case& c = caseOf(cases, "menger_sponge_3");
  const BakedGraph grammar = grammarOf(c);
  const spawn::Flow flow = spawn::makeFlow(grammar.graph);
  const std::vector<uint32_t> counts =
      options.quick ? std::vector<uint32_t>{1} : std::vector<uint32_t>{1, shareOf(options, 16), shareOf(options, 256)};
  struct Row {
    size_t groups, kernel;
    std::vector<double> times;
  };
  std::vector<Row> rows;
  Kernels kernels(grammar, hasSubgroups(session.device()));
  spawn::PartitionEnumerator enumerator(flow);
  do {
    const auto schedule = scheduleOf(grammar.graph, flow, enumerator.roots(), std::to_string(rows.size()));
    rows.push_back({schedule.groups, kernels.add(schedule), {}});
  } while (enumerator.next());
  std::printf("\n## Partitions of the Menger sponge (figure 4.7): %zu valid ones, %zu kernels; ms\n\n| partition | "
              "execution groups | kernel |",
              rows.size(), kernels.size());
  for (const uint32_t count : counts) std::printf(" %u axioms |", count);
  std::printf("\n|---|---|---|%s\n", counts.size() == 1 ? "---|" : "---|---|---|");
  const auto words = kernels.compile();
  Deriver deriver(session, grammar, axiomsOf(c, 1), {});
  const std::vector<Grammar> grammars = deriver.prepare(words);
  for (const uint32_t count : counts) {
    const auto axioms = axiomsOf(c, count);
    const spawn::Derivation reference = evaluate(grammar, axioms).result;
    deriver.setAxioms(axioms);
    for (Row& row : rows)
      row.times.push_back(timeOf(deriver, grammars[row.kernel], reference, "partition", options.repeat));
  }
  for (size_t i = 0; i < rows.size(); ++i) {
    std::printf("| %zu | %zu | %zu |", i, rows[i].groups, rows[i].kernel);
    for (const double time : rows[i].times) std::printf(" %s |", shown(time).c_str());
    std::printf("\n");
  }
}

// ---------------------------------------------------------------- vertices, and the city

void vertices(Session& session, const std::vector<Case>& cases, const Options& options) {
  std::printf(
      "\n## Vertices of 32 bytes with 32-bit indices, default schedule (city: figure 4.1)\n\n"
      "| case | axioms | terminals | vertices | triangles | bytes | ms | GB/s | CPU evaluator ms | CPU / GPU |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Case& c : cases) {
    if (!options.wants("vertices", c.name)) continue;
    const BakedGraph grammar = grammarOf(c);
    uint32_t count = shareOf(options, c.axioms);
    DeriverOptions deriverOptions;
    deriverOptions.vertices = true;
    Deriver deriver(session, grammar, axiomsOf(c, count), deriverOptions);
    const spawn::Schedule schedule = *spawn::namedSchedule(grammar.graph, "default");
    const bool subgroups = hasSubgroups(session.device());
    const auto code = compileKernels(grammar.graph, std::span(&schedule, 1), subgroups, false);
    const Grammar prepared = deriver.prepare(kernelWords(grammar, kernelInfo(schedule, subgroups), code[0]));
    GpgpSpawnReport report = deriver.fit(prepared);
    while (report.verticesWritten < report.vertices && count > 1) { // fewer, where the device binds less
      count = static_cast<uint32_t>(0.95 * count * report.verticesWritten / report.vertices);
      deriver.setAxioms(axiomsOf(c, count));
      report = deriver.fit(prepared);
    }
    const Reference reference = evaluate(grammar, axiomsOf(c, count), true);
    const double time = timeOf(deriver, prepared, reference.result, c.name, options.repeat);
    const double bytes = static_cast<double>(deriver.bytesWritten());
    std::printf("| %s | %u | %u | %u | %u | %.0f | %s | %.0f | %s | %.1f |\n", c.name.c_str(), count, report.terminals,
                report.vertices, report.vertices / 2, bytes, shown(time).c_str(), bytes / time * 1e-6,
                shown(reference.milliseconds).c_str(), reference.milliseconds / time);
    std::fflush(stdout);
  }
}

// ---------------------------------------------------------------- curves

void curves(Session& session, const std::vector<Case>& cases, const Options& options) {
  std::printf("\n## Curves: default schedule, instances\n\n"
              "| case | axioms | terminals | ms | ns a terminal | GB/s | scratch MB | output MB | CPU / GPU |\n"
              "|---|---|---|---|---|---|---|---|---|\n");
  for (const Case& c : cases) {
    const bool usual = c.name == "mc_spaceship" || c.name == "city";
    if (!options.wants("curves", c.name) || (!usual && options.wants("curves", "mc_spaceship"))) continue;
    const BakedGraph grammar = grammarOf(c);
    const spawn::Schedule schedule = *spawn::namedSchedule(grammar.graph, "default");
    const bool subgroups = hasSubgroups(session.device());
    const auto code = compileKernels(grammar.graph, std::span(&schedule, 1), subgroups, false);
    Deriver deriver(session, grammar, axiomsOf(c, 1), {});
    const Grammar prepared = deriver.prepare(kernelWords(grammar, kernelInfo(schedule, subgroups), code[0]));
    for (uint32_t count = 10; count <= (options.quick ? 100u : 1000000u); count *= 10) {
      if (uint64_t{count} * sizeof(GpgpAxiom) > session.device().properties().limits.maxStorageBufferRange) break;
      const auto axioms = axiomsOf(c, count);
      deriver.setAxioms(axioms);
      const GpgpSpawnReport report = deriver.fit(prepared);
      if (report.instancesWritten < report.terminals) {
        std::printf("| %s | %u | %u | the device binds fewer instances | | | | | |\n", c.name.c_str(), count,
                    report.terminals);
        break;
      }
      const Reference reference = evaluate(grammar, axioms);
      const double time = timeOf(deriver, prepared, reference.result, c.name, options.repeat);
      GpgpMemoryReport memory = GPGP_MEMORY_REPORT_INIT;
      session.check(gpgpGetMemoryReport(session.context(), &memory), "gpgpGetMemoryReport");
      const double bytes = static_cast<double>(deriver.bytesWritten());
      std::printf("| %s | %u | %u | %s | %.2f | %.1f | %.0f | %.1f | %.1f |\n", c.name.c_str(), count, report.terminals,
                  shown(time).c_str(), time * 1e6 / report.terminals, bytes / time * 1e-6,
                  static_cast<double>(memory.services[GPGP_SERVICE_SPAWN].deviceBytes) * 1e-6, bytes * 1e-6,
                  reference.milliseconds / time);
      std::fflush(stdout);
    }
  }
}

int run(int argc, char** argv) {
  Options options;
  const auto number = [](const std::string& text) {
    return static_cast<uint32_t>(std::max(1, std::atoi(text.c_str())));
  };
  bool pairs = false, samples = false, repeat = false;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    const auto next = [&]() -> std::string { return i + 1 < argc ? argv[++i] : ""; };
    if (arg == "--repeat")
      options.repeat = number(next()), repeat = true;
    else if (arg == "--pairs")
      options.pairs = number(next()), pairs = true;
    else if (arg == "--samples")
      options.samples = std::max(5u, number(next())), samples = true;
    else if (arg == "--share")
      options.share = std::clamp(std::atof(next().c_str()), 0.0, 1.0);
    else if (arg == "--device")
      options.device = next();
    else if (arg == "--quick")
      options.quick = true;
    else
      options.tables.push_back(arg);
  }
  const std::vector<std::string> known = {"schedules", "vertices", "partitions", "curves", "heuristics"};
  for (const std::string& table : options.tables)
    if (std::find(known.begin(), known.end(), table.substr(0, table.find(':'))) == known.end()) {
      std::fprintf(stderr, "there is no table \"%s\"\n", table.c_str());
      return 2;
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
  using Table = void (*)(Session&, const std::vector<Case>&, const Options&);
  for (const auto& [name, table] : {std::pair<const char*, Table>{"schedules", schedules},
                                    {"vertices", vertices},
                                    {"partitions", partitions},
                                    {"curves", curves},
                                    {"heuristics", heuristics}}) {
    if (!options.wants(name)) continue;
    const auto begin = Clock::now();
    table(session, cases, options);
    std::printf("\n(%s: %.1f s)\n", name, secondsSince(begin));
    std::fflush(stdout);
  }
  return 0;
}
} // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "spawn_bench: %s\n", error.what());
    return 1;
  }
}
