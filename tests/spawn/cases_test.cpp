// The sample grammars of the thesis's test cases: they compile without a word, have the counts that cases.txt states,
// and are derived by the GPU as by the evaluator.
#include "grammars.h"
#include "host/files.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct Case {
  std::string name;
  uint32_t axioms = 0;
  float size[3] = {}, spacing = 0;
  double from = 0, to = 0;
};

std::vector<Case> cases() {
  std::vector<Case> result;
  std::istringstream lines(host::readText(GPGP_SAMPLE_GRAMMARS "/cases.txt"));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    Case c;
    std::istringstream row(line);
    row >> c.name >> c.axioms >> c.size[0] >> c.size[1] >> c.size[2] >> c.spacing >> c.from >> c.to;
    EXPECT_TRUE(row) << line;
    result.push_back(c);
  }
  return result;
}

std::string textOf(const Case& c) { return host::readText(GPGP_SAMPLE_GRAMMARS "/" + c.name + ".pga"); }

std::vector<GpgpAxiom> axiomsOf(const Case& c, uint32_t count) {
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < count; ++i) {
    axioms.push_back(spawn::makeAxiom(c.size[0], c.size[1], c.size[2], 1 + i, i));
    axioms.back().transform[3] = c.spacing * float(i % 64);
    axioms.back().transform[11] = c.spacing * float(i / 64);
  }
  return axioms;
}

TEST(Cases, EveryGrammarIsACase) {
  std::set<std::string> listed, found;
  for (const Case& c : cases()) EXPECT_TRUE(listed.insert(c.name).second) << c.name << " is listed twice";
  for (const auto& entry : std::filesystem::directory_iterator(GPGP_SAMPLE_GRAMMARS))
    if (entry.path().extension() == ".pga") found.insert(entry.path().stem());
  EXPECT_EQ(listed, found);
  EXPECT_EQ(listed.size(), 14u);
}

TEST(Cases, CompileWithoutMessages) {
  for (const Case& c : cases()) EXPECT_EQ(messagesOf(textOf(c)), std::vector<std::string>{}) << c.name;
}

TEST(Cases, DeriveTheStatedCounts) {
  spawn::DeriveOptions options;
  options.keepInstances = false;
  for (const Case& c : cases()) {
    const auto words = bake(textOf(c));
    const bool exact = c.from == c.to;
    // Exact ones count the same whatever the seed, so that a few do; of the others the mean is stated.
    const uint32_t count = exact ? std::min(c.axioms, 200u) : std::min(c.axioms, 4000u);
    const auto axioms = axiomsOf(c, count);
    const auto all = spawn::derive(words, axioms, options);
    EXPECT_TRUE(all.complete) << c.name;
    EXPECT_EQ(all.unfinishedShapes, 0u) << c.name;
    const double mean = double(all.terminals) / double(count);
    EXPECT_GE(mean, c.from) << c.name;
    EXPECT_LE(mean, c.to) << c.name;
    if (!exact) continue;
    for (uint32_t i = 0; i < std::min(count, 50u); ++i)
      ASSERT_EQ(double(spawn::derive(words, std::span(&axioms[i], 1), options).terminals), c.from)
          << c.name << ' ' << i;
  }
}

TEST(Cases, NothingIsDegenerate) { // where size weights or factors go wrong, boxes turn inside out or to nothing
  for (const Case& c : cases()) {
    const auto all = spawn::derive(bake(textOf(c)), axiomsOf(c, c.name == "city" ? 500 : 8));
    for (const GpgpInstance& i : all.instances) {
      for (const float v : i.transform) ASSERT_TRUE(std::isfinite(v)) << c.name;
      ASSERT_GT(i.size[0], 0) << c.name << " terminal " << i.terminal;
      ASSERT_GT(i.size[1], 0) << c.name << " terminal " << i.terminal;
      ASSERT_GE(i.size[2], i.shape == GPGP_SHAPE_BOX ? 1e-4f : 0.0f) << c.name << " terminal " << i.terminal;
    }
  }
}

