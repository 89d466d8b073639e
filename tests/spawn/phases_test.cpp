// Phases: closed forms, and brute force for the least number of them.
#include "graphs.h"
#include "spawn/graph/heuristics.h"
#include "spawn/graph/phases.h"

#include <gtest/gtest.h>

#include <functional>

namespace {
using namespace gpgp;
using namespace gpgp::spawn;
using namespace gpgp::test;

/// Does any assignment of so many phases do?
bool possible(const Flow& flow, uint32_t count) {
  std::vector<uint32_t> phase(flow.rank.size(), 0);
  const std::function<bool(size_t)> place = [&](size_t index) {
    if (index == flow.order.size()) {
      for (const uint32_t n : flow.order)
        for (const Link& link : flow.out[n])
          if (phase[link.target] < phase[n]) return false;
      for (const Dependency& d : flow.dependencies)
        if (phase[d.target] <= phase[d.source]) return false;
      return true;
    }
    for (uint32_t p = 0; p < count; ++p) {
      phase[flow.order[index]] = p;
      if (place(index + 1)) return true;
    }
    return false;
  };
  return place(0);
}

TEST(Phases, OneWithoutDependencies) {
  const Graph graph = compiled(kSponge);
  const auto phases = phasesOfNodes(makeFlow(graph));
  ASSERT_TRUE(phases);
  EXPECT_EQ(phases->count, 1u);
}

TEST(Phases, WhatDependsRunsLaterAndShapesNeverReturn) {
  const Graph graph = ofRules("A = Replicate() { Translate(1,0,0) T | Rotate(0,1,0) Scale(1,1,2) U };");
  const uint32_t t = nodeOf(graph, shader::kOpTranslate), r = nodeOf(graph, shader::kOpRotate),
                 s = nodeOf(graph, shader::kOpScale);
  const std::vector<Dependency> dependencies{{t, r}};
  const auto phases = phasesOfNodes(makeFlow(graph, {}, dependencies));
  ASSERT_TRUE(phases);
  EXPECT_EQ(phases->count, 2u);
  EXPECT_EQ(phases->phaseOf[t], 0u);
  EXPECT_EQ(phases->phaseOf[r], 1u);
  EXPECT_EQ(phases->phaseOf[s], 1u);
  EXPECT_EQ(phases->phaseOf[0], 0u);
  // Priorities: Translate first, then Rotate, then Scale: three phases, as all depend on the level above.
  std::vector<uint32_t> priorities(graph.nodes.size(), 3);
  priorities[r] = 2;
  priorities[s] = priorities[graph.edges[graph.nodes[s].firstEdge].target] = 1;
  const Flow flow = makeFlow(graph);
  const auto levels = phasesOfNodes(makeFlow(graph, {}, dependenciesOfPriorities(flow, priorities)));
  ASSERT_TRUE(levels);
  EXPECT_EQ(levels->count, 3u);
}

TEST(Phases, DependingOnTheFutureIsAnError) {
  const Graph graph = compiled(kSponge);
  const uint32_t terminal = nodeOf(graph, shader::kOpTerminal), test = nodeOf(graph, shader::kOpIfSizeLess);
  const std::vector<Dependency> backwards{{terminal, test}};
  const auto phases = phasesOfNodes(makeFlow(graph, {}, backwards));
  ASSERT_FALSE(phases);
  EXPECT_NE(std::string(phases.error().text).find("depends on node " + std::to_string(terminal)), std::string::npos);
}

TEST(Phases, GroupsMayWaitForEachOtherWhereNodesDoNot) {
  const Graph graph = ofRules("A = Replicate() { Translate(1,0,0) T | Rotate(0,1,0) Scale(1,1,2) U };");
  const uint32_t t = nodeOf(graph, shader::kOpTranslate), r = nodeOf(graph, shader::kOpRotate);
  const std::vector<Dependency> dependencies{{t, r}};
  const Flow flow = makeFlow(graph, {}, dependencies);
  Roots roots = singleGroups(flow);
  ASSERT_TRUE(canJoin(flow, roots, r));
  join(flow, roots, r); // with Replicate, which leads to t
  EXPECT_FALSE(violation(flow, roots));
  EXPECT_FALSE(phasesOfGroups(flow, makePartition(flow, roots)));
  EXPECT_TRUE(phasesOfGroups(flow, makePartition(flow, singleGroups(flow))));
}

TEST(Phases, AreAsFewAsPossible) {
  uint32_t feasible = 0, infeasible = 0, many = 0;
  for (uint32_t seed = 0; seed < 3000; ++seed) {
    const Graph graph = compiled(randomGrammar(seed));
    std::mt19937 random(seed);
    Flow flow = makeFlow(graph);
    if (flow.order.size() < 3 || flow.order.size() > 7) continue;
    std::vector<Dependency> dependencies;
    for (int i = 0; i < 3; ++i) {
      const uint32_t s = flow.order[random() % flow.order.size()], d = flow.order[random() % flow.order.size()];
      if (s != d) dependencies.push_back({s, d});
    }
    flow = makeFlow(graph, {}, dependencies);
    const auto phases = phasesOfNodes(flow);
    if (!phases) {
      EXPECT_FALSE(possible(flow, 4)) << seed; // three dependencies never need more
      ++infeasible;
      continue;
    }
    EXPECT_TRUE(possible(flow, phases->count)) << seed;
    EXPECT_FALSE(possible(flow, phases->count - 1)) << seed;
    for (const Dependency& d : dependencies) EXPECT_GT(phases->phaseOf[d.target], phases->phaseOf[d.source]);
    for (const uint32_t n : flow.order)
      for (const Link& link : flow.out[n]) EXPECT_GE(phases->phaseOf[link.target], phases->phaseOf[n]);
    ++feasible;
    many += phases->count > 2;
  }
  EXPECT_GT(feasible, 100u);
  EXPECT_GT(infeasible, 50u);
  EXPECT_GT(many, 20u);
}

} // namespace
