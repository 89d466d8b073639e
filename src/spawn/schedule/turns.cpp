#include "spawn/schedule/turns.h"

#include "core/turns.h"
#include "spawn/graph/longest_paths.h"
#include "spawn/outputs/mesh.h"

#include <algorithm>

namespace gpgp::spawn {
namespace {
using namespace shader;

/// A loop of n turns, with others in it that take so many: the turn that finds its end runs those as well.
constexpr uint32_t loop(uint32_t n, uint32_t inside = 0) { return (n + 1) * (1 + inside); }

/// Operators on the longest way between two operators that multiply; kMaxChain where there is one without end.
uint32_t longestChain(const Graph& graph) {
  std::pmr::vector<uint32_t> before(graph.nodes.size(), 0, graph.nodes.get_allocator().resource());
  const bool within = longestPaths(before, kMaxChain - 1, [&](uint32_t n, auto&& reach) {
    const Node& node = graph.nodes[n];
    for (uint32_t e = 0; !multiplies(node) && e < node.edgeCount; ++e)
      if (const uint32_t target = graph.edges[node.firstEdge + e].target; target != kNoNode) reach(target, 1);
  });
  if (!within || before.empty()) return kMaxChain;
  return *std::max_element(before.begin(), before.end()) + 1;
}

/// Of a program's codes.
uint32_t lengthOf(const Graph& graph, const Parameter& parameter) {
  if (!hasProgram(parameter.kind)) return 0;
  uint32_t codes = 0;
  for (uint32_t at = parameter.value; graph.code[at] != kCodeEnd; ++at, ++codes)
    if (graph.code[at] == kCodeNumber) ++at;
  return std::min(codes, kDeviceTurns); // more is as bad
}

/// Of what terminals become as vertices, at most.
uint32_t quadsOf(const Graph& graph) {
  uint32_t shapes = 0, quads = 6;
  for (const Node& node : graph.nodes)
    if (node.op == kOpTerminal) shapes |= node.shapes;
  if (shapes & (1u << kShapeSphere)) quads = std::max(quads, kSphereRings * kSphereSegments);
  for (const Polygon& polygon : graph.polygons) quads = std::max(quads, 3 * polygon.vertexCount);
  return quads;
}

/// Polygons that a SubDiv cuts.
uint32_t cutsOf(const Graph& graph, const Node& node) {
  if (node.op != kOpSubDiv || node.division == UINT32_MAX) return 0;
  const uint32_t at = graph.divisions[node.division + kDivisionCuts];
  return at ? graph.divisions[node.division + at] : 0;
}

/// Steps of a family from its operator to a child (codegen/table.cpp), the choices among them included, at most.
constexpr uint32_t kFamilySteps = 16;
/// Moving shapes between the stack and elsewhere, and what else a step by itself does: ranks, sums, and the search for
/// a parent, over 64 invocations in subgroups of at least four.
constexpr uint32_t kStepTurns = 512, kQueryTurns = 80;
/// Of kRoom, what a SubDiv that keeps one of its parts takes at least: with parts by expressions, or one that cuts.
constexpr uint32_t kDivisionRoom = 16, kCutRoom = 5;

/// Turns that a loop with an expression in each of its turns takes, where invocations run it for operators of their
/// own: in each turn the longest expression of any of them counts.
class LoopOfExpressions {
public:
  void add(uint32_t turn, uint32_t codes) {
    if (turn >= longest_.size()) longest_.resize(turn + 1);
    longest_[turn] = std::max(longest_[turn], codes);
  }
  uint32_t turns() const {
    uint32_t all = loop(0, loop(0)); // the turn that finds the end
    for (const uint32_t codes : longest_) all = std::min(all + 1 + loop(codes), kDeviceTurns);
    return all;
  }

private:
  std::vector<uint32_t> longest_; // by turn
};
} // namespace

Turns turnsOf(const Graph& graph) {
  // A loop of the shaders takes as many turns as the worst operator that runs it; invocations with other operators run
  // other loops meanwhile, so that those add up.
  LoopOfExpressions transform, choice, parts; // loops of transform(), chooseEdge() and divisionOf()
  uint32_t repeatedBy = 0, edges = 1, cut = 0;
  bool sees = false;
  bool rotates = false, keepsPart = false, keepsPiece = false; // of operators that kernels have code with loops for
  for (const Node& node : graph.nodes) {
    const auto codes = [&](uint32_t i) {
      return i < node.parameterCount ? lengthOf(graph, graph.parameters[node.firstParameter + i]) : 0;
    };
    sees |= node.sees;
    if (kOperators[node.op].relation == Relation::Passing) {
      for (uint32_t i = 0; i < std::min(node.parameterCount, 3u); ++i) transform.add(i, codes(i));
      rotates |= node.op == kOpRotate;
    } else if (chooses(node.op)) {
      choice.add(0, codes(0));
      for (uint32_t e = 1; node.op == kOpRandomRule && e <= node.edgeCount; ++e) {
        choice.add(e, codes(e));
        choice.add(node.edgeCount + e, codes(e));
      }
    } else if (couldMultiply(node.op)) {
      edges = std::max(edges, node.edgeCount);
      cut = std::max(cut, cutsOf(graph, node));
      if (node.op == kOpRepeat) repeatedBy = std::max(repeatedBy, codes(0));
      keepsPart |= node.filter && node.op == kOpSubDiv && node.division == UINT32_MAX;
      keepsPiece |= node.filter && cutsOf(graph, node);
      if (node.op == kOpSubDiv && node.division == UINT32_MAX)
        for (uint32_t e = 0; e < node.edgeCount; ++e) parts.add(e, codes(e));
    }
  }
  const uint32_t division = parts.turns(), look = loop(sees);
  Turns turns;
  turns.fan = look + division + 2 * loop(repeatedBy) + loop(edges) + loop(cut); // fanOf() and familyFan()
  turns.child = look + 2 * loop(edges) + division + loop(cut);                  // toChild()
  turns.family = loop(kFamilySteps);                                            // toDescendant()
  turns.passed = 1 + transform.turns() + loop(3) + choice.turns() + turns.fan + turns.child;
  turns.code = (rotates ? kRoom * loop(3) : 0) + (keepsPart ? kRoom / kDivisionRoom * division : 0) +
               (keepsPiece ? kRoom / kCutRoom * loop(cut) : 0);
  turns.chain = longestChain(graph);
  turns.phases = graph.phases > 0;
  turns.quads = quadsOf(graph);
  return turns;
}

TurnsLimit limitTurns(SpawnConstants& constants, const Turns& turns, const Fit& fit, uint32_t subgroup, bool isKernel,
                      Queues queues) {
  constants.operatorTurns = turns.passed;
  constants.mostQueried = 512;
  // Where a shape's operators or children would take more, others get their turn.
  const uint32_t mostAtOnce = subgroup ? kDeviceTurns / 8 : 1024;
  const TurnsLimit shape{turns.passed + turns.fan + turns.child, kDeviceTurns / 8};
  if (!shape) return shape;
  constants.chainLength = std::clamp(mostAtOnce / turns.passed, 1u, turns.chain);
  const uint32_t chain = (constants.chainLength + 1) * turns.passed;
  uint32_t beyond = 0; // what may come after a workgroup has found that it goes on
  if (subgroup) {
    const uint32_t rows = fit.stackShapes / subgroup + 2;
    constants.childTurns = turns.child + (isKernel ? turns.family : 0) + 1;
    constants.batchTurns = turns.fan + 32; // and the turn in which the loop over operators finds its end
    constants.childrenAtOnce = std::clamp(mostAtOnce / constants.childTurns, 1u, fit.stackShapes / 8 / subgroup);
    constants.leftTurns = 1 + kRowTurns;
    beyond = 2 * kRowTurns * rows + chain + constants.batchTurns + constants.childrenAtOnce * constants.childTurns +
             kWriteTurns * (64 / subgroup + constants.childrenAtOnce + 4) + 256;
  } else {
    // Each step counts as the worst one. Queries are counted as they are made, and one has room for as much as all
    // else.
    const uint32_t code = isKernel ? turns.code : 0;
    constants.childTurns = chain + code + kQueryTurns;
    constants.batchTurns = kStepTurns + turns.fan + turns.child + turns.family + chain + code;
    constants.childrenAtOnce = 1;
    constants.leftTurns = 24;
    const uint32_t steps = turns.phases ? 1 : std::max(fit.stackShapes / fit.groupSize, 2u) - 1; // of a batch
    beyond = steps * constants.batchTurns + (turns.phases ? kDeviceTurns / 8 : 0);
    if (queues == Queues::groups) { // two more batches may be chosen, one of them what was fetched
      constants.leftTurns += kMostQueues / fit.groupSize + 2;
      beyond += 3 * gatherTurns(fit.stackShapes, fit.groupSize);
    }
  }
  const uint32_t leftRows = subgroup ? 8192 : 512;
  constants.mostLeft = leftRows * (subgroup ? subgroup : fit.groupSize);
  beyond += constants.leftTurns * leftRows;
  const TurnsLimit all{beyond, kDeviceTurns - kDeviceTurns / 8 - 1};
  if (!all) return all;
  constants.steps = kDeviceTurns - beyond;
  return all;
}

Expansion expansionOf(const Turns& turns) {
  // Four vertices and six indices, 64 of either at once, each with the search for its record and its words.
  const uint32_t mostQuads = kDeviceTurns / 2 / 5;
  const uint32_t records = std::clamp(mostQuads / turns.quads, 1u, kSpawnGroupSize);
  return {records, std::max(mostQuads / (records * turns.quads + 1), 1u)};
}

} // namespace gpgp::spawn
