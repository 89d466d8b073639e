// Longest paths, where an edge of the flow is 0 long and a dependency 1. Lengths only grow from pass to pass; as a path
// without a cycle has each dependency at most once, a length above their number proves a cycle.
#include "spawn/graph/phases.h"

#include <algorithm>
#include <functional>
#include <map>

namespace gpgp::spawn {
namespace {

/// unitOf: by node, what runs at once.
core::Result<Phases> phasesOfUnits(const Flow& flow, std::span<const uint32_t> unitOf, size_t units, const char* noun) {
  Phases phases;
  phases.phaseOf.assign(units, kNoNode);
  for (const uint32_t n : flow.order) phases.phaseOf[unitOf[n]] = 0;
  const auto fail = [&](const Dependency& d) {
    return core::makeError(GPGP_ERROR_INVALID_DATA,
                           "node %u depends on node %u, but %s %u is also before %s %u: no order of phases can do",
                           d.target, d.source, noun, unitOf[d.target], noun, unitOf[d.source]);
  };
  for (bool more = true; more;) {
    more = false;
    const auto raise = [&](uint32_t unit, uint32_t phase) {
      if (phases.phaseOf[unit] >= phase) return;
      phases.phaseOf[unit] = phase;
      more = true;
    };
    for (const uint32_t n : flow.order)
      for (const Link& link : flow.out[n]) raise(unitOf[link.target], phases.phaseOf[unitOf[n]]);
    for (const Dependency& d : flow.dependencies) {
      raise(unitOf[d.target], phases.phaseOf[unitOf[d.source]] + 1);
      if (phases.phaseOf[unitOf[d.target]] > flow.dependencies.size()) return fail(d);
    }
  }
  for (const uint32_t n : flow.order) phases.count = std::max(phases.count, phases.phaseOf[unitOf[n]] + 1);
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
