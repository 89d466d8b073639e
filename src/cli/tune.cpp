// `gpgp tune`: finds the fastest schedule of a grammar on a device, by measuring, and bakes it.
//
// First schedules (which edges are static), each with the device's usual numbers; then, for the best ones, the numbers
// (size and count of workgroups, when work is spread). Every candidate must derive what the interpreter derives. The
// kernel is stored behind the graph with the device and the number of axioms that it was tuned for; tuning again for
// other devices or numbers adds to the same file.
#include "cli/command.h"
#include "cli/progress.h"
#include "cli/session.h"
#include "host/files.h"
#include "host/memory.h"
#include "spawn/codegen/compile_kernel.h"
#include "spawn/codegen/generate.h"
#include "spawn/codegen/schedules.h"
#include "spawn/graph/blob.h"
#include "spawn/graph/kernel.h"
#include "spawn/language/build_graph.h"

#include <gpgp/gpgp.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <thread>

namespace gpgp::cli {
namespace {

struct TuneOptions {
  std::string grammar, out, search = "heuristic";
  uint32_t axioms = 256, seed = 1, samples = 12, repeat = 15;
  std::array<float, 3> size{1, 1, 1};
  bool schedulesOnly = false;
};

/// A schedule with numbers, and what it took.
struct Candidate {
  size_t schedule = 0; ///< in the list of kernels
  spawn::Fit fit;
  double milliseconds = std::numeric_limits<double>::infinity(); ///< it does not fit the default budgets
  uint32_t rounds = 0;
};

spawn::Graph compileGraph(const TuneOptions& options) {
  spawn::Diagnostics diagnostics;
  spawn::Graph graph =
      spawn::compile(host::readText(options.grammar), {}, diagnostics, std::pmr::new_delete_resource());
  for (const spawn::Diagnostic& d : diagnostics.sorted())
    std::fprintf(stderr, "%s\n", spawn::format(d, options.grammar).c_str());
  if (diagnostics.hasErrors()) throw Failure(options.grammar + " has errors");
  if (const auto ok = spawn::validate(graph); !ok) throw Failure(options.grammar + ": " + ok.error().text);
  return graph;
}

/// Whether the library takes kernels that need subgroup operations on this device.
bool hasSubgroups(const host::HeadlessDevice& device) {
  VkPhysicalDeviceSubgroupProperties subgroups{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroups};
  device.vki().getPhysicalDeviceProperties2(device.physicalDevice(), &properties);
  constexpr VkSubgroupFeatureFlags kWanted = VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT;
  return (subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) &&
         (subgroups.supportedOperations & kWanted) == kWanted;
}

/// All kernels, on all processors.
std::vector<std::vector<uint32_t>> compileKernels(const spawn::Graph& graph, const std::vector<spawn::Schedule>& all,
                                                  bool subgroups) {
  std::vector<std::vector<uint32_t>> kernels(all.size());
  std::vector<std::string> errors(all.size());
  std::atomic<size_t> next{0};
  const auto work = [&] {
    for (size_t i = next++; i < all.size(); i = next++) {
      auto spirv = spawn::compileKernel(spawn::generate(graph, all[i].waits), subgroups);
      if (spirv)
        kernels[i] = std::move(*spirv);
      else
        errors[i] = spirv.error().text;
    }
  };
  std::vector<std::thread> threads;
  for (uint32_t t = 1; t < std::max(1u, std::thread::hardware_concurrency()); ++t) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  for (const std::string& error : errors)
    if (!error.empty()) throw Failure(error);
  return kernels;
}

class Tuner {
public:
  Tuner(Session& session, const TuneOptions& options, bool subgroups, std::pmr::vector<uint32_t> words)
      : session_(session), options_(options), subgroups_(subgroups), words_(std::move(words)) {
    GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
    info.base = session.workerInfo("tuner");
    if (words_[shader::kHeaderPhases]) info.maxColliders = 8192;
    spawner_.emplace(session.take(Spawner::create(session.context(), info), "gpgpCreateSpawner"));
    session.check(spawner_->prewarm(), "gpgpPrewarm");
    axioms_.emplace(host::makeBuffer(session.device(), axiomList(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "axioms"));
    // As many instances as come out, found by deriving into a small buffer.
    instances_.emplace(session.device(), sizeof(GpgpInstance), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const auto first = derive({}, 1);
    wanted_ = first.report;
    if (wanted_.droppedShapes || wanted_.unfinishedShapes || wanted_.collidersKept < wanted_.colliders)
      throw Failure("the derivation exceeds the budgets; use fewer axioms");
    if (!wanted_.terminals) throw Failure("the grammar derives nothing from these axioms");
    const VkDeviceSize bytes = std::min<VkDeviceSize>(VkDeviceSize{wanted_.terminals} * sizeof(GpgpInstance),
                                                      session.device().properties().limits.maxStorageBufferRange);
    instances_.emplace(session.device(), bytes / sizeof(GpgpInstance) * sizeof(GpgpInstance),
                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    interpreter = settled({});
  }

  /// Measures a kernel; throws where it does not derive what the interpreter does.
  void measure(Candidate& candidate, const spawn::Schedule& schedule, const std::vector<uint32_t>& spirv) {
    const auto kernel = baked(candidate, schedule, spirv, false);
    const GpgpSpawnReport r = derive(kernel, 1).report;
    if (r.droppedShapes) return; // reported by the GPU: with this schedule the budgets are too small
    if (r.terminals != wanted_.terminals || r.keyHash[0] != wanted_.keyHash[0] || r.keyHash[1] != wanted_.keyHash[1])
      throw Failure("schedule \"" + schedule.name + "\" derives something else than the interpreter: " +
                    std::to_string(r.terminals) + " terminals instead of " + std::to_string(wanted_.terminals));
    candidate.milliseconds = settled(kernel);
    candidate.rounds = r.rounds;
  }

  /// The kernel as it is stored: for this device and number of axioms, with one round to spare; or for measuring.
  std::pmr::vector<uint32_t> baked(const Candidate& candidate, const spawn::Schedule& schedule,
                                   const std::vector<uint32_t>& spirv, bool store) const {
    spawn::KernelInfo info;
    info.fit = candidate.fit;
    info.subgroups = subgroups_;
    if (store) {
      info.vendor = session_.device().properties().vendorID;
      info.device = session_.device().properties().deviceID;
      info.axioms = options_.axioms;
    }
    std::snprintf(info.schedule, sizeof info.schedule, "%s", schedule.name.c_str());
    return spawn::serialize(info, spirv, words_[shader::kHeaderChecksum], std::pmr::new_delete_resource());
  }

  double interpreter = 0; ///< milliseconds
  const GpgpSpawnReport& wanted() const { return wanted_; }
  const std::pmr::vector<uint32_t>& words() const { return words_; }

private:
  /// Milliseconds, the median of the second half of at least 2 * repeat derivations and of at least 0.1 s of them:
  /// while a kernel was compiled the device idled, and its clock takes time to come back.
  double settled(std::span<const uint32_t> kernel) {
    const double once = derive(kernel, 3).times.median();
    const double wanted = std::clamp(100.0 / std::max(once, 0.01), 2.0 * options_.repeat, 2000.0);
    std::vector<double> times = derive(kernel, static_cast<uint32_t>(wanted)).times.totals;
    times.erase(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2));
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
    return times[times.size() / 2];
  }
  Measured<GpgpSpawnReport> derive(std::span<const uint32_t> kernel, uint32_t repeat) {
    std::vector<uint32_t> all(words_.begin(), words_.end());
    all.insert(all.end(), kernel.begin(), kernel.end());
    GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
    info.label = options_.grammar.c_str();
    info.data = all.data();
    info.size = all.size() * 4;
    const Grammar grammar = session_.take(Grammar::create(session_.context(), info), "gpgpCreateGrammar");
    session_.check(spawner_->prewarm(grammar), "gpgpPrewarmGrammar");
    session_.upload();
    return session_.measure(*spawner_, "measuring", repeat,
                            [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordInfo& base) {
                              GpgpSpawnInfo spawn = GPGP_SPAWN_INFO_INIT;
                              spawn.base = base;
                              spawn.grammar = grammar;
                              spawn.axioms = axioms_->range();
                              spawn.axiomCount = options_.axioms;
                              spawn.instances = instances_->range();
                              return spawner_->recordPrepare(commands, frame, spawn);
                            });
  }
  std::vector<GpgpAxiom> axiomList() const {
    std::vector<GpgpAxiom> axioms(options_.axioms);
    for (uint32_t i = 0; i < options_.axioms; ++i) {
      GpgpAxiom& axiom = axioms[i];
      axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1.0f;
      std::copy(options_.size.begin(), options_.size.end(), axiom.size);
      axiom.seed = options_.seed + i;
      axiom.id = i;
      axiom.rule = GPGP_AXIOM_DEFAULT_RULE;
      axiom.attribute = std::nanf("");
    }
    return axioms;
  }

  Session& session_;
  const TuneOptions& options_;
  const bool subgroups_;
  std::pmr::vector<uint32_t> words_;
  std::optional<Spawner> spawner_;
  std::optional<host::Buffer> axioms_, instances_;
  GpgpSpawnReport wanted_{};
};

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

Outcome tune(const TuneOptions& options, const CommonOptions& common) {
  const auto begin = std::chrono::steady_clock::now();
  const spawn::Graph graph = compileGraph(options);
  const auto search = options.search == "exhaustive" ? spawn::Search::exhaustive
                      : options.search == "random"   ? spawn::Search::random
                                                     : spawn::Search::heuristic;
  bool complete = false;
  const std::vector<spawn::Schedule> schedules =
      searchSchedules(graph, search, options.samples, options.seed, complete);
  Session session(common);
  const bool subgroups = hasSubgroups(session.device());
  const auto kernels = compileKernels(graph, schedules, subgroups);
  Tuner tuner(session, options, subgroups, spawn::serialize(graph, std::pmr::new_delete_resource()));

  std::vector<Candidate> measured;
  const auto measureAll = [&](std::vector<Candidate> list, const char* label) {
    Progress progress(label, list.size());
    for (Candidate& candidate : list) {
      tuner.measure(candidate, schedules[candidate.schedule], kernels[candidate.schedule]);
      measured.push_back(candidate);
      progress.advance();
    }
    std::sort(measured.begin(), measured.end(),
              [](const Candidate& a, const Candidate& b) { return a.milliseconds < b.milliseconds; });
  };
  std::vector<Candidate> list;
  for (size_t i = 0; i < schedules.size(); ++i) list.push_back({i});
  measureAll(list, "schedules");
  Json scheduleList = Json::array();
  for (const Candidate& c : measured)
    scheduleList.push_back({{"schedule", schedules[c.schedule].name},
                            {"execution_groups", schedules[c.schedule].groups},
                            {"gpu_ms_median", std::isfinite(c.milliseconds) ? Json(c.milliseconds) : Json()}});
  std::ostringstream text;
  text << options.grammar << ": " << tuner.wanted().terminals << " terminals from " << options.axioms << " axioms on "
       << session.device().name() << "\n  " << milliseconds(tuner.interpreter) << "  interpreter\n";
  for (const Candidate& c : measured)
    text << "  " << (std::isfinite(c.milliseconds) ? milliseconds(c.milliseconds) : "exceeds the budgets") << "  "
         << schedules[c.schedule].name << '\n';
  // Two schedules are enough for the numbers: what is behind them now hardly wins by them.
  const std::vector<Candidate> leaders(measured.begin(),
                                       measured.begin() + std::min<size_t>(2, static_cast<size_t>(measured.size())));
  list.clear();
  if (!options.schedulesOnly)
    for (const Candidate& leader : leaders)
      for (const spawn::Fit& fit : fits(session.device().isSoftware())) list.push_back({leader.schedule, fit});
  measureAll(list, "numbers");
  Candidate best = measured.front();
  if (!std::isfinite(best.milliseconds)) throw Failure("no schedule fits the default budgets; use fewer axioms");
  best.fit.rounds = best.rounds + 1; // one to spare, as it is stored: empty rounds cost time as well
  tuner.measure(best, schedules[best.schedule], kernels[best.schedule]);
  const spawn::Schedule& schedule = schedules[best.schedule];

  if (!options.out.empty()) {
    const auto kernel = tuner.baked(best, schedule, kernels[best.schedule], true);
    std::vector<uint32_t> all(tuner.words().begin(), tuner.words().end());
    // What is there already for this graph stays, but for the same device and number of axioms.
    if (std::filesystem::exists(options.out)) {
      const std::string old = host::readText(options.out);
      const auto bytes = std::as_bytes(std::span(old.data(), old.size()));
      const size_t graphBytes = spawn::sizeOfGraph(bytes);
      if (graphBytes == all.size() * 4 && std::memcmp(old.data(), all.data(), graphBytes) == 0) {
        const auto others = spawn::loadKernels(bytes.subspan(graphBytes), all[shader::kHeaderChecksum],
                                               std::pmr::new_delete_resource());
        if (!others) throw Failure(options.out + ": " + others.error().text);
        const auto& p = session.device().properties();
        for (const spawn::Kernel& other : *others) {
          if (other.info.vendor == p.vendorID && other.info.device == p.deviceID && other.info.axioms == options.axioms)
            continue;
          const auto words =
              spawn::serialize(other.info, other.spirv, all[shader::kHeaderChecksum], std::pmr::new_delete_resource());
          all.insert(all.end(), words.begin(), words.end());
        }
      } else {
        throw Failure(options.out + " exists and is not a baking of this grammar");
      }
    }
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(tuner.words().size()), kernel.begin(), kernel.end());
    host::writeFile(options.out, {reinterpret_cast<const char*>(all.data()), all.size() * 4});
  }
  session.checkValidation();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  text << "best: " << milliseconds(best.milliseconds) << " by " << schedule.name;
  if (best.fit.groupSize)
    text << ", " << best.fit.maxGroups << " workgroups of " << best.fit.groupSize << ", work is given away below "
         << best.fit.spread << " shapes";
  text << "; " << measured.size() << " candidates in " << std::round(seconds * 10) / 10 << " s\n";
  Outcome outcome;
  outcome.text = text.str();
  outcome.json = {{"grammar", options.grammar},
                  {"device", session.device().name()},
                  {"axioms", options.axioms},
                  {"terminals", tuner.wanted().terminals},
                  {"search", options.search},
                  {"complete", complete},
                  {"interpreter_ms", tuner.interpreter},
                  {"schedules", scheduleList},
                  {"best",
                   {{"schedule", schedule.name},
                    {"gpu_ms_median", best.milliseconds},
                    {"group_size", best.fit.groupSize},
                    {"groups", best.fit.maxGroups},
                    {"stack_shapes", best.fit.stackShapes},
                    {"spread", best.fit.spread},
                    {"rounds", best.rounds}}},
                  {"candidates", measured.size()},
                  {"seconds", seconds},
                  {"out", options.out.empty() ? Json() : Json(options.out)}};
  return outcome;
}

} // namespace

Work addTune(CLI::App& app) {
  auto options = std::make_shared<TuneOptions>();
  CLI::App* command = app.add_subcommand("tune", "Find the fastest schedule of a grammar on this device");
  command->add_option("GRAMMAR", options->grammar, "PGA-shape grammar text (.pga)")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--axioms", options->axioms, "Start shapes to tune for")
      ->check(CLI::Range(1u, 1000000u))
      ->capture_default_str();
  command
      ->add_option_function<std::string>(
          "--axiom-size", [o = options.get()](const std::string& t) { o->size = parseTriple(t); },
          "Extents of each start shape in metres (default 1,1,1)")
      ->type_name("X,Y,Z");
  command->add_option("--seed", options->seed, "Random seed; axiom i has seed S + i")->capture_default_str();
  command->add_option("--search", options->search, "Which schedules are tried beside the named ones")
      ->check(CLI::IsMember({"exhaustive", "random", "heuristic"}))
      ->capture_default_str();
  command->add_option("--samples", options->samples, "Schedules tried at most")
      ->check(CLI::Range(5u, 10000u))
      ->capture_default_str();
  command->add_option("--repeat", options->repeat, "Derivations measured for each candidate")
      ->check(CLI::Range(3u, 1000u))
      ->capture_default_str();
  command->add_flag("--schedules-only", options->schedulesOnly, "Leave sizes and counts as the device suggests");
  command
      ->add_option("-o,--out", options->out,
                   "Baked grammar with the winning kernel; kernels in it for other devices stay")
      ->type_name("FILE");
  command->footer(R"(
Examples:
  gpgp tune tower.pga --axioms 256 --axiom-size 24,34,24 -o tower.gpgpg
  gpgp tune sponge.pga --axioms 256 --search exhaustive --json | jq .best

Every candidate must derive exactly what the interpreter derives. Times are medians of GPU timestamps.)");
  return [options](const CommonOptions& common) { return tune(*options, common); };
}

} // namespace gpgp::cli
