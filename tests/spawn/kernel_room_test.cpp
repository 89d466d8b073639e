// Kernels of grammars that are long, wide or deep: what there is no room for as code is run by the graph's words, in
// time and stack that do not grow with the grammar, and with the same result.
#include "grammars.h"
#include "host/device.h"
#include "kernels.h"
#include "random_grammar.h"
#include "spawn/codegen/compile_kernel.h"
#include "spawn/codegen/generate.h"
#include "spawn/codegen/large_stack.h"
#include "spawn/codegen/schedules.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/graph/kernel.h"
#include "spawn_device.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

namespace {
using namespace gpgp;
using namespace gpgp::test;

std::string chain(uint32_t rules) {
  std::string text = "axiom Box S;\nterminal A (1, 0);\nS = R0;\n";
  for (uint32_t i = 0; i < rules; ++i)
    text += "R" + std::to_string(i) + " = Translate(1, 0, 0) R" + std::to_string(i + 1) + ";\n";
  return text + "R" + std::to_string(rules) + " = A;\n";
}
/// Rules that keep one of an operator's shapes.
std::string filters(uint32_t rules, const std::string& before, const std::string& behind) {
  std::string text = "axiom Box R0;\nterminal A (1, 0);\n";
  for (uint32_t i = 0; i < rules; ++i)
    text += "R" + std::to_string(i) + " = " + before + "R" + std::to_string(i + 1) + behind + ";\n";
  return text + "R" + std::to_string(rules) + " = A;\n";
}
/// Rules beside each other, each with a choice and a translation.
std::string wide(uint32_t rules) {
  std::string text = "axiom Box S0;\nterminal A (1, 0);\nterminal B (1, 1);\n";
  for (uint32_t i = 0; i < rules; ++i)
    text += "S" + std::to_string(i) + " = IfSizeLess(X, " + std::to_string(i % 7) + ") { Translate(" +
            std::to_string(i) + ", 0, 0) A | Scale(2, 1, 1) B };\n";
  return text;
}
/// A choice among 1 024, as choices of 32 that choose among 32 each.
std::string choices() {
  std::string text = "axiom Box S;\n", rules;
  for (uint32_t i = 0; i < 1024; ++i)
    if (i < 1000) text += "terminal T" + std::to_string(i) + " (1, " + std::to_string(i) + ");\n";
  std::string all = "S = RandomRule(ShapeSeed()) { ";
  for (uint32_t i = 0; i < 32; ++i) {
    all += std::string(i ? " | " : "") + "1: C" + std::to_string(i);
    rules += "C" + std::to_string(i) + " = RandomRule(Exp(ShapeSeed() * 32)) { ";
    for (uint32_t k = 0; k < 32; ++k)
      rules += std::string(k ? " | " : "") + "1: T" + std::to_string(std::min(32 * i + k, 999u));
    rules += " };\n";
  }
  return text + all + " };\n" + rules;
}
/// Choices that both lead to the next one: inlined, 2^rules operators.
std::string twice(uint32_t rules) {
  std::string text = "axiom Box R0;\nterminal A (1, 0);\n";
  for (uint32_t i = 0; i < rules; ++i)
    text += "R" + std::to_string(i) + " = IfSizeLess(X, " + std::to_string(i) + ") { R" + std::to_string(i + 1) +
            " | Scale(1.5, 1, 1) R" + std::to_string(i + 1) + " };\n";
  return text + "R" + std::to_string(rules) + " = A;\n";
}
std::string nestedSplits(uint32_t levels) {
  std::string text = "axiom Box R0;\nterminal A (1, 0);\n";
  for (uint32_t i = 0; i < levels; ++i)
    text += "R" + std::to_string(i) + " = SubDiv(" +
            (i % 3 == 0   ? "X"
             : i % 3 == 1 ? "Y"
                          : "Z") +
            std::string(") { 0.001: A | -1: Translate(0, 0.1, 0) R") + std::to_string(i + 1) + " };\n";
  return text + "R" + std::to_string(levels) + " = A;\n";
}
std::string longExpression(uint32_t operands) {
  std::string sum = "ShapeSize(X)";
  for (uint32_t i = 1; i < 60; ++i) sum += i % 2 ? " + ShapeSize(Y) * 0.25" : " - ShapeSize(Z) * 0.25";
  std::string text = "axiom Box S;\nterminal A (1, 0);\nS = ";
  for (uint32_t i = 0; i < operands; ++i) text += "Translate(Exp(" + sum + "), Exp(" + sum + "), 0) ";
  return text + "A;\n";
}

spawn::Graph graphOf(const std::vector<uint32_t>& words) {
  return *spawn::load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource());
}
spawn::KernelSource sourceOf(const std::string& text) {
  const spawn::Graph graph = graphOf(bake(text));
  return spawn::generate(graph, spawn::namedSchedule(graph, "default")->waits);
}

