// `gpgp graph`: the operator graph of a grammar and its schedules, as text or as a picture. Needs no GPU.
#include "cli/shared/command.h"
#include "cli/spawn/grammar_source.h"
#include "cli/tune/kernels.h"
#include "host/files.h"
#include "spawn/graph/export.h"
#include "spawn/graph/heuristics.h"
#include "spawn/graph/matching.h"
#include "spawn/language/print.h"

#include <cstdio>
#include <sstream>

namespace gpgp::cli {
namespace {

constexpr size_t kMostDrawn = 2000; // nodes; long edges through many layers are what takes the time

struct GraphOptions {
  std::string schedule, format = "text", out;
  std::vector<std::string> grammars, set;
  bool partitions = false;
  spawn::Heuristics heuristics;
  uint64_t limit = 1000000;
};

std::optional<spawn::Partition> schedule(const GraphOptions& options, const spawn::Graph& graph,
                                         const spawn::Flow& flow) {
  const std::string& name = options.schedule;
  if (name.empty()) return std::nullopt;
  if (name == "sgl") return makePartition(flow, coarsestPartition(flow));
  if (name == "rw") return makePartition(flow, singleGroups(flow));
  if (name == "rules") return makePartition(flow, rulePartition(graph, flow));
  if (name == "heuristic") return makePartition(flow, heuristicPartition(graph, flow, options.heuristics));
  if (!std::filesystem::exists(name))
    throw Usage("--schedule takes sgl, rw, rules, heuristic or a file with groups; there is no \"" + name + "\"");
  if (isBaked(name)) throw Failure(name + " is a baked grammar; expected groups, as gpgp graph prints them");
  spawn::Diagnostics diagnostics;
  auto partition = parseGroups(host::readText(name), graph, diagnostics);
  report(diagnostics, name);
  return partition;
}

Outcome drawGraph(const GraphOptions& options) {
  const BakedGraph grammar = bakeGraph(options.grammars, options.set);
  const spawn::Graph& graph = grammar.graph;
  const spawn::Flow flow = spawn::makeFlow(graph);
  const std::optional<spawn::Partition> partition = schedule(options, graph, flow);

  Outcome outcome;
  std::ostringstream summary;
  outcome.json = {{"grammar", jsonOf(options.grammars)}, {"nodes", graph.nodes.size()}, {"edges", graph.edges.size()}};
  summary << joined(options.grammars) << ": " << graph.nodes.size() << " nodes, " << graph.edges.size() << " edges\n";
  if (partition) {
    size_t fixed = 0, queued = 0;
    for (const spawn::Group& group : partition->groups) {
      fixed += group.staticEdges.size();
      queued += group.dynamicEdges.size();
    }
    const size_t classes = matchGroups(graph, *partition).classes.size();
    outcome.json.update({{"schedule", options.schedule},
                         {"execution_groups", partition->groups.size()},
                         {"group_classes", classes},
                         {"static_edges", fixed},
                         {"dynamic_edges", queued}});
    summary << options.schedule << ": " << partition->groups.size() << " execution groups of " << classes << " kinds, "
            << fixed << " static and " << queued << " dynamic edges\n";
  }
  if (options.partitions) {
    const uint64_t count = countPartitions(flow, options.limit);
    const auto groups = [&](const spawn::Roots& roots) { return makePartition(flow, roots).groups.size(); };
    const Json named = {{"sgl", groups(coarsestPartition(flow))},
                        {"rw", groups(singleGroups(flow))},
                        {"rules", groups(rulePartition(graph, flow))},
                        {"heuristic", groups(heuristicPartition(graph, flow, options.heuristics))}};
    outcome.json.update({{"partitions", count}, {"partitions_complete", count < options.limit}, {"groups", named}});
    summary << count << (count < options.limit ? "" : " or more") << " valid partitions; groups:";
    for (const auto& [name, size] : named.items()) summary << ' ' << name << ' ' << size;
    summary << '\n';
  }

  std::string drawing;
  if (options.format == "dot") {
    drawing = exportDot(graph, partition ? &*partition : nullptr);
  } else if (options.format == "svg") {
    if (graph.nodes.size() > kMostDrawn)
      throw Failure(joined(options.grammars) + ": more than " + std::to_string(kMostDrawn) +
                    " nodes are too many to draw; take --format dot");
    drawing = exportSvg(graph, partition ? &*partition : nullptr);
  } else {
    drawing = printGraph(graph) + (partition ? printGroups(*partition) : std::string());
  }
  outcome.text = drawing;
  if (!options.out.empty()) {
    host::writeFile(options.out, drawing);
    outcome.json["out"] = options.out;
    summary << "written: " << options.out << '\n';
  }
  if (!options.out.empty() || options.partitions) outcome.text = summary.str();
  return outcome;
}

} // namespace

Work addGraph(CLI::App& app) {
  auto options = std::make_shared<GraphOptions>();
  CLI::App* command = app.add_subcommand("graph", "Show the operator graph of a grammar and its schedules");
  addGrammars(*command, options->grammars);
  addVariables(*command, options->set);
  command
      ->add_option("--schedule", options->schedule,
                   "Execution groups: sgl (as few as possible; with colliders, as few as a bounded search finds), rw "
                   "(one per node), rules (one per rule), heuristic, or a "
                   "file with groups")
      ->type_name("NAME|FILE");
  addGroupSize(*command, options->heuristics);
  command->add_option("--format", options->format, "text, dot or svg")
      ->check(CLI::IsMember({"text", "dot", "svg"}))
      ->capture_default_str();
  command->add_flag("--partitions", options->partitions,
                    "Count the valid partitions and the groups of each schedule, instead of printing the graph");
  command->add_option("--limit", options->limit, "--partitions: where to stop counting")
      ->check(CLI::Range(uint64_t(1), uint64_t(1) << 40))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "Write the graph to a file")->type_name("FILE");
  command->footer(R"(
Examples:
  gpgp graph sponge.pga                                      the graph as text
  gpgp graph sponge.pga --schedule heuristic > sponge.txt    with its execution groups; edit them, then
  gpgp graph sponge.pga --schedule sponge.txt --format svg -o sponge.svg
  gpgp graph sponge.pga --partitions                         how many schedules there are)");
  return [options](const CommonOptions&) { return drawGraph(*options); };
}

} // namespace gpgp::cli
