// Rules that are only a name lead to what the name leads to.
#pragma once
#include "spawn/graph/graph.h"

#include <functional>
#include <optional>
#include <span>

namespace gpgp::spawn {

/// Where a successor leads: a node, nowhere, or to a rule whose node is not known yet.
struct Target {
  uint32_t node = kNoNode;
  std::optional<size_t> rule;
};

/// The node of each rule, in time that grows with their number however long chains of names are. isCircle is called for
/// each that leads back to itself; these, and what leads to them, have no node.
std::vector<uint32_t> resolveRules(std::span<const Target> targets, const std::function<void(size_t rule)>& isCircle);

} // namespace gpgp::spawn
