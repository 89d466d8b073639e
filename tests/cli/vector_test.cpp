// `gpgp vector` on a drawing whose pixels are known.
#include "files.h"
#include "host/picture.h"
#include "run.h"

#include <algorithm>

namespace gpgp::test {
namespace {

constexpr const char* kHalves = R"(<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20" viewBox="0 0 40 20">
<path d="M0 0 H20 V20 H0 Z" fill="#ff0000"/>
</svg>
)";

TEST(CliVector, DrawsWhatTheFileSays) {
  const TemporaryFile file("halves.svg", kHalves), picture("halves.png");
  const json drawn = gpgpJson(
      {"vector", file.path(), "--out", picture.path(), "--background", "0000ff", "--repeat", "2", "--validate"});
  EXPECT_EQ(keys(drawn), (std::set<std::string>{"command",
                                                "ok",
                                                "file",
                                                "device",
                                                "status",
                                                "width",
                                                "height",
                                                "samples",
                                                "paths",
                                                "curves",
                                                "patches",
                                                "curves_per_patch",
                                                "tile_entries",
                                                "tile_entries_given",
                                                "patches_per_tile",
                                                "paths_dropped",
                                                "warnings",
                                                "unsupported",
                                                "parse_ms",
                                                "convert_ms",
                                                "gpu_ms_median",
                                                "passes",
                                                "image"}));
  EXPECT_EQ(drawn["status"], "GPGP_SUCCESS");
  EXPECT_EQ(drawn["width"], 40);
  EXPECT_EQ(drawn["height"], 20);
  EXPECT_EQ(drawn["paths"], 1);
  const host::Picture seen = host::readPng(picture.path());
  ASSERT_EQ(seen.width, 40u);
  const auto pixel = [&seen](uint32_t x, uint32_t y) {
    const uint8_t* p = &seen.rgba[(size_t{y} * seen.width + x) * 4];
    return std::vector<int>{p[0], p[1], p[2], p[3]};
  };
  EXPECT_EQ(pixel(5, 10), (std::vector<int>{255, 0, 0, 255}));
  EXPECT_EQ(pixel(19, 19), (std::vector<int>{255, 0, 0, 255}));
  EXPECT_EQ(pixel(20, 0), (std::vector<int>{0, 0, 255, 255}));
  EXPECT_EQ(pixel(35, 10), (std::vector<int>{0, 0, 255, 255}));
}

TEST(CliVector, FitsIntoASizeAndLeavesTheRestClear) {
  const TemporaryFile file("fit.svg", kHalves), picture("fit.png");
  gpgpJson({"vector", file.path(), "--out", picture.path(), "--size", "40x40"});
  const host::Picture seen = host::readPng(picture.path());
  EXPECT_EQ(seen.rgba[3], 0) << "above the drawing nothing is painted";
  EXPECT_EQ(seen.rgba[(20 * 40 + 5) * 4 + 3], 255) << "the drawing stands in the middle";
}

TEST(CliVector, StagesArePicturesThatItReadsItself) {
  const TemporaryFile file("stages.svg", kHalves), picture("stages.png");
  const std::string folder = picture.path() + ".stages";
  gpgpJson({"vector", file.path(), picture.path(), "--stages", folder});
  EXPECT_EQ(host::readPng(picture.path()).width, 40u);
  for (const char* stage : {"paths", "pieces", "crossings", "patches"})
    EXPECT_GE(gpgpJson({"vector", folder + "/" + stage + ".svg"})["paths"], 1) << stage;
  std::filesystem::remove_all(folder);
}

TEST(CliVector, RealDrawing) {
  const std::string tiger = GPGP_TEST_DATA "/fetched/svg/tiger.svgz";
  ASSERT_TRUE(std::filesystem::exists(tiger)) << "run tests/data/fetch.sh --only svg";
  const ProcessResult result = gpgp({"vector", tiger, "--size", "128x128", "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json drawn = json::parse(result.out, nullptr, false);
  ASSERT_TRUE(drawn.is_object()) << result.out;
  EXPECT_EQ(drawn["status"], "GPGP_SUCCESS");
  EXPECT_GT(drawn["paths"], 200);
}

TEST(CliVector, WarningsAreCountedAndNotAFlood) {
  std::string svg = R"(<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20"><filter id="f"/>)";
  for (int i = 0; i < 30; ++i) svg += "\n<path d=\"M0 0 H20 V20 Z\" filter=\"url(#f)\"/>";
  const TemporaryFile file("warnings.svg", svg + "\n</svg>\n");
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  const ProcessResult some = gpgp({"vector", file.path(), "--json"});
  const ProcessResult all = gpgp({"vector", file.path(), "--json", "--all-warnings"});
  ASSERT_EQ(some.exitCode, 0) << some.err;
  const json counted = json::parse(some.out, nullptr, false);
  ASSERT_TRUE(counted.is_object()) << some.out;
  EXPECT_GE(counted["warnings"], 30);
  EXPECT_EQ(counted["unsupported"].size(), counted["warnings"]);
  EXPECT_EQ(counted["unsupported"][0].get<std::string>().substr(0, 7), "line 2:");
  EXPECT_EQ(lines(some.err), 11) << some.err;
  EXPECT_EQ(lines(all.err), counted["warnings"]) << all.err;
}

TEST(CliVector, BadDrawingsAreNamed) {
  const TemporaryFile file("no.svg", "this is no drawing");
  EXPECT_NE(gpgpFailure({"vector", file.path()}).find("no.svg"), std::string::npos);
}

TEST(CliVector, WrongUsage) {
  const TemporaryFile file("usage.svg", kHalves);
  expectWrongUsage({{"vector"},
                    {"vector", "no_such_file.svg"},
                    {"vector", file.path(), "--samples", "3"},
                    {"vector", file.path(), "--background", "red"},
                    {"vector", file.path(), "--size", "big"}});
}

} // namespace
} // namespace gpgp::test
