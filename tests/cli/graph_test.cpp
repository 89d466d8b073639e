// `gpgp graph` on a sponge whose schedules are published.
#include "files.h"
#include "host/files.h"
#include "run.h"

#include <algorithm>
#include <filesystem>

namespace gpgp::test {
namespace {

constexpr const char* kSponge = R"(axiom Box A;
terminal B (1,0);
A = IfSizeLess(X, 0.333) { B | SubX };
ZDiscard = SubDiv(Z) { -1: A | -1: Discard() | -1: A };
YDiscard = SubDiv(Y) { -1: ZDiscard | -1: Discard() | -1: ZDiscard };
SubZ = SubDiv(Z) { -1: A | -1: A | -1: A };
SubY = SubDiv(Y) { -1: SubZ | -1: ZDiscard | -1: SubZ };
SubX = SubDiv(X) { -1: SubY | -1: YDiscard | -1: SubY };
)";

TEST(CliGraph, CountsPartitions) {
  const TemporaryFile grammar("sponge.pga", kSponge);
  const json all = gpgpJson({"graph", grammar.path(), "--partitions"});
  EXPECT_EQ(all["nodes"], 7);
  EXPECT_EQ(all["edges"], 17);
  EXPECT_EQ(all["partitions"], 40);
  EXPECT_EQ(all["partitions_complete"], true);
  EXPECT_EQ(all["groups"], (json{{"sgl", 1}, {"rw", 7}, {"rules", 6}, {"heuristic", 3}}));
  const json some = gpgpJson({"graph", grammar.path(), "--partitions", "--limit", "12"});
  EXPECT_EQ(some["partitions"], 12);
  EXPECT_EQ(some["partitions_complete"], false);
}

TEST(CliGraph, PrintedSchedulesAreRead) {
  const TemporaryFile grammar("read.pga", kSponge), printed("read.txt"), picture("read.svg");
  for (const auto& [schedule, groups, classes, dynamic] :
       {std::tuple{"sgl", 1, 1, 5}, {"rw", 7, 4, 15}, {"rules", 6, 3, 14}, {"heuristic", 3, 3, 7}}) {
    const json made = gpgpJson({"graph", grammar.path(), "--schedule", schedule, "--out", printed.path()});
    EXPECT_EQ(made["execution_groups"], groups);
    EXPECT_EQ(made["group_classes"], classes);
    EXPECT_EQ(made["dynamic_edges"], dynamic);
    EXPECT_EQ(made["static_edges"], 15 - dynamic);
    const json read = gpgpJson({"graph", grammar.path(), "--schedule", printed.path()});
    EXPECT_EQ(read["execution_groups"], groups);
    EXPECT_EQ(read["dynamic_edges"], dynamic);
    const ProcessResult text = gpgp({"graph", grammar.path(), "--schedule", printed.path()});
    EXPECT_EQ(text.out, host::readText(printed.path()));
  }
  gpgpJson({"graph", grammar.path(), "--schedule", "rules", "--format", "svg", "-o", picture.path()});
  EXPECT_EQ(host::readText(picture.path()).substr(0, 5), "<svg ");
  EXPECT_EQ(gpgp({"graph", grammar.path(), "--format", "dot"}).out.substr(0, 8), "digraph ");
}

TEST(CliGraph, PrintsTheGraphsOfTheTestData) { // where the fuzzer of the printed form begins
  const std::filesystem::path data = GPGP_TEST_DATA;
  const auto printed = [&](const std::filesystem::path& grammar, const char* schedule) {
    const auto wanted = data / "graphs" / grammar.stem().concat(".graph");
    EXPECT_EQ(gpgp({"graph", grammar.string(), "--schedule", schedule}).out, host::readText(wanted)) << wanted;
  };
  printed(std::filesystem::path(GPGP_SAMPLE_GRAMMARS) / "overview.pga", "rules");
  for (const char* name : {"shapes.pga", "sponge.pga", "tree.pga"}) printed(data / "grammars" / name, "heuristic");
}

TEST(CliGraph, ErrorsHaveAPlace) {
  const TemporaryFile wrong("wrong_graph.pga", "axiom Box A;\nterminal T (1, 0);\nA = Nonsense(X) T;\n");
  EXPECT_NE(gpgpFailure({"graph", wrong.path()}).find("wrong_graph.pga:3:5: error: "), std::string::npos);
  const TemporaryFile grammar("right_graph.pga", kSponge),
      groups("groups.txt", "group { 0 1 2 3 5 6 }\ngroup { 4 7 }\n");
  EXPECT_NE(gpgpFailure({"graph", grammar.path(), "--schedule", groups.path()}).find("groups.txt:2:11: error: "),
            std::string::npos);
  const TemporaryFile baked("groups.gpgp");
  ASSERT_EQ(gpgp({"bake", grammar.path(), "--no-kernel", "-o", baked.path()}).exitCode, 0);
  EXPECT_EQ(gpgpFailure({"graph", grammar.path(), "--schedule", baked.path()}),
            baked.path() + " is a baked grammar; expected groups, as gpgp graph prints them");
}

TEST(CliGraph, NumbersOfErrorsAreThoseOfTheFile) {
  std::string rules = "axiom Box A;\nterminal T (1, 0);\nA = T;\n";
  for (int i = 0; i < 1500; ++i) rules += "R" + std::to_string(i) + " = Nowhere;\n";
  const TemporaryFile wrong("many_errors.pga", rules);
  const std::string errors = gpgp({"graph", wrong.path()}).err;
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 21) << "twenty, and what ends the command";
  EXPECT_NE(errors.find("gpgp graph: 1500 errors\n"), std::string::npos);
}

TEST(CliGraph, WrongUsage) {
  const TemporaryFile grammar("usage_graph.pga", kSponge);
  expectWrongUsage({{"graph"},
                    {"graph", "no_such_file.pga"},
                    {"graph", grammar.path(), "--format", "png"},
                    {"graph", grammar.path(), "--schedule", "fastest"},
                    {"graph", grammar.path(), "--group-size", "-1"}});
}

} // namespace
} // namespace gpgp::test