/// samples/rivals
std::vector<uint32_t> rival(const std::string& name) {
  const std::string text = host::readText(GPGP_SAMPLE_GRAMMARS "/../rivals/" + name + ".pga");
  EXPECT_EQ(messagesOf(text), std::vector<std::string>{}) << name;
  return bake(text);
}
/// A tree so far from the camera.
GpgpAxiom treeAt(float metres, uint32_t seed) {
  GpgpAxiom tree = spawn::makeAxiom(0.6f, 1.6f, 0.6f, seed, seed);
  tree.attribute = metres;
  return tree;
}

TEST(Rivals, HaveTheirSizesAndTheGpuDerivesTheSame) {
  const auto market = rival("market"), wood = rival("wood");
  const std::vector<GpgpAxiom> square{spawn::makeAxiom(120, 16, 120, 1, 0)};
  const auto stalls = spawn::derive(market, square);
  EXPECT_GT(stalls.terminals, 76000u);
  EXPECT_LT(stalls.terminals, 84000u);
  std::vector<GpgpAxiom> trees;
  for (uint32_t seed = 1; seed <= 5; ++seed) trees.push_back(treeAt(20 * float(seed), seed));
  SpawnDevice device;
  for (const auto& [words, axioms] : {std::pair{market, square}, {wood, trees}}) {
    const auto cpu = spawn::derive(words, axioms);
    const GpgpSpawnReport gpu = device.derive(words, axioms, uint32_t(cpu.terminals));
    EXPECT_EQ(gpu.base.status, GPGP_SUCCESS);
    EXPECT_EQ(gpu.terminals, cpu.terminals);
    EXPECT_EQ(gpu.keyHash[0], cpu.keyHash[0]);
    EXPECT_EQ(gpu.keyHash[1], cpu.keyHash[1]);
  }
}

TEST(Rivals, TreesHaveLessDetailFartherAway) {
  const auto wood = rival("wood");
  const auto limbs = [&](float metres, uint32_t seed) { // by place: bark is not moved by what is left out
    std::set<std::array<float, 3>> places;
    for (const GpgpInstance& i : spawn::derive(wood, std::vector{treeAt(metres, seed)}).instances)
      if (i.terminal == 0) places.insert({i.transform[3], i.transform[7], i.transform[11]});
    return places;
  };
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    size_t before = SIZE_MAX;
    for (const float metres : {5.0f, 45.0f, 100.0f, 400.0f}) {
      const size_t count = spawn::derive(wood, std::vector{treeAt(metres, seed)}).terminals;
      EXPECT_LT(count, before) << metres << " m, seed " << seed;
      before = count;
    }
    EXPECT_LT(before, 40u); // a trunk and its crown
    const auto near = limbs(5, seed), far = limbs(400, seed);
    EXPECT_TRUE(std::includes(near.begin(), near.end(), far.begin(), far.end())) << "seed " << seed;
  }
}

TEST(Cases, TheGpuDerivesTheSame) {
  SpawnDevice device({.maxColliders = 8192});
  for (const Case& c : cases()) {
    const auto words = bake(textOf(c));
    const uint32_t count = std::clamp(uint32_t(20000 / c.to), 1u, std::min(c.axioms, 400u));
    const auto axioms = axiomsOf(c, count);
    const auto cpu = spawn::derive(words, axioms);
    const GpgpSpawnReport gpu = device.derive(words, axioms, uint32_t(cpu.terminals));
    EXPECT_EQ(gpu.base.status, GPGP_SUCCESS) << c.name;
    EXPECT_EQ(gpu.terminals, cpu.terminals) << c.name;
    EXPECT_EQ(gpu.instancesWritten, cpu.terminals) << c.name;
    EXPECT_EQ(gpu.keyHash[0], cpu.keyHash[0]) << c.name;
    EXPECT_EQ(gpu.keyHash[1], cpu.keyHash[1]) << c.name;
  }
}

} // namespace
