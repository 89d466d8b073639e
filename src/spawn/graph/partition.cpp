// What a partition is, when it is valid, and how groups join.
//
// Why roots decide: condition 1 lets edges from outside only into a group's root, and an edge within a group that leads
// to another node is static. So all edges into a node that is no root come from its own group, and every cycle has a
// root in it. In particular, wherever a depth-first search finds a cycle closing, the target is a root: were it not,
// the group's root would lie above it in the search tree, outside the part of the cycle that the search walked.
#include "spawn/graph/partition.h"

#include <algorithm>
#include <iterator>
#include <map>

namespace gpgp::spawn {
namespace {

/// Depth first, later slots first, and reversed: sources come before targets, earlier slots first. linksOf(node) gives
/// the links to follow; closes(node) hears of targets that the search is still inside.
template <class LinksOf, class Closes>
std::vector<uint32_t> reversePostorder(std::span<const uint32_t> starts, size_t nodes, LinksOf&& linksOf,
                                       Closes&& closes) {
  struct Visit {
    uint32_t node;
    size_t left; // links not yet followed
  };
  enum : uint8_t { unseen, inside, done };
  std::vector<uint8_t> state(nodes, unseen);
  std::vector<Visit> stack;
  std::vector<uint32_t> order;
  for (size_t s = starts.size(); s-- > 0;) {
    if (state[starts[s]] != unseen) continue;
    state[starts[s]] = inside;
    stack.push_back({starts[s], linksOf(starts[s]).size()});
    while (!stack.empty()) {
      Visit& visit = stack.back();
      if (visit.left == 0) {
        state[visit.node] = done;
        order.push_back(visit.node);
        stack.pop_back();
        continue;
      }
      const uint32_t target = linksOf(visit.node)[--visit.left].target;
      if (state[target] == inside) closes(target);
      if (state[target] != unseen) continue;
      state[target] = inside;
      stack.push_back({target, linksOf(target).size()});
    }
  }
  std::reverse(order.begin(), order.end());
  return order;
}

std::string nodeText(uint32_t node) { return "node " + std::to_string(node); }
} // namespace

std::vector<Dependency> dependenciesOf(const Graph& graph) {
  std::vector<Dependency> result;
  std::map<uint32_t, std::vector<uint32_t>> levels; // by priority
  for (uint32_t n = 0; n < graph.nodes.size(); ++n)
    if (isContext(graph.nodes[n].op)) levels[graph.nodes[n].priority].push_back(n);
  for (auto level = levels.begin(); level != levels.end(); ++level) {
    const auto higher = std::next(level);
    for (const uint32_t target : level->second) {
      const Node& node = graph.nodes[target];
      for (const uint32_t source : level->second)
        if (node.op == shader::kOpIfCollides && graph.nodes[source].op == shader::kOpCollider &&
            graph.nodes[source].argument == node.argument)
          result.push_back({source, target});
      if (higher == levels.end()) continue;
      for (const uint32_t source : higher->second) result.push_back({source, target});
    }
  }
  return result;
}

Flow makeFlow(const Graph& graph, std::span<const uint32_t> starts, std::span<const Dependency> dependencies) {
  const size_t nodes = graph.nodes.size();
  Flow flow;
  const auto addStart = [&](uint32_t node) {
    if (node != kNoNode && std::find(flow.starts.begin(), flow.starts.end(), node) == flow.starts.end())
      flow.starts.push_back(node);
  };
  if (starts.empty())
    for (const Axiom& axiom : graph.axioms) addStart(axiom.node);
  for (const uint32_t start : starts) addStart(start);

  flow.in.resize(nodes);
  flow.out.resize(nodes);
  flow.at.resize(nodes);
  flow.mustRoot.assign(nodes, 0);
  flow.rank.assign(nodes, kNoNode);
  for (uint32_t n = 0; n < nodes; ++n)
    for (uint32_t slot = 0; slot < graph.nodes[n].edgeCount; ++slot) {
      const uint32_t edge = graph.nodes[n].firstEdge + slot;
      if (graph.edges[edge].target != kNoNode)
        flow.out[n].push_back({edge, n, slot, graph.edges[edge].target, graph.edges[edge].multiplicity});
    }
  flow.order = reversePostorder(
      flow.starts, nodes, [&](uint32_t n) -> const std::vector<Link>& { return flow.out[n]; },
      [&](uint32_t target) { flow.mustRoot[target] = 1; });
  for (uint32_t i = 0; i < flow.order.size(); ++i) {
    flow.rank[flow.order[i]] = i;
    for (const Link& link : flow.out[flow.order[i]]) flow.in[link.target].push_back(link);
  }
  for (const uint32_t start : flow.starts) flow.mustRoot[start] = 1;
  const auto depend = [&](const Dependency& d) {
    if (flow.rank[d.source] == kNoNode || flow.rank[d.target] == kNoNode) return;
    flow.dependencies.push_back(d);
    flow.at[d.source].push_back(d.target);
    flow.at[d.target].push_back(d.source);
  };
  for (const Dependency& d : dependenciesOf(graph)) depend(d);
  for (const Dependency& d : dependencies) depend(d);
  return flow;
}

Roots singleGroups(const Flow& flow) {
  Roots roots(flow.rank.size(), kNoNode);
  for (const uint32_t n : flow.order) roots[n] = n;
  return roots;
}

bool canJoin(const Flow& flow, const Roots& roots, uint32_t root) {
  if (flow.mustRoot[root] || flow.in[root].empty()) return false;
  const uint32_t group = roots[flow.in[root][0].source];
  if (group == root) return false;
  for (const Link& link : flow.in[root])
    if (roots[link.source] != group) return false;
  for (const Dependency& d : flow.dependencies)
    if ((roots[d.source] == root && roots[d.target] == group) || (roots[d.source] == group && roots[d.target] == root))
      return false;
  return true;
}

void join(const Flow& flow, Roots& roots, uint32_t root) {
  const uint32_t group = roots[flow.in[root][0].source];
  for (const uint32_t n : flow.order)
    if (roots[n] == root) roots[n] = group;
}

size_t groupCount(const Flow& flow, const Roots& roots) {
  return static_cast<size_t>(
      std::count_if(flow.order.begin(), flow.order.end(), [&](uint32_t n) { return roots[n] == n; }));
}

Partition makePartition(const Flow& flow, const Roots& roots) {
  Partition partition;
  partition.groupOf.assign(flow.rank.size(), kNoGroup);
  for (const uint32_t n : flow.order)
    if (roots[n] == n) {
      partition.groupOf[n] = static_cast<uint32_t>(partition.groups.size());
      partition.groups.emplace_back().root = n;
    }
  std::vector<std::vector<Link>> links(flow.rank.size()); // the static ones
  for (const uint32_t n : flow.order) {
    partition.groupOf[n] = partition.groupOf[roots[n]];
    for (const Link& link : flow.out[n])
      if (roots[link.target] == roots[n] && link.target != roots[n]) links[n].push_back(link);
  }
  // One search over all groups: static links never leave one, so each root's nodes follow it back to back.
  std::vector<uint32_t> starts;
  for (const Group& group : partition.groups) starts.push_back(group.root);
  const auto order = reversePostorder(
      starts, flow.rank.size(), [&](uint32_t n) -> const std::vector<Link>& { return links[n]; }, [](uint32_t) {});
  for (const uint32_t n : order) {
    Group& group = partition.groups[partition.groupOf[n]];
    group.nodes.push_back(n);
    for (const Link& link : flow.out[n]) {
      const bool isStatic = roots[link.target] == roots[n] && link.target != roots[n];
      (isStatic ? group.staticEdges : group.dynamicEdges).push_back(link);
    }
  }
  return partition;
}

Partition partitionOfGroups(const Flow& flow, std::span<const uint32_t> groupOf) {
  std::map<uint32_t, uint32_t> rootOf; // the first node of a group in the flow's order leads to all others
  Roots roots(flow.rank.size(), kNoNode);
  for (const uint32_t n : flow.order) roots[n] = rootOf.try_emplace(groupOf[n], n).first->second;
  return makePartition(flow, roots);
}

std::optional<Violation> violation(const Flow& flow, std::span<const uint32_t> groupOf) {
  std::map<uint32_t, std::vector<uint32_t>> groups;
  for (uint32_t n = 0; n < flow.rank.size(); ++n) {
    const bool reachable = flow.rank[n] != kNoNode;
    if (reachable && groupOf[n] == kNoGroup) return Violation{0, n, nodeText(n) + " is in no group"};
    if (!reachable && groupOf[n] != kNoGroup)
      return Violation{0, n, nodeText(n) + " is in a group, but no shape reaches it"};
  }
  for (const uint32_t n : flow.order) groups[groupOf[n]].push_back(n);
  std::vector<uint8_t> isStart(flow.rank.size(), 0);
  for (const uint32_t start : flow.starts) isStart[start] = 1;

  for (const auto& [number, nodes] : groups) {
    const auto inside = [&, g = number](uint32_t n) { return groupOf[n] == g; };
    // 1: only a single node has incoming edges from outside
    uint32_t root = kNoNode;
    for (const uint32_t n : nodes) {
      const bool entered = isStart[n] || std::any_of(flow.in[n].begin(), flow.in[n].end(),
                                                     [&](const Link& link) { return !inside(link.source); });
      if (!entered) continue;
      if (root != kNoNode)
        return Violation{1, n, std::string("shapes enter the group at ") + nodeText(root) + " and at " + nodeText(n)};
      root = n;
    }
    // 2: a path within the group from the root to every other node
    std::vector<uint8_t> reached(flow.rank.size(), 0);
    std::vector<uint32_t> open{root};
    reached[root] = 1;
    while (!open.empty()) {
      const uint32_t n = open.back();
      open.pop_back();
      for (const Link& link : flow.out[n])
        if (inside(link.target) && !reached[link.target]) {
          reached[link.target] = 1;
          open.push_back(link.target);
        }
    }
    for (const uint32_t n : nodes)
      if (!reached[n])
        return Violation{2, n,
                         std::string("within the group, no path leads from ") + nodeText(root) + " to " + nodeText(n)};
    // 3: no cycles but those that include the root: without it, nodes can be taken away one by one
    std::map<uint32_t, size_t> entering; // edges from nodes that are left
    for (const uint32_t n : nodes)
      if (n != root)
        entering[n] = static_cast<size_t>(std::count_if(flow.in[n].begin(), flow.in[n].end(), [&](const Link& link) {
          return inside(link.source) && link.source != root;
        }));
    for (const auto& [n, count] : entering)
      if (count == 0) open.push_back(n);
    size_t left = entering.size();
    while (!open.empty()) {
      const uint32_t n = open.back();
      open.pop_back();
      --left;
      for (const Link& link : flow.out[n])
        if (inside(link.target) && link.target != root && --entering[link.target] == 0) open.push_back(link.target);
    }
    if (left)
      for (const uint32_t n : nodes)
        if (n != root && entering[n])
          return Violation{3, n,
                           "a cycle leads through " + nodeText(n) +
                               ", or to it, that does not pass the group's root, " + nodeText(root)};
    // 4: no dependencies within
    for (const uint32_t n : nodes)
      for (const uint32_t other : flow.at[n])
        if (inside(other)) return Violation{4, n, nodeText(n) + " depends on " + nodeText(other) + ", or the reverse"};
  }
  return std::nullopt;
}

bool mayBelong(const Flow& flow, const Roots& roots, size_t place) {
  const uint32_t n = flow.order[place];
  if (flow.mustRoot[n] || flow.in[n].empty()) return false;
  const uint32_t group = roots[flow.in[n][0].source];
  for (const Link& link : flow.in[n])
    if (roots[link.source] != group) return false;
  for (const uint32_t other : flow.at[n])
    if (flow.rank[other] < place && roots[other] == group) return false;
  return true;
}

PartitionEnumerator::PartitionEnumerator(const Flow& flow) : flow_(flow), roots_(singleGroups(flow)) { fill(0); }

void PartitionEnumerator::fill(size_t from) {
  for (size_t i = from; i < flow_.order.size(); ++i) {
    const uint32_t n = flow_.order[i];
    roots_[n] = mayBelong(flow_, roots_, i) ? roots_[flow_.in[n][0].source] : n;
  }
}

bool PartitionEnumerator::next() {
  for (size_t i = flow_.order.size(); i-- > 0;) {
    const uint32_t n = flow_.order[i];
    if (roots_[n] == n) continue;
    roots_[n] = n;
    fill(i + 1);
    return true;
  }
  return false;
}

uint64_t countPartitions(const Flow& flow, uint64_t limit) {
  if (flow.order.empty()) return 0;
  PartitionEnumerator all(flow);
  uint64_t count = 1;
  while (count < limit && all.next()) ++count;
  return count;
}

} // namespace gpgp::spawn
