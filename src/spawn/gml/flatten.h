// The operator graph while a program runs: shapes on the stack are edges of it that lead nowhere yet (thesis 4.3.3).
//
// An operator that takes a shape becomes a node, to which all edges of the shape lead. A node takes one shape, so what
// takes several is written as several nodes, or as one node to which the edges of all of them lead.
#pragma once
#include "spawn/gml/value.h"
#include "spawn/graph/graph.h"
#include "spawn/language/expressions.h"
#include "spawn/language/resolve_rules.h"

#include <map>
#include <string>

namespace gpgp::spawn::gml {

struct PlacedGraph {
  explicit PlacedGraph(std::pmr::memory_resource* memory) : graph(memory) {}
  Graph graph;
  std::vector<Place> places; ///< of its nodes
};

class Flattener {
public:
  Flattener(Diagnostics& diagnostics, std::pmr::memory_resource* memory);

  struct NewNode {
    uint32_t op = 0;
    uint32_t argument = 0, argument2 = 0;
    std::vector<Parameter> parameters;
    uint32_t edges = 1;
  };
  /// A node that takes a shape. Returns its number.
  uint32_t addNode(const Shape& shape, NewNode node, Place place);
  Shape edgeOf(uint32_t node, uint32_t edge, const Shape& from);
  /// One more copy: the shape becomes the first one, and the other is returned.
  Shape copy(Shape& shape, Place place);
  void discard(const Shape& shape);
  void toTerminal(const Shape& shape, uint32_t terminal, Place place);
  void toRule(const Shape& shape, uint32_t rule);

  uint32_t addTerminalLine() { return graph_.buckets++; }
  uint32_t addTerminal(const std::string& name, uint32_t kind, uint32_t index, uint32_t bucket);
  uint32_t addRule(const std::string& name, Place place);
  void addAxiom(uint32_t rule, uint32_t shape, uint32_t polygon);
  /// The shape that comes to a rule, whose body follows.
  Shape beginRule(uint32_t rule);
  uint32_t tagNamed(const std::string& name);
  Parameter parameter(const Expression& expression) { return expressions_.parameter(expression); }
  Graph& graph() { return graph_; }
  size_t nodeCount() const { return nodes_.size(); }
  bool hasAxiom() const { return !graph_.axioms.empty(); }
  uint32_t newVersion() { return ++stamps_; }

  /// The graph of all that was added. Warns of shapes that were made and never used.
  PlacedGraph finish();

private:
  struct Edge {
    Target target;
    bool isTaken = false;
  };
  struct Pending {
    Node node;
    std::vector<Parameter> parameters;
    std::vector<Edge> edges;
    Place place;
  };
  void connect(const Shape& shape, Target target);
  Edge& edgeAt(const End& end) { return end.isRule ? entries_[end.node] : nodes_[end.node].edges[end.edge]; }
  void dropUnusedCopies();
  std::vector<uint32_t> resolve();

  Diagnostics& diagnostics_;
  PlacedGraph result_;
  Graph& graph_;
  const std::map<std::string, float> noVariables_;
  ExpressionCompiler expressions_;
  std::vector<Pending> nodes_;
  std::vector<Edge> entries_; // of rules
  std::vector<Place> rulePlaces_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> terminalNodes_; // by rule and terminal
  std::map<std::string, uint32_t> tags_;
  uint32_t stamps_ = 0;
};

} // namespace gpgp::spawn::gml
