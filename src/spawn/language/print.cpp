#include "spawn/language/print.h"

#include "spawn/graph/export_labels.h"

#include <sstream>

namespace gpgp::spawn {
namespace {
using namespace shader;

std::string targetText(uint32_t node) { return node == kNoNode ? std::string("Discard") : std::to_string(node); }
} // namespace

std::string printGraph(const Graph& graph) {
  std::ostringstream out;
  for (const Axiom& axiom : graph.axioms) {
    out << "axiom " << axiomText(graph, axiom);
    if (axiom.polygon != usualPolygon(axiom.shape)) out << '(' << axiom.polygon << ')';
    out << " -> " << targetText(axiom.node) << '\n';
  }
  for (const Terminal& t : graph.terminals)
    out << "terminal " << graph.nameAt(t.name) << " (" << t.kind << ", " << t.index << ") bucket " << t.bucket << '\n';
  for (const uint32_t field : graph.fields) out << "field " << graph.nameAt(field) << '\n';
  const size_t own = graph.polygons.size() - graph.pieces; // SubDiv makes the others anew
  for (uint32_t i = kRegularPolygons; i < own; i += 2) {
    out << "polygon " << i << " {";
    for (uint32_t v = 0; v < graph.polygons[i].vertexCount; ++v) {
      const float* corner = &graph.vertices[2 * (graph.polygons[i].firstVertex + size_t(v))];
      out << " (" << numberText(corner[0]) << ',' << numberText(corner[1]) << ')';
    }
    out << " }\n";
  }
  for (const Rule& rule : graph.rules) {
    out << "rule " << graph.nameAt(rule.name);
    if (rule.axiom) out << '(' << rule.axiom << ')';
    out << " -> " << targetText(rule.node) << '\n';
  }
  for (uint32_t i = 0; i < graph.nodes.size(); ++i) {
    const Node& node = graph.nodes[i];
    out << i << ' ' << nodeText(graph, node);
    if (node.rule != kNoRule) out << " in " << graph.nameAt(graph.rules[node.rule].name);
    if (node.priority) out << " priority " << node.priority;
    for (uint32_t e = 0; e < node.edgeCount; ++e) {
      const std::string value = edgeValueText(graph, node, e);
      out << (e ? " | " : " { ") << value << (value.empty() ? "" : ": ") << multiplicityText(graph, node, e) << " -> "
          << targetText(graph.edges[node.firstEdge + e].target);
    }
    out << (node.edgeCount ? " }\n" : "\n");
  }
  return out.str();
}

std::string printGroups(const Partition& partition) {
  std::ostringstream out;
  for (const Group& group : partition.groups) {
    out << "group {";
    for (const uint32_t n : group.nodes) out << ' ' << n;
    out << " }\n";
  }
  return out.str();
}

} // namespace gpgp::spawn
