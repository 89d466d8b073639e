// The mini-engine's frame against the stored pictures: what a person sees must stay what it is, on every device.
//
// Tolerance: devices round differently when they rasterise and blend, so edges may move by a sample. At most 1 % of the
// pixels may differ by more than 16/255 in a channel, and the mean difference stays under 0.5/255. A lost roof, a wrong
// colour or a missing HUD is far outside of that. Pictures are made anew by tests/golden/regenerate.sh.
#include "host/picture.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace {
using gpgp::host::Picture;

/// Share of pixels with a channel that differs by more than a limit.
double shareBeyond(const Picture& a, const Picture& b, int limit) {
  size_t beyond = 0;
  for (size_t i = 0; i < a.rgba.size(); i += 4) {
    int largest = 0;
    for (size_t c = 0; c < 4; ++c) largest = std::max(largest, std::abs(int(a.rgba[i + c]) - int(b.rgba[i + c])));
    beyond += largest > limit;
  }
  return static_cast<double>(beyond) / (static_cast<double>(a.rgba.size()) / 4);
}

TEST(Golden, MiniEngine) {
  // The stored pictures show the fetched model and drawing, not the small ones that stand in for them.
  for (const char* needed : {"/fetched/models/2CylinderEngine.glb", "/fetched/svg/tiger.svgz"})
    if (!std::filesystem::exists(std::string(GPGP_TEST_DATA) + needed))
      GTEST_SKIP() << GPGP_TEST_DATA << needed << " is missing: run tests/data/fetch.sh";
  const std::filesystem::path out = GPGP_GOLDEN_OUT;
  std::filesystem::remove_all(out);
  const std::string command = std::string("\"") + GPGP_MINI_ENGINE + "\" --frames 3 --size 640x360 --out \"" +
                              out.string() + "\" --data \"" + GPGP_TEST_DATA + "\"";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  for (const char* name : {"city.png", "side.png"}) {
    const Picture made = gpgp::host::readPng(out / name);
    const Picture stored = gpgp::host::readPng(std::filesystem::path(GPGP_GOLDEN) / name);
    ASSERT_EQ(made.width, stored.width);
    ASSERT_EQ(made.height, stored.height);
    const double mean = gpgp::host::compare(made, stored).mean, share = shareBeyond(made, stored, 16);
    RecordProperty(std::string(name) + " mean", std::to_string(mean));
    std::printf("%s: mean difference %.4f/255, %.4f %% of pixels beyond 16/255\n", name, mean, 100 * share);
    EXPECT_LT(mean, 0.5) << (out / name);
    EXPECT_LT(share, 0.01) << (out / name);
  }
}

/// What the mini-engine prints.
std::string outputOf(const std::string& arguments) {
  std::string text;
  FILE* pipe =
      popen((std::string("\"") + GPGP_MINI_ENGINE + "\" --data \"" + GPGP_TEST_DATA + "\" " + arguments).c_str(), "r");
  if (!pipe) return text;
  char part[256];
  while (std::fgets(part, sizeof part, pipe)) text += part;
  EXPECT_EQ(pclose(pipe), 0) << arguments << ":\n" << text;
  return text;
}

// Section 6.2: shading of every eighth frame, displayed from the poses between.
TEST(DecoupledShading, ExactSamplingLeavesLessWithoutShadingThanStandard) {
  const std::string out = GPGP_GOLDEN_OUT "-path";
  const std::string text = outputOf("--path --frames 8 --rate 8 --size 320x180 --validate --out \"" + out + "\"");
  double missing[2] = {-1, -1};
  const char* const names[2] = {"standard", "exact"};
  for (int i = 0; i < 2; ++i) {
    const size_t at = text.find(std::string("path        ") + names[i]);
    ASSERT_NE(at, std::string::npos) << text;
    ASSERT_EQ(std::sscanf(text.c_str() + text.find("shading ", at), "shading %lf", &missing[i]), 1) << text;
  }
  EXPECT_GT(missing[0], 0.05) << text; // percent: or there was nothing to see
  EXPECT_LT(missing[1], missing[0] * 0.8) << text;
}

