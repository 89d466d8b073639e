#include "spawn/gml/flatten.h"

#include "spawn/language/append_graph.h"

#include <algorithm>

namespace gpgp::spawn::gml {
using namespace shader;

namespace {
/// What an operator leaves of a shape as it was: bits of qualities.
uint32_t keptBy(uint32_t op) {
  constexpr uint32_t all = (1u << kQualityCount) - 1;
  switch (op) {
  case kOpTranslate: return all & ~(1u << kPosition);
  case kOpRotate: return all & ~(1u << kRotation);
  case kOpScale:
  case kOpSwapSize: return all & ~(1u << kSize);
  case kOpExtrude: return 1u << kPosition;
  case kOpSetGeometry:
  case kOpIf:
  case kOpIfSizeLess:
  case kOpRandomRule:
  case kOpCollider:
  case kOpIfCollides:
  case kOpReplicate: return all;
  default: return 0;
  }
}
} // namespace

Flattener::Flattener(Diagnostics& diagnostics, std::pmr::memory_resource* memory)
    : diagnostics_(diagnostics), result_(memory), graph_(result_.graph),
      expressions_(noVariables_, graph_, diagnostics) {
  addRegularPolygons(graph_);
}

void Flattener::connect(const Shape& shape, Target target) {
  for (const End& end : shape->ends) {
    Edge& edge = edgeAt(end);
    edge.target = target;
    edge.isTaken = true;
  }
}

uint32_t Flattener::addNode(const Shape& shape, NewNode made, Place place) {
  const uint32_t number = static_cast<uint32_t>(nodes_.size());
  Pending pending;
  pending.node.op = made.op;
  pending.node.argument = made.argument;
  pending.node.argument2 = made.argument2;
  pending.parameters = std::move(made.parameters);
  pending.edges.resize(made.edges);
  pending.place = place;
  nodes_.push_back(std::move(pending));
  connect(shape, {number, std::nullopt});
  return number;
}

Shape Flattener::edgeOf(uint32_t node, uint32_t edge, const Shape& from) {
  auto state = std::make_shared<ShapeState>(*from);
  state->ends = {{node, edge, false}};
  const uint32_t kept = keptBy(nodes_[node].node.op);
  // What multiplies shapes gives each of its edges versions of its own.
  for (uint32_t q = 0; q < kQualityCount; ++q)
    if (!(kept >> q & 1)) state->versions[q] = newVersion();
  return state;
}

Shape Flattener::copy(Shape& shape, Place place) {
  if (shape->ends.empty()) return shape;
  const auto isCopy = [&](const End& end) {
    return !end.isRule && nodes_[end.node].node.op == kOpReplicate && nodes_[end.node].edges.size() < kMaxSuccessors;
  };
  uint32_t node = shape->ends[0].node;
  if (shape->ends.size() == 1 && isCopy(shape->ends[0])) {
    nodes_[node].edges.emplace_back();
  } else {
    node = addNode(shape, {kOpReplicate, 0, 0, {}, 2}, place);
    shape = edgeOf(node, 0, shape);
  }
  return edgeOf(node, static_cast<uint32_t>(nodes_[node].edges.size() - 1), shape);
}

void Flattener::discard(const Shape& shape) { connect(shape, {}); }

void Flattener::toTerminal(const Shape& shape, uint32_t terminal, Place place) {
  if (shape->ends.empty()) return;
  const auto [it, isNew] = terminalNodes_.try_emplace({shape->rule, terminal}, static_cast<uint32_t>(nodes_.size()));
  if (isNew) {
    Pending pending;
    pending.node.argument = terminal;
    pending.node.argument2 = graph_.terminals[terminal].bucket;
    pending.node.rule = shape->rule;
    pending.place = place;
    nodes_.push_back(std::move(pending));
  }
  connect(shape, {it->second, std::nullopt});
}

void Flattener::toRule(const Shape& shape, uint32_t rule) { connect(shape, {kNoNode, rule}); }

uint32_t Flattener::addTerminal(const std::string& name, uint32_t kind, uint32_t index, uint32_t bucket) {
  graph_.terminals.push_back({addName(graph_, name), kind, index, bucket});
  return static_cast<uint32_t>(graph_.terminals.size() - 1);
}

uint32_t Flattener::addRule(const std::string& name, Place place) {
  graph_.rules.push_back({addName(graph_, name)});
  entries_.emplace_back();
  rulePlaces_.push_back(place);
  return static_cast<uint32_t>(graph_.rules.size() - 1);
}

void Flattener::addAxiom(uint32_t rule, uint32_t shape, uint32_t polygon) {
  const uint32_t number = static_cast<uint32_t>(graph_.axioms.size());
  const bool isNamed = std::any_of(graph_.axioms.begin(), graph_.axioms.end(),
                                   [&](const Axiom& a) { return a.name == graph_.rules[rule].name; });
  if (!isNamed) graph_.rules[rule].axiom = number;
  graph_.axioms.push_back({graph_.rules[rule].name, rule, shape, polygon}); // the node is known at the end
}

Shape Flattener::beginRule(uint32_t rule) {
  auto state = std::make_shared<ShapeState>();
  state->ends = {{rule, 0, true}};
  state->rule = rule;
  for (uint32_t& version : state->versions) version = newVersion();
  return state;
}

uint32_t Flattener::tagNamed(const std::string& name) {
  const auto [tag, isNew] = tags_.try_emplace(name);
  if (isNew) tag->second = kTagName | addName(graph_, name);
  return tag->second;
}

/// Of copies that were made of what a name holds, the last is never used. What has one copy is none.
void Flattener::dropUnusedCopies() {
  for (Pending& n : nodes_)
    if (n.node.op == kOpReplicate) std::erase_if(n.edges, [](const Edge& e) { return !e.isTaken; });
}

/// The node where each rule, and each operator, begins: copies of one pass on what comes to them.
std::vector<uint32_t> Flattener::resolve() {
  const size_t rules = entries_.size();
  std::vector<Target> targets(rules + nodes_.size());
  const auto throughNode = [&](Target t) { // what leads to a node leads to the node's own entry of the list
    if (t.node != kNoNode) t.rule = rules + t.node, t.node = kNoNode;
    return t;
  };
  for (size_t r = 0; r < rules; ++r) targets[r] = throughNode(entries_[r].target);
  for (size_t n = 0; n < nodes_.size(); ++n) {
    const Pending& p = nodes_[n];
    const bool passes = p.node.op == kOpReplicate && p.edges.size() <= 1;
    if (!passes)
      targets[rules + n].node = static_cast<uint32_t>(n);
    else if (!p.edges.empty())
      targets[rules + n] = throughNode(p.edges[0].target);
  }
  return resolveRules(targets, [&](size_t at) {
    if (at < rules)
      diagnostics_.error(rulePlaces_[at], "rule '" + std::string(graph_.nameAt(graph_.rules[at].name)) +
                                              "' leads back to itself without any operator");
  });
}

PlacedGraph Flattener::finish() {
  dropUnusedCopies();
  const auto isUnused = [](const Edge& e) { return !e.isTaken; };
  for (const Pending& p : nodes_)
    if (!diagnostics_.hasErrors() && std::any_of(p.edges.begin(), p.edges.end(), isUnused))
      diagnostics_.warning(p.place, "a shape that this makes is never used; 'pop' ends shapes that are not wanted");
  const size_t rules = entries_.size();
  const std::vector<uint32_t> targets = resolve();
  std::vector<uint32_t> numbers(nodes_.size(), kNoNode);
  uint32_t count = 0;
  for (size_t n = 0; n < nodes_.size(); ++n)
    if (targets[rules + n] == n) numbers[n] = count++;
  const auto numberOf = [&](uint32_t node) { return node == kNoNode ? kNoNode : numbers[node]; };
  for (size_t n = 0; n < nodes_.size(); ++n) {
    if (numbers[n] == kNoNode) continue;
    Pending& p = nodes_[n];
    Node node = p.node;
    node.firstParameter = static_cast<uint32_t>(graph_.parameters.size());
    node.parameterCount = static_cast<uint32_t>(p.parameters.size());
    node.firstEdge = static_cast<uint32_t>(graph_.edges.size());
    node.edgeCount = static_cast<uint32_t>(p.edges.size());
    graph_.parameters.insert(graph_.parameters.end(), p.parameters.begin(), p.parameters.end());
    for (const Edge& e : p.edges) {
      spawn::Edge edge;
      const uint32_t target = e.target.node != kNoNode ? targets[rules + e.target.node]
                              : e.target.rule          ? targets[*e.target.rule]
                                                       : kNoNode;
      edge.target = numberOf(target);
      graph_.edges.push_back(edge);
    }
    graph_.nodes.push_back(node);
    result_.places.push_back(p.place);
  }
  for (size_t r = 0; r < rules; ++r) graph_.rules[r].node = numberOf(targets[r]);
  for (Axiom& axiom : graph_.axioms) axiom.node = graph_.rules[axiom.node].node;
  return std::move(result_);
}

} // namespace gpgp::spawn::gml
