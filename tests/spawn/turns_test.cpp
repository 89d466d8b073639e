// Derivations whose loops are long, on devices that end a shader's loops in silence (shaders/core/turns.h): every
// instance against the CPU evaluator, by the interpreter and by kernels of every schedule.
#include "grammars.h"
#include "kernels.h"
#include "spawn/codegen/compile_kernel.h"
#include "spawn/codegen/generate.h"
#include "spawn/codegen/schedules.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/graph/kernel.h"
#include "spawn/schedule/turns.h"
#include "spawn_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>

namespace {
using namespace gpgp;
using namespace gpgp::test;

std::string fileCase(const std::string& name) { return textOf(GPGP_TEST_DATA "/cases/spawn/" + name + ".pga"); }

std::vector<GpgpAxiom> axiomsOf(uint32_t count, float size = 2) {
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < count; ++i) axioms.push_back(spawn::makeAxiom(size, size, size, i + 1, i));
  return axioms;
}

spawn::Graph graphOf(const std::vector<uint32_t>& words) {
  return *spawn::load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource());
}

/// What must be the same: terminal, rule, bucket, shape, seed, and the size's bits, by key.
using Facts = std::array<uint32_t, 9>;
std::map<uint64_t, std::vector<Facts>> factsOf(std::span<const GpgpInstance> instances) {
  std::map<uint64_t, std::vector<Facts>> facts;
  for (const GpgpInstance& i : instances) {
    Facts f{i.terminal, i.rule, i.bucket, i.shape, i.seed, i.axiomId};
    std::memcpy(&f[6], i.size, sizeof i.size);
    facts[uint64_t(i.key[1]) << 32 | i.key[0]].push_back(f);
  }
  for (auto& [key, all] : facts) std::sort(all.begin(), all.end());
  return facts;
}

