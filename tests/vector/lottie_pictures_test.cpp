// Animations of one feature each (tests/data/lottie, which make.py there writes), drawn on a canvas at several frames:
// beside rlottie, and by properties where that draws something else or nothing.
#include "canvas_fixture.h"
#include "host/files.h"
#include "lottie_file.h"
#include "tile_difference.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#ifdef GPGP_TEST_RLOTTIE
#include <rlottie.h>
#endif

namespace {
using namespace gpgp;
using namespace gpgp::test;
namespace fs = std::filesystem;

constexpr uint32_t kSize = 100;

/// Premultiplied, as sRGB encodes it, 0 to 255.
using Pixels = std::vector<std::array<double, 4>>;

std::string textOf(const std::string& name) {
  return host::readText(fs::path(GPGP_TEST_DATA) / "lottie" / (name + ".json"));
}
std::vector<std::string> allNames() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(GPGP_TEST_DATA) / "lottie"))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

struct LottiePictures : CanvasTest {
  void SetUp() override {
    CanvasTest::SetUp();
    blendSrgb = encodeSrgb = true;
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
    info.maxWidth = info.maxHeight = kSize;
    info.maxPaths = 4096;
    info.targets = canvasTargets;
    info.maxLayerPixels = 1 << 21;
    canvas = recorder(gpgpCreateCanvas, info, nullptr);
  }
  Pixels draw(LottieFile& file, double frame) {
    const GpgpLottieFrame now = file.at(frame);
    Pixels pixels(size_t(kSize) * kSize);
    if (now.pathCount == 0) return pixels;
    const GpgpAsset drawing =
        makeDrawing({now.paths, now.paths + now.pathCount}, {now.groups, now.groups + now.groupCount});
    GpgpCanvasReport report{};
    const std::vector<Rgba> drawn = raster({place(drawing)}, kSize, kSize, 16, &report);
    EXPECT_EQ(report.pathsDropped, 0u) << "layers need " << report.layerPixels;
    gpgpDestroyAsset(drawing);
    for (size_t i = 0; i < drawn.size(); ++i)
      pixels[i] = {255.0 * static_cast<double>(drawn[i].r), 255.0 * static_cast<double>(drawn[i].g),
                   255.0 * static_cast<double>(drawn[i].b), 255.0 * static_cast<double>(drawn[i].a)};
    return pixels;
  }
  Pixels draw(const std::string& json, double frame) {
    const std::string text = json;
    LottieFile file(text);
    EXPECT_EQ(file.result, GPGP_SUCCESS);
    return draw(file, frame);
  }
};

TileDifference worst(const Pixels& a, const Pixels& b) {
  return worstTile(kSize, kSize, [&](uint32_t x, uint32_t y) {
    double most = 0;
    for (size_t c = 0; c < 4; ++c) most = std::max(most, std::fabs(a[y * kSize + x][c] - b[y * kSize + x][c]));
    return most;
  });
}

/// A solid of 100 x 100 with something about it.
std::string solidLayer(const std::string& color, const std::string& more = "") {
  return R"({"ty":1,"sw":100,"sh":100,"sc":")" + color + R"(","ip":0,"op":60,"st":0,"ks":{},)" + more + R"("nm":""})";
}
std::string starLayer(const std::string& more) {
  return R"({"ty":4,"ip":0,"op":60,"st":0,"ks":{},)" + more +
         R"("shapes":[{"ty":"sr","sy":1,"pt":{"k":5},"p":{"k":[50,50]},"r":{"k":9},"or":{"k":45},"ir":{"k":20}},
{"ty":"fl","c":{"k":[0.9,0.6,0.2]},"o":{"k":70}}]})";
}
std::string maskOf(const std::string& mode, const std::string& vertices, const std::string& more = "") {
  return R"({"mode":")" + mode + R"(",)" + more + R"("pt":{"k":{"v":)" + vertices + R"(,"c":true}}})";
}
std::string masks(const std::string& list) { return R"("masksProperties":[)" + list + "],"; }
const std::string kBox = "[[20,20],[70,20],[70,80],[20,80]]", kKite = "[[50,5],[90,50],[50,95],[35,50]]";

