#include "spawn/codegen/room.h"

#include <algorithm>

namespace gpgp::spawn {
namespace {
using namespace shader;

/// What the camera sees of a shape is as much code as so many others, and what a field has at a place of it.
constexpr uint32_t kSeenCodes = 24, kFieldCodes = 12;

/// Of an operator's expressions.
uint32_t codesOf(const Graph& graph, const Node& node) {
  uint32_t codes = 0;
  for (uint32_t i = 0; i < node.parameterCount; ++i)
    if (const Parameter& p = graph.parameters[node.firstParameter + i]; hasProgram(p.kind))
      for (uint32_t at = p.value; graph.code[at] != kCodeEnd && codes < 8 * kRoom; ++at, ++codes) {
        if (graph.code[at] >= kCodeView) codes += kSeenCodes;
        if (isField(graph.code[at])) codes += kFieldCodes;
        if (graph.code[at] == kCodeNumber) ++at;
      }
  return codes;
}

/// Of what an operator does, by the time that compilers take for twelve of them in a row, beside twelve translations.
uint32_t codeOf(const Node& node) {
  if (node.op == kOpCompSplit) return node.shapes == 1u << kShapeBox ? 8 : 24;
  if (node.op == kOpSubDiv) return node.division == UINT32_MAX ? 16 : 5;
  if (node.op == kOpRaiseRoof || node.op == kOpToRoofFace) return 4;
  return 1;
}

/// What chains are inlined to, by the node whose code it is: at most 2 kRoom.
class Measure {
public:
  Measure(const Graph& graph, const std::vector<bool>& waits, const std::vector<uint32_t>& first)
      : graph_(graph), waits_(waits), first_(first), seen_(graph.nodes.size()), weights_(graph.nodes.size()) {}

  std::vector<uint32_t> run() {
    for (uint32_t n = 0; n < graph_.nodes.size(); ++n) measure(n);
    return std::move(weights_);
  }

private:
  template <class Call> void forCalled(uint32_t node, const Call& call) const {
    for (uint32_t e = 0; e < graph_.nodes[node].edgeCount; ++e) {
      const Edge& edge = graph_.edges[graph_.nodes[node].firstEdge + e];
      if (edge.target != kNoNode && !edge.recursive && !waits_[edge.target]) call(first_[edge.target]);
    }
  }
  /// Depth first by hand, as chains may be long: what a chain calls is measured before it.
  void measure(uint32_t index) {
    struct Visit {
      uint32_t node;
      bool opened;
    };
    std::vector<Visit> stack{{first_[index], false}};
    while (!stack.empty()) {
      const auto [node, opened] = stack.back();
      const Node& n = graph_.nodes[node];
      if (!opened && !seen_[node] && isChain(n)) {
        seen_[node] = 1;
        stack.back().opened = true;
        forCalled(node, [&](uint32_t target) { stack.push_back({target, false}); });
        continue;
      }
      stack.pop_back();
      if (!opened) continue;
      uint32_t weight = weightOf(graph_, n);
      forCalled(node, [&](uint32_t target) { // terminals and what multiplies have none
        weight = std::min(weight + weights_[target], 2 * kRoom);
      });
      weights_[node] = weight;
    }
  }

  const Graph& graph_;
  const std::vector<bool>& waits_;
  const std::vector<uint32_t>& first_;
  std::vector<uint8_t> seen_;
  std::vector<uint32_t> weights_;
};
} // namespace

uint32_t weightOf(const Graph& graph, const Node& node) {
  return codeOf(node) + codesOf(graph, node) / 4 + node.edgeCount / 2;
}

Room findRoom(const Graph& graph, const std::vector<bool>& waits, const std::vector<uint32_t>& first,
              const std::vector<bool>& entered, const std::vector<bool>& chooses) {
  const auto count = static_cast<uint32_t>(graph.nodes.size());
  const std::vector<uint32_t> inlined = Measure(graph, waits, first).run();
  std::vector<bool> enters(count); // by the node whose code it is
  for (uint32_t n = 0; n < count; ++n)
    if (entered[n]) enters[first[n]] = true;
  Room room;
  room.named.resize(count);
  room.coded.resize(count);
  std::vector<uint32_t> weights; // of what is named
  uint64_t all = 0;
  for (uint32_t n = 0; n < count; ++n) {
    const Node& node = graph.nodes[n];
    if (chooses[n]) all += weightOf(graph, node);
    if (multiplies(node)) all += codesOf(graph, node) / 4;
    room.coded[n] = isChain(node) && first[n] == n;
    room.named[n] = room.coded[n] && enters[n];
    if (!room.named[n]) continue;
    weights.push_back(inlined[n]);
    all += inlined[n];
  }
  if (all <= kRoom) return room;
  // Only light chains are code. None of them calls a heavier one.
  room.words = true;
  std::sort(weights.begin(), weights.end());
  uint32_t most = 0;
  uint64_t sum = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    if (sum > kRoomBesideWords) break;
    if (i + 1 == weights.size() || weights[i + 1] > weights[i]) most = weights[i];
  }
  for (uint32_t n = 0; n < count; ++n) {
    if (isChain(graph.nodes[n]) && inlined[first[n]] > most) ++room.byWords;
    if (!room.coded[n] || inlined[n] <= most) continue;
    room.coded[n] = room.named[n] = false;
  }
  return room;
}

} // namespace gpgp::spawn
