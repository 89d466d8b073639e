// Phases (thesis 4.3.2, 4.4.1): dependencies and priorities as an order of execution with barriers in between.
//
// Shapes only move on to the same or a later phase, and what depends on a node runs in a later phase than it. The
// number of phases is the least possible: each node runs as early as it can.
#pragma once
#include "core/result.h"
#include "spawn/graph/partition.h"

namespace gpgp::spawn {

struct Phases {
  std::vector<uint32_t> phaseOf; ///< from 0; kNoNode where not reachable
  uint32_t count = 1;
};

/// Of nodes. An error where a node depends on what comes after it: then no order of phases can do.
core::Result<Phases> phasesOfNodes(const Flow& flow);
/// Of the groups of a partition, each of which runs in one phase. Conditions 1 to 4 do not rule out that groups wait
/// for each other where their nodes do not; that is an error, too.
core::Result<Phases> phasesOfGroups(const Flow& flow, const Partition& partition);

/// What priorities (by node, the highest runs first) mean: all nodes of a priority depend on all of the next higher
/// one.
std::vector<Dependency> dependenciesOfPriorities(const Flow& flow, std::span<const uint32_t> priorities);

} // namespace gpgp::spawn
