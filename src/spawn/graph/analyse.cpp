// What follows from a graph's shape: multiplicities, the types of shapes on each edge, which operators only filter,
// which edges are recursive, and the phases of Collider and IfCollides.
//
// Types flow from the axioms and, since a derivation may start with any rule, from every rule with its axiom's type.
// Recursive are the back edges of a depth-first search from the axioms' nodes: without them there is no cycle.
#include "core/math.h"
#include "spawn/graph/cuts.h"
#include "spawn/graph/graph.h"
#include "spawn/graph/longest_paths.h"

#include <algorithm>
#include <functional>
#include <map>

namespace gpgp::spawn {
namespace {
using namespace shader;

constexpr uint32_t bit(uint32_t shape) { return 1u << (shape & 31u); }

uint32_t outgoing(const Node& node, uint32_t edge, uint32_t shapes) {
  uint32_t result = 0;
  for (uint32_t s = 0; s < kShapeCount; ++s)
    if (shapes & bit(s)) result |= outputOf(node, edge, s);
  return result;
}

void removePieces(Graph& graph) {
  if (!graph.pieces) return;
  const Polygon first = graph.polygons[graph.polygons.size() - graph.pieces];
  graph.polygons.resize(graph.polygons.size() - graph.pieces);
  graph.vertices.resize(2 * size_t(first.firstVertex));
  graph.quads.resize(kQuadSize * size_t(first.firstQuad));
  graph.pieces = 0;
}

/// The division of a SubDiv, where all parts are constant.
void divide(Graph& graph, Node& node) {
  node.division = UINT32_MAX;
  node.cuts = false;
  if (node.op != kOpSubDiv) return;
  const auto value = [&](uint32_t i) { return uintBitsToFloat(graph.parameters[node.firstParameter + i].value); };
  float fixedLength = 0, weights = 0;
  uint32_t fixedParts = 0, weightedParts = 0;
  for (uint32_t i = 0; i < node.edgeCount; ++i) {
    if (graph.parameters[node.firstParameter + i].kind != kParameterConstant) return;
    const uint32_t own = graph.edges[node.firstEdge + i].target != kNoNode ? bit(i) : 0;
    if (value(i) > 0) fixedLength = add(fixedLength, value(i)), fixedParts |= own;
    if (value(i) < 0) weights = subtract(weights, value(i)), weightedParts |= own;
  }
  node.division = static_cast<uint32_t>(graph.divisions.size());
  graph.divisions.insert(graph.divisions.end(), {floatBitsToUint(fixedLength), fixedParts, weightedParts, 0u});
  node.cuts = fixedLength == 0 && weights > 0;
  float fixedBefore = 0, weightBefore = 0;
  for (uint32_t i = 0; i < node.edgeCount; ++i) {
    const float v = value(i);
    for (const float word : {v > 0 ? v : 0.0f, v < 0 ? shader::divide(-v, weights) : 0.0f, fixedBefore,
                             weightBefore > 0 ? shader::divide(weightBefore, weights) : 0.0f})
      graph.divisions.push_back(floatBitsToUint(word));
    if (v > 0) fixedBefore = add(fixedBefore, v);
    if (v < 0) weightBefore = subtract(weightBefore, v);
  }
}

/// The phase of each IfCollides: no Collider of its tag and priority can still be reached, and none with a higher
/// priority; and of each Collider: no operator of theirs with a higher priority can. Other operators run as soon as a
/// shape comes to them, so that only these wait. A derivation may start with any rule: all nodes count.
void assignPhases(Graph& graph) {
  const auto memory = graph.nodes.get_allocator().resource();
  const uint32_t nodes = static_cast<uint32_t>(graph.nodes.size());
  graph.phases = 0;
  // Places beside the nodes: of each tag in each priority between its Colliders and IfCollides, and of each priority
  // between its nodes and those of the next lower one. What comes after a place is one phase further.
  std::pmr::map<uint32_t, std::pmr::vector<uint32_t>, std::greater<>> levels(memory); // nodes by priority
  std::pmr::map<uint32_t, uint32_t> behind(memory),
      before(memory); // places by priority; the highest has none before it
  std::pmr::map<std::pair<uint32_t, uint32_t>, uint32_t> tags(memory);
  std::pmr::vector<std::pmr::vector<uint32_t>> after(memory);
  const auto addPlace = [&] {
    after.emplace_back();
    return nodes + static_cast<uint32_t>(after.size()) - 1;
  };
  for (uint32_t n = 0; n < nodes; ++n) {
    const Node& node = graph.nodes[n];
    if (!isContext(node.op)) continue;
    graph.phases = 1;
    levels[node.priority].push_back(n);
    if (node.op != kOpCollider) continue;
    const auto [tag, isNew] = tags.try_emplace({node.argument, node.priority}, 0);
    if (isNew) tag->second = addPlace();
  }
  if (graph.phases == 0) return;
  for (uint32_t n = 0; n < nodes; ++n) {
    const auto tag = tags.find({graph.nodes[n].argument, graph.nodes[n].priority});
    if (graph.nodes[n].op == kOpIfCollides && tag != tags.end()) after[tag->second - nodes].push_back(n);
  }
  uint32_t higher = 0;
  for (const auto& [priority, level] : levels) {
    if (higher) before[priority] = higher;
    if (higher) after[higher - nodes] = level;
    higher = behind[priority] = addPlace();
  }
  std::pmr::vector<uint32_t> phaseOf(nodes + after.size(), 0, memory);
  const bool ordered = longestPaths(phaseOf, kMaxPhases - 1, [&](uint32_t place, auto&& reach) {
    if (place >= nodes) {
      for (const uint32_t n : after[place - nodes]) reach(n, 1);
      return;
    }
    const Node& node = graph.nodes[place];
    for (uint32_t e = 0; e < node.edgeCount; ++e)
      if (graph.edges[node.firstEdge + e].target != kNoNode) reach(graph.edges[node.firstEdge + e].target, 0);
    if (!isContext(node.op)) return;
    reach(behind.at(node.priority), 0);
    if (node.op == kOpCollider) reach(tags.at({node.argument, node.priority}), 0);
  });
  for (uint32_t n = 0; n < nodes; ++n) {
    Node& node = graph.nodes[n];
    graph.phases = std::max(graph.phases, phaseOf[n] + 1);
    if (node.op == kOpIfCollides) node.argument2 = phaseOf[n];
    if (node.op != kOpCollider) continue;
    const auto place = before.find(node.priority);
    node.argument2 = place == before.end() ? 0 : phaseOf[place->second] + 1;
  }
  if (!ordered) graph.phases = kNoPhases;
}

/// What flows from arrivals on; shapes: the field of a node that keeps it.
class ShapeFlow {
public:
  ShapeFlow(Graph& graph, uint32_t Node::*shapes)
      : graph_(graph), shapes_(shapes), changed_(graph.nodes.get_allocator().resource()) {
    for (Node& node : graph.nodes) node.*shapes = 0;
  }
  void arrive(uint32_t node, uint32_t shapes) {
    if (node == kNoNode || (graph_.nodes[node].*shapes_ | shapes) == graph_.nodes[node].*shapes_) return;
    graph_.nodes[node].*shapes_ |= shapes;
    changed_.push_back(node);
  }
  void run() {
    while (!changed_.empty()) {
      const Node node = graph_.nodes[changed_.back()];
      changed_.pop_back();
      for (uint32_t e = 0; e < node.edgeCount; ++e)
        arrive(graph_.edges[node.firstEdge + e].target, outgoing(node, e, node.*shapes_));
    }
  }

private:
  Graph& graph_;
  uint32_t Node::*shapes_;
  std::pmr::vector<uint32_t> changed_; // nodes whose outgoing types must be worked out
};
} // namespace

uint32_t outputOf(const Node& node, uint32_t edge, uint32_t shape) {
  switch (node.op) {
  case kOpExtrude: return bit(isPolygon(shape) ? prismOf(shape) : shape);
  case kOpSetGeometry: return bit(node.argument);
  case kOpGrowAlong: return bit(kShapeBox);
  case kOpToFace: return bit(kShapeQuad);
  case kOpRaiseRoof: return bit(kRectangleShapes & bit(shape) ? kShapeRoof : shape);
  case kOpToRoofFace: return shape == kShapeRoof ? bit(kShapeQuad) | bit(kShapeTrapezoid) : bit(shape);
  case kOpCompSplit:
    if (edge == 2) return isPrism(shape) ? bit(kShapeQuad) : 0u;
    if (isPrism(shape)) return bit(polygonOf(shape));
    return (kFacedShapes >> shape & 1u) && edge == 0 ? bit(shape) : 0u;
  case kOpSubDiv:
    if (!isCut(shape, node.argument)) return bit(shape);
    return node.cuts && shape < kShapeSphere ? bit(pieceShape(shape)) : 0u;
  default: return bit(shape);
  }
}

uint32_t drawsOf(const Graph& graph, const Parameter& parameter) {
  if (!hasProgram(parameter.kind)) return 0;
  uint32_t draws = 0;
  for (uint32_t at = parameter.value; graph.code[at] != kCodeEnd; ++at) {
    if (graph.code[at] == kCodeNumber)
      ++at; // which follows
    else if (graph.code[at] == kCodeRandom)
      ++draws;
  }
  return draws;
}

void analyse(Graph& graph) {
  const auto memory = graph.nodes.get_allocator().resource();
  graph.divisions.clear();
  removePieces(graph);
  for (Node& node : graph.nodes) {
    divide(graph, node);
    uint32_t kept = 0;
    for (uint32_t e = 0; e < node.edgeCount; ++e) {
      Edge& edge = graph.edges[node.firstEdge + e];
      edge.multiplicity = kOperators[node.op].multiplicity;
      const bool many = edge.multiplicity == kMultiplicityAny || (node.op == kOpCompSplit && e == 2);
      if (edge.target != kNoNode) kept += many ? 2 : 1;
    }
    node.filter = couldMultiply(node.op) && kept <= 1;
    node.draws = node.sees = false;
    for (uint32_t i = 0; i < node.parameterCount; ++i) {
      const Parameter& parameter = graph.parameters[node.firstParameter + i];
      node.draws |= !couldMultiply(node.op) && drawsOf(graph, parameter) > 0;
      node.sees |= parameter.kind == kParameterView;
    }
  }
  ShapeFlow fromAxioms(graph, &Node::axiomShapes), all(graph, &Node::shapes);
  for (const Axiom& axiom : graph.axioms) {
    fromAxioms.arrive(axiom.node, bit(axiom.shape));
    all.arrive(axiom.node, bit(axiom.shape));
  }
  for (const Rule& rule : graph.rules) all.arrive(rule.node, bit(graph.axioms[rule.axiom].shape));
  fromAxioms.run();
  all.run();
  for (Node& node : graph.nodes) // what it drops is counted where it waits
    if (isCutting(node)) node.filter = false;
  cutPolygons(graph);
  for (const Node& node : graph.nodes)
    for (uint32_t e = 0; e < node.edgeCount; ++e)
      graph.edges[node.firstEdge + e].shapes = outgoing(node, e, node.shapes);

  // Edges that close a cycle, depth first with an explicit stack: a graph may be deep.
  struct Visit {
    uint32_t node, edge;
  };
  std::pmr::vector<uint8_t> state(graph.nodes.size(), 0, memory); // 1 on the stack, 2 done
  std::pmr::vector<Visit> stack(memory);
  const auto visit = [&](uint32_t root) {
    if (root == kNoNode || state[root]) return;
    stack.push_back({root, 0});
    state[root] = 1;
    while (!stack.empty()) {
      Visit& top = stack.back();
      const Node& node = graph.nodes[top.node];
      if (top.edge == node.edgeCount) {
        state[top.node] = 2;
        stack.pop_back();
        continue;
      }
      Edge& edge = graph.edges[node.firstEdge + top.edge++];
      edge.recursive = edge.target != kNoNode && state[edge.target] == 1;
      if (edge.target == kNoNode || state[edge.target]) continue;
      state[edge.target] = 1;
      stack.push_back({edge.target, 0});
    }
  };
  for (const Axiom& axiom : graph.axioms) visit(axiom.node);
  for (uint32_t root = 0; root < graph.nodes.size(); ++root) visit(root);
  assignPhases(graph);
}

} // namespace gpgp::spawn
