// `gpgp spawn --camera` with --detail and --budget; fields beside measures, schedules, fits; options that mean nothing
// to a language.
#include "files.h"
#include "host/picture.h"
#include "run.h"

namespace gpgp::test {
namespace {

const std::string kWorld = GPGP_SAMPLE_GRAMMARS "/../world";

std::vector<std::string> wood(std::vector<std::string> more) {
  more.insert(more.begin(), {"spawn", kWorld + "/wood.pga", "--axioms", "64", "--axiom-size", "7,10,7", "--spacing",
                             "9", "--schedule", "interpreter", "--camera", "0,4,90,0,3,0"});
  return more;
}

TEST(CliCamera, ABudgetFindsTheDetail) {
  const json all = gpgpJson(wood({}));
  EXPECT_EQ(all["detail"], 1);
  const uint64_t most = all["terminals"];
  ASSERT_GT(most, 3000u);
  const json within = gpgpJson(wood({"--budget", "2000"}));
  const uint64_t terminals = within["terminals"];
  const double detail = within["detail"];
  EXPECT_LE(terminals, 2000u);
  EXPECT_LT(detail, 1);
  // The same as that detail, and no larger one that matters is within the budget.
  char same[32], more[32];
  std::snprintf(same, sizeof same, "%.9g", detail);
  std::snprintf(more, sizeof more, "%.9g", detail * 1.041);
  const json again = gpgpJson(wood({"--detail", same}));
  EXPECT_EQ(again["terminals"], terminals);
  EXPECT_EQ(again["key_hash"], within["key_hash"]);
  EXPECT_TRUE(terminals >= 1800 || gpgpJson(wood({"--detail", more}))["terminals"] > 2000) << terminals;
  EXPECT_EQ(gpgpJson(wood({"--budget", std::to_string(most)}))["terminals"], most);
  EXPECT_EQ(gpgpJson({"spawn", kWorld + "/wood.pga", "--schedule", "interpreter"})["detail"], json());
}

TEST(CliCamera, SaysWhatIsWrong) {
  EXPECT_NE(gpgpFailure(wood({"--budget", "3"})).find("with the least detail"), std::string::npos);
  const TemporaryFile plain("plain.pga", "axiom Box A;\nterminal T (1, 0);\nA = Repeat(X, 0.1, ADJUST_TO_FILL) T;\n");
  const std::string failure =
      gpgpFailure({"spawn", plain.path(), "--schedule", "interpreter", "--camera", "0,4,90,0,3,0", "--budget", "5"});
  EXPECT_NE(failure.find("10 terminals"), std::string::npos) << failure;
  EXPECT_NE(failure.find("no rule that matters here reads ScreenSize()"), std::string::npos) << failure;
  const std::string g = plain.path();
  expectWrongUsage({{"spawn", g, "--detail", "2"},
                    {"spawn", g, "--budget", "2"},
                    wood({"--budget", "100", "--detail", "0.5"}),
                    wood({"--budget", "0"}),
                    wood({"--detail", "0"}),
                    wood({"--image", "x.png", "--yaw", "10"})}); // the picture is the camera's
}

/// Nothing that was given is ignored.
TEST(CliCamera, OptionsOfOtherLanguagesAreRefused) {
  const TemporaryFile cga("house.cga", "version \"2023.0\"\nLot --> extrude(3) House.\n"),
      plant("plant.lsys", "axiom: F\niterations: 1\nF --> FF\n"),
      pga("pga.pga", "axiom Box A;\nterminal T (1, 0);\nA = T;\n"), lots("lots.csv", "x,z\n0,0\n");
  const auto refused = [](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"spawn", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult result = gpgp(arguments);
    EXPECT_EQ(result.exitCode, 2) << testing::PrintToString(arguments);
    EXPECT_NE(result.err.find(more[0]), std::string::npos) << result.err;
  };
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{"--camera", "0,4,90,0,3,0"},
                                                                                    {"--changed", "5"},
                                                                                    {"--scatter", "3"},
                                                                                    {"--measure", "all:x"},
                                                                                    {"--sorted"},
                                                                                    {"--slice", "2"},
                                                                                    {"--queues", "group"},
                                                                                    {"--max-colliders", "8"}}) {
    refused(cga.path(), more);
    refused(plant.path(), more);
  }
  refused(cga.path(), {"--string"});
  refused(cga.path(), {"--max-instances", "5"});
  refused(cga.path(), {"--schedule", "rules"});
  refused(plant.path(), {"--schedule", "interpreter"});
  refused(plant.path(), {"--attr", "a=1"});
  refused(plant.path(), {"--max-faces", "4"});
  refused(pga.path(), {"--string"});
  refused(pga.path(), {"--attr", "a=1"});
  refused(pga.path(), {"--geographic"});
  refused(pga.path(), {"--interval", "3", "--axiom-file", lots.path()});
  EXPECT_EQ(gpgp({"spawn", cga.path(), "--axioms", "2", "--repeat", "1"}).exitCode, 0);
  EXPECT_EQ(gpgp({"spawn", plant.path(), "--axioms", "2", "--string"}).exitCode, 0);
}

