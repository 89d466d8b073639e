// Random numbers of derivations: each Rand() and each N% draws one of its own. Judged by chi-square over thousands of
// axioms, pair by pair: whatever two places of a derivation draw is independent.
#include "grammars.h"
#include "spawn/evaluator/evaluator.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

namespace {
using namespace gpgp;
using namespace gpgp::test;

/// Seeds as the command counts them up.
std::vector<GpgpAxiom> axiomsOf(uint32_t count, uint32_t firstSeed = 1) {
  std::vector<GpgpAxiom> result;
  for (uint32_t i = 0; i < count; ++i) result.push_back(spawn::makeAxiom(1, 1, 1, firstSeed + i, i));
  return result;
}
std::vector<GpgpInstance> instancesOf(const std::string& text, std::span<const GpgpAxiom> axioms) {
  auto result = spawn::derive(bake(text), axioms).instances;
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.axiomId < b.axiomId; });
  return result;
}

/// Of counts that should be equal, as standard deviations above what chance makes of them.
double excess(std::span<const double> counts) {
  double sum = 0, chi = 0;
  for (const double c : counts) sum += c;
  const double expected = sum / double(counts.size()), freedom = double(counts.size()) - 1;
  for (const double c : counts) chi += (c - expected) * (c - expected) / expected;
  return (chi - freedom) / std::sqrt(2 * freedom);
}
constexpr double kMost = 6; // far beyond chance, for all of the tests together

TEST(RandomNumbers, NestedChoicesAreIndependent) { // all 16 ways are taken as often
  std::string text = "axiom Box R1; terminal T (1,0);";
  std::string terminals;
  for (int level = 1; level < 16; ++level)
    text += "R" + std::to_string(level) + " = 50%: " + (level < 8 ? "R" : "L") + std::to_string(2 * level) +
            " else: " + (level < 8 ? "R" : "L") + std::to_string(2 * level + 1) + ";";
  for (int leaf = 16; leaf < 32; ++leaf) text += "terminal L" + std::to_string(leaf) + " (1,0);";
  std::array<double, 17> counts{};
  for (const GpgpInstance& i : instancesOf(text, axiomsOf(64000))) ++counts.at(i.bucket);
  EXPECT_EQ(counts[0], 0);
  for (size_t leaf = 1; leaf < counts.size(); ++leaf) EXPECT_GT(counts[leaf], 3700) << leaf;
  EXPECT_LT(excess(std::span(counts).subspan(1)), kMost);
}

TEST(RandomNumbers, SizesOfOneRuleAreIndependent) {
  const auto of = [](const std::string& rules) {
    return instancesOf("axiom Box S; terminal A (1,0); terminal B (1,1);" + rules, axiomsOf(20000));
  };
  uint32_t equal = 0;
  for (const GpgpInstance& i : of("S = Scale(Rand(0,1),1,Rand(0,1)) If(ShapeSize(X) == ShapeSize(Z)) { A | B };"))
    equal += i.bucket == 0;
  EXPECT_LT(equal, 10u); // == tolerates one part in 100 000
}

/// Draws of one derivation, as sizes of the terminals that it makes: x, y and z of each, in [0, 1).
std::vector<std::vector<double>> drawsOf(const std::string& text, uint32_t axioms, uint32_t firstSeed) {
  std::vector<std::vector<double>> result(axioms);
  for (const GpgpInstance& i : instancesOf(text, axiomsOf(axioms, firstSeed)))
    for (const float size : i.size)
      if (size < 1) result.at(i.axiomId).push_back(size);
  return result;
}
void expectIndependent(const std::string& text, size_t draws, uint32_t firstSeed = 1) {
  constexpr uint32_t kAxioms = 12800, kCells = 8;
  const auto all = drawsOf(text, kAxioms, firstSeed);
  for (const auto& one : all) ASSERT_EQ(one.size(), draws);
  for (size_t a = 0; a < draws; ++a)
    for (size_t b = 0; b < a; ++b) {
      std::array<double, kCells * kCells> counts{}, differences{};
      for (const auto& one : all) {
        const auto cell = [](double x, uint32_t cells) { return static_cast<size_t>(x * cells); };
        ++counts.at(cell(one[a], kCells) * kCells + cell(one[b], kCells));
        double difference = one[a] - one[b];
        if (difference < 0) difference += 1;
        ++differences.at(cell(difference, kCells * kCells));
      }
      EXPECT_LT(excess(counts), kMost) << "draws " << b << " and " << a;
      EXPECT_LT(excess(differences), kMost) << "draws " << b << " and " << a;
    }
}

