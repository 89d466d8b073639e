// Programs of the thesis's figures as operator graphs: the recursion counter of figure 4.3 and the string rewriting of
// figure 4.4, on the CPU and the GPU, against closed forms and against the rewriting of L-systems.
//
// The counter (IncRec, IfRecGreater) is the attribute that shapes hand down: SetAttribute counts, If compares. A
// character's place on the string is a part of its box: a rewriting leaves room for as many characters as any of them
// makes, so that places are conservative, and the empty ones are left out by whoever puts the characters in order.
// L-systems do that by a prefix sum within the cycle, which figure 4.4's text names as the other way.
#include "grammars.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/lsystem/compile.h"
#include "spawn/lsystem/reference.h"
#include "spawn/lsystem/rewrite.h"
#include "spawn_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct Figures : ::testing::Test {
  std::unique_ptr<SpawnDevice> device = std::make_unique<SpawnDevice>();

  /// By the evaluator and by the GPU, which must have the same.
  std::vector<GpgpInstance> derive(const std::string& text, float x, float y, float z) {
    const auto words = bake(text);
    std::vector<GpgpAxiom> axioms{spawn::makeAxiom(x, y, z, 1, 0)};
    axioms[0].attribute = 0; // the counter
    const auto cpu = spawn::derive(words, axioms);
    EXPECT_TRUE(cpu.complete);
    std::vector<GpgpInstance> instances;
    const auto gpu = device->derive(words, axioms, static_cast<uint32_t>(cpu.terminals) + 1, &instances);
    EXPECT_EQ(gpu.base.status, GPGP_SUCCESS);
    EXPECT_EQ(gpu.terminals, cpu.terminals);
    EXPECT_EQ(gpu.keyHash[0], cpu.keyHash[0]);
    EXPECT_EQ(gpu.keyHash[1], cpu.keyHash[1]);
    return instances;
  }
};

TEST_F(Figures, TheSpongeCountsItsRecursions) { // figure 4.3, with rules as in 4.3.2
  for (uint32_t level = 0; level <= 3; ++level) {
    const float side = std::pow(3.0f, float(level));
    const auto cubes = derive(R"(axiom Box E;
terminal Cube (1, 0);
A = SubDiv(X) { -1: B | -1: SubDiv(Y) { -1: C | -1: Discard() | -1: C } | -1: B };
B = SubDiv(Y) { -1: D | -1: C | -1: D };
C = SubDiv(Z) { -1: E | -1: Discard() | -1: E };
D = SubDiv(Z) { -1: E | -1: E | -1: E };
E = SetAttribute(Exp(ShapeCustomAttribute() + 1)) IfRecGreater;
IfRecGreater = If(Exp(ShapeCustomAttribute() > )" +
                                  std::to_string(level) + ")) { Cube | A };\n",
                              side, side, side);
    std::set<std::array<int, 3>> cells;
    for (const GpgpInstance& cube : cubes) {
      EXPECT_EQ(cube.attribute, float(level + 1));
      std::array<int, 3> cell{};
      for (int i = 0; i < 3; ++i) cell[i] = static_cast<int>(std::floor(cube.transform[4 * i + 3] + side / 2));
      cells.insert(cell);
    }
    ASSERT_EQ(cells.size(), std::pow(20, level));
    for (std::array<int, 3> cell : cells) // no digit to base 3 is the middle along two axes
      for (uint32_t digit = 0; digit < level; ++digit) {
        int middle = 0;
        for (int& c : cell) middle += c % 3 == 1, c /= 3;
        ASSERT_LT(middle, 2);
      }
  }
}

TEST_F(Figures, AlgaeGrowByRewriting) { // figure 4.4: A becomes AB, B becomes A
  spawn::Diagnostics diagnostics;
  const auto words = spawn::lsystem::compile("axiom: A\nA --> AB\nB --> A\n", {}, diagnostics);
  ASSERT_TRUE(words);
  const auto table =
      spawn::lsystem::Table::load(std::as_bytes(std::span(words.value())), std::pmr::new_delete_resource());
  ASSERT_TRUE(table);
  std::string before = "B", algae = "A"; // S(n) = S(n-1) S(n-2)
  for (uint32_t steps = 0; steps <= 10; ++steps) {
    const float places = std::pow(2.0f, float(steps));
    const std::string counted = "If(Exp(ShapeCustomAttribute() >= " + std::to_string(steps) + ")) { ";
    const auto characters =
        derive("axiom Box A;\nterminal CharacterA (1, 0);\nterminal CharacterB (1, 1);\nA = " + counted +
                   "CharacterA | Rewrite };\nB = " + counted +
                   "CharacterB | RewriteB };\n"
                   "Rewrite = SetAttribute(Exp(ShapeCustomAttribute() + 1)) "
                   "SubDiv(X) { -1: A | -1: B };\n"
                   "RewriteB = SetAttribute(Exp(ShapeCustomAttribute() + 1)) "
                   "SubDiv(X) { -1: A | -1: Discard() };\n",
               places, 1, 1);
    // Compaction: places that nothing lies at are left out.
    std::string string(static_cast<size_t>(places), ' ');
    for (const GpgpInstance& c : characters) {
      char& place = string.at(static_cast<size_t>(c.transform[3] + places / 2));
      EXPECT_EQ(place, ' ');
      place = c.terminal == 0 ? 'A' : 'B';
    }
    std::erase(string, ' ');
    EXPECT_EQ(string, algae) << steps;
    const std::vector<GpgpAxiom> axiom{spawn::makeAxiom(1, 1, 1, 1, 0)};
    EXPECT_EQ(spawn::lsystem::print(*table, spawn::lsystem::derive(*table, axiom, steps).string), algae) << steps;
    before = std::exchange(algae, algae + before);
  }
  EXPECT_EQ(algae.size(), 233u); // after 11 steps: a Fibonacci number
}
} // namespace
