#include "spawn/codegen/schedules.h"

#include "spawn/codegen/generate.h"
#include "spawn/graph/heuristics.h"

#include <algorithm>

namespace gpgp::spawn {
namespace {
/// Partitions that an exhaustive search looks at; beyond, the space is not for it.
constexpr uint64_t kMostPartitions = 1u << 20;
} // namespace

Schedule scheduleOf(const Graph& graph, const Flow& flow, const Roots& roots, std::string name) {
  Schedule schedule{std::move(name), 0, waitsAtFans(graph), roots};
  for (size_t n = 0; n < roots.size(); ++n) {
    if (flow.rank[n] == kNoNode || roots[n] != n) continue;
    ++schedule.groups;
    // What ends at a terminal is through: it needs no queue to be written.
    if (graph.nodes[n].op != shader::kOpTerminal) schedule.waits[n] = true;
  }
  // The start is where axioms arrive; nothing waits for it but shapes that come back to it.
  return schedule;
}

std::optional<Schedule> namedSchedule(const Graph& graph, const std::string& name) {
  const Flow flow = makeFlow(graph);
  if (name == "default") { // a group for each node that shapes wait for, and for the start
    Schedule schedule{name, 0, waitsAtFans(graph), {}};
    for (uint32_t n = 0; n < graph.nodes.size(); ++n)
      schedule.groups += flow.rank[n] != kNoNode && (schedule.waits[n] || n == graph.axiomNode);
    return schedule;
  }
  if (name == "sgl") return scheduleOf(graph, flow, coarsestPartition(flow), name);
  if (name == "rw") return scheduleOf(graph, flow, singleGroups(flow), name);
  if (name == "rules") return scheduleOf(graph, flow, rulePartition(graph, flow), name);
  if (name == "heuristic") return scheduleOf(graph, flow, heuristicPartition(graph, flow), name);
  return std::nullopt;
}

std::vector<Schedule> searchSchedules(const Graph& graph, Search search, size_t limit, uint32_t seed, bool& complete) {
  std::vector<Schedule> found;
  const auto add = [&](Schedule schedule) {
    const bool known =
        std::any_of(found.begin(), found.end(), [&](const Schedule& s) { return s.waits == schedule.waits; });
    if (!known && found.size() < limit) found.push_back(std::move(schedule));
    return !known;
  };
  for (const char* name : kScheduleNames) add(*namedSchedule(graph, name));
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
        search == Search::random ? randomPartition(flow, random) : heuristicPartition(graph, flow, {}, &random);
    if (add(scheduleOf(graph, flow, roots,
                       (search == Search::random ? "random " : "heuristic ") + std::to_string(found.size()))))
      misses = 0;
    else
      ++misses;
  }
  return found;
}

} // namespace gpgp::spawn
