// Schedules by name and by search, as generated kernels take them: which nodes shapes wait for (generate.h).
//
// A partition's roots wait, and so does what multiplies by a number that is not known before (table.h). Partitions that
// differ only in edges into the latter give the same kernel, and a search meets each kernel once.
#pragma once
#include "spawn/codegen/generate.h"
#include "spawn/graph/heuristics.h"

#include <string>

namespace gpgp::spawn {

struct Schedule {
  std::string name;
  size_t groups = 0;       ///< execution groups of its partition; of "default", of the one with as many static edges as
                           ///< can be where shapes wait where it lets them
  std::vector<bool> waits; ///< by node
  Roots roots;             ///< of the partition; empty for "default", which is none
  Queues queues = Queues::mixed;
};

/// sgl, rw, rules, heuristic, or default (as few as are worth it, docs/internals/schedules.md); nothing for other
/// names.
std::optional<Schedule> namedSchedule(const Graph& graph, const std::string& name, const Heuristics& heuristics = {});
constexpr const char* kScheduleNames[] = {"default", "sgl", "rw", "rules", "heuristic"};

/// The same with a queue for each execution group, and a name that says so.
Schedule withQueues(Schedule schedule);

/// The source of its kernel. matching: as generate() has it.
KernelSource sourceOf(const Graph& graph, const Schedule& schedule, bool matching = false);

Schedule scheduleOf(const Graph& graph, const Flow& flow, const Roots& roots, std::string name);

enum class Search {
  exhaustive, ///< every valid partition
  random,     ///< random partitions
  heuristic   ///< the heuristics, and coins for the edges that they leave open
};
/// The named schedules, then what a search finds: at most `limit` in all, no kernel twice. complete: all there are.
std::vector<Schedule> searchSchedules(const Graph& graph, Search search, size_t limit, uint32_t seed, bool& complete,
                                      const Heuristics& heuristics = {});

/// The schedules of partitions in which one node more, or one fewer, begins a group. Some may have the same kernel, or
/// the schedule's own.
std::vector<Schedule> neighbours(const Graph& graph, const Schedule& schedule);

} // namespace gpgp::spawn
