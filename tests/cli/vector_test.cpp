// `gpgp vector` on a drawing whose pixels are known.
#include "cli/shared/textures.h"
#include "files.h"
#include "host/picture.h"
#include "run.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

namespace gpgp::test {
namespace {

constexpr const char* kHalves = R"(<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20" viewBox="0 0 40 20">
<path d="M0 0 H20 V20 H0 Z" fill="#ff0000"/>
</svg>
)";

TEST(CliVector, DrawsWhatTheFileSays) {
  const TemporaryFile file("halves.svg", kHalves), picture("halves.png");
  const json drawn =
      gpgpJson({"vector", file.path(), "--out", picture.path(), "--background", "blue", "--repeat", "2", "--validate"});
  EXPECT_EQ(keys(drawn), (std::set<std::string>{"command",
                                                "ok",
                                                "file",
                                                "device",
                                                "status",
                                                "width",
                                                "height",
                                                "method",
                                                "aa",
                                                "samples",
                                                "paths",
                                                "curves",
                                                "patches",
                                                "curves_per_patch",
                                                "tile_entries",
                                                "tile_entries_given",
                                                "tile_words",
                                                "tile_patches",
                                                "tile_words_given",
                                                "patches_per_tile",
                                                "curves_per_patch_tiled",
                                                "paths_dropped",
                                                "warnings",
                                                "messages",
                                                "unsupported",
                                                "parse_ms",
                                                "convert_ms",
                                                "gpu_ms_median",
                                                "passes",
                                                "image"}));
  EXPECT_EQ(drawn["status"], "GPGP_SUCCESS");
  EXPECT_TRUE(drawn["passes"].contains("begin"));
  EXPECT_FALSE(drawn["passes"].contains("mark, projective")) << "what did not run is listed";
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

using Pixel = std::vector<int>;
Pixel pixelOf(const host::Picture& picture, uint32_t x, uint32_t y) {
  const uint8_t* p = &picture.rgba[(size_t{y} * picture.width + x) * 4];
  return {p[0], p[1], p[2], p[3]};
}

TEST(CliVector, BackgroundsAreCssColours) {
  const TemporaryFile file("background.svg", kHalves), picture("background.png");
  const struct {
    const char* text;
    Pixel pixel;
  } cases[] = {
      {"RebeccaPurple", {102, 51, 153, 255}},

      {"#0f88", {0, 255, 136, 136}},
      {"rgba(255, 255, 0, 0.2)", {255, 255, 0, 51}},
      {"hsl(240, 100%, 50%)", {0, 0, 255, 255}},
  };
  for (const auto& c : cases) {
    gpgpJson({"vector", file.path(), picture.path(), "--background", c.text});
    const Pixel seen = pixelOf(host::readPng(picture.path()), 30, 10);
    EXPECT_EQ(seen[3], c.pixel[3]) << c.text;
    for (size_t k = 0; k < 3; ++k) // alpha times colour was rounded to bytes
      EXPECT_NEAR(seen[k], c.pixel[k], c.pixel[3] == 255 ? 0 : 255 / (2 * c.pixel[3]) + 1) << c.text;
  }
}

TEST(CliVector, AntialiasingOfAllKindsAgainstTheReference) {
  // An edge through pixels of column 20 at a quarter of their width; half-transparent colours mix as SVG says.
  const TemporaryFile file("aa.svg", R"(<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20">
<path d="M0 0 H20.25 V20 H0 Z"/><path d="M30 0 H40 V20 H30 Z" opacity="0.5"/></svg>
)");
  const TemporaryFile picture("aa.png");
  for (const char* aa : {"1", "4", "8", "16", "area"}) {
    const json drawn =
        gpgpJson({"vector", file.path(), picture.path(), "--background", "#fff", "--aa", aa, "--reference"});
    EXPECT_EQ(drawn["aa"], aa);
    EXPECT_EQ(drawn["samples"], std::string_view(aa) == "area" ? 16 : std::atoi(aa));
    EXPECT_GE(drawn["psnr_db"], std::string_view(aa) == "1" ? 20 : 45) << aa;
    const host::Picture seen = host::readPng(picture.path());
    EXPECT_NEAR(pixelOf(seen, 20, 5)[0], std::string_view(aa) == "1" ? 255 : 191, 1) << aa;
    EXPECT_NEAR(pixelOf(seen, 35, 5)[0], 128, 1) << "mixed as sRGB encodes";
  }
}

TEST(CliVector, StrokesAreSmoothAtTheSizeAskedFor) {
  const std::string wave = "<path d='M1 12c2-6 4-6 5 0s3 6 5 0 3-6 5 0 3 6 6 0' fill='none' stroke='black' "
                           "stroke-width='.5'/><ellipse cx='12' cy='12' rx='11' ry='2'/></svg>";
  const std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' ";
  const TemporaryFile icon("icon.svg", svg + "width='24' height='24'>" + wave),
      large("large.svg", svg + "width='960' height='960' viewBox='0 0 24 24'>" + wave),
      ink("ink.svg", svg + ">" + wave), picture("icon.png"), other("large.png");
  // The picture is the one of a page of that size, and near a reference of finer strokes.
  const json drawn = gpgpJson({"vector", icon.path(), picture.path(), "--size", "960x960", "--reference"});
  const json whole = gpgpJson({"vector", large.path(), other.path()});
  EXPECT_EQ(drawn["curves"], whole["curves"]);
  EXPECT_GE(drawn["psnr_db"], 45);
  const host::Picture one = host::readPng(picture.path()), two = host::readPng(other.path());
  ASSERT_EQ(one.rgba.size(), two.rgba.size());
  int worst = 0;
  for (size_t i = 0; i < one.rgba.size(); ++i) worst = std::max(worst, std::abs(one.rgba[i] - two.rgba[i]));
  EXPECT_LE(worst, 32); // two samples of 16
  EXPECT_GT(drawn["curves"], gpgpJson({"vector", icon.path()})["curves"]);
  EXPECT_GT(gpgpJson({"vector", ink.path(), "--size", "960x960"})["curves"],
            gpgpJson({"vector", ink.path()})["curves"]);
}

TEST(CliVector, ReadsStandardInput) {
  const TemporaryFile file("input.svg", kHalves), picture("input.png"), same("same.png");
  const ProcessResult result = runProcess(
      {"/bin/sh", "-c", "cat " + file.path() + " | " + GPGP_CLI + " vector - " + picture.path() + " --json"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(json::parse(result.out, nullptr, false)["paths"], 1);
  gpgpJson({"vector", file.path(), same.path()});
  EXPECT_EQ(host::readText(picture.path()), host::readText(same.path()));
}

TEST(CliVector, AFailureNamesWhatItIsAbout) {
  const TemporaryFile page("page.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='1e9' height='1e9'>"
                                       "<rect width='1e9' height='1e9'/></svg>");
  const ProcessResult result = gpgp({"vector", page.path()});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_NE(result.err.find("page.svg:1:1: <svg> is wider or taller than 10000000 pixels"), std::string::npos)
      << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

TEST(CliVector, PathsThatAreLeftOutAreAFailure) {
  const TemporaryFile file("budget.svg", R"(<svg xmlns="http://www.w3.org/2000/svg" width="64" height="64">
<path d="M1 1H60V60H1Z"/><path d="M2 2H60V60H2Z"/></svg>
)");
  const ProcessResult run = gpgp({"vector", file.path(), "--max-tile-entries", "10", "--json"});
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_NE(run.err.find("2 of 2 paths were left out; --max-tile-entries "), std::string::npos) << run.err;
  const json told = json::parse(run.out);
  EXPECT_EQ(told["ok"], false);
  EXPECT_EQ(told["status"], "GPGP_BUDGET_EXCEEDED");
  EXPECT_EQ(told["paths_dropped"], 2);
  EXPECT_GT(told["tile_entries"], 10);
  EXPECT_NE(told["error"].get<std::string>().find("left out"), std::string::npos);
  gpgpJson({"vector", file.path(), "--max-tile-entries", "1000"});
}

/// Lines of a map, each across most of the page: a few tiles in boxes of many.
std::string mapOf(int lines, int size) {
  std::mt19937 random(3);
  std::ostringstream svg;
  svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << size << "' height='" << size << "'>\n";
  for (int i = 0; i < lines; ++i) {
    const int step = size / 64, turn = static_cast<int>(random() % 4) * 2 - 3;
    int x = static_cast<int>(random() % static_cast<uint32_t>(size)), y = 0;
    svg << "<path fill='none' stroke='#" << (100 + random() % 900) << "' d='M" << x << " 0";
    for (; y < size; y += step) {
      x += turn * step / 3 + static_cast<int>(random() % 9) - 4;
      svg << 'L' << x << ' ' << y + step;
    }
    svg << "'/>\n";
  }
  svg << "</svg>\n";
  return svg.str();
}

TEST(CliVector, TheCanvasIsAsLargeAsTheDrawingNeeds) {
  const TemporaryFile file("map.svg", mapOf(600, 2048));
  const json drawn = gpgpJson({"vector", file.path(), "--aa", "4"});
  EXPECT_EQ(drawn["paths"], 600);
  EXPECT_EQ(drawn["paths_dropped"], 0);
  EXPECT_EQ(drawn["status"], "GPGP_SUCCESS");
  EXPECT_GT(drawn["tile_words"], 131072) << "more than a canvas has by default";
  EXPECT_GT(drawn["tile_entries"], 131072) << "more than a canvas has by default";
  EXPECT_GE(drawn["tile_words_given"], drawn["tile_words"]);
  EXPECT_GE(drawn["tile_entries_given"], drawn["tile_entries"]);
  // What was said is kept to.
  const ProcessResult few = gpgp({"vector", file.path(), "--aa", "4", "--max-tile-entries", "131072", "--json"});
  EXPECT_EQ(few.exitCode, 1);
  EXPECT_GT(json::parse(few.out)["paths_dropped"], 0);
}

TEST(CliVector, CountsPatchesByTile) {
  const TemporaryFile file("tiles.svg", R"(<svg xmlns="http://www.w3.org/2000/svg" width="32" height="32">
<path d="M0 0 H16 V16 H0 Z"/></svg>
)");
  const json drawn = gpgpJson({"vector", file.path()}); // one patch of four sides in the first four of 16 tiles
  EXPECT_EQ(drawn["patches"], 1);
  EXPECT_EQ(drawn["curves_per_patch"], 4);
  // 3 x 2 tiles: the right side lies on the border of the third column, which counts as in it
  EXPECT_EQ(drawn["patches_per_tile"], 6 / 16.0);
  EXPECT_EQ(drawn["curves_per_patch_tiled"], (2 + 2 + 3 + 3) / 6.0);
  EXPECT_FALSE(drawn.contains("psnr_db"));
  // A disc has four patches, as its arcs end where they lean by 45 degrees: just below the second row's border, or just
  // above it, where the outer ones reach into the corner tiles and the inner ones into the outer rows.
  for (const auto& [radius, tiles] : {std::pair("11.2", 4 * 2 + 2 * 4), {"11.4", 6 * 4}}) {
    const TemporaryFile disc("disc.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='32' height='32'>"
                                         "<circle cx='16' cy='16' r='" +
                                             std::string(radius) + "'/></svg>");
    const json round = gpgpJson({"vector", disc.path()});
    EXPECT_EQ(round["patches"], 4);
    EXPECT_EQ(round["patches_per_tile"], tiles / 16.0) << radius;
  }
}

TEST(CliVector, FitsAsPreserveAspectRatioSays) {
  const TemporaryFile picture("aspect.png");
  const auto draw = [&picture](const std::string& attributes) {
    const TemporaryFile file("aspect.svg", "<svg xmlns='http://www.w3.org/2000/svg' " + attributes +
                                               "><path d='M0 0 H40 V20 H0 Z' fill='red'/></svg>");
    gpgpJson({"vector", file.path(), picture.path(), "--size", "40x40"});
    const host::Picture seen = host::readPng(picture.path());
    std::string rows;
    for (const uint32_t y : {5u, 20u, 35u}) rows += pixelOf(seen, 20, y)[3] ? 'x' : '.';
    return rows;
  };
  EXPECT_EQ(draw("viewBox='0 0 40 20' preserveAspectRatio='xMidYMax meet'"), ".xx");
  EXPECT_EQ(draw("viewBox='0 0 40 20' preserveAspectRatio='xMidYMid slice'"), "xxx");
  // The picture takes the place of the size that the file asks for.
  EXPECT_EQ(draw("width='10' height='90' viewBox='0 0 40 20' preserveAspectRatio='xMidYMin'"), "x..");
  EXPECT_EQ(draw("width='40' height='20' preserveAspectRatio='none'"), "xxx");
}

TEST(CliVector, FitsIntoASizeAndLeavesTheRestClear) {
  const TemporaryFile file("fit.svg", kHalves), picture("fit.png");
  gpgpJson({"vector", file.path(), "--out", picture.path(), "--size", "40x40"});
  const host::Picture seen = host::readPng(picture.path());
  EXPECT_EQ(seen.rgba[3], 0) << "above the drawing nothing is painted";
  EXPECT_EQ(seen.rgba[(20 * 40 + 5) * 4 + 3], 255) << "the drawing stands in the middle";
}

TEST(CliVector, APageTooLargeIsShrunkAndThatIsSaid) {
  const TemporaryFile file("large.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='1e6' height='1000'>"
                                        "<path d='M0 0 H1e6 V1000 H0 Z'/></svg>");
  EXPECT_EQ(gpgpJson({"vector", file.path()})["width"], 4096);
  EXPECT_NE(gpgp({"vector", file.path()}).out.find("4096 x 5 pixels (shrunk to them; --size makes more), "),
            std::string::npos);
  EXPECT_NE(gpgp({"vector", file.path(), "--size", "8x8"}).out.find("8 x 8 pixels, "), std::string::npos);
}

TEST(CliVector, OneSideIsGivenAndThePageSaysTheOther) {
  const auto sizes = [](const std::string& path, const std::vector<std::string>& options) {
    std::vector<std::string> words{"vector", path};
    words.insert(words.end(), options.begin(), options.end());
    const json drawn = gpgpJson(words);
    return std::array<int, 2>{drawn["width"].get<int>(), drawn["height"].get<int>()};
  };
  using Sides = std::array<int, 2>;
  const std::string inside = " xmlns='http://www.w3.org/2000/svg'><path d='M10 10h40v80h-40z'/></svg>";
  const TemporaryFile page("page.svg", "<svg width='200' height='100'" + inside), ink("bare.svg", "<svg" + inside);
  EXPECT_EQ(sizes(page.path(), {"--width", "300"}), (Sides{300, 150}));
  EXPECT_EQ(sizes(page.path(), {"--height", "25"}), (Sides{50, 25}));
  EXPECT_EQ(sizes(page.path(), {"--width", "33"}), (Sides{33, 17})) << "what does not fill a pixel has one";
  EXPECT_EQ(sizes(page.path(), {"--width", "40", "--height", "40"}), (Sides{40, 40}));
  EXPECT_EQ(sizes(ink.path(), {"--width", "10"}), (Sides{10, 20})) << "the ink is the page";
  const TemporaryFile one("one.png"), two("two.png"), wide("wide.svg", "<svg width='9000' height='1'" + inside);
  gpgpJson({"vector", page.path(), one.path(), "--width", "300"});
  gpgpJson({"vector", page.path(), two.path(), "--size", "300x150"});
  EXPECT_EQ(host::readPng(one.path()).rgba, host::readPng(two.path()).rgba);
  EXPECT_NE(gpgpFailure({"vector", wide.path(), "--height", "2"}).find("more than 16384 pixels wide"),
            std::string::npos);
}

TEST(CliVector, EmbeddedImagesArePainted) {
  // Two pixels, red and blue, in a place of 20 x 20: fitted into its width, in the middle.
  const std::string png = "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAA"
                          "DUlEQVR4nGP4zwAE/wEHAAH/4iOeWQAAAABJRU5ErkJggg==";
  const std::string image = "<image x='10' width='20' height='20' href='data:image/png;base64," + png + "'";
  const TemporaryFile picture("image.png");
  const auto draw = [&picture](const std::string& inside) {
    const TemporaryFile file("image.svg",
                             "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='20'>" + inside + "</svg>");
    EXPECT_EQ(gpgpJson({"vector", file.path(), picture.path()})["unsupported"], json::array());
    return host::readPng(picture.path());
  };
  host::Picture seen = draw(image + "/>");
  EXPECT_EQ(pixelOf(seen, 11, 10), (Pixel{255, 0, 0, 255}));
  EXPECT_EQ(pixelOf(seen, 28, 10), (Pixel{0, 0, 255, 255}));
  EXPECT_EQ(pixelOf(seen, 11, 2)[3], 0) << "above the picture";
  EXPECT_EQ(pixelOf(seen, 5, 10)[3], 0) << "beside its place";
  seen = draw(image + " preserveAspectRatio='xMinYMid slice' opacity='0.5'/>");
  EXPECT_NEAR(pixelOf(seen, 11, 2)[0], 255, 2);
  EXPECT_NEAR(pixelOf(seen, 11, 2)[3], 127.5, 0.5); // half of 255, which devices round either way
  EXPECT_GT(pixelOf(seen, 28, 10)[0], pixelOf(seen, 28, 10)[2]) << "the blue half is cut off";
  EXPECT_EQ(pixelOf(seen, 31, 10)[3], 0) << "beside its place";
  const TemporaryFile webp("webp.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='20'><image x='10' "
                                       "width='20' height='20' href='data:image/webp;base64,UklGRh4AAABXRUJQVlA4TBEAAA"
                                       "AvAQAAAA8Q87//8x8OMqL/AQA='/></svg>");
  if (gpgpJson({"vector", webp.path(), picture.path()})["unsupported"].empty()) { // else built without libwebp
    EXPECT_EQ(pixelOf(host::readPng(picture.path()), 11, 10), (Pixel{255, 0, 0, 255}));
    EXPECT_EQ(pixelOf(host::readPng(picture.path()), 28, 10), (Pixel{0, 0, 255, 255}));
  }
  const TemporaryFile broken("broken.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='20'>\n"
                                           "<image width='9' height='9' href='data:image/png;base64,AAAA'/></svg>");
  const ProcessResult result = gpgp({"vector", broken.path(), "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(json::parse(result.out, nullptr, false)["unsupported"][0]["element"], "image");
}

TEST(CliVector, TextHasTheSystemsFontsWhereNoneAreGiven) {
  const std::string font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  if (!std::ifstream(font)) GTEST_SKIP() << "fonts-dejavu-core is not there";
  const TemporaryFile file("text.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='80' height='30'><text x='5' "
                                       "y='22' font-size='20' font-family='DejaVu Sans'>Text</text></svg>");
  const TemporaryFile systems("system.png"), given("given.png");
  const json drawn = gpgpJson({"vector", file.path(), "--out", systems.path()});
  if (!drawn["unsupported"].empty()) GTEST_SKIP() << "built without fontconfig";
  gpgpJson({"vector", file.path(), "--font", font, "--out", given.path()});
  const host::Picture found = host::readPng(systems.path());
  EXPECT_EQ(found.rgba, host::readPng(given.path()).rgba);
  EXPECT_GT(std::count(found.rgba.begin(), found.rgba.end(), 255), 30) << "it is blank";
}

TEST(CliVector, MarksOfTextTakeNoRoom) {
  const std::string font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  if (!std::ifstream(font)) GTEST_SKIP() << "fonts-dejavu-core is not there";
  const auto drawn = [&](const std::string& word) {
    const TemporaryFile file("mark.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='80' height='50'><text x='70' "
                                         "y='30' font-size='24' text-anchor='end'>" +
                                             word + "</text></svg>"),
        out("mark.png");
    gpgpJson({"vector", file.path(), "--font", font, "--out", out.path()});
    return host::readPng(out.path()).rgba;
  };
  const std::vector<uint8_t> bare = drawn("\u05dc"), marked = drawn("\u05dc\u05b0"); // a lamed; with a point below
  const auto baseline = static_cast<ptrdiff_t>(29 * 80 * 4);
  EXPECT_TRUE(std::equal(bare.begin(), bare.begin() + baseline, marked.begin())) << "the letter has moved";
  EXPECT_NE(bare, marked);
}

TEST(CliVector, ShrunkImagesKeepTheirPlaces) {
  // Black to 7/8 of the width, then white: each texel is white by the part of it that lies there.
  const auto stepped = [](uint32_t width, uint32_t height, bool wide) {
    host::Picture picture{width, height, std::vector<uint8_t>(size_t{width} * height * 4, 255)};
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; ++x)
        if (wide ? 8 * x < 7 * width : 8 * y < 7 * height)
          std::fill_n(picture.rgba.begin() + (size_t{y} * width + x) * 4, 3, uint8_t{0});
    return picture;
  };
  for (const uint32_t length : {3u, 5u, 33u, 65u, 129u, 130u, 1025u})
    for (const bool wide : {true, false}) {
      SCOPED_TRACE(std::to_string(length) + (wide ? " wide" : " tall"));
      const uint32_t pixels = std::max(length / 8, 2u);
      const cli::ShareOfPixel shown{wide ? 1.0 / pixels : 0.01, wide ? 0.01 : 1.0 / pixels};
      const auto [kept, levels] = cli::shrunk(stepped(wide ? length : 2, wide ? 2 : length, wide), shown, shown);
      const uint32_t across = wide ? kept.width : kept.height;
      EXPECT_EQ(levels, 1u);
      EXPECT_LT(across, 1.5 * pixels);
      EXPECT_EQ(wide ? kept.height : kept.width, 2u);
      const double edge = std::ceil(7 * length / 8.0) / length * across; // in texels of what is kept
      for (uint32_t i = 0; i < across; ++i)
        EXPECT_NEAR(kept.rgba[size_t{i} * (wide ? 1 : 2) * 4], 255 * std::clamp(i + 1 - edge, 0.0, 1.0), 1) << i;
    }
}

TEST(CliVector, ImagesShownAtTwoSizesHaveLevels) {
  host::Picture picture{128, 128, std::vector<uint8_t>(size_t{128} * 128 * 4, 255)};
  const auto [kept, levels] = cli::shrunk(picture, {1.0 / 128, 1.0 / 128}, {1.0 / 16, 1.0 / 16});
  EXPECT_EQ(kept.width, 128u);
  EXPECT_EQ(levels, 4u); // 128, 64, 32 and 16
  // Noise of black and white is grey where it is small, however large another copy of it is.
  std::mt19937 random(7);
  for (int i = 0; i < 128 * 128; ++i) {
    const uint8_t value = random() & 1 ? 255 : 0;
    std::fill_n(picture.rgba.begin() + i * 4, 3, value);
  }
  const TemporaryFile png("noise.png"), out("sizes.png");
  host::writePng(png.path(), picture);
  std::ifstream file(png.path(), std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const TemporaryFile svg("sizes.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='160' height='128'>"
                                       "<image id='a' width='128' height='128' href='data:image/png;base64," +
                                           base64(bytes) +
                                           "'/><use href='#a' transform='translate(136 8) scale(0.125)'/></svg>");
  gpgpJson({"vector", svg.path(), out.path()});
  const host::Picture seen = host::readPng(out.path());
  for (uint32_t y = 9; y < 23; ++y)
    for (uint32_t x = 137; x < 151; ++x) EXPECT_NEAR(pixelOf(seen, x, y)[0], 128, 50) << x << ' ' << y;
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
  std::string svg = R"(<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20">)";
  for (int i = 0; i < 30; ++i) svg += "\n<path d=\"M0 0 H20 V20 Z\" vector-effect=\"non-rotation\"/>";
  const TemporaryFile file("warnings.svg", svg + "\n</svg>\n");
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  const ProcessResult some = gpgp({"vector", file.path(), "--json"});
  const ProcessResult all = gpgp({"vector", file.path(), "--json", "--all-warnings"});
  ASSERT_EQ(some.exitCode, 0) << some.err;
  const json counted = json::parse(some.out, nullptr, false);
  ASSERT_TRUE(counted.is_object()) << some.out;
  EXPECT_GE(counted["warnings"], 30);
  EXPECT_EQ(counted["unsupported"].size(), counted["warnings"]);
  EXPECT_EQ(
      counted["unsupported"][0],
      json({{"element", "path"},
            {"line", 2},
            {"column", 1},
            {"text", "vector-effect other than non-scaling-stroke is not supported: <path> is drawn without it"}}));
  EXPECT_EQ(lines(some.err), 11) << some.err;
  EXPECT_EQ(lines(all.err), counted["warnings"]) << all.err;
  EXPECT_EQ(counted["messages"].size(), counted["warnings"]);
  EXPECT_EQ(counted["messages"][0]["severity"], "warning");
}

TEST(CliVector, BadDrawingsAreNamed) {
  const TemporaryFile file("no.svg", "this is no drawing");
  EXPECT_NE(gpgpFailure({"vector", file.path()}).find("no.svg"), std::string::npos);
}

TEST(CliVector, WhatIsNotValidIsNamedAndNotUnsupported) {
  const TemporaryFile file("invalid.svg", R"(<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20">
<path d="M0 0 H20 V20 Z" fill="blurple"/>
<path d="M0 0 H20 V20 X"/></svg>
)");
  const ProcessResult result = gpgp({"vector", file.path(), "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json drawn = json::parse(result.out, nullptr, false);
  EXPECT_EQ(drawn["unsupported"], json::array());
  EXPECT_EQ(drawn["warnings"], 2);
  EXPECT_NE(result.err.find("invalid.svg:2:1: warning: <path> has fill 'blurple'"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("invalid.svg:3:23: error: <path> has an error in its path data"), std::string::npos)
      << result.err;
}

TEST(CliVector, StagesThatCannotBeWrittenAreAnError) {
  const TemporaryFile file("blocked.svg", kHalves);
  EXPECT_NE(gpgpFailure({"vector", file.path(), "--stages", file.path()}).find("blocked.svg"), std::string::npos);
}

TEST(CliVector, WrongUsage) {
  const TemporaryFile file("usage.svg", kHalves);
  expectWrongUsage({{"vector"},
                    {"vector", "no_such_file.svg"},
                    {"vector", file.path(), "--out", "out.jpg"},
                    {"vector", file.path(), "--out", "png"},
                    {"vector", file.path(), "--aa", "3"},
                    {"vector", file.path(), "--aa", "exact"},
                    {"vector", file.path(), "--background", "ffffff"},
                    {"vector", file.path(), "--background", "reddish"},
                    {"vector", file.path(), "--background", "rgb(1, 2)"},
                    {"vector", file.path(), "--repeat", "0"},
                    {"vector", file.path(), "--size", "0x40"},
                    {"vector", file.path(), "--width", "0"},
                    {"vector", file.path(), "--height", "16385"},
                    {"vector", file.path(), "--size", "9x9", "--width", "9"},
                    {"vector", file.path(), "--size", "big"}});
}

} // namespace
} // namespace gpgp::test
