#include "spawn/codegen/schedules.h"

#include "spawn/codegen/table.h"

#include <algorithm>

namespace gpgp::spawn {
namespace {
/// Partitions that an exhaustive search looks at; beyond, the space is not for it.
constexpr uint64_t kMostPartitions = 1u << 20;

/// Calls for each edge of a node that leads somewhere.
template <class Call> void forEdges(const Graph& graph, uint32_t node, const Call& call) {
  for (uint32_t e = 0; e < graph.nodes[node].edgeCount; ++e) {
    const Edge& edge = graph.edges[graph.nodes[node].firstEdge + e];
    if (edge.target != kNoNode) call(edge);
  }
}

/// The nodes that shapes of one axiom come to any number of times: those behind an operator that makes as many shapes
/// as the shape's size says, and those in and behind cycles.
std::vector<bool> reachedOften(const Graph& graph) {
  std::vector<bool> often(graph.nodes.size());
  std::vector<uint32_t> open;
  const auto reach = [&](const Edge& edge) {
    if (!often[edge.target]) open.push_back(edge.target);
    often[edge.target] = true;
  };
  for (uint32_t n = 0; n < graph.nodes.size(); ++n)
    forEdges(graph, n, [&](const Edge& edge) {
      if (edge.recursive || (multiplies(graph.nodes[n]) && !multipliesByKnown(graph.nodes[n]))) reach(edge);
    });
  while (!open.empty()) {
    const uint32_t node = open.back();
    open.pop_back();
    forEdges(graph, node, reach);
  }
  return often;
}

/// Marks the SubDivs that shapes come to from a SubDiv by what a family can hold.
void markInner(const Graph& graph, uint32_t subDiv, std::vector<bool>& inner) {
  std::vector<bool> seen(graph.nodes.size());
  std::vector<uint32_t> open{subDiv};
  while (!open.empty()) {
    const uint32_t node = open.back();
    open.pop_back();
    forEdges(graph, node, [&](const Edge& edge) {
      if (edge.recursive || seen[edge.target]) return;
      seen[edge.target] = true;
      const Node& target = graph.nodes[edge.target];
      if (target.op == shader::kOpSubDiv && multiplies(target))
        inner[edge.target] = true;
      else if (isOfFrames(target.op) || multipliesByKnown(target))
        open.push_back(edge.target);
    });
  }
}

/// Shapes wait where they must, and for a SubDiv behind another one on static edges: families make every child from the
/// start, and the outer one's pieces again for each piece of the inner one. Those are few where an axiom has only as
/// many shapes as the grammar says, and to wait there costs more; but families that outgrow a workgroup do so as well,
/// and only uneven derivations have large workgroups. Where few programs make all children, that is quicker than to
/// wait.
Schedule defaultSchedule(const Graph& graph, const Flow& flow) {
  Schedule schedule{"default", 0, std::vector<bool>(graph.nodes.size()), {}};
  std::vector<bool> comesBack(graph.nodes.size()), often = reachedOften(graph);
  for (uint32_t n = 0; n < graph.nodes.size(); ++n) {
    if (graph.nodes[n].op == shader::kOpSubDiv && multiplies(graph.nodes[n])) markInner(graph, n, schedule.waits);
    forEdges(graph, n, [&](const Edge& edge) {
      if (edge.recursive) comesBack[edge.target] = true;
    });
  }
  const bool uneven = isUneven(graph);
  const std::vector<bool> none(graph.nodes.size());
  if (makeTable(graph, none).programs.size() <= kMostPrograms) schedule.waits = none;
  std::vector<bool> isStatic(graph.edges.size());
  for (uint32_t n = 0; n < graph.nodes.size(); ++n) {
    const Node& node = graph.nodes[n];
    schedule.waits[n] = schedule.waits[n] && (often[n] || !uneven);
    const bool waits = multiplies(node) && (schedule.waits[n] || comesBack[n] || !multipliesByKnown(node));
    for (const Link& link : flow.in[n]) isStatic[link.edge] = !waits;
  }
  schedule.groups = groupCount(flow, realise(flow, isStatic));
  return schedule;
}
} // namespace

Schedule scheduleOf(const Graph& graph, const Flow& flow, const Roots& roots, std::string name) {
  Schedule schedule{std::move(name), groupCount(flow, roots), std::vector<bool>(graph.nodes.size()), roots};
  for (const uint32_t n : flow.order) // what ends at a terminal is through: it needs no queue to be written
    schedule.waits[n] = roots[n] == n && graph.nodes[n].op != shader::kOpTerminal;
  // The start is where axioms arrive; nothing waits for it but shapes that come back to it.
  return schedule;
}

Schedule withQueues(Schedule schedule) {
  schedule.queues = Queues::groups;
  schedule.name = schedule.name.substr(0, 23) + ", queues"; // names fit a kernel's
  return schedule;
}

KernelSource sourceOf(const Graph& graph, const Schedule& schedule, bool matching) {
  return generate(graph, schedule.waits, matching ? schedule.roots : Roots{}, schedule.queues);
}

std::optional<Schedule> namedSchedule(const Graph& graph, const std::string& name, const Heuristics& heuristics) {
  const Flow flow = makeFlow(graph);
  if (name == "default") return defaultSchedule(graph, flow);
  if (name == "sgl") return scheduleOf(graph, flow, coarsestPartition(flow), name);
  if (name == "rw") return scheduleOf(graph, flow, singleGroups(flow), name);
  if (name == "rules") return scheduleOf(graph, flow, rulePartition(graph, flow), name);
  if (name == "heuristic") return scheduleOf(graph, flow, heuristicPartition(graph, flow, heuristics), name);
  return std::nullopt;
}

std::vector<Schedule> searchSchedules(const Graph& graph, Search search, size_t limit, uint32_t seed, bool& complete,
                                      const Heuristics& heuristics) {
  std::vector<Schedule> found;
  const auto add = [&](Schedule schedule) {
    const bool known =
        std::any_of(found.begin(), found.end(), [&](const Schedule& s) { return s.waits == schedule.waits; });
    if (!known && found.size() < limit) found.push_back(std::move(schedule));
    return !known;
  };
  for (const char* name : kScheduleNames) add(*namedSchedule(graph, name, heuristics));
  const Flow flow = makeFlow(graph);
  complete = false;
  if (search == Search::exhaustive) {
    PartitionEnumerator enumerator(flow);
    uint64_t seen = 0;
    do {
      add(scheduleOf(graph, flow, enumerator.roots(), "partition " + std::to_string(seen)));
      ++seen;
      complete = !enumerator.next();
    } while (!complete && seen < kMostPartitions && found.size() < limit);
    return found;
  }
  std::mt19937 random(seed);
  for (size_t misses = 0; misses < 100 && found.size() < limit;) { // until nothing new comes up for long
    const Roots roots =
        search == Search::random ? randomPartition(flow, random) : heuristicPartition(graph, flow, heuristics, &random);
    if (add(scheduleOf(graph, flow, roots,
                       (search == Search::random ? "random " : "heuristic ") + std::to_string(found.size()))))
      misses = 0;
    else
      ++misses;
  }
  return found;
}

std::vector<Schedule> neighbours(const Graph& graph, const Schedule& schedule) {
  const Flow flow = makeFlow(graph);
  std::vector<bool> isStatic(graph.edges.size());
  for (const uint32_t n : flow.order)
    for (const Link& link : flow.in[n]) isStatic[link.edge] = !schedule.waits[n];
  std::vector<Schedule> found;
  for (const uint32_t n : flow.order) {
    if (flow.in[n].empty()) continue;
    std::vector<bool> other = isStatic;
    for (const Link& link : flow.in[n]) other[link.edge] = schedule.waits[n];
    const size_t shown = std::min<size_t>(schedule.name.find(" but "), 16); // the first one's name: they fit a kernel's
    found.push_back(scheduleOf(graph, flow, realise(flow, other),
                               schedule.name.substr(0, shown) + " but node " + std::to_string(n)));
    if (schedule.queues == Queues::groups) found.back() = withQueues(std::move(found.back()));
  }
  return found;
}

} // namespace gpgp::spawn
