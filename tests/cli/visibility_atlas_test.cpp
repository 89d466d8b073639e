// `gpgp visibility --atlas`: the report, and shading through the atlas beside direct shading.
#include "files.h"
#include "host/picture.h"
#include "run.h"

#include <cmath>
#include <sstream>

namespace gpgp::test {
namespace {

/// A sphere of quads, whose triangles are pairs but at the poles.
std::string sphere(int rows, int columns) {
  std::ostringstream text;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double up = 3.14159265 * r / rows, around = 2 * 3.14159265 * c / columns;
      text << "v " << std::sin(up) * std::sin(around) << ' ' << std::cos(up) << ' ' << std::sin(up) * std::cos(around)
           << '\n';
    }
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const int next = (c + 1) % columns;
      text << "f " << r * columns + c + 1 << ' ' << (r + 1) * columns + c + 1 << ' ' << (r + 1) * columns + next + 1
           << ' ' << r * columns + next + 1 << '\n';
    }
  return text.str();
}

TEST(CliVisibilityAtlas, ShowsTheSameFromTheAtlas) {
  const TemporaryFile model("sphere.obj", sphere(24, 48)), atlas("atlas.png"), display("display.png");
  const json all =
      gpgpJson({"visibility", model.path(), "--size", "320x240", "--method", "exact", "--atlas", "512", "--texels", "2",
                "--out", atlas.path(), "--display", display.path(), "--repeat", "2", "--validate"});
  const json& found = all["atlas"];
  EXPECT_EQ(found["status"], "GPGP_SUCCESS");
  EXPECT_EQ(found["visibleTriangles"], all["visible"]);
  EXPECT_LT(found["blocks"].get<int>(), all["visible"].get<int>() * 6 / 10); // nearly all are pairs
  int blocks = 0;
  for (const json& count : found["blocksByClass"]) blocks += count.get<int>();
  EXPECT_EQ(blocks, found["blocks"]);
  EXPECT_EQ(found["holes"], 0);
  EXPECT_GT(found["shownPixels"].get<int>(), 320 * 240 / 6);
  EXPECT_GT(found["psnr"].get<double>(), 35);
  const json& changing = found["changing"];
  EXPECT_EQ(changing["new"].get<int>() + changing["gone"].get<int>() > 0, true);
  EXPECT_EQ(changing["changed"], 0);
  EXPECT_EQ(host::readPng(atlas.path()).width, 512u);
  EXPECT_EQ(host::readPng(display.path()).width, 640u);
}

TEST(CliVisibilityAtlas, SaysWhatFindsNoRoom) {
  const TemporaryFile model("sphere.obj", sphere(24, 48));
  const ProcessResult result =
      gpgp({"visibility", model.path(), "--size", "320x240", "--atlas", "128", "--texels", "64"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.out.find("blocks have fewer texels than asked for"), std::string::npos) << result.out;
  expectWrongUsage({{"visibility", model.path(), "--atlas", "100"},
                    {"visibility", model.path(), "--atlas", "16384"},
                    {"visibility", model.path(), "--atlas", "x"},
                    {"visibility", model.path(), "--out", "a.png"},
                    {"visibility", model.path(), "--atlas", "128", "--texels", "0"},
                    {"visibility", model.path(), "--atlas", "128", "--out", "a.jpg"}});
}

} // namespace
} // namespace gpgp::test
