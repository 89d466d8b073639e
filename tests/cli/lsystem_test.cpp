// `gpgp spawn` on L-systems whose modules can be counted by hand. The command itself compares with the CPU reference.
#include "files.h"
#include "run.h"

namespace gpgp::test {
namespace {

constexpr const char* kBranches = "axiom: F\nangle: 30\niterations: 3\nF --> F[+F]F\n";

TEST(CliLsystem, CountsModulesAndPrintsTheString) {
  const TemporaryFile file("branches.lsys", kBranches), picture("branches.png"), mesh("branches.glb");
  const json three = gpgpJson({"spawn", file.path(), "--axioms", "2", "--image", picture.path(), "--image-size",
                               "64x64", "--out", mesh.path(), "--validate"});
  EXPECT_EQ(three["terminals"], 2 * 27);
  EXPECT_EQ(three["modules"], 2 * (27 + 3 * 13)); // 1 + 3 + 9 branches of a bracket pair and a turn
  EXPECT_EQ(three["steps"], 3);
  EXPECT_EQ(three["buckets"][0]["name"], "F");
  EXPECT_EQ(three["triangles"], 2 * 27 * 20);
  const json one = gpgpJson({"spawn", file.path(), "--set", "iterations=1", "--string"});
  EXPECT_EQ(one["string"], "F[+F]F");
}

TEST(CliLsystem, SaysWhatIsWrong) {
  const TemporaryFile file("wrong.lsys", "axiom: F]\nangel: 3\n"), good("good.lsys", kBranches);
  const ProcessResult wrong = gpgp({"spawn", file.path()});
  EXPECT_EQ(wrong.exitCode, 1);
  EXPECT_NE(wrong.err.find(":1:9: error: ']' without a '['"), std::string::npos) << wrong.err;
  EXPECT_NE(wrong.err.find("did you mean 'angle'?"), std::string::npos) << wrong.err;
  EXPECT_EQ(gpgp({"spawn", good.path(), "--sorted"}).exitCode, 2);
  EXPECT_EQ(gpgp({"spawn", good.path(), "--set", "iteration=1"}).exitCode, 1);
  const ProcessResult small = gpgp({"spawn", good.path(), "--max-modules", "10"});
  EXPECT_EQ(small.exitCode, 1);
  EXPECT_NE(small.err.find("--max-modules 24 would have held it"), std::string::npos) << small.err;
}

} // namespace
} // namespace gpgp::test
