// Schedules as generated kernels take them: which nodes shapes wait for.
#include "grammars.h"
#include "random_grammar.h"
#include "spawn/codegen/compile_kernel.h"
#include "spawn/codegen/generate.h"
#include "spawn/codegen/schedules.h"
#include "spawn/graph/kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::test;

spawn::Graph graphOf(const std::string& text) {
  spawn::Diagnostics diagnostics;
  spawn::Graph graph = spawn::compile(text, {}, diagnostics, std::pmr::new_delete_resource());
  if (diagnostics.hasErrors()) throw std::runtime_error("the grammar has errors");
  return graph;
}

TEST(Schedules, UnevenDerivationsAreKnownByTheirGraph) {
  const auto uneven = [](const char* rules) {
    return isUneven(graphOf(std::string("axiom Box A; terminal T U (1, 0);\n") + rules));
  };
  EXPECT_TRUE(uneven("A = RandomRule(ShapeSeed()) { 1: T | 2: B }; B = Repeat(X, 0.1, ADJUST_TO_FILL) U;"));
  EXPECT_FALSE(uneven("A = RandomRule(ShapeSeed()) { 1: T | 2: U };")); // one for one
  EXPECT_FALSE(
      uneven("A = Repeat(X, 0.1, ADJUST_TO_FILL) SubDiv(Y) { 1: T | -1: U };")); // alike for all axioms of a size
}

TEST(Schedules, TheDefaultWaitsForSubDivsBehindSubDivsWhereThereAreMany) {
  // Nothing waits where few programs make all children, so that there is a rule with many.
  const std::string many = R"(
M = Replicate() { Translate(1, 0, 0) T | Rotate(0, 9, 0) T | Scale(1, 1, 2) T | Translate(1, 0, 0) Rotate(0, 9, 0) T |
  Rotate(0, 9, 0) Scale(1, 1, 2) T | Translate(1, 0, 0) Scale(2, 1, 1) T | Scale(1, 1, 2) Translate(1, 0, 0) T |
  Translate(1, 0, 0) Rotate(0, 5, 0) Scale(1, 2, 3) T | Rotate(0, 9, 0) Translate(1, 0, 0) T };)";
  const auto waitingWith = [](const std::string& rules) {
    const spawn::Graph graph = graphOf("axiom Box A; terminal T U (1, 0);\n" + rules);
    const auto waits = spawn::namedSchedule(graph, "default")->waits;
    return std::count(waits.begin(), waits.end(), true);
  };
  const auto waiting = [&](const std::string& rules) { return waitingWith(rules + many); };
  EXPECT_EQ(waitingWith("A = SubDiv(Y) { 0.3: SubDiv(X) { 0.3: T | -1: U } | -1: T };"), 0);
  const std::string uneven = " B = RandomRule(ShapeSeed()) { 1: T | 2: C }; C = Repeat(X, 0.1, ADJUST_TO_FILL) ";
  const std::string twice = "SubDiv(Y) { 0.3: SubDiv(X) { 0.3: T | -1: B } | -1: T };";
  EXPECT_EQ(waiting("A = SubDiv(Y) { 0.3: SubDiv(X) { 0.3: T | -1: U } | -1: T };"), 1);
  EXPECT_EQ(waiting("A = " + twice + uneven + "U;"), 0); // one for each axiom
  EXPECT_EQ(waiting("A = B;" + uneven + "SubDiv(Y) { 0.3: SubDiv(X) { 0.3: T | -1: U } | -1: T };"), 1);
  EXPECT_EQ(
      waiting("A = IfSizeLess(X, 0.2) { T | SubDiv(Y) { 0.3: SubDiv(X) { -1: A | -1: B } | -1: T } };" + uneven + "U;"),
      1); // one for each turn
}

TEST(Schedules, RootsWaitButForTerminals) {
  for (uint32_t seed = 0; seed < 300; ++seed) {
    const spawn::Graph graph = graphOf(randomGrammar(seed));
    const spawn::Flow flow = spawn::makeFlow(graph);
    bool complete = false;
    for (const auto search : {spawn::Search::random, spawn::Search::heuristic})
      for (const spawn::Schedule& schedule : searchSchedules(graph, search, 8, seed, complete)) {
        ASSERT_EQ(schedule.waits.size(), graph.nodes.size());
        for (size_t n = 0; n < graph.nodes.size(); ++n) {
          const bool terminal = graph.nodes[n].op == shader::kOpTerminal;
          const bool root = !schedule.roots.empty() && flow.rank[n] != spawn::kNoNode && schedule.roots[n] == n;
          if (terminal || !schedule.roots.empty()) {
            ASSERT_EQ(schedule.waits[n], root && !terminal) << schedule.name << "\n" << randomGrammar(seed);
          }
        }
      }
  }
}

