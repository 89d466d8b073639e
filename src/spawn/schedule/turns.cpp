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
  uint32_t codes = 0;
  if (parameter.kind != kParameterProgram) return codes;
  for (uint32_t at = parameter.value; graph.code[at] != kCodeEnd; ++at, ++codes)
    if (graph.code[at] == kCodeNumber) ++at;
  return std::min(codes, kDeviceTurns); // more is as bad
}

/// What evaluating parameters takes, at most over operators that invocations may be at beside each other: by a
/// parameter's index, as a loop over parameters is as long as each of its turns is for the longest of them.
class Values {
public:
  explicit Values(const Graph& graph) : graph_(graph), lengths_(graph.nodes.get_allocator().resource()) {}
  void add(const Node& node) {
    if (node.parameterCount > lengths_.size()) lengths_.resize(node.parameterCount, 0);
    for (uint32_t i = 0; i < node.parameterCount; ++i)
      lengths_[i] = std::max(lengths_[i], lengthOf(graph_, graph_.parameters[node.firstParameter + i]));
  }
  /// Of evaluate() for one.
  uint32_t one(uint32_t index) const { return loop(index < lengths_.size() ? lengths_[index] : 0); }
  /// Of a loop over `count` of them: the turn that finds its end runs the longest once more.
  uint32_t over(uint32_t first, uint32_t count) const {
    uint32_t turns = 1, longest = one(UINT32_MAX);
    for (uint32_t i = first; i < first + count; ++i) {
      turns += 1 + one(i);
      longest = std::max(longest, one(i));
    }
    return turns + longest;
  }
  uint32_t longest() const {
    uint32_t longest = one(UINT32_MAX);
    for (uint32_t i = 0; i < lengths_.size(); ++i) longest = std::max(longest, one(i));
    return longest;
  }

private:
  const Graph& graph_;
  std::pmr::vector<uint32_t> lengths_;
};

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
} // namespace

Turns turnsOf(const Graph& graph) {
  uint32_t choices = 1, parts = 1, edges = 1, cut = 0;
  Values ofTransforms(graph), ofChoices(graph), ofDivisions(graph), ofFans(graph);
  for (const Node& node : graph.nodes) {
    if (node.op <= kOpSetGeometry) ofTransforms.add(node);
    if (node.op > kOpSetGeometry && node.op <= kOpRandomRule) ofChoices.add(node);
    if (node.op == kOpRandomRule) choices = std::max(choices, node.edgeCount);
    if (node.op == kOpSubDiv && node.division == UINT32_MAX) {
      parts = std::max(parts, node.edgeCount);
      ofDivisions.add(node);
    }
    if (node.op >= kOpCompSplit) {
      edges = std::max(edges, node.edgeCount);
      ofFans.add(node);
    }
    cut = std::max(cut, cutsOf(graph, node));
  }
  const uint32_t value = ofFans.longest();
  const uint32_t division = ofDivisions.over(0, parts);            // divisionOf()
  const uint32_t byWords = 2 * loop(edges) + division + loop(cut); // toChild()
  Turns turns;
  turns.fan = division + 2 * value + loop(edges) + loop(cut); // familyFan(), fanOf(): a Repeat, or others
  turns.child = byWords;
  turns.family = loop(kFamilySteps);                            // toDescendant()
  const uint32_t transform = ofTransforms.over(0, 3) + loop(3); // and rotationOf()
  const uint32_t choose = ofChoices.one(0) + 2 * ofChoices.over(1, choices);
  turns.passed = 1 + transform + choose + turns.fan + byWords;
  turns.chain = longestChain(graph);
  turns.phases = graph.phases > 0;
  turns.quads = quadsOf(graph);
  return turns;
}

TurnsLimit limitTurns(SpawnConstants& constants, const Turns& turns, const Fit& fit, uint32_t subgroup, bool isKernel) {
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
    constants.childTurns = chain + kQueryTurns;
    constants.batchTurns = kStepTurns + turns.fan + turns.child + turns.family + chain;
    constants.childrenAtOnce = 1;
    constants.leftTurns = 24;
    const uint32_t steps = turns.phases ? 1 : std::max(fit.stackShapes / fit.groupSize, 2u) - 1; // of a batch
    beyond = steps * constants.batchTurns + (turns.phases ? kDeviceTurns / 8 : 0);
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
