// Fields of the world that a graph reads: their numbers by name, and where they are read.
#include "spawn/graph/graph.h"

namespace gpgp::spawn {
namespace {
using namespace shader;

bool reads(const Graph& graph, const Node& node, uint32_t field) {
  for (uint32_t i = 0; i < node.parameterCount; ++i) {
    const Parameter& parameter = graph.parameters[node.firstParameter + i];
    if (!hasProgram(parameter.kind)) continue;
    for (uint32_t at = parameter.value; graph.code[at] != kCodeEnd; ++at) {
      if (graph.code[at] == kCodeField + field) return true;
      if (graph.code[at] == kCodeNumber) ++at; // which follows
    }
  }
  return false;
}
} // namespace

uint32_t fieldNamed(Graph& graph, std::string_view name) {
  for (uint32_t field = 0; field < graph.fields.size(); ++field)
    if (graph.nameAt(graph.fields[field]) == name) return field;
  if (graph.fields.size() == kMaxFields) return kNoField;
  graph.fields.push_back(static_cast<uint32_t>(graph.names.size()));
  graph.names.insert(graph.names.end(), name.begin(), name.end());
  graph.names.push_back(0);
  return static_cast<uint32_t>(graph.fields.size() - 1);
}

const char* ruleThatReads(const Graph& graph, uint32_t field) {
  const auto memory = graph.nodes.get_allocator().resource();
  std::pmr::vector<uint32_t> waiting(memory);
  std::pmr::vector<uint8_t> done(graph.nodes.size(), 0, memory); // bodies of rules begin at nodes that are
  for (const Rule& rule : graph.rules)
    if (rule.node != kNoNode) done[rule.node] = 1;
  for (const Rule& rule : graph.rules) {
    if (rule.node != kNoNode) waiting.push_back(rule.node);
    while (!waiting.empty()) {
      const Node& node = graph.nodes[waiting.back()];
      waiting.pop_back();
      if (reads(graph, node, field)) return graph.nameAt(rule.name);
      for (uint32_t e = 0; e < node.edgeCount; ++e) {
        const uint32_t target = graph.edges[node.firstEdge + e].target;
        if (target == kNoNode || done[target]) continue;
        done[target] = 1;
        waiting.push_back(target);
      }
    }
  }
  return nullptr;
}

} // namespace gpgp::spawn