/// Of two pictures what they are together, or of one a part.
Pixels sum(const Pixels& a, const Pixels& b) {
  Pixels result = a;
  for (size_t i = 0; i < a.size(); ++i)
    for (size_t c = 0; c < 4; ++c) result[i][c] += b[i][c];
  return result;
}
Pixels times(const Pixels& a, double factor) {
  Pixels result = a;
  for (auto& pixel : result)
    for (double& c : pixel) c *= factor;
  return result;
}
/// Where two pictures differ most, by pixel.
double furthest(const Pixels& a, const Pixels& b) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i)
    for (size_t c = 0; c < 4; ++c) most = std::max(most, std::fabs(a[i][c] - b[i][c]));
  return most;
}

TEST_F(LottiePictures, MattesAndTheirInversesAreTheWhole) {
  const Pixels whole = draw(animation(solidLayer("#4080c0")), 0);
  EXPECT_NEAR(whole[5050][2], 192, 1);
  for (const int matte : {1, 3}) {
    const auto matted = [&](int kind) {
      return draw(
          animation(starLayer(R"("td":1,)") + "," + solidLayer("#4080c0", R"("tt":)" + std::to_string(kind) + ",")), 0);
    };
    const Pixels shown = matted(matte), hidden = matted(matte + 1);
    EXPECT_LT(furthest(sum(shown, hidden), whole), 2) << matte;
    EXPECT_LT(shown[0][3], 1) << "a corner";
    // The star is 70 % of a colour; luminance as Rec. 709 has it, of what sRGB encodes.
    const double part = matte == 1 ? 0.7 : 0.7 * (0.2126 * 0.9 + 0.7152 * 0.6 + 0.0722 * 0.2);
    EXPECT_NEAR(shown[5050][3], 255 * part, 2) << matte;
  }
  // A matte that is not there hides all, or nothing.
  EXPECT_LT(furthest(draw(animation(starLayer(R"("td":1,"hd":true,)") + "," + solidLayer("#4080c0", R"("tt":2,)")), 0),
                     whole),
            1);
  EXPECT_LT(furthest(draw(animation(starLayer(R"("td":1,"hd":true,)") + "," + solidLayer("#4080c0", R"("tt":1,)")), 0),
                     times(whole, 0)),
            1);
}

TEST_F(LottiePictures, MasksAddUp) {
  const auto masked = [&](const std::string& list) { return draw(animation(solidLayer("#4080c0", masks(list))), 0); };
  // Edges are covered by sixteenths, which fall on one side or the other.
  const auto expectEqual = [](const Pixels& got, const Pixels& want, const char* what) {
    EXPECT_LT(worst(got, want).mean, 3) << what;
    EXPECT_LT(furthest(got, want), 17) << what;
  };
  const Pixels whole = draw(animation(solidLayer("#4080c0")), 0), none = times(whole, 0);
  const std::string a = maskOf("a", kBox), b = maskOf("a", kKite), minus = maskOf("s", kKite),
                    both = maskOf("i", kKite);
  const Pixels box = masked(a), kite = masked(b);
  EXPECT_GT(furthest(box, kite), 200);
  expectEqual(sum(kite, masked(minus)), whole, "what is subtracted, and the rest");
  EXPECT_LT(furthest(masked(maskOf("a", kKite, R"("inv":true,)")), masked(minus)), 2) << "inverted is subtracted";
  expectEqual(sum(masked(a + "," + minus), masked(a + "," + both)), box, "without it, and with it");
  expectEqual(sum(masked(a + "," + b), masked(a + "," + both)), sum(box, kite), "either, and both");
  EXPECT_LT(furthest(masked(both), kite), 1) << "what is first intersects with all";
  EXPECT_LT(furthest(masked(minus + "," + b), whole), 66)
      << "taken away and added again: an edge's pixel lacks up to a quarter";
  EXPECT_LT(furthest(masked(maskOf("a", kKite, R"("o":{"k":40},)")), times(kite, 0.4)), 2);
  expectEqual(masked(maskOf("s", kKite, R"("o":{"k":40},)")), sum(whole, times(kite, -0.4)), "a part is subtracted");
  EXPECT_LT(furthest(masked(maskOf("a", "[]")), none), 1);
  EXPECT_LT(furthest(masked(maskOf("n", kBox)), whole), 1) << "none is none";
}

