// `gpgp tune` as a person or a script uses it.
#include "files.h"
#include "run.h"

#include <filesystem>

namespace gpgp::test {
namespace {

constexpr const char* kTower = R"(axiom Box Tower;
terminal Wall Roof (1, 0);
Tower = Repeat(Y, 1, ADJUST_TO_FILL) Floor;
Floor = IfSizeLess(X, 2) { Roof | SubDiv(X) { -1: Scale(-0.5, -1, -1) Floor | -1: Translate(0, 1, 0) Wall } };
)";

TEST(CliTune, FindsAScheduleAndBakesIt) {
  const TemporaryFile grammar("tune.pga", kTower), baked("tune.gpgpg");
  const std::vector<std::string> arguments = {
      "tune", grammar.path(),     "--axioms",     "3",     "--samples", "5",         "--repeat",
      "3",    "--schedules-only", "--axiom-size", "8,4,1", "-o",        baked.path()};
  const json first = gpgpJson(arguments);
  EXPECT_EQ(first["terminals"], 3 * 4 * 3); // 8 becomes 2 and a wall, 2 becomes 0.5 and a wall, 0.5 is a roof
  EXPECT_GE(first["schedules"].size(), 2u);
  EXPECT_EQ(first["candidates"], first["schedules"].size());
  EXPECT_GT(first["best"]["gpu_ms_median"], 0);
  const auto size = static_cast<double>(std::filesystem::file_size(baked.path()));
  gpgpJson(arguments); // tuned again for the same device and number: replaced, not added
  EXPECT_NEAR(static_cast<double>(std::filesystem::file_size(baked.path())), size, 0.3 * size);
}

} // namespace
} // namespace gpgp::test