// Table 6.1: a row for each configuration, with times.
TEST(DecoupledShading, TheTableHasAllConfigurations) {
  const std::string out = GPGP_GOLDEN_OUT "-table";
  const std::string text = outputOf("--table --frames 2 --rate 2 --size 160x90 --out \"" + out + "\"");
  for (const char* name :
       {"conservative 0.25", "conservative 0.5 ", "conservative 0.75", "conservative 1 ", "exact "}) {
    const size_t at = text.find(std::string("path        ") + name);
    ASSERT_NE(at, std::string::npos) << name << "\n" << text;
    double visibility = 0, shading = 0, display = 0;
    ASSERT_EQ(std::sscanf(text.c_str() + text.find("GPU times", at),
                          "GPU times visibility %lf ms, shading %lf ms, display %lf ms", &visibility, &shading,
                          &display),
              3)
        << text;
    EXPECT_GT(visibility, 0) << name;
    EXPECT_GT(shading, 0) << name;
    EXPECT_GT(display, 0) << name;
  }
}

// Figure 6.2: what standard sampling finds is green, what only the method finds is grey.
TEST(DecoupledShading, FrozenShadingShowsWhatTheMethodAdds) {
  const std::string out = GPGP_GOLDEN_OUT "-overlay";
  const std::string text =
      outputOf("--decoupled --show overlay --freeze 1 --reference 2 --frames 3 --size 320x180 --out \"" + out + "\"");
  EXPECT_NE(text.find("\nreference "), std::string::npos) << text;
  const Picture picture = gpgp::host::readPng(std::filesystem::path(out) / "shaded.png");
  size_t green = 0;
  for (size_t i = 0; i < picture.rgba.size(); i += 4)
    green += picture.rgba[i + 1] > picture.rgba[i] + 90 && picture.rgba[i + 1] > picture.rgba[i + 2] + 90;
  EXPECT_GT(green, 1000u);
}

/// The last display of decoupled shading, and how often it shaded.
std::pair<Picture, unsigned> shown(const std::string& arguments) {
  const std::filesystem::path out = GPGP_GOLDEN_OUT "-decoupled";
  const std::string text = outputOf("--decoupled --validate --out \"" + out.string() + "\" " + arguments);
  EXPECT_NE(text.find("validation  0 messages"), std::string::npos) << text;
  unsigned shadings = 0;
  const size_t at = text.find(" triangles, ");
  EXPECT_TRUE(at != std::string::npos && std::sscanf(text.c_str() + at, " triangles, %u times", &shadings) == 1)
      << text;
  return {gpgp::host::readPng(out / "shaded.png"), shadings};
}

size_t count(const Picture& picture, bool (*isSo)(int, int, int)) {
  size_t n = 0;
  for (size_t i = 0; i < picture.rgba.size(); i += 4)
    n += isSo(picture.rgba[i], picture.rgba[i + 1], picture.rgba[i + 2]);
  return n;
}
bool isGreen(int r, int g, int b) { return g > r + 90 && g > b + 90; }
bool isBlue(int r, int g, int b) { return b > r + 90 && b > g + 90; }
bool isMagenta(int r, int g, int b) { return r > 150 && b > 150 && g < 90; }

TEST(DecoupledShading, TheKeyFreezesAndMovesOn) {
  const std::string run = "--frames 9 --rate 4 --size 320x180 ";
  const auto [always, three] = shown(run);
  EXPECT_EQ(three, 3u) << "frames 0, 4 and 8";
  const auto [frozen, once] = shown(run + "--input f");
  EXPECT_EQ(once, 1u);
  EXPECT_EQ(frozen.rgba, shown(run + "--freeze 1").first.rgba) << "as if it was said before";
  EXPECT_GT(count(frozen, isMagenta), count(always, isMagenta)) << "walked round what was shaded";
  const auto [again, threeAgain] = shown(run + "--input f,f");
  EXPECT_EQ(threeAgain, 3u);
  EXPECT_EQ(again.rgba, always.rgba);
}

