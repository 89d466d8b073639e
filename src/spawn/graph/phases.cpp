// Longest paths, where an edge of the flow is 0 long and a dependency 1.
#include "spawn/graph/phases.h"

#include "spawn/graph/longest_paths.h"

#include <algorithm>
#include <functional>
#include <map>

namespace gpgp::spawn {
namespace {

/// unitOf: by node, what runs at once.
core::Result<Phases> phasesOfUnits(const Flow& flow, std::span<const uint32_t> unitOf, size_t units, const char* noun) {
  struct Step {
    uint32_t target;
    const Dependency* dependency; // null: an edge
  };
  std::vector<std::vector<Step>> steps(units);
  for (const uint32_t n : flow.order)
    for (const Link& link : flow.out[n]) steps[unitOf[n]].push_back({unitOf[link.target], nullptr});
  for (const Dependency& d : flow.dependencies) steps[unitOf[d.source]].push_back({unitOf[d.target], &d});
  std::pmr::vector<uint32_t> length(units);
  const Dependency* last = nullptr;
  const auto follow = [&](uint32_t unit, auto&& reach) {
    for (const Step& step : steps[unit]) {
      if (step.dependency && length[unit] == flow.dependencies.size()) last = step.dependency;
      reach(step.target, step.dependency ? 1 : 0);
      if (last) return;
    }
  };
  // A path without a cycle has each dependency at most once.
  if (!longestPaths(length, static_cast<uint32_t>(flow.dependencies.size()), follow))
    return core::makeError(GPGP_ERROR_INVALID_DATA,
                           "node %u depends on node %u, but %s %u is also before %s %u: no order of phases can do",
                           last->target, last->source, noun, unitOf[last->target], noun, unitOf[last->source]);
  Phases phases;
  phases.phaseOf.assign(units, kNoNode);
  for (const uint32_t n : flow.order) {
    phases.phaseOf[unitOf[n]] = length[unitOf[n]];
    phases.count = std::max(phases.count, length[unitOf[n]] + 1);
  }
  return phases;
}
} // namespace

core::Result<Phases> phasesOfNodes(const Flow& flow) {
  std::vector<uint32_t> self(flow.rank.size());
  for (uint32_t n = 0; n < self.size(); ++n) self[n] = n;
  return phasesOfUnits(flow, self, self.size(), "node");
}

core::Result<Phases> phasesOfGroups(const Flow& flow, const Partition& partition) {
  return phasesOfUnits(flow, partition.groupOf, partition.groups.size(), "group");
}

std::vector<Dependency> dependenciesOfPriorities(const Flow& flow, std::span<const uint32_t> priorities) {
  std::map<uint32_t, std::vector<uint32_t>, std::greater<>> levels;
  for (const uint32_t n : flow.order) levels[priorities[n]].push_back(n);
  std::vector<Dependency> result;
  const std::vector<uint32_t>* higher = nullptr;
  for (const auto& [priority, nodes] : levels) {
    if (higher)
      for (const uint32_t source : *higher)
        for (const uint32_t target : nodes) result.push_back({source, target});
    higher = &nodes;
  }
  return result;
}

} // namespace gpgp::spawn
