// SGL: the valid partition with the fewest groups.
//
// Without dependencies every node that may belong to the group before it should: all other partitions split those
// groups further. With them a group has either of two nodes, and which one decides what else can be in it, so the
// decisions are searched: branch and bound over the nodes in the flow's order, each of which joins the group that its
// edges come from or, where that can save groups later, becomes a root. A prefix is left where its roots, and those
// that must follow, are no fewer than the best partition has, which is at first the best of three greedy ones. The
// search gives up after kMostDecisions; what it has found until then is valid, and no group of it can join another.
#include "spawn/graph/heuristics.h"

#include <algorithm>

namespace gpgp::spawn {
namespace {
constexpr uint32_t kMostDecisions = 1u << 18;

/// Joins in the flow's order whatever can join, but those last that wait.
Roots greedy(const Flow& flow, Roots roots, const std::vector<bool>& waits) {
  for (const bool all : {false, true})
    for (const uint32_t n : flow.order)
      if (roots[n] == n && (all || !waits[n]) && canJoin(flow, roots, n)) join(flow, roots, n);
  return roots;
}

/// Where a root can save groups: nodes that lead to one with dependencies. Of a sequence the first node after one with
/// dependencies is enough: the group of a later one can begin there as well.
std::vector<bool> placesToCut(const Flow& flow) {
  std::vector<bool> leads(flow.rank.size()), cuts(flow.rank.size());
  std::vector<uint32_t> open;
  const auto reach = [&](uint32_t n) {
    if (!leads[n]) open.push_back(n);
    leads[n] = true;
  };
  for (const uint32_t n : flow.order)
    if (!flow.at[n].empty()) reach(n);
  while (!open.empty()) {
    const uint32_t n = open.back();
    open.pop_back();
    for (const Link& link : flow.in[n]) reach(link.source);
  }
  for (const uint32_t n : flow.order) {
    const auto follows = [&](const Link& link) { // nothing else comes from there, and nothing from elsewhere
      return link.source == flow.in[n][0].source && flow.at[link.source].empty() &&
             std::all_of(flow.out[link.source].begin(), flow.out[link.source].end(),
                         [n](const Link& out) { return out.target == n; });
    };
    cuts[n] = leads[n] && !flow.in[n].empty() && !std::all_of(flow.in[n].begin(), flow.in[n].end(), follows);
  }
  return cuts;
}

Roots search(const Flow& flow, Roots best) {
  const size_t nodes = flow.order.size();
  const std::vector<bool> cuts = placesToCut(flow);
  std::vector<size_t> before(nodes + 1), must(nodes + 1); // roots before a place in the order, and at least from it on
  for (size_t i = nodes; i-- > 0;) must[i] = must[i + 1] + flow.mustRoot[flow.order[i]];
  Roots roots = singleGroups(flow);
  size_t fewest = groupCount(flow, best), i = 0;
  for (uint32_t left = kMostDecisions; left > 0;) {
    for (; i < nodes && before[i] + must[i] < fewest && left > 0; ++i, --left) {
      const uint32_t n = flow.order[i];
      roots[n] = mayBelong(flow, roots, i) ? roots[flow.in[n][0].source] : n;
      before[i + 1] = before[i] + (roots[n] == n);
    }
    if (i == nodes && before[i] < fewest) {
      fewest = before[i];
      best = roots;
    }
    do { // back to the last node that can be a root instead
      if (i == 0) return best;
      --i;
    } while (roots[flow.order[i]] == flow.order[i] || !cuts[flow.order[i]]);
    roots[flow.order[i]] = flow.order[i];
    before[i + 1] = before[i] + 1;
    ++i;
  }
  return best;
}
} // namespace

Roots coarsestPartition(const Flow& flow) {
  Roots best = PartitionEnumerator(flow).roots();
  if (flow.dependencies.empty()) return best;
  std::vector<bool> sources(flow.rank.size()), targets(flow.rank.size());
  for (const Dependency& d : flow.dependencies) sources[d.source] = targets[d.target] = true;
  for (const auto& waits : {sources, targets})
    if (Roots other = greedy(flow, singleGroups(flow), waits); groupCount(flow, other) < groupCount(flow, best))
      best = std::move(other);
  return greedy(flow, search(flow, std::move(best)), std::vector<bool>(flow.rank.size()));
}

} // namespace gpgp::spawn
