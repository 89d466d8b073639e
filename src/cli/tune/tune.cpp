// `gpgp tune`: finds the fastest schedule of a grammar on a device and keeps its kernel, baked behind the graph.
#include "cli/shared/command.h"
#include "cli/spawn/axioms.h"
#include "cli/spawn/fields.h"
#include "cli/spawn/grammar_source.h"
#include "cli/spawn/reference.h"
#include "cli/tune/tuner.h"

#include <cmath>
#include <sstream>

namespace gpgp::cli {
namespace {

struct TuneOptions {
  std::string axiomFile, out, search = "auto", matching = "off", queues = "both";
  std::vector<std::string> grammars, set, fields;
  uint32_t axioms = 256;
  std::array<float, 3> size{1, 1, 1};
  TuneSettings settings;
};

Outcome tune(const TuneOptions& options, const CommonOptions& common) {
  const BakedGraph grammar = bakeGraph(options.grammars, options.set);
  TuneSettings settings = options.settings;
  settings.matching = options.matching == "on";
  settings.mixed = options.queues != "group";
  settings.grouped = options.queues != "mixed";
  if (options.search == "exhaustive") settings.search = spawn::Search::exhaustive;
  if (options.search == "random") settings.search = spawn::Search::random;
  if (options.search == "heuristic") settings.search = spawn::Search::heuristic;
  const std::filesystem::path out =
      options.out.empty() ? tunedFile(options.grammars, grammar) : std::filesystem::path(options.out);
  // Read now: what cannot be kept is said before the search rather than after it.
  const auto others = storedKernels(out, grammar, options.out.empty());
  checkWritable(out);
  const AxiomDefaults defaults{options.size, settings.seed, grammar.starts()};
  const std::vector<GpgpAxiom> axioms = options.axiomFile.empty()
                                            ? axiomGrid(options.axioms, 0, defaults)
                                            : readAxioms(options.axiomFile, grammar.namedStarts(), defaults);
  const WorldFields fields(options.fields, grammar.graph);
  fields.give(settings.derive);
  checkThatItEnds(grammar.words, axioms, settings.derive.maxDepth, joined(options.grammars),
                  {nullptr, &fields.bound()});
  Session session(common);
  const Tuned tuned = tuneGrammar(session, grammar, axioms, settings);
  keepKernel(out, grammar, tuned.info, tuned.code, others);
  session.checkValidation();

  const spawn::Schedule& schedule = tuned.schedule();
  const Candidate& best = tuned.best;
  Json scheduleList = Json::array();
  std::ostringstream text;
  text << joined(options.grammars) << ": " << tuned.report.terminals << " terminals from " << axioms.size()
       << " axioms on " << session.device().name() << "\n  " << milliseconds(tuned.interpreter) << "  interpreter\n";
  for (const Candidate& c : tuned.measured) {
    const bool fits = std::isfinite(c.milliseconds);
    scheduleList.push_back({{"schedule", tuned.schedules[c.schedule].name},
                            {"execution_groups", tuned.schedules[c.schedule].groups},
                            {"gpu_ms_median", fits ? Json(c.milliseconds) : Json()},
                            {"needs_larger_budgets", !fits}});
    text << "  " << (fits ? milliseconds(c.milliseconds) : "needs larger budgets") << "  "
         << tuned.schedules[c.schedule].name << '\n';
  }
  text << "best: " << milliseconds(best.milliseconds) << " by " << schedule.name;
  if (best.fit.groupSize)
    text << ", " << best.fit.maxGroups << " workgroups of " << best.fit.groupSize << ", work is given away below "
         << best.fit.spread << " shapes" << (best.fit.balances ? " and to idle workgroups" : "");
  text << "; " << tuned.candidates << (tuned.candidates == 1 ? " candidate in " : " candidates in ")
       << std::round(tuned.seconds * 10) / 10 << " s";
  if (options.search == "exhaustive" && !tuned.complete) text << ", not of all partitions (--samples, --seconds)";
  if (tuned.omitted) text << "; " << tuned.omitted << " were left out for lack of time";
  if (tuned.interpreter < best.milliseconds)
    text << "\nthe interpreter is faster than any kernel: spawn --schedule interpreter, bake --no-kernel";
  text << "\nkept: " << out.string() << '\n';
  Outcome outcome;
  outcome.text = text.str();
  outcome.json = {{"grammar", jsonOf(options.grammars)},
                  {"device", session.device().name()},
                  {"axioms", axioms.size()},
                  {"terminals", tuned.report.terminals},
                  {"search", options.search},
                  {"matching", settings.matching},
                  {"complete", tuned.complete},
                  {"interpreter_ms", tuned.interpreter},
                  {"schedules", scheduleList},
                  {"best",
                   {{"schedule", schedule.name},
                    {"queues", schedule.queues == spawn::Queues::groups ? "group" : "mixed"},
                    {"execution_groups", schedule.groups},
                    {"gpu_ms_median", best.milliseconds},
                    {"group_size", best.fit.groupSize},
                    {"groups", best.fit.maxGroups},
                    {"stack_shapes", best.fit.stackShapes},
                    {"spread", best.fit.spread},
                    {"balances", best.fit.balances == 1},
                    {"rounds", best.rounds}}},
                  {"candidates", tuned.candidates},
                  {"left_out", tuned.omitted},
                  {"seconds", tuned.seconds},
                  {"out", out.string()}};
  return outcome;
}

} // namespace

Work addTune(CLI::App& app) {
  auto options = std::make_shared<TuneOptions>();
  TuneSettings& settings = options->settings;
  CLI::App* command = app.add_subcommand("tune", "Find the fastest schedule of a grammar on this device");
  addGrammars(*command, options->grammars);
  CLI::Option* axioms =
      command->add_option("--axioms", options->axioms, "Start shapes to tune for; linked grammars take turns")
          ->check(CLI::Range(1u, 1000000u))
          ->capture_default_str();
  command->add_option("--axiom-file", options->axiomFile, "Start shapes from a file, as `gpgp spawn` takes it")
      ->check(CLI::ExistingFile)
      ->excludes(axioms);
  command
      ->add_option_function<std::string>(
          "--axiom-size", [o = options.get()](const std::string& t) { o->size = parseTriple(t); },
          "Extents of each start shape in metres (default 1,1,1)")
      ->type_name("X,Y,Z");
  addVariables(*command, options->set);
  addFields(*command, options->fields);
  command->add_option("--seed", settings.seed, "Random seed, of the search too; axiom i has seed S + i")
      ->capture_default_str();
  command
      ->add_option("--search", options->search,
                   "Which schedules are tried beside the named ones: every valid partition, random ones, or those of "
                   "the heuristics, with random choices where they leave edges open. auto: all of them if they are "
                   "few, otherwise some of both, and then neighbours of the best")
      ->check(CLI::IsMember({"auto", "exhaustive", "random", "heuristic"}))
      ->capture_default_str();
  addGroupSize(*command, settings.heuristics);
  command
      ->add_option("--matching", options->matching, "Execution groups that differ only in parameters share their code")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  addQueues(*command, options->queues, "; both: the fastest schedules are tried with either");
  command->add_option("--samples", settings.samples, "Schedules tried at most, the named ones included")
      ->check(CLI::Range(5u, 10000u))
      ->capture_default_str();
  command->add_option("--repeat", settings.repeat, "Derivations measured for each candidate")
      ->check(CLI::Range(3u, 1000u))
      ->capture_default_str();
  command
      ->add_option("--seconds", settings.seconds,
                   "Time budget: candidates that would probably take longer are left out, slow derivations are "
                   "measured less often, and "
                   "the best so far is kept. The interpreter and one schedule are always measured, which takes a "
                   "software device some seconds; 0: no limit")
      ->check(within(0.0, 86400.0))
      ->capture_default_str();
  command->add_option("--max-depth", settings.derive.maxDepth,
                      "Budget: recursion depth of rules (0: the library's default)");
  command->add_flag("--schedules-only", settings.schedulesOnly, "Leave sizes and counts as the device suggests");
  command
      ->add_option("-o,--out", options->out,
                   "Baked grammar with the winning kernel; kernels in it for other devices or numbers of axioms stay "
                   "(default: where `gpgp spawn --schedule tuned` looks, in $XDG_CACHE_HOME/gpgp or ~/.cache/gpgp)")
      ->type_name("FILE");
  command->footer(R"(
Examples:
  gpgp tune tower.pga --axioms 256 --axiom-size 24,34,24 -o tower.gpgp
  gpgp tune sponge.pga --axioms 256 --search exhaustive --matching on --json | jq .best

Every candidate must derive exactly what the interpreter derives. Times are medians of GPU timestamps.)");
  return [options](const CommonOptions& common) { return tune(*options, common); };
}

} // namespace gpgp::cli
