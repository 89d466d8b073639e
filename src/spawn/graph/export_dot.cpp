#include "spawn/graph/export.h"
#include "spawn/graph/export_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace gpgp::spawn {
namespace {
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}
std::string startName(size_t axiom) {
  return std::string("start").append(axiom ? std::to_string(axiom) : std::string());
}
} // namespace

std::string groupColour(uint32_t group) {
  const double hue = 6 * std::fmod(0.55 + group * 0.61803398875, 1.0);
  const auto channel = [&](double shift) { // hue to a channel at high lightness
    const double t = std::fmod(hue + shift, 6.0);
    const double v = std::clamp(std::fabs(t - 3) - 1, 0.0, 1.0);
    return static_cast<unsigned>(std::lround(255 * (0.80 + 0.16 * v)));
  };
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", channel(0), channel(4), channel(2));
  return text.data();
}

std::string exportDot(const Graph& graph, const Partition* partition) {
  std::ostringstream out;
  out << "digraph grammar {\n  node [shape=box, style=\"rounded,filled\", fillcolor=white, fontname=\"sans-serif\"];\n";
  for (size_t a = 0; a < graph.axioms.size(); ++a)
    out << "  " << startName(a) << " [label=\"" << escaped(axiomText(graph, graph.axioms[a])) << "\", color=blue];\n";
  const auto node = [&](const char* indent, uint32_t n) {
    const Node& v = graph.nodes[n];
    const bool unreached = partition && partition->groupOf[n] == kNoGroup;
    out << indent << 'n' << n << " [label=\"" << escaped(nodeText(graph, v)) << '"'
        << (v.op == shader::kOpTerminal ? ", color=orange"
            : unreached                 ? ", style=dashed"
                                        : "")
        << "];\n";
  };
  if (partition)
    for (uint32_t g = 0; g < partition->groups.size(); ++g) {
      out << "  subgraph cluster" << g << " {\n    style=\"rounded,filled\"; color=gray; fillcolor=\"" << groupColour(g)
          << "\"; label=\"" << g << "\";\n";
      for (const uint32_t n : partition->groups[g].nodes) node("    ", n);
      out << "  }\n";
    }
  for (uint32_t n = 0; n < graph.nodes.size(); ++n)
    if (!partition || partition->groupOf[n] == kNoGroup) node("  ", n);
  uint32_t discards = 0;
  const auto edge = [&](const std::string& source, uint32_t target, const std::string& label, const char* style) {
    std::string end = std::string("n").append(std::to_string(target));
    if (target == kNoNode) {
      end = std::string("discard").append(std::to_string(discards++));
      out << "  " << end << " [shape=plain, fillcolor=none, fontcolor=gray, label=\"\u00d7\"];\n";
    }
    out << "  " << source << " -> " << end << " [label=\"" << escaped(label) << '"' << style << "];\n";
  };
  for (size_t a = 0; a < graph.axioms.size(); ++a)
    edge(startName(a), graph.axioms[a].node, "*", partition ? ", color=blue" : "");
  for (uint32_t n = 0; n < graph.nodes.size(); ++n) {
    const Node& v = graph.nodes[n];
    for (uint32_t e = 0; e < v.edgeCount; ++e) {
      const uint32_t target = graph.edges[v.firstEdge + e].target;
      const std::string value = edgeValueText(graph, v, e);
      const char* style = "";
      if (partition && target != kNoNode && partition->groupOf[n] != kNoGroup)
        style = partition->isRoot(target) ? ", color=blue" : ", color=darkgreen";
      edge(std::string("n").append(std::to_string(n)), target,
           value + (value.empty() ? "" : ": ") + multiplicityText(graph, v, e), style);
    }
  }
  for (const Dependency& d : dependenciesOf(graph))
    out << "  n" << d.source << " -> n" << d.target << " [style=dashed, color=red, constraint=false];\n";
  out << "}\n";
  return out.str();
}

} // namespace gpgp::spawn