TEST(RandomNumbers, AllPairsOfARuleAreIndependent) {
  // Several in one operator and in one expression, in operators one after the other, of copies, of pieces and of what
  // was drawn before they were made.
  expectIndependent(
      "axiom Box S; terminal T (1,0);"
      "S = Scale(Rand(0,1),Rand(0,1),2) Replicate() { T | Scale(2,Rand(0,1),Rand(0,1)) Rotate(0,Rand(0,90),0)"
      "  Replicate() { T | Scale(Exp(Rand(0,1) * 0 + Rand(0,1)),2,Rand(0,1)) T } };",
      2 + 2 + 2);
  for (const uint32_t seed : {1u, 4000000000u})
    expectIndependent("axiom Box S; terminal T (1,0);"
                      "S = Replicate() { D | D | Scale(2,2,2) Repeat(X,1,ADJUST_TO_FILL) D };"
                      "D = Scale(Rand(0,1),Rand(0,1),Rand(0,1)) T;",
                      12, seed);
}

TEST(RandomNumbers, ParentsAndChildrenAreIndependent) { // of a rule that comes back to itself without new seeds
  expectIndependent("axiom Box S; terminal T (1,0);"
                    "S = Scale(Rand(0,1),Rand(0,1),1) Replicate() { T | If(ShapePos(X) < 2.5) { Translate(1,0,0) S | "
                    "SubDiv(Z) { -1: Scale(Rand(0,1),2,Rand(0,1)) T } } };",
                    2 * 4 + 2);
}

TEST(RandomNumbers, ChoicesAreIndependentOfNumbersBesideThem) {
  const auto instances = instancesOf("axiom Box S; terminal A (1,0); terminal B (1,1); terminal C (1,2);"
                                     "S = Scale(Rand(0,1),1,1) R; R = 30%: A 30%: B else: Scale(-1,Rand(0,1),1) C;",
                                     axiomsOf(30000));
  std::map<uint32_t, double> sums;
  std::map<uint32_t, uint32_t> counts;
  for (const GpgpInstance& i : instances) {
    sums[i.bucket] += i.size[0];
    ++counts[i.bucket];
  }
  for (const auto& [bucket, sum] : sums) EXPECT_NEAR(sum / counts[bucket], 0.5, 0.02) << bucket;
  EXPECT_NEAR(counts[0], 9000, 400);
  EXPECT_NEAR(counts[1], 9000, 400);
}

TEST(RandomNumbers, SeedsAndAttributesDoNotChangeWhereNumbersAreDrawn) {
  const auto axioms = axiomsOf(50);
  const auto of = [&](const std::string& rules) {
    return instancesOf("axiom Box S; terminal T U (1,0);" + rules, axioms);
  };
  const auto none = of("S = If(ShapeSeed() < 0.5) { T | U };"),
             some = of("S = Translate(Rand(0,1),0,0) If(ShapeSeed() < 0.5) { T | U };"),
             copies = of("S = Replicate() { Translate(Rand(0,1),0,0) T | Translate(Rand(0,1),0,0) T };");
  for (size_t i = 0; i < none.size(); ++i) {
    EXPECT_EQ(none[i].seed, some[i].seed);
    EXPECT_EQ(none[i].terminal, some[i].terminal);
    EXPECT_EQ(none[i].attribute, some[i].attribute);
    EXPECT_EQ(copies[2 * i].seed, copies[2 * i + 1].seed);
    EXPECT_NE(copies[2 * i].transform[3], copies[2 * i + 1].transform[3]);
  }
}

TEST(RandomNumbers, AxiomsThatShareASeedAreAlike) { // whatever their ids are, but their keys are not
  auto axioms = axiomsOf(2);
  axioms[0].seed = axioms[1].seed = 77;
  const auto instances = instancesOf(
      "axiom Box S; terminal T (1,0); S = Repeat(X,0.1,ADJUST_TO_FILL) Scale(1,Rand(0,1),Rand(0,1)) T;", axioms);
  ASSERT_EQ(instances.size(), 20u);
  std::map<std::pair<uint32_t, uint32_t>, int> keys;
  for (size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(instances[i].size[1], instances[i + 10].size[1]);
    EXPECT_EQ(instances[i].size[2], instances[i + 10].size[2]);
  }
  for (const GpgpInstance& i : instances) ++keys[{i.key[0], i.key[1]}];
  EXPECT_EQ(keys.size(), 20u);
}

} // namespace
