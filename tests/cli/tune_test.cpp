// `gpgp tune` as a person or a script uses it.
#include "files.h"
#include "host/picture.h"
#include "run.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>

namespace gpgp::test {
namespace {

constexpr const char* kTower = R"(var floors = 1;
axiom Box Tower;
terminal Wall Roof (1, 0);
Tower = Repeat(Y, floors, ADJUST_TO_FILL) Floor;
Floor = IfSizeLess(X, 2) { Roof | SubDiv(X) { -1: Scale(-0.5, -1, -1) Floor | -1: Translate(0, 1, 0) Wall } };
)";

/// Tuned schedules in a folder of the test's own.
class Cache {
public:
  explicit Cache(const std::string& name)
      : folder_(std::filesystem::path(testing::TempDir()) / ("gpgp_cli_test_cache_" + name)) {
    std::filesystem::remove_all(folder_); // of a run that was ended
    std::filesystem::create_directories(folder_);
    if (const char* before = std::getenv("XDG_CACHE_HOME")) before_ = before;
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
  }
  ~Cache() {
    if (before_)
      setenv("XDG_CACHE_HOME", before_->c_str(), 1);
    else
      unsetenv("XDG_CACHE_HOME");
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;
  std::filesystem::path gpgp() const { return folder_ / "gpgp"; }

private:
  std::filesystem::path folder_;
  std::optional<std::string> before_;
};

/// Kernels of a baked grammar: they stand behind its graph, and each says how many words it has.
size_t kernelCount(const std::string& file) {
  const std::string bytes = host::readText(file);
  const auto word = [&](size_t index) {
    uint32_t value = 0;
    if (4 * index + 4 <= bytes.size()) std::memcpy(&value, bytes.data() + 4 * index, 4);
    return value;
  };
  size_t count = 0;
  for (size_t at = word(2); word(at) == 0x6b677067u && word(at + 2) > 0; at += word(at + 2)) ++count;
  return count;
}

TEST(CliTune, FindsAScheduleAndBakesIt) {
  const TemporaryFile grammar("tune.pga", kTower), baked("tune.gpgpg");
  const std::vector<std::string> arguments = {
      "tune",         grammar.path(), "--axioms",  "3", "--samples", "5",         "--repeat", "3", "--schedules-only",
      "--axiom-size", "8,4,1",        "--seconds", "0", "-o",        baked.path()};
  const json first = gpgpJson(arguments);
  EXPECT_EQ(first["terminals"], 3 * 4 * 3); // 8 becomes 2 and a wall, 2 becomes 0.5 and a wall, 0.5 is a roof
  EXPECT_GE(first["schedules"].size(), 2u);
  EXPECT_EQ(first["candidates"], first["schedules"].size());
  double before = 0; // the fastest comes first: it is the one that is kept
  for (const json& schedule : first["schedules"]) {
    const json& time = schedule["gpu_ms_median"]; // none where budgets do not suffice
    EXPECT_LE(before, time.is_null() ? std::numeric_limits<double>::infinity() : time.get<double>()) << first.dump(2);
    before = time.is_null() ? std::numeric_limits<double>::infinity() : time.get<double>();
  }
  EXPECT_GT(first["best"]["gpu_ms_median"], 0);
  const size_t kernels = kernelCount(baked.path());
  EXPECT_GE(kernels, 1u);
  gpgpJson(arguments); // tuned again for the same device and number: replaced, not added
  EXPECT_EQ(kernelCount(baked.path()), kernels);
  const json derived = gpgpJson(
      {"spawn", grammar.path(), "--axioms", "3", "--axiom-size", "8,4,1", "--schedule", baked.path(), "--validate"});
  EXPECT_EQ(derived["terminals"], first["terminals"]);
  EXPECT_EQ(derived["schedule_file"], baked.path());
}

TEST(CliTune, TheFastestIsKeptWhereSchedulesAreFarApart) {
  std::string rule; // a shape that waits at each of these operators takes many times as long as one that passes all
  for (int i = 0; i < 16; ++i) rule += "Translate(0, 0.5, 0) Rotate(0, 10, 0) ";
  const TemporaryFile grammar("apart.pga", "axiom Box S;\nterminal A (1, 0);\nS = " + rule + "A;\n"),
      baked("apart.gpgpg");
  const json tuned = gpgpJson({"tune", grammar.path(), "--axioms", "20000", "--samples", "8", "--repeat", "5",
                               "--schedules-only", "--seconds", "0", "-o", baked.path()});
  double least = std::numeric_limits<double>::infinity(), most = 0, kept = 0;
  for (const json& schedule : tuned["schedules"]) {
    if (schedule["needs_larger_budgets"]) continue;
    const double time = schedule["gpu_ms_median"];
    least = std::min(least, time), most = std::max(most, time);
    if (schedule["schedule"] == tuned["best"]["schedule"] &&
        schedule["execution_groups"] == tuned["best"]["execution_groups"])
      kept = time;
  }
  ASSERT_GT(most, 2 * least) << "these schedules tell nothing";
  ASSERT_GT(kept, 0);
  EXPECT_LT(kept * kept, least * most) << tuned.dump(2); // nearer to the fastest
}

TEST(CliTune, KeepsToItsTime) {
  const TemporaryFile grammar("brief.pga", kTower), baked("brief.gpgpg");
  const json tuned = gpgpJson({"tune", grammar.path(), "--axioms", "3", "--axiom-size", "8,4,1", "--repeat", "3",
                               "--seconds", "0.001", "-o", baked.path()});
  EXPECT_EQ(tuned["candidates"], 1); // whatever the time
  EXPECT_GT(tuned["left_out"], 0);   // sizes and counts of workgroups at least
  EXPECT_FALSE(tuned["complete"]);
  EXPECT_EQ(tuned["best"]["group_size"], 0); // as the device suggests
  EXPECT_EQ(gpgpJson({"spawn", grammar.path(), "--axioms", "3", "--axiom-size", "8,4,1", "--schedule",
                      baked.path()})["terminals"],
            3 * 4 * 3);
}

TEST(CliTune, TunedSchedulesAreKept) {
  const TemporaryFile grammar("kept.pga", kTower);
  const Cache cache("kept");
  const json tuned =
      gpgpJson({"tune", grammar.path(), "--axioms", "3", "--axiom-size", "8,4,1", "--samples", "5", "--repeat", "3",
                "--schedules-only", "--matching", "on", "--search", "random", "--set", "floors=1"});
  EXPECT_EQ(tuned["matching"], true);
  EXPECT_EQ(std::filesystem::path(tuned["out"].get<std::string>()).parent_path(), cache.gpgp());
  const std::vector<std::string> spawn = {"spawn",      grammar.path(), "--axiom-size", "8,4,1",
                                          "--schedule", "tuned",        "--set",        "floors=1"};
  auto two = spawn; // 2 and 3 are of one class
  two.insert(two.end(), {"--axioms", "2"});
  const json found = gpgpJson(two); // nothing on standard error: it is not tuned again
  EXPECT_EQ(found["schedule_file"], tuned["out"]);
  EXPECT_EQ(found["schedule"], tuned["best"]["schedule"]);
  EXPECT_EQ(found["execution_groups"], tuned["best"]["execution_groups"]);
  EXPECT_EQ(found["terminals"], 2 * 4 * 3);
}

TEST(CliTune, WhatCannotBeUsedAnyMoreIsMadeAnew) {
  const TemporaryFile grammar("stale.pga", "axiom Box S;\nterminal T (1, 0);\nS = T;\n"), baked("stale.gpgpg");
  const Cache cache("stale");
  const std::vector<std::string> tune = {"tune", grammar.path(), "--axioms", "1", "--seconds", "0.001"},
                                 spawn = {"spawn", grammar.path(), "--schedule", "tuned"};
  const std::string kept = gpgpJson(tune)["out"];
  const std::string whole = host::readText(kept);
  std::string oldKernel = whole, oldGraph = whole;
  uint32_t graphWords = 0;
  std::memcpy(&graphWords, whole.data() + 8, 4);
  --oldKernel.at(4 * graphWords + 4); // versions stand behind what the bytes are
  --oldGraph.at(4);
  const std::vector<std::string> all = {std::string(), "gp", whole.substr(0, whole.size() / 2), oldKernel, oldGraph};
  for (size_t i = 0; i < all.size(); ++i) { // tuning is slow on software devices: each by one of the commands
    host::writeFile(kept, all[i]);
    const ProcessResult result = gpgp(i % 2 ? spawn : tune);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.err.find(kept), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("; its contents are made anew"), std::string::npos) << result.err;
    EXPECT_EQ(gpgpJson(spawn)["schedule_file"], kept); // without a word
  }
  // In a file that was named, only what can be nothing else is replaced.
  auto named = tune;
  named.insert(named.end(), {"-o", baked.path()});
  host::writeFile(baked.path(), "gp");
  EXPECT_NE(gpgpFailure(named).find("is not a baking of this grammar"), std::string::npos);
  host::writeFile(baked.path(), oldKernel);
  EXPECT_EQ(gpgp(named).exitCode, 0);
  EXPECT_EQ(gpgpJson({"spawn", grammar.path(), "--schedule", baked.path()})["terminals"], 1);
}

TEST(CliTune, DepthIsABudget) {
  const TemporaryFile grammar("deep.pga", "axiom Box S;\nterminal T (1, 0);\n"
                                          "S = IfSizeLess(X, 0.01) { T | SubDiv(X) { 0.01: T | -1: S } };\n");
  const Cache cache("deep");
  std::vector<std::string> tune = {"tune", grammar.path(), "--axioms", "1", "--seconds", "0.001"};
  EXPECT_NE(gpgpFailure(tune).find("1 shapes were not finished: rules nest deeper than the budget; raise --max-depth"),
            std::string::npos);
  tune.insert(tune.end(), {"--max-depth", "200"});
  const json tuned = gpgpJson(tune);
  const json spawned = gpgpJson({"spawn", grammar.path(), "--schedule", "tuned", "--max-depth", "200"});
  EXPECT_EQ(tuned["terminals"], spawned["terminals"]);
  EXPECT_GE(spawned["terminals"], 100);
  EXPECT_EQ(spawned["schedule_file"], tuned["out"]);
  std::filesystem::remove(tuned["out"].get<std::string>());
  const ProcessResult first = gpgp({"spawn", grammar.path(), "--schedule", "tuned", "--max-depth", "200"});
  EXPECT_EQ(first.exitCode, 0) << first.err; // tunes with that depth, too
}

TEST(CliTune, FilesSayWhyTheyAreNoSchedules) {
  const TemporaryFile grammar("sum.pga", kTower), baked("sum.gpgp");
  ASSERT_EQ(gpgp({"bake", grammar.path(), "--no-kernel", "-o", baked.path()}).exitCode, 0);
  std::string bytes = host::readText(baked.path());
  ++bytes.back();
  host::writeFile(baked.path(), bytes);
  for (const auto& command : {std::vector<std::string>{"spawn", grammar.path(), "--schedule", baked.path()},
                              std::vector<std::string>{"spawn", baked.path()}})
    EXPECT_NE(gpgpFailure(command).find("its checksum is wrong"), std::string::npos);
  // and so is what stands behind the graph, whoever reads it
  ASSERT_EQ(gpgp({"bake", grammar.path(), "-o", baked.path()}).exitCode, 0);
  bytes = host::readText(baked.path());
  std::string flipped = bytes;
  flipped[bytes.size() / 2] ^= 1;
  const TemporaryFile out("sum_again.gpgp");
  for (const auto& [damaged, why] :
       {std::pair(bytes.substr(0, 4096), "cut"), {flipped, "checksum"}, {bytes + "behind it", "size"}}) {
    host::writeFile(baked.path(), damaged);
    for (const auto& command :
         {std::vector<std::string>{"spawn", baked.path()}, std::vector<std::string>{"graph", baked.path()},
          std::vector<std::string>{"bake", "--link", baked.path(), "-o", out.path()}})
      EXPECT_NE(gpgpFailure(command).find(why), std::string::npos) << why << " by " << command[0];
  }
  EXPECT_FALSE(std::filesystem::exists(out.path()));
}

/// Heights of a field decide what is derived: four boxes side by side where the ground is above 0.5.
TEST(CliTune, GrammarsWithFields) {
  const TemporaryFile grammar("field.pga", "axiom Box S;\nterminal T (1, 0);\nterminal U (1, 1);\n"
                                           "S = If(Field(f) > 0.5) { Repeat(X, 0.25, ADJUST_TO_FILL) T | U };\n"),
      picture("field.png");
  host::writePng(picture.path(), {2, 1, {0, 0, 0, 255, 255, 255, 255, 255}});
  const Cache cache("field");
  const std::string field = "f=" + picture.path() + ",-1000,0,1000,0.001";
  const std::vector<std::string> tune = {"tune",      grammar.path(), "--axioms", "4",
                                         "--seconds", "0.001",        "--field",  field};
  const json tuned = gpgpJson(tune);
  // A field of 0.5 at the origin, as good as flat there: with twice the scale all is above, as it is all below here.
  const json found =
      gpgpJson({"spawn", grammar.path(), "--schedule", "tuned", "--axioms", "4", "--field", field + ",2"});
  EXPECT_EQ(found["schedule_file"], tuned["out"]);
  EXPECT_EQ(found["terminals"], 16);
  EXPECT_EQ(gpgp({"tune", grammar.path()}).exitCode, 2);
}

TEST(CliTune, WrongUsage) {
  const TemporaryFile grammar("usage_tune.pga", kTower), other("other_file.txt", "no grammar");
  expectWrongUsage({{"tune"},
                    {"tune", grammar.path(), "--search", "lucky"},
                    {"tune", grammar.path(), "--matching", "perhaps"},
                    {"tune", grammar.path(), "--samples", "1"},
                    {"tune", grammar.path(), "--seconds", "-1"},
                    {"tune", grammar.path(), "--set", "floors"}});
  EXPECT_NE(gpgpFailure({"tune", grammar.path(), "-o", other.path()}).find("is not a baking of this grammar"),
            std::string::npos);
  EXPECT_EQ(gpgpFailure({"tune", grammar.path(), "-o", "/proc/x"}).substr(0, 9), "/proc/x: "); // before the search
}

} // namespace
} // namespace gpgp::test
