// `gpgp spawn` on grammars whose terminals can be counted by hand.
#include "files.h"
#include "host/picture.h"
#include "run.h"

namespace gpgp::test {
namespace {

constexpr const char* kTower = R"(axiom Box Tower;
terminal Floor (1, 0);
Tower = Repeat(Y, 1, ADJUST_TO_FILL) Floor;
)";

TEST(CliSpawn, CountsTerminals) {
  const TemporaryFile grammar("tower.pga", kTower), picture("tower.png");
  const json tower = gpgpJson({"spawn", grammar.path(), "--axioms", "3", "--axiom-size", "4,10,4", "--repeat", "2",
                               "--image", picture.path(), "--image-size", "96x64", "--validate"});
  EXPECT_EQ(keys(tower),
            (std::set<std::string>{"command", "ok", "grammar", "device", "status", "axioms", "seed", "terminals",
                                   "instances", "buckets", "rounds", "peakShapes", "droppedShapes", "unfinishedShapes",
                                   "keyHash", "gpuMilliseconds", "image"}));
  EXPECT_EQ(tower["status"], "GPGP_SUCCESS");
  EXPECT_EQ(tower["terminals"], 30);
  EXPECT_EQ(tower["instances"], 30);
  ASSERT_EQ(tower["buckets"].size(), 1u);
  EXPECT_EQ(tower["buckets"][0]["name"], "Floor");
  EXPECT_EQ(tower["buckets"][0]["instances"], 30);
  EXPECT_EQ(tower["keyHash"].get<std::string>().size(), 16u);
  EXPECT_EQ(host::readPng(picture.path()).width, 96u);
  const json again = gpgpJson({"spawn", grammar.path(), "--axioms", "3", "--axiom-size", "4,10,4"});
  EXPECT_EQ(again["keyHash"], tower["keyHash"]);
  const json otherSeed = gpgpJson({"spawn", grammar.path(), "--axioms", "3", "--axiom-size", "4,10,4", "--seed", "9"});
  EXPECT_NE(otherSeed["keyHash"], tower["keyHash"]);
}

TEST(CliSpawn, BudgetsAreReported) {
  const TemporaryFile grammar("budget.pga", kTower);
  const json tower = gpgpJson({"spawn", grammar.path(), "--axiom-size", "4,10,4", "--max-instances", "4"});
  EXPECT_EQ(tower["status"], "GPGP_BUDGET_EXCEEDED");
  EXPECT_EQ(tower["terminals"], 10);
  EXPECT_EQ(tower["instances"], 4);
}

TEST(CliSpawn, ErrorsHaveAPlace) {
  const TemporaryFile grammar("wrong.pga", "axiom Box A;\nterminal T (1, 0);\nA = Nonsense(X) T;\n");
  EXPECT_NE(gpgpFailure({"spawn", grammar.path()}).find("wrong.pga:3:"), std::string::npos);
}

TEST(CliSpawn, WrongUsage) {
  const TemporaryFile grammar("usage.pga", kTower);
  expectWrongUsage({{"spawn"},
                    {"spawn", "no_such_file.pga"},
                    {"spawn", grammar.path(), "--axioms", "0"},
                    {"spawn", grammar.path(), "--axiom-size", "1,2"},
                    {"spawn", grammar.path(), "--axiom-size", "1,2,-3"},
                    {"spawn", grammar.path(), "--set", "floors"},
                    {"spawn", grammar.path(), "--set", "=3"},
                    {"spawn", grammar.path(), "--set", "floors=many"}});
}

} // namespace
} // namespace gpgp::test
