// Schedules as generated kernels take them: which nodes shapes wait for.
#include "grammars.h"
#include "random_grammar.h"
#include "spawn/codegen/compile_kernel.h"
#include "spawn/codegen/generate.h"
#include "spawn/codegen/schedules.h"

#include <gtest/gtest.h>

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
bool multiplies(const spawn::Node& node) { return node.op >= shader::kOpCompSplit && !node.filter; }

TEST(Schedules, WhatMultipliesAlwaysWaits) {
  for (uint32_t seed = 0; seed < 300; ++seed) {
    const spawn::Graph graph = graphOf(randomGrammar(seed));
    bool complete = false;
    for (const auto search : {spawn::Search::random, spawn::Search::heuristic})
      for (const spawn::Schedule& schedule : searchSchedules(graph, search, 8, seed, complete)) {
        ASSERT_EQ(schedule.waits.size(), graph.nodes.size());
        for (size_t n = 0; n < graph.nodes.size(); ++n) {
          if (multiplies(graph.nodes[n])) {
            ASSERT_TRUE(schedule.waits[n]) << schedule.name << "\n" << randomGrammar(seed);
          }
          if (graph.nodes[n].op == shader::kOpTerminal) {
            ASSERT_FALSE(schedule.waits[n]) << schedule.name;
          }
        }
      }
  }
}

TEST(Schedules, TheNamedOnesAreOrdered) {
  // The default waits least, rewriting waits wherever a shape can arrive.
  for (const std::string& name : ownGrammarNames()) {
    const spawn::Graph graph = graphOf(ownGrammar(name));
    const auto least = *spawn::namedSchedule(graph, "default");
    const auto most = *spawn::namedSchedule(graph, "rw");
    const spawn::Flow flow = spawn::makeFlow(graph);
    for (const char* other : {"sgl", "rules", "heuristic"}) {
      const auto schedule = *spawn::namedSchedule(graph, other);
      EXPECT_LE(spawn::namedSchedule(graph, "sgl")->groups, schedule.groups) << name;
      EXPECT_GE(most.groups, schedule.groups) << name;
      for (uint32_t n = 0; n < graph.nodes.size(); ++n) {
        if (least.waits[n]) {
          EXPECT_TRUE(schedule.waits[n]) << name << ' ' << other;
        }
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
  // Its one operator that passes on one shape is the cycle's head, a root of every partition: one kernel beside the
  // default.
  EXPECT_EQ(all.size(), 2u);
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
  const std::string own = spawn::generate(graph, schedule.waits);
  const std::string shared = spawn::generate(graph, schedule.waits, schedule.roots);
  EXPECT_EQ(chains(own), 6u);
  EXPECT_EQ(chains(shared), 4u); // One and Two are alike but for their numbers and terminals
  EXPECT_EQ(own.find("matchedWords"), std::string::npos);
  EXPECT_NE(shared.find("matchedWords"), std::string::npos);
  EXPECT_EQ(spawn::generate(graph, schedule.waits, spawn::Roots()), own);
  for (const bool subgroups : {false, true}) EXPECT_TRUE(spawn::compileKernel(shared, subgroups));
}

TEST(Schedules, KernelsOfAllSchedulesCompile) {
  for (const char* name : {"shapes.pga"}) {
    const spawn::Graph graph = graphOf(ownGrammar(name));
    std::set<std::string> texts;
    for (const char* schedule : spawn::kScheduleNames) {
      const std::string functions = spawn::generate(graph, spawn::namedSchedule(graph, schedule)->waits);
      texts.insert(functions);
      for (const bool subgroups : {false, true}) {
        const auto spirv = spawn::compileKernel(functions, subgroups);
        ASSERT_TRUE(spirv) << spirv.error().text;
        EXPECT_GT(spirv->size(), 1000u);
      }
    }
    EXPECT_GE(texts.size(), 3u) << name; // schedules differ in code
  }
}

} // namespace