TEST(Schedules, GroupsOfTheDefaultAreThoseOfItsPartition) {
  // Shapes wait at the Repeat; what it and Replicate lead to is a third group, though no shape waits for it.
  const spawn::Graph graph = graphOf("axiom Box A; terminal T (1,0); A = Replicate() { S | R };\n"
                                     "R = Repeat(Y, 1, ADJUST_TO_FILL) S; S = Scale(1,1,1) T;");
  const spawn::Flow flow = spawn::makeFlow(graph);
  std::vector<uint32_t> groupOf(graph.nodes.size());
  for (uint32_t n = 0; n < graph.nodes.size(); ++n)
    groupOf[n] = graph.nodes[n].op == shader::kOpReplicate ? 0 : graph.nodes[n].op == shader::kOpRepeat ? 1 : 2;
  ASSERT_FALSE(spawn::violation(flow, groupOf));
  EXPECT_EQ(spawn::namedSchedule(graph, "default")->groups, spawn::partitionOfGroups(flow, groupOf).groups.size());
  // Where nothing waits it is one, as that of sgl.
  const spawn::Graph one = graphOf("axiom Box A; terminal T (1,0); A = Scale(1,1,1) T;");
  EXPECT_EQ(spawn::namedSchedule(one, "default")->groups, spawn::namedSchedule(one, "sgl")->groups);
}

TEST(Schedules, LongChainsAreNamedWhereShapesEnter) { // as each name inlines the chain to its end
  std::string rules = "axiom Box A; terminal T (1,0); A = ";
  for (int i = 0; i < 150; ++i) rules += "Translate(1,0,0) ";
  const spawn::Graph graph = graphOf(rules + "T;");
  const std::string text = spawn::generate(graph, spawn::namedSchedule(graph, "default")->waits).functions;
  size_t named = 0;
  for (size_t at = text.find("uint runChain("); (at = text.find("end = chain", at)) != std::string::npos; ++at) ++named;
  EXPECT_GE(named, 1u);
  EXPECT_LE(named, 30u);
}

TEST(Schedules, TheNamedOnesAreOrdered) {
  // Rewriting waits wherever a shape can arrive.
  for (const std::string& name : ownGrammarNames()) {
    const spawn::Graph graph = graphOf(ownGrammar(name));
    const auto most = *spawn::namedSchedule(graph, "rw");
    const spawn::Flow flow = spawn::makeFlow(graph);
    for (const char* other : {"sgl", "rules", "heuristic", "default"}) {
      const auto schedule = *spawn::namedSchedule(graph, other);
      EXPECT_LE(spawn::namedSchedule(graph, "sgl")->groups, schedule.groups) << name;
      EXPECT_GE(most.groups, schedule.groups) << name;
      for (uint32_t n = 0; n < graph.nodes.size(); ++n) {
        if (schedule.waits[n] && flow.rank[n] != spawn::kNoNode) {
          EXPECT_TRUE(most.waits[n]) << name << ' ' << other;
        }
      }
    }
  }
  EXPECT_FALSE(spawn::namedSchedule(graphOf(ownGrammar("sponge.pga")), "sideways"));
}

TEST(Schedules, AnExhaustiveSearchMeetsEveryKernelOnce) {
  const auto text = sharedGrammar("menger_sponge_3.pga");
  if (!text) GTEST_SKIP() << "menger_sponge_3.pga is not in the shared data folder";
  const spawn::Graph graph = graphOf(*text);
  bool complete = false;
  const auto all = searchSchedules(graph, spawn::Search::exhaustive, 1000, 1, complete);
  EXPECT_TRUE(complete);
  std::set<std::vector<bool>> kernels;
  for (const spawn::Schedule& schedule : all) EXPECT_TRUE(kernels.insert(schedule.waits).second) << schedule.name;
  std::set<std::vector<bool>> partitions; // of the 40, those that differ in more than whether the terminal is a group
  const spawn::Flow flow = spawn::makeFlow(graph);
  spawn::PartitionEnumerator enumerator(flow);
  do partitions.insert(spawn::scheduleOf(graph, flow, enumerator.roots(), "").waits);
  while (enumerator.next());
  EXPECT_EQ(partitions.size(), 20u);
  partitions.insert(spawn::namedSchedule(graph, "default")->waits);
  EXPECT_EQ(kernels, partitions);
}

