// Live editing in the mini-engine, by a script: what each state shows, against the CPU's derivation of the same text
// and values; the old city under the message of a broken file.
#include "host/picture.h"
#include "live_run.h"
#include "mini_engine/level.h"

#include <gpgp/gpgp.hpp>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace {
namespace fs = std::filesystem;
using gpgp::host::Picture;
using namespace gpgp::test;

struct LiveEditing : testing::Test {
  const fs::path folder = GPGP_GOLDEN_OUT "-live";
  std::string text, output;

  void SetUp() override {
    if (std::string(GPGP_LIVE) != "1") GTEST_SKIP() << "built without gpgp::imgui";
    fs::remove_all(folder);
    fs::create_directories(folder);
    std::ifstream in(GPGP_TEST_DATA "/grammars/building.pga", std::ios::binary);
    std::stringstream all;
    all << in.rdbuf();
    text = all.str();
    write("city.pga", text);
  }
  void write(const char* name, const std::string& contents) const {
    std::ofstream(folder / name, std::ios::binary) << contents;
  }
  static std::string replaced(std::string from, const std::string& what, const std::string& by) {
    const size_t at = from.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return at == std::string::npos ? from : from.replace(at, what.size(), by);
  }
  std::vector<State> run(const std::string& script) {
    write("script", script);
    return runLive(folder, "city.pga", output);
  }
  /// What the CPU makes of a text with other values.
  static void expectDerived(const State& state, const std::string& grammar, std::vector<GpgpVariable> variables) {
    auto source = gpgp::init<GpgpGrammarSource>();
    source.name = "city.pga";
    source.text = grammar.data();
    source.size = grammar.size();
    source.variables = variables.data();
    source.variableCount = static_cast<uint32_t>(variables.size());
    auto info = gpgp::init<GpgpEvaluatorCreateInfo>();
    info.sources = &source;
    info.sourceCount = 1;
    const gpgp::Result<gpgp::Evaluator> evaluator = gpgp::Evaluator::create(info);
    ASSERT_TRUE(evaluator) << evaluator.name();
    gpgp::Result<gpgp::Evaluation> evaluation = evaluator->evaluation();
    ASSERT_TRUE(evaluation) << evaluation.name();
    const std::vector<GpgpAxiom> axioms = mini::levelAxioms();
    auto derive = gpgp::init<GpgpEvaluationInfo>();
    derive.axioms = axioms.data();
    derive.axiomCount = static_cast<uint32_t>(axioms.size());
    derive.flags = GPGP_EVALUATION_COUNT_ONLY;
    ASSERT_EQ(evaluation->derive(derive), GPGP_SUCCESS);
    const GpgpEvaluationResult result = *evaluation->result();
    char hash[17];
    std::snprintf(hash, sizeof hash, "%08x%08x", result.keyHash[1], result.keyHash[0]);
    EXPECT_EQ(state.count, result.terminals) << state.file;
    EXPECT_EQ(state.keyHash, hash) << state.file;
  }
  Picture picture(const State& state) const { return gpgp::host::readPng(state.file); }
};

TEST_F(LiveEditing, AttributesAndFilesAreSeenAndBrokenOnesLeaveTheCity) {
  const std::string good = replaced(text, "var groundHeight = 4;", "var groundHeight = 7;");
  // A character of no word, in line 6 and column 25.
  const std::string broken = replaced(good, "var floorHeight = 3;", "var floorHeight = 3;    ?");
  write("good.pga", good);
  write("broken.pga", broken);
  const std::vector<State> states = run("# all states in turn\n"
                                        "picture first.png\n"
                                        "set floorHeight 5.5\n"
                                        "picture set.png\n"
                                        "write good.pga\n"
                                        "picture good.png\n"
                                        "write broken.pga\n"
                                        "picture broken.png\n"
                                        "set floorHeight 3\n"
                                        "write good.pga\n"
                                        "picture again.png\n");
  ASSERT_EQ(states.size(), 5u) << output;
  const State &first = states[0], &set = states[1], &saved = states[2], &wrong = states[3], &again = states[4];
  expectDerived(first, text, {});
  expectDerived(set, text, {{"floorHeight", 5.5f}});
  expectDerived(saved, good, {{"floorHeight", 5.5f}}); // what was set stays
  expectDerived(wrong, good, {{"floorHeight", 5.5f}});
  expectDerived(again, good, {{"floorHeight", 3}}); // set while the file was broken
  EXPECT_NE(first.keyHash, set.keyHash);
  EXPECT_NE(set.keyHash, saved.keyHash);

  // The message has its place, in the output and over the picture; all else is as it was.
  for (const State* state : {&first, &set, &saved, &again}) {
    EXPECT_TRUE(state->errors.empty()) << state->errors[0];
    EXPECT_EQ(state->errorBox[2], 0);
  }
  ASSERT_FALSE(wrong.errors.empty()) << output;
  EXPECT_EQ(wrong.errors[0].rfind((folder / "city.pga").string() + ":6:25: ", 0), 0u) << wrong.errors[0];
  ASSERT_GT(wrong.errorBox[2] - wrong.errorBox[0], 300);
  ASSERT_GT(wrong.errorBox[3] - wrong.errorBox[1], 20);
  const Picture before = picture(saved), message = picture(wrong);
  EXPECT_EQ(different(before, message, wrong.errorBox), 0u);
  EXPECT_GT(different(before, message, kNowhere), 3000u);
  // The change of an attribute is seen: of the city, not of its panel alone.
  const int panel[4] = {480 - 192 - 12, 0, 480, 200};
  EXPECT_GT(different(picture(first), picture(set), panel), 3000u);
  EXPECT_GT(different(picture(set), picture(saved), panel), 1000u);
  // An attribute is seen in the next frame; so is a file, and an error once two looks agree on it.
  std::istringstream lines(output);
  size_t changes = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("change      ", 0) != 0) continue;
    ++changes;
    unsigned frames = 0;
    ASSERT_EQ(std::sscanf(line.c_str() + line.find("after "), "after %u frames", &frames), 1) << line;
    EXPECT_EQ(frames, line.find("broken.pga") != std::string::npos ? 2u : 1u) << line;
  }
  EXPECT_EQ(changes, 5u);
}

TEST_F(LiveEditing, WrongScriptsAreErrors) {
  for (const char* script : {"set floorHeight\n", "frames 2 3\n", "jump\n"}) {
    write("script", script);
    const std::string command = std::string("\"") + GPGP_MINI_ENGINE + "\" --live \"" + (folder / "city.pga").string() +
                                "\" --script \"" + (folder / "script").string() + "\" --out \"" + folder.string() +
                                "\" --size 64x64 > /dev/null 2>&1";
    EXPECT_NE(std::system(command.c_str()), 0) << script;
  }
}

} // namespace
