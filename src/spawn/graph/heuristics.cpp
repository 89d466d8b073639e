#include "spawn/graph/heuristics.h"

#include <algorithm>

namespace gpgp::spawn {
namespace {
using namespace shader;

bool isConstant(uint32_t multiplicity) {
  return multiplicity == kMultiplicityOne || multiplicity == kMultiplicityFixed;
}

template <class Wanted> std::vector<Link> select(const Flow& flow, Wanted&& wanted) {
  std::vector<Link> links;
  for (const uint32_t n : flow.order)
    std::copy_if(flow.out[n].begin(), flow.out[n].end(), std::back_inserter(links), wanted);
  return links;
}

class Search {
public:
  Search(const Graph& graph, const Flow& flow, const Heuristics& heuristics)
      : flow_(flow), heuristics_(heuristics), roots_(singleGroups(flow)), size_(flow.rank.size(), 1),
        isDynamic_(flow.rank.size(), false) {
    if (heuristics.fuseSequences) sequences_ = sequenceEdges(graph, flow);
    if (heuristics.avoidDivergence) divergent_ = divergentEdges(graph, flow);
    if (heuristics.minimumGroupSize > 1) constant_ = constantEdges(graph, flow);
  }

  Roots run(std::mt19937* leftOver) {
    fuse();
    for (const Link& link : divergent_)
      if (roots_[link.target] == link.target) isDynamic_[link.target] = true;
    while (grow() && fuse()) {
    }
    if (leftOver)
      for (const uint32_t n : flow_.order)
        if (!isDynamic_[n] && ((*leftOver)() & 1)) tryJoin(n);
    return std::move(roots_);
  }

private:
  bool tryJoin(uint32_t node) {
    if (roots_[node] != node || !canJoin(flow_, roots_, node)) return false;
    size_[roots_[flow_.in[node][0].source]] += size_[node];
    join(flow_, roots_, node);
    return true;
  }
  /// Until no link can join that may; true where anything changed.
  template <class May> bool joinAll(const std::vector<Link>& links, May&& may) {
    bool any = false;
    for (bool more = true; more; any |= more) {
      more = false;
      for (const Link& link : links)
        if (may(link)) more |= tryJoin(link.target);
    }
    return any;
  }
  bool fuse() {
    return joinAll(sequences_, [](const Link&) { return true; });
  }
  bool grow() {
    return joinAll(constant_, [&](const Link& link) {
      const uint32_t smaller = std::min(size_[roots_[link.source]], size_[roots_[link.target]]);
      return smaller < heuristics_.minimumGroupSize && !isDynamic_[link.target];
    });
  }

  const Flow& flow_;
  const Heuristics& heuristics_;
  Roots roots_;
  std::vector<uint32_t> size_; // by root
  std::vector<bool> isDynamic_;
  std::vector<Link> sequences_, divergent_, constant_;
};
} // namespace

Roots realise(const Flow& flow, const std::vector<bool>& isStatic) {
  Roots roots = singleGroups(flow);
  for (const uint32_t n : flow.order)
    if (std::all_of(flow.in[n].begin(), flow.in[n].end(), [&](const Link& link) { return isStatic[link.edge]; }) &&
        canJoin(flow, roots, n))
      roots[n] = roots[flow.in[n][0].source]; // what follows n has not joined yet
  return roots;
}

Roots rulePartition(const Graph& graph, const Flow& flow) {
  std::vector<bool> isStatic(graph.edges.size(), true);
  for (const Rule& rule : graph.rules)
    if (rule.node != kNoNode)
      for (const Link& link : flow.in[rule.node]) isStatic[link.edge] = false;
  return realise(flow, isStatic);
}

Roots randomPartition(const Flow& flow, std::mt19937& random) {
  Roots roots = singleGroups(flow);
  for (const uint32_t n : flow.order)
    if ((random() & 1) && canJoin(flow, roots, n)) roots[n] = roots[flow.in[n][0].source];
  return roots;
}

uint32_t usualMultiplicity(const Graph& graph, const Link& link) {
  const Node& node = graph.nodes[link.source];
  if (node.op != kOpSubDiv) return link.multiplicity;
  const Parameter& extent = graph.parameters[node.firstParameter + link.slot];
  return extent.kind == kParameterConstant && extent.value != 0 ? kMultiplicityOne : kMultiplicityOptional;
}

std::vector<Link> sequenceEdges(const Graph& graph, const Flow& flow) {
  return select(flow, [&](const Link& link) {
    return flow.out[link.source].size() == 1 && usualMultiplicity(graph, link) == kMultiplicityOne;
  });
}

std::vector<Link> divergentEdges(const Graph& graph, const Flow& flow) {
  return select(flow, [&](const Link& link) { return usualMultiplicity(graph, link) == kMultiplicityOptional; });
}

std::vector<Link> constantEdges(const Graph& graph, const Flow& flow) {
  return select(flow, [&](const Link& link) { return isConstant(usualMultiplicity(graph, link)); });
}

Roots heuristicPartition(const Graph& graph, const Flow& flow, const Heuristics& heuristics, std::mt19937* leftOver) {
  return Search(graph, flow, heuristics).run(leftOver);
}

} // namespace gpgp::spawn
