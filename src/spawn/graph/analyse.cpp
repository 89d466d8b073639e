// What follows from a graph's shape: multiplicities, the types of shapes on each edge, and the number of rounds.
//
// Types flow from the axiom and, since a derivation may start with any rule, from every rule with the axiom's type.
// Rounds: a shape leaves a round where it multiplies (more than one successor may live) or after kMaxChain operators.
#include "spawn/graph/graph.h"

#include <algorithm>

namespace gpgp::spawn {
namespace {
using namespace shader;

constexpr uint32_t bit(uint32_t shape) { return 1u << (shape & 31u); }

template <class F> uint32_t mapShapes(uint32_t shapes, F&& f) {
  uint32_t result = 0;
  for (uint32_t s = 0; s < kShapeCount; ++s)
    if (shapes & bit(s)) result |= f(s);
  return result;
}

uint32_t outgoing(const Node& node, uint32_t edge) {
  switch (node.op) {
  case kOpExtrude: return mapShapes(node.shapes, [](uint32_t s) { return bit(isPolygon(s) ? prismOf(s) : s); });
  case kOpSetGeometry: return bit(node.argument);
  case kOpCompSplit:
    if (edge == 2) return mapShapes(node.shapes, [](uint32_t s) { return isPrism(s) ? bit(kShapeQuad) : 0u; });
    return mapShapes(node.shapes, [edge](uint32_t s) {
      return isPrism(s) ? bit(polygonOf(s)) : s != kShapeSphere && edge == 0 ? bit(s) : 0u;
    });
  default: return node.shapes;
  }
}

uint32_t multiplicityOf(uint32_t op) {
  switch (op) {
  case kOpIf:
  case kOpIfSizeLess:
  case kOpRandomRule:
  case kOpSubDiv: return kMultiplicityOptional; // SubDiv skips parts without an extent
  case kOpCompSplit: return kMultiplicityFixed;
  case kOpRepeat: return kMultiplicityAny;
  default: return kMultiplicityOne;
  }
}
} // namespace

void analyse(Graph& graph) {
  const auto memory = graph.nodes.get_allocator().resource();
  for (Node& node : graph.nodes) {
    node.shapes = 0;
    for (uint32_t e = 0; e < node.edgeCount; ++e)
      graph.edges[node.firstEdge + e].multiplicity = multiplicityOf(node.op);
  }
  std::pmr::vector<uint32_t> changed(memory); // nodes whose outgoing types must be worked out
  const auto arrive = [&](uint32_t node, uint32_t shapes) {
    if (node == kNoNode || (graph.nodes[node].shapes | shapes) == graph.nodes[node].shapes) return;
    graph.nodes[node].shapes |= shapes;
    changed.push_back(node);
  };
  arrive(graph.axiomNode, bit(graph.axiomShape));
  for (const Rule& rule : graph.rules) arrive(rule.node, bit(graph.axiomShape));
  while (!changed.empty()) {
    const Node node = graph.nodes[changed.back()];
    changed.pop_back();
    for (uint32_t e = 0; e < node.edgeCount; ++e) {
      Edge& edge = graph.edges[node.firstEdge + e];
      edge.shapes = outgoing(node, e);
      arrive(edge.target, edge.shapes);
    }
  }

  // Longest paths, depth first with an explicit stack: a graph may be deep. A cycle leaves rounds at 0.
  struct Visit {
    uint32_t node, edge;
  };
  struct Length {
    uint32_t fans = 0, operators = 0;
  };
  std::pmr::vector<uint8_t> state(graph.nodes.size(), 0, memory); // 1 on the stack, 2 done
  std::pmr::vector<Length> lengths(graph.nodes.size(), memory);
  std::pmr::vector<Visit> stack(memory);
  graph.rounds = 0;
  Length longest;
  for (uint32_t root = 0; root < graph.nodes.size(); ++root) {
    if (state[root]) continue;
    stack.push_back({root, 0});
    state[root] = 1;
    while (!stack.empty()) {
      Visit& visit = stack.back();
      const Node& node = graph.nodes[visit.node];
      if (visit.edge < node.edgeCount) {
        const uint32_t target = graph.edges[node.firstEdge + visit.edge++].target;
        if (target == kNoNode || state[target] == 2) continue;
        if (state[target] == 1) return; // a cycle
        state[target] = 1;
        stack.push_back({target, 0});
        continue;
      }
      Length length;
      for (uint32_t e = 0; e < node.edgeCount; ++e) {
        const uint32_t target = graph.edges[node.firstEdge + e].target;
        if (target == kNoNode) continue;
        length.fans = std::max(length.fans, lengths[target].fans);
        length.operators = std::max(length.operators, lengths[target].operators);
      }
      length.fans += node.op >= kOpCompSplit;
      length.operators += 1;
      lengths[visit.node] = length;
      longest.fans = std::max(longest.fans, length.fans);
      longest.operators = std::max(longest.operators, length.operators);
      state[visit.node] = 2;
      stack.pop_back();
    }
  }
  graph.rounds = 1 + longest.fans + longest.operators / kMaxChain;
}

} // namespace gpgp::spawn
