#include "spawn/language/append_graph.h"

#include "spawn/language/build_graph.h"
#include "spawn/language/lexer.h"

#include <algorithm>

namespace gpgp::spawn {
namespace {
using namespace shader;

template <class List> uint32_t sizeOf(const List& list) { return static_cast<uint32_t>(list.size()); }

/// Names in their order, which is that of adding them: new offsets by old ones, and by what they name. Of a field the
/// number.
enum class Named { other, tag, field };
using Names = std::map<std::pair<uint32_t, Named>, uint32_t>;

Names appendNames(const Graph& part, const std::string& name, Graph& graph, Tags& tags, Diagnostics& diagnostics) {
  Names names;
  for (const Terminal& t : part.terminals) names[{t.name, Named::other}];
  for (const Rule& r : part.rules) names[{r.name, Named::other}];
  for (size_t i = name.empty() ? 0 : 1; i < part.axioms.size(); ++i) names[{part.axioms[i].name, Named::other}];
  for (const Node& n : part.nodes)
    if (isContext(n.op) && (n.argument & kTagName)) names[{n.argument & ~kTagName, Named::tag}];
  for (const uint32_t field : part.fields) names[{field, Named::field}];
  for (auto& [old, added] : names) {
    const std::string text = part.nameAt(old.first);
    if (old.second == Named::other) {
      added = addName(graph, name.empty() ? text : name + "." + text);
    } else if (old.second == Named::field) {
      added = fieldNamed(graph, text);
      if (added == kNoField) diagnostics.error({}, kTooManyFields);
    } else {
      const auto [tag, isNew] = tags.try_emplace(text);
      if (isNew) tag->second = kTagName | addName(graph, text);
      added = tag->second;
    }
  }
  return names;
}

/// All but the regular ones, which every graph has, and pieces, which follow from the whole.
void appendPolygons(const Graph& part, Graph& graph) {
  for (size_t i = kRegularPolygons; i < part.polygons.size() - part.pieces; ++i) {
    const Polygon& p = part.polygons[i];
    graph.polygons.push_back({sizeOf(graph.vertices) / 2, p.vertexCount, sizeOf(graph.quads) / kQuadSize, p.quadCount});
    const auto vertices = part.vertices.begin() + 2 * std::ptrdiff_t(p.firstVertex);
    graph.vertices.insert(graph.vertices.end(), vertices, vertices + 2 * std::ptrdiff_t(p.vertexCount));
    const auto quads = part.quads.begin() + kQuadSize * std::ptrdiff_t(p.firstQuad);
    graph.quads.insert(graph.quads.end(), quads, quads + kQuadSize * std::ptrdiff_t(p.quadCount));
  }
}

void appendCode(const Graph& part, const Names& names, Graph& graph) {
  for (size_t at = 0; at < part.code.size(); ++at) {
    uint32_t code = part.code[at];
    if (isField(code)) code = kCodeField + names.at({part.fields[code - kCodeField], Named::field});
    graph.code.push_back(code);
    if (code == kCodeNumber) graph.code.push_back(part.code[++at]);
  }
}
} // namespace

std::string linkedName(std::string_view file) {
  std::string name(file.substr(file.find_last_of("/\\") + 1)); // npos + 1 is 0
  name.erase(std::min(name.find('.'), name.size()));
  for (char& c : name)
    if (!isNameCharacter(c)) c = '_';
  const bool digits = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
  return digits ? std::string("_").append(name) : name;
}

uint32_t addName(Graph& graph, std::string_view name) {
  const uint32_t at = sizeOf(graph.names);
  graph.names.insert(graph.names.end(), name.begin(), name.end());
  graph.names.push_back(0);
  return at;
}

void appendGraph(const Graph& part, const std::string& name, Graph& graph, Tags& tags, Diagnostics& diagnostics) {
  const uint32_t firstNode = sizeOf(graph.nodes), firstEdge = sizeOf(graph.edges),
                 firstParameter = sizeOf(graph.parameters), firstCode = sizeOf(graph.code),
                 firstPolygon = sizeOf(graph.polygons) - kRegularPolygons, firstTerminal = sizeOf(graph.terminals),
                 firstRule = sizeOf(graph.rules), firstAxiom = sizeOf(graph.axioms), firstBucket = graph.buckets;
  const auto node = [&](uint32_t n) { return n == kNoNode ? kNoNode : firstNode + n; };
  const auto polygon = [&](uint32_t p) { return p < kRegularPolygons ? p : firstPolygon + p; };
  const Names names = appendNames(part, name, graph, tags, diagnostics);
  const auto named = [&](uint32_t offset) { return names.at({offset, Named::other}); };

  appendPolygons(part, graph);
  for (Node n : part.nodes) {
    if (n.op != kOpTerminal) { // which has neither
      n.firstParameter += firstParameter;
      n.firstEdge += firstEdge;
    }
    if (n.op == kOpSetGeometry) n.argument2 = polygon(n.argument2);
    if (isContext(n.op) && (n.argument & kTagName)) n.argument = names.at({n.argument & ~kTagName, Named::tag});
    if (n.op == kOpTerminal) {
      n.argument += firstTerminal;
      n.argument2 += firstBucket;
      if (n.rule != kNoRule) n.rule += firstRule;
    }
    graph.nodes.push_back(n);
  }
  for (Edge e : part.edges) {
    e.target = node(e.target);
    graph.edges.push_back(e);
  }
  for (Parameter p : part.parameters) {
    if (hasProgram(p.kind)) p.value += firstCode;
    graph.parameters.push_back(p);
  }
  appendCode(part, names, graph);
  for (const Terminal& t : part.terminals)
    graph.terminals.push_back({named(t.name), t.kind, t.index, firstBucket + t.bucket});
  graph.buckets += part.buckets;
  for (const Rule& r : part.rules) graph.rules.push_back({named(r.name), node(r.node), firstAxiom + r.axiom});
  for (const Axiom& a : part.axioms) {
    const bool isWhole = &a == part.axioms.data() && !name.empty();
    graph.axioms.push_back({isWhole ? addName(graph, name) : named(a.name), node(a.node), a.shape, polygon(a.polygon)});
  }
}

} // namespace gpgp::spawn