TEST(KernelRoom, CodeIsBoundedWhateverTheGrammar) {
  const size_t most = sourceOf(chain(40)).functions.size();
  for (const uint32_t rules : {60u, 120u, 250u, 500u, 2000u}) {
    const spawn::KernelSource source = sourceOf(chain(rules));
    EXPECT_GT(source.byWords, 0u) << rules;
    EXPECT_LT(source.functions.size(), 2 * most) << rules;
  }
  for (const std::string& text : {wide(500), choices(), twice(60), nestedSplits(150), longExpression(100)}) {
    const spawn::KernelSource source = sourceOf(text);
    EXPECT_LT(source.functions.size(), 200'000u) << text.substr(0, 200);
  }
}

TEST(KernelRoom, CompiledCodeIsBoundedForOperatorsThatKeepOneShape) {
  const auto sizeOf = [](const spawn::KernelSource& source) { // as drivers get it: inlined
    return spawn::compileKernel(source, spawn::KernelTarget::subgroups)->size();
  };
  const size_t most = sizeOf(sourceOf(ownGrammar("building.pga")));
  const std::pair<const char*, const char*> operators[] = {
      {"SubDiv(X) { 0.01: Discard() | -1: ", " }"},     {"SubDiv(Y) { Rand(0.01, 0.02): Discard() | -1: ", " }"},
      {"CompSplit() { Discard() | ", " | Discard() }"}, {"IfSizeLess(X, 1) { A | ", " }"},
      {"RandomRule(ShapeSeed()) { 0.1: A | 1: ", " }"}, {"Replicate() { Discard() | Translate(0, 1, 0) ", " }"}};
  for (const auto& [before, behind] : operators) {
    uint32_t rules = 0; // as many as are compiled
    while (rules < 30 && spawn::isWorthCompiling(sourceOf(filters(rules + 1, before, behind)))) ++rules;
    EXPECT_GE(rules, 3u) << before;
    EXPECT_LT(sizeOf(sourceOf(filters(rules, before, behind))), 2 * most) << before << rules;
    EXPECT_FALSE(spawn::isWorthCompiling(sourceOf(filters(500, before, behind)))) << before;
  }
}

TEST(KernelRoom, GrammarsWithRoomAreCodeAsAWhole) {
  for (const std::string& name : ownGrammarNames()) EXPECT_EQ(sourceOf(ownGrammar(name)).byWords, 0u) << name;
  for (const char* name : {"3d_tree_4_3.pga", "3d_tree_8_3.pga", "balcony.pga", "commercial.pga", "mc_skyscraper.pga",
                           "menger_sponge_3.pga"})
    if (const auto text = sharedGrammar(name)) {
      EXPECT_EQ(sourceOf(*text).byWords, 0u) << name;
    }
}

TEST(KernelRoom, MessagesSayWhatIsInterpreted) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  const std::string text = chain(250);
  std::vector<std::string> messages;
  source.name = "chain";
  source.text = text.data();
  source.size = text.size();
  source.flags = GPGP_COMPILE_KERNEL;
  source.messageUserData = &messages;
  source.messageFn = [](void* data, const GpgpCompileMessage* m) {
    static_cast<std::vector<std::string>*>(data)->push_back(std::to_string(m->severity) + " " + m->text);
  };
  GpgpBlob blob{};
  ASSERT_EQ(gpgpCompileGrammar(&source, &blob), GPGP_SUCCESS);
  const auto baked =
      spawn::loadBaked({static_cast<const std::byte*>(blob.data), blob.size}, std::pmr::new_delete_resource());
  ASSERT_TRUE(baked);
  EXPECT_EQ(baked->kernels.size(), 0u);
  gpgpFreeBlob(&blob);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("this grammar is interpreted, and has no kernel"), std::string::npos) << messages[0];
  EXPECT_EQ(messages[0][0], '1'); // a warning
}

TEST(KernelRoom, DerivesWhatTheEvaluatorDerives) {
  SpawnDevice device;
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 200; ++i) axioms.push_back(spawn::makeAxiom(3, 4, 5, i + 1, i));
  // Splits wait between one another, so that their code has room whatever their number.
  for (const auto& [text, hasRoom] :
       {std::pair(chain(250), false), std::pair(choices(), false), std::pair(twice(40), false),
        std::pair(nestedSplits(60), true), std::pair(longExpression(100), false)}) {
    std::vector<uint32_t> words = bake(text);
    const spawn::Derivation expected = spawn::derive(words, axioms);
    const spawn::KernelSource source = sourceOf(text);
    EXPECT_EQ(source.byWords == 0, hasRoom) << text.substr(0, 200);
    const spawn::Graph graph = graphOf(words);
    for (const spawn::KernelTarget target : spawn::targetsOf(graph)) {
      const std::vector<uint32_t> one = withKernel(words, source, target);
      ASSERT_GT(one.size(), words.size());
      const GpgpSpawnReport report = device.derive(one, axioms, uint32_t(expected.terminals) + 1);
      EXPECT_EQ(report.base.status, GPGP_SUCCESS) << text.substr(0, 200);
      EXPECT_EQ(report.terminals, expected.terminals) << text.substr(0, 200);
      EXPECT_EQ(report.keyHash[0], expected.keyHash[0]) << text.substr(0, 200);
      EXPECT_EQ(report.keyHash[1], expected.keyHash[1]) << text.substr(0, 200);
    }
  }
}

int depthOf(int levels) { // uses a page of the stack each
  volatile char page[4096];
  page[0] = 1;
  return levels ? depthOf(levels - 1) + page[0] : 0;
}
TEST(LargeStack, HoldsWhatNoUsualOneDoes) {
  int depth = 0;
  ASSERT_TRUE(spawn::onLargeStack([&] { depth = depthOf(50000); })); // 200 MiB
  EXPECT_EQ(depth, 50000);
  EXPECT_THROW(spawn::onLargeStack([] { throw std::runtime_error("through"); }), std::runtime_error);
}

} // namespace
