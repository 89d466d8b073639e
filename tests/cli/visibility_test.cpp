// `gpgp visibility` on models whose visible triangles are known.
#include "files.h"
#include "host/files.h"
#include "host/picture.h"
#include "run.h"

namespace gpgp::test {
namespace {

// A square, and a second one behind it that it hides wholly from the front.
constexpr const char* kTwoSquares = R"(# comment
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
v -0.5 -0.5 -1
v 0.5 -0.5 -1
v 0.5 0.5 -1
v -0.5 0.5 -1
f 1 2 3 4
f -4/1/1 -3//1 -2 -1
)";

TEST(CliVisibility, SeesWhatIsInFront) {
  const TemporaryFile model("two_squares.obj", kTwoSquares), picture("two_squares.png");
  const json front = gpgpJson({"visibility", model.path(), "--yaw", "0", "--pitch", "0", "--size", "64x48", "--repeat",
                               "2", "--image", picture.path(), "--validate"});
  EXPECT_EQ(keys(front), (std::set<std::string>{"command",
                                                "ok",
                                                "model",
                                                "device",
                                                "status",
                                                "method",
                                                "width",
                                                "height",
                                                "draws",
                                                "triangles",
                                                "facing",
                                                "visible",
                                                "listed",
                                                "coveredPixels",
                                                "gpuMilliseconds",
                                                "image",
                                                "cameras",
                                                "truth",
                                                "coverage",
                                                "overestimation",
                                                "coverage_area",
                                                "overestimation_area",
                                                "neededCandidates",
                                                "neededPairs",
                                                "unresolved",
                                                "gpu_ms_median",
                                                "passes"}));
  EXPECT_TRUE(front["coverage"].is_null()) << "no truth was asked for";
  EXPECT_EQ(front["status"], "GPGP_SUCCESS");
  EXPECT_EQ(front["triangles"], 4);
  EXPECT_EQ(front["visible"], 2);
  EXPECT_EQ(front["listed"], 2);
  EXPECT_EQ(front["width"], 64);
  EXPECT_EQ(front["gpuMilliseconds"]["repeats"], 2);
  EXPECT_FALSE(front["gpuMilliseconds"]["passes"].empty());
  const host::Picture seen = host::readPng(picture.path());
  EXPECT_EQ(seen.width, 128u) << "two views side by side";
  EXPECT_EQ(seen.height, 48u);
  const uint8_t* middle = &seen.rgba[(24 * 128 + 32) * 4];
  EXPECT_GT(middle[0], middle[2] + 60) << "the seen square is orange";

  const json behind =
      gpgpJson({"visibility", model.path(), "--yaw", "180", "--pitch", "0", "--size", "64x48", "--repeat", "100"});
  EXPECT_EQ(behind["visible"], 0) << "back faces are not visible";
  const json twoSided =
      gpgpJson({"visibility", model.path(), "--yaw", "180", "--pitch", "0", "--size", "64x48", "--two-sided"});
  EXPECT_EQ(twoSided["visible"], 4) << "from behind the little square hides no triangle of the large one wholly";
}

TEST(CliVisibility, RealModel) {
  const std::string model = GPGP_TEST_DATA "/fetched/models/2CylinderEngine.glb";
  ASSERT_TRUE(std::filesystem::exists(model)) << "run tests/data/fetch.sh --only models";
  const json seen = gpgpJson({"visibility", model, "--size", "160x120"});
  EXPECT_EQ(seen["triangles"], 121496);
  EXPECT_GT(seen["draws"], 1);
  EXPECT_GT(seen["visible"], 500);
  EXPECT_LT(seen["visible"], 160 * 120);
  EXPECT_LE(seen["visible"], seen["coveredPixels"]);
}

// The first triangle is a tenth of a pixel wide and lies between the pixels' centres.
TEST(CliVisibility, ConservativeFindsWhatLiesBetweenCentres) {
  const TemporaryFile model("sliver.obj", "v -0.01 -0.9 0\nv 0.01 -0.9 0\nv 0 0.9 0\nf 1 2 3\n"
                                          "v -2 -2 -0.01\nv 2 -2 -0.01\nv 0 2 -0.01\nf 4 5 6\n"),
      ids("sliver.ids");
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> args{"visibility", model.path(), "--yaw", "0",         "--pitch",
                                  "0",          "--size",     "32x32", "--validate"};
    args.insert(args.end(), more.begin(), more.end());
    return gpgpJson(args);
  };
  EXPECT_EQ(run({})["visible"], 1);
  const json found = run({"--method", "conservative", "--truth", "16", "--export-ids", ids.path()});
  EXPECT_EQ(found["visible"], 2);
  EXPECT_EQ(found["method"], "conservative");
  for (const char* key : {"triangles", "visible", "truth", "coverage", "overestimation", "coverage_area",
                          "overestimation_area", "gpu_ms_median", "passes"})
    EXPECT_TRUE(found.contains(key)) << key;
  EXPECT_EQ(found["coverage"], 1.0);
  EXPECT_EQ(found["overestimation"], 0.0);
  EXPECT_EQ(host::readText(ids.path()), std::string("\0\0\0\0\1\0\0\0", 8));
  EXPECT_EQ(run({"--method", "conservative", "--epsilon", "0,0"})["visible"], 1) << "a hundredth in front is too far";
  EXPECT_EQ(run({"--method", "conservative", "--epsilon", "0,0", "--heuristics", "in-circle,front"})["visible"], 2);
  EXPECT_EQ(run({"--method", "conservative", "--heuristics", "none", "--resolution", "0.5"})["visible"], 2);
}

TEST(CliVisibility, BadModelsAreNamed) {
  const TemporaryFile badIndex("bad_index.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n");
  EXPECT_NE(gpgpFailure({"visibility", badIndex.path()}).find("bad_index.obj:3:"), std::string::npos);
  const TemporaryFile badNumber("bad_number.obj", "v 0 zero 0\n");
  EXPECT_NE(gpgpFailure({"visibility", badNumber.path()}).find("bad_number.obj:1:"), std::string::npos);
  const TemporaryFile empty("empty.obj", "");
  EXPECT_NE(gpgpFailure({"visibility", empty.path()}).find("no triangle"), std::string::npos);
  const TemporaryFile noGlb("no.glb", "glTF but not really");
  EXPECT_NE(gpgpFailure({"visibility", noGlb.path()}).find("no.glb"), std::string::npos);
  const TemporaryFile unknown("model.xyz", "?");
  EXPECT_NE(gpgpFailure({"visibility", unknown.path()}).find(".glb"), std::string::npos);
}

TEST(CliVisibility, WrongUsage) {
  const TemporaryFile model("usage.obj", kTwoSquares);
  expectWrongUsage({{"visibility"},
                    {"visibility", "no_such_file.obj"},
                    {"visibility", model.path(), "--size", "0x5"},
                    {"visibility", model.path(), "--size", "64"},
                    {"visibility", model.path(), "--size", "-4x4"},
                    {"visibility", model.path(), "--size", "64x64x64"},
                    {"visibility", model.path(), "--pitch", "90"},
                    {"visibility", model.path(), "--epsilon", "1"},
                    {"visibility", model.path(), "--epsilon", "1,-1"},
                    {"visibility", model.path(), "--heuristics", "depth,luck"},
                    {"visibility", model.path(), "--resolution", "0.2"},
                    {"visibility", model.path(), "--refinements", "5"},
                    {"visibility", model.path(), "--repeat", "0"}});
}

} // namespace
} // namespace gpgp::test