/// A straight edge that is blurred is the error function.
TEST_F(LottiePictures, BlurredEdgesAreTheErrorFunction) {
  const auto edge = [&](const Pixels& pixels, double sigma, const char* what) {
    for (uint32_t x = 30; x < 70; ++x) {
      const double want = 0.5 * std::erfc((x + 0.5 - 50) / (sigma * std::sqrt(2.0)));
      EXPECT_NEAR(pixels[50 * kSize + x][3], 255 * want, 3) << what << " at " << x;
    }
  };
  const std::string half = "[[-200,-200],[50,-200],[50,300],[-200,300]]";
  edge(draw(animation(solidLayer("#ffffff", masks(maskOf("a", half, R"("f":{"k":[20,20]},)")))), 0), 6, "feather");
  edge(
      draw(
          animation(
              R"({"ty":1,"sw":250,"sh":500,"sc":"#ffffff","ip":0,"op":60,"ks":{"p":{"k":[-200,-200]}},"ef":[{"ty":29,"ef":[{"v":{"k":20}},{"v":{"k":1}},{"v":{"k":0}}]}]})"),
          0),
      6, "blur");
}

TEST_F(LottiePictures, EffectsAndBlendModesAreTheirFormulas) {
  const auto middle = [&](const std::string& layers) { return draw(animation(layers), 0)[5050]; };
  const auto near = [](const std::array<double, 4>& got, std::array<double, 3> want, const char* what) {
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 2) << what << ", channel " << c;
  };
  const std::string back = solidLayer("#80c040");
  near(middle(solidLayer("#4080c0", R"("bm":1,)") + "," + back),
       {64 * 128 / 255.0, 128 * 192 / 255.0, 192 * 64 / 255.0}, "multiply");
  near(middle(solidLayer("#4080c0", R"("bm":2,)") + "," + back),
       {192 - 64 * 128 / 255.0, 320 - 128 * 192 / 255.0, 256 - 192 * 64 / 255.0}, "screen");
  near(middle(solidLayer("#4080c0", R"("bm":10,)") + "," + back), {64, 64, 128}, "difference");
  near(middle(solidLayer("#4080c0", R"("bm":16,)") + "," + back), {192, 255, 255}, "add");
  near(middle(solidLayer("#4080c0", R"("ef":[{"ty":21,"ef":[{},{},{"v":{"k":[1,0.5,0]}},{},{},{},{"v":{"k":1}}]}],)")),
       {255, 127.5, 0}, "fill");
  const double grey = (0.2126 * 64 + 0.7152 * 128 + 0.0722 * 192) / 255;
  near(middle(solidLayer("#4080c0",
                         R"("ef":[{"ty":20,"ef":[{"v":{"k":[0.2,0,0]}},{"v":{"k":[1,1,0]}},{"v":{"k":100}}]}],)")),
       {255 * (0.2 + 0.8 * grey), 255 * grey, 0}, "tint");
  // A shadow to the right, 20 far and sharp, of a box that ends at 50.
  const Pixels shadow = draw(
      animation(
          R"({"ty":1,"sw":50,"sh":100,"sc":"#ffffff","ip":0,"op":60,"ks":{},"ef":[{"ty":25,"ef":[{"v":{"k":[1,0,0]}},{"v":{"k":127.5}},{"v":{"k":90}},{"v":{"k":20}},{"v":{"k":0}}]}]})"),
      0);
  near(shadow[50 * kSize + 40], {255, 255, 255}, "what casts it");
  near(shadow[50 * kSize + 60], {127.5, 0, 0}, "shadow");
  EXPECT_NEAR(shadow[50 * kSize + 60][3], 127.5, 2);
  EXPECT_LT(shadow[50 * kSize + 75][3], 1);
}

TEST_F(LottiePictures, LayersFadeAsOne) {
  const std::string inner = R"("assets":[{"id":"a","layers":[)" + solidLayer("#ff0000", masks(maskOf("a", kBox))) +
                            "," + solidLayer("#00ff00", masks(maskOf("a", kKite))) + "]}],";
  const auto precomp = [&](const std::string& opacity) {
    return draw(
        animation(R"({"ty":0,"refId":"a","w":100,"h":100,"ip":0,"op":60,"ks":{"o":{"k":)" + opacity + "}}}", inner), 0);
  };
  EXPECT_LT(furthest(precomp("50"), times(precomp("100"), 0.5)), 2);
}

TEST_F(LottiePictures, CompositionsAreCutToTheirSize) {
  const std::string inner = R"("assets":[{"id":"a","layers":[)" + solidLayer("#ff0000") + "]}],";
  const Pixels cut =
      draw(animation(R"({"ty":0,"refId":"a","w":40,"h":30,"ip":0,"op":60,"ks":{"p":{"k":[10,20]}}})", inner), 0);
  const Pixels box =
      draw(animation(R"({"ty":1,"sw":40,"sh":30,"sc":"#ff0000","ip":0,"op":60,"ks":{"p":{"k":[10,20]}}})"), 0);
  EXPECT_LT(furthest(cut, box), 1);
}

/// What another player draws of an animation at a frame; empty: nothing that can be compared.
using Player = std::function<Pixels(uint32_t frame)>;
struct Difference {
  const char *name, *reason;
};
/// All animations beside a player; those that are listed must differ. `allowed`: of 255, the largest channel's
/// difference, on average over a tile of 8 x 8.
void compare(LottiePictures& test, double allowed, std::span<const Difference> differing,
             const std::function<Player(const std::string& name, const std::string& text)>& load) {
  const bool prints = std::getenv("GPGP_LOTTIE_PRINT") != nullptr;
  size_t compared = 0;
  for (const std::string& name : allNames()) {
    const std::string text = textOf(name);
    LottieFile file(text);
    ASSERT_EQ(file.result, GPGP_SUCCESS) << name;
    const Player player = load(name, text);
    TileDifference most;
    uint32_t at = 0;
    for (const uint32_t frame : {0u, 12u, 30u, 45u, 58u}) {
      const Pixels theirs = player(frame);
      if (theirs.empty()) continue;
      const Pixels ours = test.draw(file, frame);
      const TileDifference tile = worst(ours, theirs);
      if (tile.mean > most.mean) most = tile, at = frame;
      ++compared;
    }
    if (prints) std::printf("%-24s %6.2f at frame %u, %s\n", name.c_str(), most.mean, at, most.where().c_str());
    const auto listed = std::find_if(differing.begin(), differing.end(),
                                     [&](const Difference& difference) { return name == difference.name; });
    if (listed == differing.end())
      EXPECT_LE(most.mean, allowed) << name << " at frame " << at << ", " << most.where();
    else
      EXPECT_GT(most.mean, allowed) << name << " is listed as differing: " << listed->reason;
  }
  EXPECT_GE(compared, 250u);
}

#ifdef GPGP_TEST_RLOTTIE
constexpr const char *kNone = "rlottie 0.1 does not draw it",
                     *kLengths = "rlottie measures lengths by short lines, and is off by a pixel or two",
                     *kWhole = "rlottie rounds frames of compositions";
constexpr Difference kRlottie[] = {
    {"blend", kNone},
    {"dashes", kLengths},
    {"easing-dimensions", "rlottie takes the first dimension's easing for all"},
    {"effects", kNone},
    {"groups", "rlottie strokes do not become uneven with their group"},
    {"mask-expansion", kNone},
    {"mask-feather", kNone},
    {"mask-inverted", kNone},
    {"mask-opacity", kNone},
    {"matte-alpha", kNone},
    {"matte-alpha-inverted", kNone},
    {"matte-luma", kNone},
    {"matte-luma-inverted", kNone},
    {"merge-exclude", kNone},
    {"modifiers", kNone},
    {"polygon", "rlottie turns stars and polygons twice"},
    {"repeater-above", "rlottie has the last copy on top whatever the file says"},
    {"repeater-fades", "rlottie never reaches the last copy's opacity"},
    {"round-corners", kNone},
    {"skew", kNone},
    {"spatial", "rlottie does not turn what has not moved yet"},
    {"star", "rlottie turns stars and polygons twice"},
    {"stretch", kWhole},
    {"text-glyphs", kNone},
    {"time-remap", kWhole},
    {"trim", kLengths},
    {"trim-sequential", kLengths},
};

TEST_F(LottiePictures, LookAsRlottieDrawsThem) {
  compare(*this, 8, kRlottie, [](const std::string& name, const std::string& text) -> Player {
    const std::shared_ptr<rlottie::Animation> animation = rlottie::Animation::loadFromData(text, name, "", false);
    EXPECT_TRUE(animation) << name;
    return [animation](uint32_t frame) {
      std::vector<uint32_t> argb(size_t(kSize) * kSize);
      animation->renderSync(frame, rlottie::Surface(argb.data(), kSize, kSize, kSize * 4));
      Pixels pixels;
      for (const uint32_t p : argb)
        pixels.push_back({double(p >> 16 & 255), double(p >> 8 & 255), double(p & 255), double(p >> 24)});
      return pixels;
    };
  });
}
#endif

constexpr const char* kNotThere = "lottie-web 5.12 (svg) does not draw it";
constexpr Difference kLottieWeb[] = {
    {"blend", "lottie-web has no mode of adding"},
    {"dashes", kNotThere},
    {"effects", "lottie-web cuts blurs and shadows, and its tint takes the mean of channels"},
    {"mask-expansion", "lottie-web dilates pixels"},
    {"mask-feather", kNotThere},
    {"mask-inverted", "lottie-web inverts only masks that run the other way round"},
    {"matte-luma-inverted", kNotThere},
    {"merge-exclude", kNotThere},
    {"polygon", kNotThere},
    {"text-glyphs", "lottie-web does not scale glyphs here"},
};

/// Pictures that lottie_web.mjs beside this file made in Chromium; skipped where there are none.
TEST_F(LottiePictures, LookAsLottieWebDrawsThem) {
  const char* folder = std::getenv("GPGP_LOTTIE_WEB");
  if (!folder) GTEST_SKIP() << "GPGP_LOTTIE_WEB names no folder of pictures (tests/vector/lottie_web.mjs makes them)";
  compare(*this, 12, kLottieWeb, [folder](const std::string& name, const std::string&) -> Player {
    return [folder, name](uint32_t frame) {
      const host::Picture picture = host::readPng(fs::path(folder) / (name + "_" + std::to_string(frame) + ".png"));
      EXPECT_EQ(picture.width, kSize) << name;
      Pixels pixels;
      for (size_t i = 0; i < picture.rgba.size(); i += 4) {
        const double a = picture.rgba[i + 3] / 255.0;
        pixels.push_back({a * picture.rgba[i], a * picture.rgba[i + 1], a * picture.rgba[i + 2], 255 * a});
      }
      return pixels;
    };
  });
}

} // namespace