void expectEqual(const std::string& what, const spawn::Derivation& expected, const GpgpSpawnReport& report,
                 const std::vector<GpgpInstance>& instances) {
  SCOPED_TRACE(what);
  EXPECT_EQ(report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(report.terminals, expected.terminals);
  EXPECT_EQ(report.droppedShapes, expected.droppedShapes);
  EXPECT_EQ(report.unfinishedShapes, expected.unfinishedShapes);
  EXPECT_EQ(report.keyHash[0], expected.keyHash[0]);
  EXPECT_EQ(report.keyHash[1], expected.keyHash[1]);
  ASSERT_EQ(instances.size(), expected.instances.size());
  const auto own = factsOf(instances), right = factsOf(expected.instances);
  size_t wrong = 0;
  for (const auto& [key, facts] : right) {
    const auto found = own.find(key);
    wrong += found == own.end() || found->second != facts ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0u) << "of " << right.size() << " keys";
}

struct TurnsTest : ::testing::Test {
  std::unique_ptr<SpawnDevice> device;
  void make(const GpgpSpawnerCreateInfo& budgets = {}) { device = std::make_unique<SpawnDevice>(budgets); }

  void check(const std::string& what, const std::vector<uint32_t>& words, const std::vector<GpgpAxiom>& axioms) {
    const spawn::Derivation expected = spawn::derive(words, axioms);
    ASSERT_TRUE(expected.complete);
    std::vector<GpgpInstance> instances;
    const GpgpSpawnReport report =
        device->derive(words, axioms, static_cast<uint32_t>(expected.terminals) + 1, &instances);
    expectEqual(what, expected, report, instances);
  }
  /// The interpreter, and kernels of all schedules for what the device takes.
  void checkSchedules(const std::string& what, const std::vector<uint32_t>& words,
                      const std::vector<GpgpAxiom>& axioms) {
    check(what + ", interpreted", words, axioms);
    const spawn::Graph graph = graphOf(words);
    for (const char* name : spawn::kScheduleNames) {
      const auto source = spawn::generate(graph, spawn::namedSchedule(graph, name)->waits);
      std::vector<uint32_t> all = words;
      for (const spawn::KernelTarget target : spawn::targetsOf(graph)) {
        const size_t before = all.size();
        all = withKernel(std::move(all), source, target);
        ASSERT_GT(all.size(), before) << what << ", " << name;
      }
      check(what + ", " + name, all, axioms);
    }
  }
};

/// Choices in a row, by size: the last of them makes the operators before it passed by the invocations beside it.
std::string ladder(uint32_t steps, const std::string& between = "", const std::string& before = "") {
  std::string terminals, rule, closing;
  for (uint32_t i = 0; i <= steps; ++i)
    terminals += "terminal B" + std::to_string(i) + " (1, " + std::to_string(i) + ");\n";
  for (uint32_t i = 0; i < steps; ++i) {
    rule += "IfSizeLess(X, " + std::to_string(10.0 * (i + 1) / (steps + 1)) + ") { B" + std::to_string(i) + " | ";
    closing += " }";
    if (i % 40 == 39) { // braces are nested up to some depth
      rule += "R" + std::to_string(i) + closing + ";\nR" + std::to_string(i) + " = ";
      closing.clear();
    }
    rule += between;
  }
  return "axiom Box S;\n" + terminals + "S = " + before + "Scale(Rand(0, 10), 1, 1) " + rule + "B" +
         std::to_string(steps) + closing + ";\n";
}

TEST_F(TurnsTest, ChainsOfChoicesHaveNoTerminalThatTheGrammarHasNot) {
  make({.maxRounds = 64});
  check("k7", bake(fileCase("k7")), axiomsOf(10000));
  check("k30", bake(fileCase("k30")), axiomsOf(1500));
  check("k60", bake(fileCase("k60")), axiomsOf(400));
  check("k60 10^4 times", bake(fileCase("k60")), axiomsOf(10000));
  check("400 choices", bake(ladder(400)), axiomsOf(10000));
}

TEST_F(TurnsTest, ChainsOfChoicesInEverySchedule) {
  make();
  checkSchedules("k7", bake(fileCase("k7")), axiomsOf(10000));
  checkSchedules("k30", bake(fileCase("k30")), axiomsOf(10000));
}

TEST_F(TurnsTest, OperatorsBetweenChoicesAndExpressionsInThem) {
  make({.maxRounds = 128});
  const std::string sum = "Exp(ShapeSize(Y) * 2 + ShapeSize(Z) - 1 + ShapeSize(Y) * 3 - ShapeSize(Z) + 0.5 + "
                          "ShapeSize(Z) * 4 - 2 * ShapeSize(Y) + ShapeSeed() * 0)";
  check("long expressions", bake(ladder(60, "Translate(" + sum + ", " + sum + ", " + sum + ") ")), axiomsOf(10000));
  // Children with choices behind them, drawn, of parts that expressions divide.
  std::string drawn, parts;
  for (uint32_t i = 0; i < 32; ++i) {
    drawn += (i ? " | " : "") + std::string("Exp(1 + ShapeSize(Y) * 0): D") + std::to_string(i);
    parts += (i ? " | " : "") + std::string("Exp(0 - ShapeSize(Y) - 1): ") + (i % 3 ? "Q" : "D" + std::to_string(i));
  }
  std::string text = "axiom Box S;\n";
  for (uint32_t i = 0; i < 32; ++i) text += "terminal D" + std::to_string(i) + " (1, " + std::to_string(i) + ");\n";
  text += "S = SubDiv(X) { " + parts + " };\nQ = RandomRule(ShapeSeed()) { " + drawn + " };\n";
  check("divisions and draws of 32", bake(text), axiomsOf(4000));
}

/// A sum of so many terms that no compiler folds.
std::string sumOf(uint32_t terms) {
  std::string sum = "ShapeSize(Y)";
  for (uint32_t i = 1; i < terms; ++i) sum += " + ShapeSize(Y) * 0.25";
  return "Exp(" + sum + ")";
}
std::string weights(uint32_t count, const std::string& first, const std::string& each, const std::string& to) {
  std::string all = first + ": " + to;
  for (uint32_t i = 1; i < count; ++i) all += " | " + each + ": " + to;
  return all;
}

TEST(Turns, WhatIsTooMuchIsRefusedWithTheNumbersThatDecide) {
  const std::string head = "axiom Box S;\nterminal A (1, 0);\nterminal B (1, 1);\n";
  const std::string wide = head + "S = RandomRule(Rand(0, 1)) { " + weights(32, sumOf(60), sumOf(60), "A") + " };\n";
  const spawn::Turns turns = spawn::turnsOf(graphOf(bake(wide)));
  shader::SpawnConstants constants{};
  const spawn::TurnsLimit limit = spawn::limitTurns(constants, turns, {.groupSize = 8, .stackShapes = 1024}, 8, false);
  EXPECT_FALSE(limit);
  EXPECT_GT(limit.needed, limit.most);
  EXPECT_GT(limit.needed, 2u * 32 * 30);
}

TEST_F(TurnsTest, LongExpressionsBesideChoicesOfManyAreNotMultiplied) {
  make({.maxRounds = 64});
  // One operator with a sum of 60 terms, another with 32 weights; half of the invocations are in each.
  std::string head = "axiom Box S;\n", terminals;
  for (uint32_t i = 0; i < 32; ++i) head += "terminal D" + std::to_string(i) + " (1, " + std::to_string(i) + ");\n";
  for (uint32_t i = 0; i < 32; ++i) terminals += (i ? " | 1: D" : "1: D") + std::to_string(i);
  std::string text = head + "S = Scale(Rand(0, 10), 1, 1) IfSizeLess(X, 5) { P | Q };\n";
  text += "P = Translate(" + sumOf(60) + ", " + sumOf(40) + ", 0) Q;\nQ = RandomRule(Rand(0, 1)) { " + terminals;
  text += " };\n";
  check("a long sum beside 32 weights", bake(text), axiomsOf(10000));
}

TEST_F(TurnsTest, ManyChildrenOfFewAxioms) {
  make({.maxRounds = 64});
  check("copies",
        bake("axiom Box S;\nterminal A (1, 0);\nterminal B (1, 1);\n"
             "S = Repeat(X, 0.0001, ADJUST_TO_FILL) IfSizeLess(Y, 1) { A | B };\n"),
        axiomsOf(3, 2));
}

TEST_F(TurnsTest, ChainsToCollidersAreCutInTime) {
  make({.maxColliders = 4096});
  check("chains with queries", bake(ladder(60, "", "Collider(1) IfCollides(2) { B0 | Translate(1, 0, 0) C };\nC = ")),
        axiomsOf(2000));
}

TEST(Turns, BoundsGrowWithTheGraph) {
  const spawn::Turns few =
      spawn::turnsOf(graphOf(bake("axiom Box S;\nterminal A (1, 0);\nS = Translate(1, 0, 0) A;\n")));
  const spawn::Turns many = spawn::turnsOf(graphOf(bake(ladder(60))));
  EXPECT_EQ(few.chain, 2u);
  EXPECT_GE(many.chain, 60u);
  EXPECT_GT(many.passed, few.passed); // as that has expressions
}

} // namespace
