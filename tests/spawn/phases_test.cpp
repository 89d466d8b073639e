// Phases: closed forms, and brute force for the least number of them.
#include "graphs.h"
#include "spawn/graph/heuristics.h"
#include "spawn/graph/phases.h"

#include <gtest/gtest.h>

#include <algorithm>

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
  for (uint32_t seed = 0; seed < 4000; ++seed) {
    const Graph graph = compiled(randomGrammar(seed));
    std::mt19937 random(seed);
    Flow flow = makeFlow(graph);
    if (flow.order.size() < 3 || flow.order.size() > 7 || graph.phases) continue; // with dependencies of its own
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

TEST(Phases, OfCollidersAreTheLeast) {
  uint32_t several = 0;
  const auto check = [&](const Graph& graph, uint32_t seed) {
    std::vector<uint32_t> all(graph.nodes.size()); // a derivation may start with any rule
    for (uint32_t n = 0; n < all.size(); ++n) all[n] = n;
    const Flow flow = makeFlow(graph, all);
    const auto phases = phasesOfNodes(flow);
    ASSERT_TRUE(phases) << seed;
    EXPECT_EQ(flow.dependencies.size(), dependenciesOf(graph).size());
    if (graph.phases == 0) {
      EXPECT_TRUE(flow.dependencies.empty());
      return;
    }
    EXPECT_EQ(graph.phases, phases->count) << seed;
    for (uint32_t n = 0; n < graph.nodes.size(); ++n)
      if (graph.nodes[n].op == shader::kOpIfCollides) {
        EXPECT_EQ(graph.nodes[n].argument2, phases->phaseOf[n]) << seed;
      }
    several += graph.phases > 2;
    if (flow.order.size() > 8) return;
    EXPECT_TRUE(possible(flow, graph.phases)) << seed;
    if (graph.phases > 1) {
      EXPECT_FALSE(possible(flow, graph.phases - 1)) << seed;
    }
  };
  for (uint32_t seed = 0; seed < 6000; seed += 3) check(compiled(randomGrammar(seed)), seed);
  EXPECT_GT(several, 2u);
  check(ofRules("A = Collider(1) IfCollides(1) { T | U };"), 1);
  check(ofRules("A = Replicate() { Collider(1) T | IfCollides(1) { Collider(2) T | IfCollides(2) { T | U } } };"), 2);
  check(ofRules("A = Replicate() { Collider(1) Collider(2) T | IfCollides(1) { T | IfCollides(2) { T | U } } };"), 3);
}

TEST(Phases, OfPrioritiesAreTheLeast) {
  uint32_t ordered = 0, several = 0, impossible = 0;
  for (uint32_t seed = 0; seed < 6000; ++seed) {
    Graph graph = compiled(randomGrammar(seed));
    if (graph.phases == 0) continue;
    std::mt19937 random(seed);
    for (Node& node : graph.nodes) node.priority = static_cast<uint32_t>(random() % 3);
    analyse(graph);
    std::vector<uint32_t> all(graph.nodes.size());
    for (uint32_t n = 0; n < all.size(); ++n) all[n] = n;
    const auto phases = phasesOfNodes(makeFlow(graph, all));
    if (graph.phases == kNoPhases) {
      EXPECT_TRUE(!phases || phases->count > shader::kMaxPhases) << seed;
      ++impossible;
      continue;
    }
    ASSERT_TRUE(phases) << seed;
    EXPECT_EQ(graph.phases, phases->count) << seed;
    uint32_t before = 0; // the first phase in which a collider may come
    for (const Dependency& d : dependenciesOf(graph)) {
      const Node &source = graph.nodes[d.source], &target = graph.nodes[d.target];
      if (source.priority == target.priority || target.op != shader::kOpCollider) continue;
      EXPECT_GT(target.argument2, phases->phaseOf[d.source]) << seed; // it waits for all of them
      before = std::max(before, target.argument2);
    }
    for (uint32_t n = 0; n < graph.nodes.size(); ++n) {
      if (graph.nodes[n].op == shader::kOpIfCollides) {
        EXPECT_EQ(graph.nodes[n].argument2, phases->phaseOf[n]) << seed;
      }
      if (graph.nodes[n].op == shader::kOpCollider) {
        EXPECT_LE(graph.nodes[n].argument2, phases->phaseOf[n]) << seed;
      }
    }
    ++ordered;
    several += before > 0;
  }
  EXPECT_GT(ordered, 100u);
  EXPECT_GT(several, 20u);
  EXPECT_GT(impossible, 20u);
}

TEST(Phases, CollidersThatWaitForEachOtherAreAnErrorWithBothPlaces) {
  const std::string head = "axiom Box A; terminal T (1,0); terminal U (1,1);\n";
  const auto messages = [&](const std::string& rules) {
    auto all = messagesOf(head + rules);
    all.erase(std::remove_if(all.begin(), all.end(),
                             [](const std::string& m) { return m.find("error") == std::string::npos; }),
              all.end());
    return all;
  };
  // Of two tags that wait for each other, each names the other's place.
  EXPECT_EQ(messages("A = Replicate() { IfCollides(a) { T | Collider(b) U } | IfCollides(b) { T | Collider(a) U } };"),
            (std::vector<std::string>{"2:19: error: IfCollides(a) waits for all of Collider(a) in line 2, "
                                      "which comes after it",
                                      "2:57: error: IfCollides(b) waits for all of Collider(b) in line 2, "
                                      "which comes after it"}));
  // Eight phases do, nine do not.
  const auto chain = [&](int phases) {
    std::string text = "A = ";
    for (int i = 0; i + 1 < phases; ++i)
      text += "Collider(" + std::to_string(i) + ") IfCollides(" + std::to_string(i) + ") { T | ";
    text += "U";
    for (int i = 0; i + 1 < phases; ++i) text += " }";
    return messages(text + ";");
  };
  EXPECT_EQ(chain(8), std::vector<std::string>{});
  ASSERT_EQ(chain(9).size(), 1u);
  EXPECT_NE(chain(9)[0].find("wait for each other in more than 8 phases"), std::string::npos);
}

} // namespace
