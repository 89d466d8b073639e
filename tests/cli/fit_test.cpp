// `gpgp fit` on optima that are known. The command itself compares the best axiom with the CPU.
#include "files.h"
#include "host/picture.h"
#include "run.h"

namespace gpgp::test {
namespace {

constexpr const char* kBlock = "axiom Box A;\nterminal T (1, 0); terminal U (1, 1);\n"
                               "A = SubDiv(Y) { -1: T | -1: Repeat(X, 2, ADJUST_TO_FILL) U };\n";

TEST(CliFit, FindsTheExtentsOfASilhouetteAndAVolume) {
  host::Picture mask{32, 32, std::vector<uint8_t>(32 * 32 * 4, 255)};
  for (uint32_t y = 12; y < 32; ++y) // 10 wide and 20 high, on the ground
    for (uint32_t x = 11; x < 21; ++x) std::fill_n(&mask.rgba[(y * 32 + x) * 4], 3, uint8_t(20));
  const TemporaryFile grammar("block.pga", kBlock), png("mask.png"), picture("fit.png"), cells("cells.png");
  host::writePng(png.path(), mask);
  const std::vector<std::string> arguments = {
      "fit",       grammar.path(),  "--silhouette",   png.path(),     "--height",
      "32",        "--vary",        "size-x=1..30/1", "--vary",       "size-y=1..30/1",
      "--vary",    "size-z=1..9/2", "--measure",      "all:xyz=1400", "--candidates",
      "200",       "--image",       picture.path(),   "--compare",    cells.path(),
      "--validate"};
  const json found = gpgpJson(arguments);
  EXPECT_EQ(found["score"], 0);
  EXPECT_EQ(found["size"], json::array({10, 20, 7}));
  EXPECT_EQ(found["target_cells"], 200);
  EXPECT_EQ(found["missing_cells"], 0);
  EXPECT_EQ(found["excess_cells"], 0);
  EXPECT_EQ(found["sums"][0]["sum"], 1400);
  const host::Picture compared = host::readPng(cells.path());
  EXPECT_EQ(compared.width, 128u);
  EXPECT_EQ(compared.rgba[(127 * 128 + 64) * 4], 96); // agrees, at the foot
  EXPECT_EQ(compared.rgba[0], 255);
  EXPECT_GT(host::readPng(picture.path()).width, 0u);
  json again = gpgpJson(arguments), before = found;
  again.erase("gpu_ms");
  before.erase("gpu_ms");
  EXPECT_EQ(again, before);
}

TEST(CliFit, CountsByTerminalAndSplitsRecordings) {
  const TemporaryFile grammar("counted.pga", kBlock);
  const json found = gpgpJson({"fit", grammar.path(), "--vary", "size-x=1..4000", "--measure", "U:count=40",
                               "--candidates", "600", "--method", "monte-carlo"});
  EXPECT_EQ(found["sums"][0]["sum"], 40);
  EXPECT_GT(found["size"][0], 70);
  EXPECT_GT(found["recordings"], found["rounds"]); // budgets grew
}

TEST(CliFit, SaysWhatIsWrong) {
  const TemporaryFile grammar("wrong.pga", kBlock);
  const TemporaryFile colliding("colliding.pga", "axiom Box A;\nterminal T (1, 0);\nA = Collider(1) T;\n");
  const std::string g = grammar.path();
  expectWrongUsage({{"fit", g},
                    {"fit", g, "--measure", "V:count=1"},
                    {"fit", g, "--measure", "U:w=1"},
                    {"fit", g, "--measure", "U:count"},
                    {"fit", g, "--measure", "U:count=x"},
                    {"fit", g, "--measure", "U:x=1", "--vary", "size-w=1..2"},
                    {"fit", g, "--measure", "U:x=1", "--vary", "size-x=2..1"},
                    {"fit", g, "--measure", "U:x=1", "--vary", "size-x=0..1"},
                    {"fit", g, "--measure", "U:x=1", "--vary", "seed=0..1", "--vary", "seed=0..2"},
                    {"fit", g, "--measure", "U:x=1", "--compare", "a.png"},
                    {"fit", colliding.path(), "--measure", "T:x=1"}});
  EXPECT_NE(gpgp({"fit", g, "--measure", "V:count=1"}).err.find("no terminal \"V\""), std::string::npos);
}

} // namespace
} // namespace gpgp::test
