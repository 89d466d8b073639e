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
  uint32_t codes = 0, choices = 1, parts = 1, edges = 1, cut = 0;
  for (const Parameter& parameter : graph.parameters) codes = std::max(codes, lengthOf(graph, parameter));
  for (const Node& node : graph.nodes) {
    if (node.op == kOpRandomRule) choices = std::max(choices, node.edgeCount);
    if (node.op == kOpSubDiv && node.division == UINT32_MAX) parts = std::max(parts, node.edgeCount);
    if (node.op >= kOpCompSplit) edges = std::max(edges, node.edgeCount);
    cut = std::max(cut, cutsOf(graph, node));
  }
  const uint32_t value = loop(codes);                              // evaluate()
  const uint32_t division = loop(parts, value);                    // divisionOf()
  const uint32_t byWords = 2 * loop(edges) + division + loop(cut); // toChild()
  Turns turns;
  turns.fan = division + 2 * value + loop(edges) + loop(cut); // familyFan(), fanOf(): a Repeat, or others
  turns.child = byWords;
  turns.family = loop(kFamilySteps);                   // toDescendant()
  const uint32_t transform = loop(3, value) + loop(3); // and rotationOf()
  const uint32_t choose = value + 2 * loop(choices, value);
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
