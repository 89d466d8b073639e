// `gpgp visibility` against the reference by rays; view points behind walls; what long work says of itself.
#include "cli/shared/progress.h"
#include "cli/visibility/forecast.h"
#include "files.h"
#include "run.h"

#include <cstdio>
#include <sstream>

namespace gpgp::test {
namespace {

using Args = std::vector<std::string>;

/// A wall of two rows of rectangles, the upper ones a third as wide, and 60 x 60 hidden squares behind it. The camera
/// is one from which snapping to 1/256 pixel opens a crack along the rows' common edge.
struct ClosedWall {
  static std::string text() {
    std::ostringstream obj;
    obj.precision(17);
    uint32_t vertices = 0;
    const auto rectangle = [&](float x0, float y0, float x1, float y1, float z) {
      obj << "v " << x0 << ' ' << y0 << ' ' << z << "\nv " << x1 << ' ' << y0 << ' ' << z << "\nv " << x1 << ' ' << y1
          << ' ' << z << "\nv " << x0 << ' ' << y1 << ' ' << z << "\nf " << vertices + 1 << ' ' << vertices + 2 << ' '
          << vertices + 3 << ' ' << vertices + 4 << '\n';
      vertices += 4;
    };
    rectangle(-2, -2, 2, 0, 0);
    for (int i = 0; i < 3; ++i)
      rectangle(-2 + 4 * static_cast<float>(i) / 3, 0, -2 + 4 * static_cast<float>(i + 1) / 3, 2, 0);
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 60; ++x)
        rectangle(-2 + 4 * static_cast<float>(x) / 60, -2 + 4 * static_cast<float>(y) / 60,
                  -2 + 4 * static_cast<float>(x + 1) / 60, -2 + 4 * static_cast<float>(y + 1) / 60, -1);
    return obj.str();
  }
  TemporaryFile model{"closed_wall.obj", text()};
  TemporaryFile camera{"closed_wall.cam",
                       "1.1957035064697266 0.027956970036029816 -0.13165083527565002 -0.13151918351650238 0.0 "
                       "-2.1340487003326416 -0.09873813390731812 -0.09863939136266708 -0.15942713618278503 "
                       "0.20967727899551392 -0.9873812794685364 -0.986393928527832 0.0 1.190440485801487e-16 "
                       "2.9443256855010986 3.041381359100342"};
};

TEST(CliVisibilityReference, RaysSeeNoCrackInAClosedWall) {
  const ClosedWall wall;
  const Args args{
      "visibility", wall.model.path(),    "--camera", wall.camera.path(), "--size", "320x180", "--reference",
      "64",         "--reference-device", "cpu",      "--recheck",        "0"};
  const json seen = gpgpJson(args);
  EXPECT_EQ(seen["triangles"], 7208);
  EXPECT_EQ(seen["reference"], 8);
  EXPECT_EQ(seen["referenceDevice"], "cpu");
  EXPECT_EQ(seen["coverage"], 1.0);
}

TEST(CliVisibilityReference, RaysAndTheDeviceAgreeOnWhatIsEasy) {
  const TemporaryFile model("easy.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -3 -0.5 -1\nv 3 -0.5 -1\nv 0 3 -1\n"
                                        "f 1 2 3 4\nf 5 6 7\nf 1 2 3\n");
  for (const char* more : {"--yaw", "--cell", "--orbit"}) {
    const auto graded = [&](const char* device) {
      return gpgpJson({"visibility", model.path(), "--size", "48x36", "--reference", "16", "--reference-device", device,
                       more, std::string(more) == "--cell" ? "0.5:4" : "3"});
    };
    const json cpu = graded("cpu"), gpu = graded("gpu");
    EXPECT_EQ(gpu["referenceDevice"], "gpu");
    EXPECT_EQ(cpu["reference"], gpu["reference"]) << more;
    EXPECT_EQ(cpu["coverage"], gpu["coverage"]) << more;
    EXPECT_EQ(cpu["overestimation"], gpu["overestimation"]) << more;
    EXPECT_NEAR(cpu["coverage_area"].get<double>(), gpu["coverage_area"].get<double>(), 0.01) << more;
  }
  expectWrongUsage({{"visibility", model.path(), "--reference-device", "cpu"},
                    {"visibility", model.path(), "--reference", "4", "--reference-device", "embree"},
                    {"visibility", model.path(), "--through-walls"}});
}

// Two rooms with a wall between them: the middle of the cell is in one, three of its points behind it.
TEST(CliVisibilityReference, ViewPointsBehindAWallAreLeftOut) {
  const std::string folder = GPGP_TEST_DATA "/cases/visibility/";
  const Args args{"visibility", folder + "rooms.obj", "--camera", folder + "rooms2.cam", "--size", "160x90"};
  const auto run = [&](const Args& more) {
    Args all = args;
    all.insert(all.end(), more.begin(), more.end());
    return gpgpJson(all);
  };
  const json alone = run({"--method", "exact"}), cell = run({"--method", "cell", "--cell", "0.2:9"}),
             through = run({"--method", "cell", "--cell", "0.2:9", "--through-walls"});
  EXPECT_EQ(alone["viewPoints"], 1);
  EXPECT_EQ(alone["behindWalls"], 0);
  EXPECT_EQ(cell["viewPoints"], 9);
  EXPECT_GT(cell["behindWalls"], 0);
  EXPECT_LT(cell["behindWalls"], 9);
  EXPECT_EQ(through["behindWalls"], 0);
  EXPECT_EQ(cell["visible"], alone["visible"]) << "nothing of the next room";
  EXPECT_GE(through["visible"].get<int>(), cell["visible"].get<int>() + 8);
  const ProcessResult text = gpgp({"visibility", folder + "rooms.obj", "--camera", folder + "rooms2.cam", "--size",
                                   "160x90", "--method", "cell", "--cell", "0.2:9"});
  EXPECT_NE(text.out.find("view points left out"), std::string::npos) << text.out;
}

/// What is written until the work has taken `time` milliseconds.
std::string progressOf(bool terminal, uint64_t total, uint64_t done, int time) {
  std::FILE* file = std::tmpfile();
  {
    using std::chrono::milliseconds;
    cli::Progress progress("work", total, {file, terminal, milliseconds(40), milliseconds(40)});
    for (uint64_t i = 0; i < done; ++i) progress.advance();
    std::this_thread::sleep_for(milliseconds(time));
  }
  std::string text;
  std::rewind(file);
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
  std::fclose(file);
  return text;
}

TEST(CliProgress, LongWorkIsNotSilent) {
  EXPECT_EQ(progressOf(false, 4, 2, 0), "") << "short work is";
  const std::string lines = progressOf(false, 4, 2, 400);
  EXPECT_EQ(lines.rfind("work: 2 of 4, 1 s so far\n", 0), 0u) << lines;
  EXPECT_GE(std::count(lines.begin(), lines.end(), '\n'), 2) << lines;
  EXPECT_EQ(lines.find('\r'), std::string::npos) << "for a log";
  EXPECT_EQ(progressOf(false, 0, 0, 200).rfind("work: 1 s so far\n", 0), 0u);
  const std::string bar = progressOf(true, 4, 2, 200);
  EXPECT_NE(bar.find("work [###############...............] 2 of 4"), std::string::npos) << bar;
  EXPECT_EQ(bar.find('\n'), std::string::npos);
  EXPECT_TRUE(bar.ends_with("\r\033[K")) << "the bar goes away";
  EXPECT_NE(progressOf(false, 10, 9, 2300).find("about 1 s left"), std::string::npos);
}

TEST(CliProgress, DurationsAreInWords) {
  EXPECT_EQ(cli::durationText(0.2), "1 s");
  EXPECT_EQ(cli::durationText(99), "99 s");
  EXPECT_EQ(cli::durationText(110), "2 minutes");
  EXPECT_EQ(cli::durationText(3600 * 26), "26 hours");
}

TEST(CliProgress, WhatTakesLongIsSaidBeforehand) {
  EXPECT_EQ(cli::forecast(50, 64, false), "");
  const std::string reference = cli::forecast(100, 64, false), again = cli::forecast(900, 256, true);
  EXPECT_NE(reference.find("reference of 64 x 64 samples takes about 2 minutes"), std::string::npos) << reference;
  EXPECT_EQ(reference.find("--recheck"), std::string::npos) << reference;
  EXPECT_NE(again.find("256 x 256 takes about 15 minutes; --recheck 0"), std::string::npos) << again;
  EXPECT_EQ(withoutProgress(reference + again + "an error\n"), "an error\n");
}

} // namespace
} // namespace gpgp::test