TEST(Schedules, NeighboursDifferInFewNodes) {
  for (const std::string& name : ownGrammarNames()) {
    const spawn::Graph graph = graphOf(ownGrammar(name));
    const spawn::Flow flow = spawn::makeFlow(graph);
    for (const char* of : spawn::kScheduleNames) {
      const auto schedule = *spawn::namedSchedule(graph, of);
      size_t others = 0;
      for (const spawn::Schedule& near : spawn::neighbours(graph, schedule)) {
        EXPECT_LT(near.name.size(), sizeof(spawn::KernelInfo::schedule)) << near.name;
        const auto violated = spawn::violation(flow, spawn::makePartition(flow, near.roots).groupOf);
        EXPECT_FALSE(violated) << name << ' ' << near.name << ": " << violated->text;
        others += near.waits != schedule.waits;
      }
      EXPECT_GT(others, 0u) << name << ' ' << of;
    }
    // From the finest one, the first step of each node that may join.
    const auto finest = *spawn::namedSchedule(graph, "rw");
    size_t joined = 0;
    for (const spawn::Schedule& near : spawn::neighbours(graph, finest)) {
      size_t differences = 0;
      for (size_t n = 0; n < graph.nodes.size(); ++n) differences += near.waits[n] != finest.waits[n];
      EXPECT_LE(differences, 1u) << name << ' ' << near.name;
      joined += differences;
    }
    EXPECT_GT(joined, 0u) << name;
  }
}

TEST(Schedules, MatchingGroupsShareCode) {
  const spawn::Graph graph = graphOf(R"(axiom Box All;
terminal T (1, 0);
terminal U (1, 1);
All = SubDiv(X) { -1: One | -1: Two | -1: Three | -1: U };
One = Translate(1, 0, 0) Rotate(0, 30, 0) T;
Two = Translate(2, 0, 0) Rotate(0, 40, 0) U;
Three = Translate(0, 3, 0) Scale(2, 2, 2) T;
)");
  const auto chains = [](const std::string& text) {
    size_t count = 0;
    for (size_t at = text.find("\nuint chain"); at != std::string::npos; at = text.find("\nuint chain", at + 1))
      ++count;
    return count;
  };
  const auto schedule = *spawn::namedSchedule(graph, "rules");
  const std::string own = spawn::generate(graph, schedule.waits).functions;
  const spawn::KernelSource matched = spawn::generate(graph, schedule.waits, schedule.roots);
  const std::string& shared = matched.functions;
  EXPECT_EQ(chains(own), 6u);
  EXPECT_EQ(chains(shared), 4u); // One and Two are alike but for their numbers and terminals
  EXPECT_EQ(own.find("matchedWords"), std::string::npos);
  EXPECT_NE(shared.find("matchedWords"), std::string::npos);
  EXPECT_EQ(spawn::generate(graph, schedule.waits, spawn::Roots()).functions, own);
  for (const spawn::KernelTarget target : spawn::targetsOf(graph)) EXPECT_TRUE(spawn::compileKernel(matched, target));
}

TEST(Schedules, KernelsOfAllSchedulesCompile) {
  for (const char* name : {"shapes.pga"}) {
    const spawn::Graph graph = graphOf(ownGrammar(name));
    std::set<std::string> texts;
    for (const char* schedule : spawn::kScheduleNames) {
      const spawn::KernelSource source = spawn::generate(graph, spawn::namedSchedule(graph, schedule)->waits);
      texts.insert(source.functions);
      for (const spawn::KernelTarget target : spawn::targetsOf(graph)) {
        const auto spirv = spawn::compileKernel(source, target);
        ASSERT_TRUE(spirv) << spirv.error().text;
        EXPECT_GT(spirv->size(), 1000u);
      }
    }
    EXPECT_GE(texts.size(), 3u) << name; // schedules differ in code
  }
}

} // namespace
