// `gpgp spawn --measure`: sums of each axiom against closed forms. The command itself compares device and CPU.
#include "files.h"
#include "run.h"

namespace gpgp::test {
namespace {

TEST(CliMeasure, SumsUpTheTerminalsOfEachAxiom) {
  // Four slices of a box, every second one of another name.
  const TemporaryFile grammar("slices.pga", "axiom Box A;\nterminal T (1, 0);\nterminal U (1, 1);\n"
                                            "A = SubDiv(X) { -1: T | -1: U | -1: T | -1: U };\n");
  const TemporaryFile axioms("axioms.csv", "x,y,z,size_x,size_y,size_z,attribute\n"
                                           "0,1,0,8,2,4,0.5\n"
                                           "100,0,0,4,3,1,0.25\n"
                                           "0,0,-50,16,16,16,0\n");
  const json made =
      gpgpJson({"spawn", grammar.path(), "--axiom-file", axioms.path(), "--measure", "all:xyz", "--measure", "T:count",
                "--measure", "U:x", "--measure", "all:a", "--schedule", "interpreter", "--validate"});
  const json& measures = made["measures"];
  ASSERT_EQ(measures.size(), 3u);
  const double volumes[] = {64, 12, 4096}, halves[] = {4, 2, 8}, attributes[] = {2, 1, 0};
  // Positions of files are those of the foot.
  const double middles[][3] = {{0, 2, 0}, {100, 1.5, 0}, {0, 8, -50}},
               sizes[][3] = {{8, 2, 4}, {4, 3, 1}, {16, 16, 16}};
  for (size_t i = 0; i < 3; ++i) {
    const json& axiom = measures[i];
    EXPECT_EQ(axiom["axiom"], i);
    EXPECT_EQ(axiom["terminals"], 4);
    EXPECT_EQ(axiom["clamped"], 0);
    EXPECT_EQ(axiom["sums"]["all:xyz"], volumes[i]);
    EXPECT_EQ(axiom["sums"]["T:count"], 2);
    EXPECT_EQ(axiom["sums"]["U:x"], halves[i]);
    EXPECT_EQ(axiom["sums"]["all:a"], attributes[i]);
    for (size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(axiom["bounds"]["min"][axis].get<double>(), middles[i][axis] - sizes[i][axis] / 2, 1e-3);
      EXPECT_NEAR(axiom["bounds"]["max"][axis].get<double>(), middles[i][axis] + sizes[i][axis] / 2, 1e-3);
    }
  }
}

/// More axioms than a recording of measures takes, and a grammar of random numbers.
TEST(CliMeasure, OfManyAxiomsIsTheirSum) {
  const json made =
      gpgpJson({"spawn", GPGP_TEST_DATA "/grammars/building.pga", "--axioms", "40", "--axiom-size", "12,19,14",
                "--measure", "all:count", "--measure", "Glass:xy", "--schedule", "interpreter"});
  EXPECT_TRUE(
      gpgpJson({"spawn", GPGP_TEST_DATA "/grammars/building.pga", "--schedule", "interpreter"})["measures"].is_null());
  double terminals = 0;
  for (const json& axiom : made["measures"]) {
    terminals += axiom["sums"]["all:count"].get<double>();
    EXPECT_EQ(axiom["sums"]["all:count"], axiom["terminals"]);
    EXPECT_GT(axiom["sums"]["Glass:xy"].get<double>(), 10);
  }
  EXPECT_EQ(made["measures"].size(), 40u);
  EXPECT_EQ(terminals, made["terminals"].get<double>());
}

TEST(CliMeasure, SaysWhatIsWrong) {
  const TemporaryFile grammar("one.pga", "axiom Box A;\nterminal T (1, 0);\nA = T;\n");
  const TemporaryFile colliding("colliding.pga", "axiom Box A;\nterminal T (1, 0);\nA = Collider(1) T;\n");
  const TemporaryFile plant("plant.lsys", "axiom: F\niterations: 1\nF --> FF\n");
  const std::string g = grammar.path();
  expectWrongUsage({{"spawn", g, "--measure", "T"},
                    {"spawn", g, "--measure", "T:w"},
                    {"spawn", g, "--measure", "T:"},
                    {"spawn", g, "--measure", "V:x"},
                    {"spawn", g, "--measure", "T:x", "--measure", "T:y", "--measure", "T:z", "--measure", "T:a",
                     "--measure", "T:count"},
                    {"spawn", colliding.path(), "--measure", "T:x"},
                    {"spawn", plant.path(), "--measure", "T:x"}});
  EXPECT_NE(gpgp({"spawn", g, "--measure", "V:x"}).err.find("no terminal \"V\""), std::string::npos);
}

} // namespace
} // namespace gpgp::test