// Figure 6.1. Colours go by area: three times as many pixels each way make triangles less red, by half of the scale.
TEST(DecoupledShading, DensityIsByArea) {
  const std::string run = "--frames 2 --show density ";
  const auto isRed = [](int r, int g, int b) { return r > g + 40 && r > b + 40; };
  const Picture small = shown(run + "--size 160x90").first, large = shown(run + "--size 480x270").first;
  const double pixels = 160 * 90;
  const double smallRed = static_cast<double>(count(small, isRed)) / pixels;
  const double largeRed = static_cast<double>(count(large, isRed)) / pixels / 9;
  EXPECT_GT(smallRed, 0.02);
  EXPECT_LT(largeRed, smallRed * 0.75);
  EXPECT_GT(count(large, isBlue), count(small, isBlue) * 9 + 100);
  EXPECT_EQ(large.rgba, shown("--frames 2 --size 480x270 --input 3").first.rgba) << "the key 3 shows the same";
}

// 17 slices are there after 5 frames; the next multiple of the rate is frame 8.
TEST(DecoupledShading, OverlaysWaitForTheirReference) {
  const std::string run = "--method standard --reference 8 --rate 4 --size 320x180 ";
  const auto [known, once] = shown(run + "--show overlay --frames 8");
  EXPECT_EQ(once, 1u);
  EXPECT_GT(count(known, isBlue), 0u) << "what standard sampling missed";
  const auto [next, twice] = shown(run + "--show overlay --frames 9");
  EXPECT_EQ(twice, 2u);
  EXPECT_EQ(count(next, isBlue), 0u) << "of the second shading no reference is known";
  EXPECT_NE(outputOf("--decoupled --show overlay --size 64x64 --out \"" GPGP_GOLDEN_OUT "-short\"")
                .find("reference       12 of 65 slices"),
            std::string::npos);
}

TEST(DecoupledShading, OverlaysOfWhatIsFrozen) {
  for (const char* options : {"--freeze 1 --input 2", "--freeze 0 --input 2", "--input 2,f", "--input f,2"}) {
    const auto [picture, once] = shown(std::string("--reference 2 --frames 4 --size 320x180 ") + options);
    EXPECT_EQ(once, 1u) << options;
    EXPECT_GT(count(picture, isGreen), 1000u) << options;
  }
}

TEST(DecoupledShading, PathsShadeFromTheirFirstFrameOn) {
  const std::string text = outputOf("--path --freeze 0 --frames 2 --size 160x90 --out \"" GPGP_GOLDEN_OUT "-path\"");
  const auto shaded = [&](const char* name) {
    unsigned displays = 0, triangles = 0;
    const size_t at = text.find(std::string("path        ") + name);
    EXPECT_TRUE(at != std::string::npos &&
                std::sscanf(text.c_str() + at + 30, "%u displays, %u", &displays, &triangles) == 2)
        << text;
    return triangles;
  };
  EXPECT_GT(shaded("exact"), shaded("standard"));
}

// What would have no effect.
TEST(DecoupledShading, ItsOptionsBelongToIt) {
  for (const char* options :
       {"--show density", "--method exact", "--rate 2", "--freeze 1", "--reference 4", "--farther 2",
        "--decoupled --reference 4", "--decoupled --input x", "--decoupled --watch", "--path --method conservative",
        "--path --show overlay", "--path --reference 4"})
    EXPECT_NE(
        std::system((std::string("\"") + GPGP_MINI_ENGINE + "\" " + options + " 2> /dev/null > /dev/null").c_str()), 0)
        << options;
}

} // namespace
