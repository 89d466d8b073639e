// Each chain is followed up to a rule whose node is known, and then all of its rules have that node.
#include "spawn/language/resolve_rules.h"

namespace gpgp::spawn {

std::vector<uint32_t> resolveRules(std::span<const Target> targets, const std::function<void(size_t rule)>& isCircle) {
  enum class State : uint8_t { open, onPath, known };
  std::vector<State> states(targets.size());
  std::vector<uint32_t> nodes(targets.size(), kNoNode);
  std::vector<size_t> path;
  for (size_t start = 0; start < targets.size(); ++start) {
    path.clear();
    size_t rule = start;
    for (; states[rule] == State::open && targets[rule].rule; rule = *targets[rule].rule) {
      states[rule] = State::onPath;
      path.push_back(rule);
    }
    uint32_t node = kNoNode;
    if (states[rule] == State::open) {
      node = nodes[rule] = targets[rule].node;
      states[rule] = State::known;
    } else if (states[rule] == State::known) {
      node = nodes[rule];
    } else { // the path is a circle from this rule on
      size_t first = path.size();
      while (path[--first] != rule) {
      }
      for (size_t at = first; at < path.size(); ++at) isCircle(path[at]);
    }
    for (const size_t passed : path) {
      nodes[passed] = node;
      states[passed] = State::known;
    }
  }
  return nodes;
}

} // namespace gpgp::spawn