/// Axioms of a file start where --start says, but for those that name a rule.
TEST(CliAxiomFiles, StartWhereStartSays) {
  const TemporaryFile grammar("start.pga",
                              "axiom Box A;\nterminal T (1, 0);\nA = B;\nB = Repeat(X, 1, ADJUST_TO_FILL) C;\n"
                              "C = Repeat(Y, 1, ADJUST_TO_FILL) T;\n"),
      plain("plain.csv", "x,z,size_x,size_y\n0,0,3,4\n9,0,3,4\n"),
      ruled("ruled.csv", "x,z,size_x,size_y,rule\n0,0,3,4,B\n9,0,3,4,\n");
  const auto terminals = [&](const TemporaryFile& file, std::vector<std::string> more) {
    more.insert(more.begin(), {"spawn", grammar.path(), "--axiom-file", file.path(), "--schedule", "interpreter"});
    return gpgpJson(more)["terminals"].get<int>();
  };
  EXPECT_EQ(terminals(plain, {}), 24);
  EXPECT_EQ(terminals(plain, {"--start", "C"}), 8);
  EXPECT_EQ(terminals(ruled, {"--start", "C"}), 16);
}

// ---------------------------------------------------------------- fields

/// Heights that rise from 0 at x = 0 to 8 at x = 10.
struct Slope {
  TemporaryFile picture{"slope.png"};
  TemporaryFile grammar{"slope.pga", "axiom Box A;\nterminal T (1, 0);\nterminal Rest (1, 1);\n"
                                     "A = SubDiv(Y) { Field(f): T | -1: Rest };\n"};
  TemporaryFile axioms{"slope.csv", "x,y,z,size_x,size_y,size_z\n2.5,0,0,1,10,1\n5,0,0,1,10,1\n10,0,3,1,10,1\n"};
  Slope() { host::writePng(picture.path(), {2, 1, {0, 0, 0, 255, 255, 255, 255, 255}}); }
  std::string field() const { return "f=" + picture.path() + ",0,0,10,0.001,8"; }
};

TEST(CliFields, AreMeasured) {
  const Slope slope;
  const json made = gpgpJson({"spawn", slope.grammar.path(), "--axiom-file", slope.axioms.path(), "--schedule",
                              "interpreter", "--field", slope.field(), "--measure", "T:y", "--measure", "all:xyz"});
  const double heights[] = {2, 4, 8};
  ASSERT_EQ(made["measures"].size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(made["measures"][i]["sums"]["T:y"].get<double>(), heights[i], 1e-3);
    EXPECT_NEAR(made["measures"][i]["sums"]["all:xyz"].get<double>(), 10, 1e-3);
  }
  EXPECT_NE(gpgp({"spawn", slope.grammar.path(), "--measure", "T:y"}).err.find("field \"f\""), std::string::npos);
}

TEST(CliFields, AreFitted) {
  const Slope slope;
  // An axiom as high as the ground is there, and half as much again.
  const json found = gpgpJson({"fit", slope.grammar.path(), "--axiom-size", "1,10,1", "--vary", "size-y=8.5..20/0.5",
                               "--field", "f=" + slope.picture.path() + ",-5,0,5,0.001,16", "--measure", "T:y=8",
                               "--measure", "Rest:y=4", "--candidates", "64", "--rounds", "4"});
  EXPECT_NEAR(found["size"][1].get<double>(), 12, 1e-3);
  EXPECT_EQ(gpgp({"fit", slope.grammar.path(), "--measure", "T:y=8"}).exitCode, 2);
}

} // namespace
} // namespace gpgp::test
