// What `gpgp spawn` compares the device's instances with.
#include "cli/spawn/reference.h"

#include <gpgp/gpgp.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>

namespace gpgp::test {
namespace {

std::vector<uint32_t> bake(const std::string& text) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.text = text.data();
  source.size = text.size();
  const Result<Blob> blob = compileGrammar(source);
  std::vector<uint32_t> words(blob->size() / 4);
  std::memcpy(words.data(), blob->data(), blob->size());
  return words;
}

GpgpSpawnReport reportOf(const spawn::Derivation& derivation) {
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  report.terminals = static_cast<uint32_t>(derivation.terminals);
  std::copy(std::begin(derivation.keyHash), std::end(derivation.keyHash), report.keyHash);
  return report;
}

/// Both branches make one terminal with the same key, bucket and shape.
std::string branches(int chosen) {
  return "axiom Box S;\nterminal A B (1, 0);\nS = If(" + std::to_string(chosen) +
         ") { One | Two };\nOne = Translate(1, 0, 0) A;\nTwo = Scale(2, 2, 2) B;\n";
}

TEST(CliReference, OrderDoesNotCountAndEverythingElseDoes) {
  const auto words = bake("axiom Box S;\nterminal T (1, 0);\nS = Repeat(X, 1, ADJUST_TO_FILL) T;\n");
  GpgpAxiom axiom = spawn::makeAxiom(0, 0, 0);
  axiom.size[0] = 5;
  axiom.start = GPGP_AXIOM_DEFAULT_START;
  const spawn::Derivation cpu = cli::evaluate(words, {axiom}, 0, nullptr, "grammar").result;
  ASSERT_EQ(cpu.instances.size(), 5u);
  const GpgpSpawnReport report = reportOf(cpu);
  std::vector<GpgpInstance> instances = cpu.instances;
  std::reverse(instances.begin(), instances.end());
  EXPECT_EQ(cli::difference(cpu, report, instances), "");
  instances[0].transform[3] += 1e-6f; // as another device rounds
  EXPECT_EQ(cli::difference(cpu, report, instances), "");
  const std::vector<std::function<void(GpgpInstance&)>> changes = {
      [](GpgpInstance& i) { ++i.terminal; }, [](GpgpInstance& i) { ++i.axiomId; },
      [](GpgpInstance& i) { ++i.seed; },     [](GpgpInstance& i) { i.size[2] += 1; },
      [](GpgpInstance& i) { ++i.key[1]; },   [](GpgpInstance& i) { i.attribute = -1; },
      [](GpgpInstance& i) { ++i.rule; }};
  for (const auto& change : changes) {
    auto changed = cpu.instances;
    change(changed[3]);
    EXPECT_NE(cli::difference(cpu, report, changed), "");
  }
  EXPECT_EQ(cli::difference(cpu, report, std::span(instances).first(2)), ""); // a budget, of which the report tells
  GpgpSpawnReport other = report;
  ++other.keyHash[1];
  EXPECT_NE(cli::difference(cpu, other, instances), "");
  other = report;
  ++other.terminals;
  EXPECT_EQ(cli::difference(cpu, other, instances), "6 terminals instead of 5");
}

TEST(CliReference, TheOtherBranchIsADifference) {
  const auto one = bake(branches(1)), two = bake(branches(0));
  GpgpAxiom axiom = spawn::makeAxiom(0, 0, 0);
  axiom.start = GPGP_AXIOM_DEFAULT_START;
  const spawn::Derivation cpu = cli::evaluate(one, {axiom}, 0, nullptr, "grammar").result,
                          wrong = cli::evaluate(two, {axiom}, 0, nullptr, "grammar").result;
  EXPECT_NE(cli::difference(cpu, reportOf(wrong), wrong.instances), "");
}

} // namespace
} // namespace gpgp::test
