// `gpgp visibility` on models whose visible triangles are known.
#include "cli/shared/median.h"
#include "files.h"
#include "host/files.h"
#include "host/picture.h"
#include "run.h"

#include <map>

namespace gpgp::test {
namespace {

using Args = std::vector<std::string>;

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
                                                "viewPoints",
                                                "behindWalls",
                                                "referenceDevice",
                                                "reference",
                                                "coverage",
                                                "overestimation",
                                                "coverage_area",
                                                "overestimation_area",
                                                "neededCandidates",
                                                "neededPairs",
                                                "unresolved",
                                                "skippedTriangles",
                                                "skippedDraws",
                                                "omitted",
                                                "notes",
                                                "gpu_ms_median",
                                                "passes"}));
  EXPECT_TRUE(front["coverage"].is_null()) << "no reference was asked for";
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
  const json found = run({"--method", "conservative", "--reference", "16", "--export-ids", ids.path()});
  EXPECT_EQ(found["visible"], 2);
  EXPECT_EQ(found["method"], "conservative");
  for (const char* key : {"triangles", "visible", "reference", "coverage", "overestimation", "coverage_area",
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
  const TemporaryFile goesOn("goes_on.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\n2 \\\n4\n");
  EXPECT_NE(gpgpFailure({"visibility", goesOn.path()}).find("goes_on.obj:4:"), std::string::npos);
  const TemporaryFile far("far.obj", "v 1e30 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_NE(gpgpFailure({"visibility", far.path()}).find("positions reach 1e+30"), std::string::npos);
  const TemporaryFile tooFar("too_far.obj", "v 2e30 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_NE(gpgpFailure({"visibility", tooFar.path()}).find("no triangle has finite corners"), std::string::npos);
}

/// A glTF of one mesh: a triangle, and where asked for lines, too.
std::string gltf(const std::string& nodes, bool lines = false) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
         R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}})" +
         (lines ? R"(,{"attributes":{"POSITION":0},"mode":3})" : "") +
         R"(]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
         R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":)"
         R"("data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]})";
}

TEST(CliVisibility, NodesAreATree) {
  const TemporaryFile tree("tree.gltf", gltf(R"({"children":[1,2]},{"mesh":0},{"mesh":0,"translation":[3,0,0]})"));
  EXPECT_EQ(gpgpJson({"visibility", tree.path(), "--yaw", "0", "--size", "32x32"})["visible"], 2);
  // With two ways to each of forty nodes, one after the other, there would be 2^40 triangles.
  std::string nodes;
  for (int i = 1; i <= 40; ++i)
    nodes += R"({"name":"joint","children":[)" + std::to_string(i) + "," + std::to_string(i) + "]},";
  const TemporaryFile doubled("doubled.gltf", gltf(nodes + R"({"mesh":0})"));
  const std::string failure = gpgpFailure({"visibility", doubled.path()});
  EXPECT_NE(failure.find("node 40 has two parents"), std::string::npos) << failure;
  const TemporaryFile cycle("cycle.gltf", gltf(R"({"name":"root","mesh":0,"children":[0]})"));
  EXPECT_NE(gpgpFailure({"visibility", cycle.path()}).find("node 0 (root)"), std::string::npos);
  const TemporaryFile none("none.gltf", gltf(R"({"children":[7]})"));
  EXPECT_NE(gpgpFailure({"visibility", none.path()}).find("no node 7"), std::string::npos);
}

TEST(CliVisibility, WhatIsSkippedIsSaid) {
  const TemporaryFile lines("lines.gltf", gltf(R"({"mesh":0})", true));
  const json seen = gpgpJson({"visibility", lines.path(), "--yaw", "0", "--size", "32x32"});
  EXPECT_EQ(seen["visible"], 1);
  EXPECT_EQ(seen["omitted"], 1);
  EXPECT_EQ(seen["skippedTriangles"], 0);
  EXPECT_NE(gpgp({"visibility", lines.path(), "--size", "32x32"}).out.find("1 primitives are not triangles"),
            std::string::npos);
  // Reaches 2^100; the camera sees the other one.
  const TemporaryFile far("one_far.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 0 2e30 0\nf 1 2 3\nf 1 2 4\n");
  const json one = gpgpJson({"visibility", far.path(), "--yaw", "0", "--size", "32x32"});
  EXPECT_EQ(one["visible"], 1);
  EXPECT_EQ(one["skippedTriangles"], 1);
  EXPECT_EQ(one["skippedDraws"], 0);
  EXPECT_NE(gpgp({"visibility", far.path(), "--size", "32x32"}).out.find("1 triangles skipped"), std::string::npos);
}

TEST(CliVisibility, NamesAndLinesOfModels) {
  const TemporaryFile upper("UPPER.OBJ", "v -1 -1 0\r\nv 1 -1 0\r\nv 0 \\\r\n1 0\r\nf 1 \\\r\n  2 3 # all\r\n");
  EXPECT_EQ(gpgpJson({"visibility", upper.path(), "--yaw", "0", "--size", "32x32"})["visible"], 1);
  const TemporaryFile noBinary("UPPER.GLB", "glTF but not really");
  EXPECT_NE(gpgpFailure({"visibility", noBinary.path()}).find("UPPER.GLB"), std::string::npos);
}

// The reference's only sample, the pixel's centre, does not see the triangle.
TEST(CliVisibility, SharesOfNothingAreNone) {
  const TemporaryFile model("corner.obj", "v -0.9 -0.9 0.5\nv -0.8 -0.9 0.5\nv -0.9 -0.8 0.5\nf 1 2 3\n"),
      camera("corner.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  const std::vector<std::string> args{"visibility", model.path(), "--camera",    camera.path(), "--size", "1x1",
                                      "--method",   "exact",      "--two-sided", "--reference", "1",      "--recheck"};
  const auto with = [&](const std::string& recheck) {
    std::vector<std::string> all = args;
    all.push_back(recheck);
    return all;
  };
  const json none = gpgpJson(with("0"));
  EXPECT_EQ(none["visible"], 1);
  EXPECT_EQ(none["reference"], 0);
  for (const char* key : {"coverage", "overestimation", "coverage_area", "overestimation_area"})
    EXPECT_TRUE(none[key].is_null()) << key;
  EXPECT_NE(gpgp(with("0")).out.find("coverage -, overestimation -"), std::string::npos);
  const json rechecked = gpgpJson(with("64"));
  EXPECT_EQ(rechecked["coverage"], 1.0);
  EXPECT_EQ(rechecked["overestimation"], 0.0);
  EXPECT_TRUE(rechecked["coverage_area"].is_null()) << "no sample of the reference shows anything";

  // From behind there is nothing to see, which does not count.
  const TemporaryFile sliver("one_side.obj", "v -0.01 -0.9 0\nv 0.01 -0.9 0\nv 0 0.9 0\nf 1 2 3\n"
                                             "v -2 -2 -0.01\nv 2 -2 -0.01\nv 0 2 -0.01\nf 4 5 6\n");
  const auto orbit = [&](const std::string& cameras) {
    return gpgpJson(
        {"visibility", sliver.path(), "--size", "32x32", "--reference", "64", "--recheck", "0", "--orbit", cameras});
  };
  const json one = orbit("1"), two = orbit("2");
  EXPECT_LT(one["coverage"], 1.0);
  EXPECT_EQ(two["coverage"], one["coverage"]);
  EXPECT_EQ(two["coverage_area"], one["coverage_area"]);
}

TEST(CliVisibility, MediansAreInTheMiddle) {
  EXPECT_EQ(cli::medianOf({}), 0.0);
  EXPECT_EQ(cli::medianOf({5, 1, 3}), 3.0);
  EXPECT_EQ(cli::medianOf({7, 1}), 4.0);
  EXPECT_EQ(cli::medianOf({4, 1, 9, 2}), 3.0);
}

TEST(CliVisibility, ExactNeedsNoNumberOfSamples) {
  const TemporaryFile model("needless.obj", kTwoSquares);
  const ProcessResult with =
      gpgp({"visibility", model.path(), "--method", "exact", "--samples", "8", "--size", "64x64"});
  EXPECT_EQ(with.exitCode, 0) << with.err;
  EXPECT_NE(with.err.find("note: --samples changes nothing here"), std::string::npos) << with.err;
  EXPECT_EQ(withoutProgress(gpgp({"visibility", model.path(), "--method", "exact", "--size", "64x64"}).err), "");
}

TEST(CliVisibility, PassesOfOneNameAddUp) {
  const TemporaryFile model("passes.obj", kTwoSquares);
  const json seen =
      gpgpJson({"visibility", model.path(), "--method", "conservative", "--refinements", "2", "--size", "64x64"});
  std::map<std::string, double> sums;
  for (const json& pass : seen["gpuMilliseconds"]["passes"])
    sums[pass["name"].get<std::string>()] += pass["milliseconds"].get<double>();
  EXPECT_LT(sums.size(), seen["gpuMilliseconds"]["passes"].size()) << "a refinement's passes are there twice";
  ASSERT_EQ(seen["passes"].size(), sums.size());
  EXPECT_TRUE(sums.contains("gather") && !sums.contains("resolve") && !sums.contains("expand commands"))
      << "what did not run is listed";
  for (const auto& [name, sum] : sums) EXPECT_DOUBLE_EQ(seen["passes"].value(name, -1.0), sum) << name;
}

TEST(CliVisibility, SamplesAreNotPixels) {
  const TemporaryFile model("samples.obj", kTwoSquares);
  const Args args{"visibility", model.path(), "--size", "64x48"};
  EXPECT_NE(gpgp(args).out.find(" of 3072 pixels covered"), std::string::npos);
  const Args eight{"visibility", model.path(), "--size", "64x48", "--samples", "8"};
  EXPECT_NE(gpgp(eight).out.find(" of 196608 samples covered"), std::string::npos);
  EXPECT_NEAR(gpgpJson(eight)["coveredPixels"].get<double>() / 64, gpgpJson(args)["coveredPixels"].get<double>(), 150);
}

TEST(CliVisibility, WrongUsage) {
  const TemporaryFile model("usage.obj", kTwoSquares), camera("usage.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  // What would have no effect.
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--method", "exact", "--epsilon", "1,1"},
                                             {"--method", "exact", "--heuristics", "depth"},
                                             {"--method", "exact", "--resolution", "0.5"},
                                             {"--refinements", "2"},
                                             {"--method", "conservative", "--samples", "4"},
                                             {"--method", "cell"},
                                             {"--motion", "1,2"},
                                             {"--motion", "1,-2,3"},
                                             {"--eyes", "0.06"},
                                             {"--walk", "1,2,30"}, // of exact sampling
                                             {"--method", "exact", "--walk", "1,2"},
                                             {"--method", "exact", "--walk", "1,2,2"},
                                             {"--method", "exact", "--walk", "1,2,30,0.5"},
                                             {"--method", "exact", "--walk", "1,2,30", "--motion", "1,2,3"},
                                             {"--distance", "3"},
                                             {"--orbit", "2", "--yaw", "10"},
                                             {"--orbit", "2", "--pitch", "10"},
                                             {"--camera", camera.path(), "--yaw", "10"},
                                             {"--camera", camera.path(), "--pitch", "10"},
                                             {"--camera", camera.path(), "--orbit", "2"},
                                             {"--recheck", "64"},
                                             {"--reference", "64", "--recheck", "64"}}) {
    std::vector<std::string> arguments{"visibility", model.path()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expectWrongUsage({arguments});
  }
  expectWrongUsage({{"visibility"},
                    {"visibility", "no_such_file.obj"},
                    {"visibility", model.path(), "--size", "0x5"},
                    {"visibility", model.path(), "--size", "64"},
                    {"visibility", model.path(), "--size", "-4x4"},
                    {"visibility", model.path(), "--size", "64x64x64"},
                    {"visibility", model.path(), "--pitch", "90"},
                    {"visibility", model.path(), "--pitch", "nan"},
                    {"visibility", model.path(), "--yaw", "nan"},
                    {"visibility", model.path(), "--yaw", "inf"},
                    {"visibility", model.path(), "--epsilon", "1"},
                    {"visibility", model.path(), "--epsilon", "1,-1"},
                    {"visibility", model.path(), "--method", "conservative", "--heuristics", "depth,luck"},
                    {"visibility", model.path(), "--method", "conservative", "--heuristics", ""},
                    {"visibility", model.path(), "--method", "conservative", "--heuristics", "depth,none"},
                    {"visibility", model.path(), "--method", "conservative", "--heuristics", "depth,"},
                    {"visibility", model.path(), "--resolution", "0.2"},
                    {"visibility", model.path(), "--refinements", "5"},
                    {"visibility", model.path(), "--repeat", "0"}});
}

} // namespace
} // namespace gpgp::test
