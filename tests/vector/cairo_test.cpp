// Pictures beside cairo's: gradients of all circles, fills and groups of real drawings.
#include "cairo_fixture.h"
#include "cli/vector/reference.h"
#include "fetched_svg.h"

namespace {
using namespace gpgp;
using namespace gpgp::test;

/// A pair of circles: start, its radius; end, its radius.
struct Circles {
  float x0, y0, r0, x1, y1, r1;
};
constexpr Circles kCircles[] = {
    {20, 20, 0, 32, 32, 24},  // the end holds the start
    {40, 32, 4, 32, 32, 24},  //
    {32, 32, 24, 40, 32, 4},  // the start holds the end
    {32, 32, 20, 32, 32, 5},  // around one point
    {32, 32, 20, 32, 32, 13}, //
    {10, 32, 8, 54, 32, 8},   // side by side, of one size
    {14, 20, 10, 45, 40, 10}, // overlapping, of one size
    {12, 30, 3, 50, 40, 10},  // cones, growing
    {50, 40, 10, 12, 30, 3},  // and shrinking
    {12, 50, 0, 50, 20, 12},  // from a point
    {50, 20, 12, 12, 50, 0},  // to a point
    {12, 32, 0, 32, 32, 20},  // touching from inside
    {32, 32, 20, 12, 32, 0},  //
    {20, 32, 8, 32, 32, 20},  //
    {20, 20, 9, 20, 20, 9},   // equal: nothing
    {10, 20, 0, 40, 30, 0},   // points: nothing
    {-90, 32, 2, 150, 40, 6}, // far away
    {32, 32, 0.01f, 60, 9, 0.02f},
};

TEST_F(CairoTest, GradientsBetweenAnyTwoCircles) {
  makeCanvas(64);
  TestPath square;
  square.move(-64, -64).line(128, -64).line(128, 128).line(-64, 128).close();
  const GpgpGradientStop stops[] = {{0, {1, 0, 0, 1}}, {0.4f, {0, 1, 0, 0.5f}}, {1, {0, 0, 1, 1}}};
  GpgpGradient gradient{};
  gradient.kind = GPGP_GRADIENT_RADIAL;
  gradient.stops = stops;
  gradient.stopCount = 3;
  gradient.interpolateSrgb = VK_TRUE;
  const float transforms[][6] = {{1, 0, 0, 1, 0, 0}, {0.9f, 0.5f, -0.3f, 0.7f, 8, -4}, {-0.6f, 0, 0.2f, 1.3f, 60, -9}};
  std::mt19937 random(5);
  std::uniform_real_distribution<float> at(-10, 74), radius(0, 30);
  std::vector<Circles> all(std::begin(kCircles), std::end(kCircles));
  for (int i = 0; i < 20; ++i)
    all.push_back({at(random), at(random), radius(random), at(random), at(random), radius(random)});
  for (const Circles& c : all)
    for (int i = 0; i < 3; ++i) {
      gradient.start[0] = c.x0, gradient.start[1] = c.y0, gradient.startRadius = c.r0;
      gradient.end[0] = c.x1, gradient.end[1] = c.y1, gradient.endRadius = c.r1;
      gradient.spread = i;
      std::copy_n(transforms[(&c - all.data()) % 3], 6, gradient.transform);
      GpgpPath view = square.view();
      view.gradient = &gradient;
      const GpgpAsset drawing = makeDrawing({view});
      const auto pixels = raster({place(drawing)}, 64, 64, 4);
      gpgpDestroyAsset(drawing);
      const std::string where = "circles " + std::to_string(&c - all.data()) + ", spread " + std::to_string(i);
      // Where a hundredth of a pixel decides, either is right.
      size_t wrong = 0, doubtful = 0;
      const bool nothing = c.r0 == c.r1 && (c.r0 == 0 || (c.x0 == c.x1 && c.y0 == c.y1));
      for (size_t k = 0; k < pixels.size(); ++k) {
        const double x = static_cast<double>(k % 64) + 0.5, y = static_cast<double>(k / 64) + 0.5;
        const auto colorAt = [&](double px, double py) {
          if (nothing) return Rgba{};
          const auto t = cli::referenceOfGradient(gradient, px, py);
          const auto mixed = [&t](size_t n) {
            return host::srgbFromLinear(static_cast<float>(t[n])) * static_cast<float>(t[3]);
          };
          return Rgba{mixed(0), mixed(1), mixed(2), static_cast<float>(t[3])};
        };
        const Rgba reference = colorAt(x, y);
        bool sure = true;
        for (const double d : {-0.01, 0.01})
          sure = sure && differenceOf(reference, colorAt(x + d, y)) < 0.02f &&
                 differenceOf(reference, colorAt(x, y + d)) < 0.02f;
        doubtful += !sure;
        wrong += sure && differenceOf(reference, pixels[k]) > 0.02f;
      }
      EXPECT_EQ(wrong, 0u) << where;
      EXPECT_LT(doubtful, pixels.size() / 4) << where;
      const auto theirs = cairoPicture({&view, 1}, {}, 1, 64);
      const Difference d = compare(pixels, theirs, 64);
      EXPECT_LE(d.mean, 0.01) << where;
      EXPECT_LE(d.far, 0.02) << where;
    }
}

// Fills, gradients, clips and groups, composited: what is far off are pixels in which cairo mixes what path after path
// covers of a pixel as if each lay elsewhere in it.
struct DrawingBesideCairo : CairoTest, testing::WithParamInterface<const char*> {};

TEST_P(DrawingBesideCairo, LooksTheSame) {
  const auto svg = fetchedSvg(GetParam());
  if (!svg) GTEST_SKIP() << GetParam() << " is not there";
  const vector::svg::ImportedViews views(*svg);
  constexpr uint32_t kSize = 512; // a multiple of what a word of tiles holds
  const float scale = std::min(float(kSize) / float(svg->width), float(kSize) / float(svg->height));
  makeCanvas(kSize, 0, 1u << 18);
  const GpgpAsset drawing = makeDrawing(views.paths, views.groups);
  const auto theirs = cairoPicture(views.paths, views.groups, static_cast<double>(scale), kSize);
  for (const bool area : {false, true}) {
    exactArea = area;
    const Difference d = compare(raster({place(drawing, scale)}, kSize, kSize, 16), theirs, kSize);
    std::printf("%s%s: %.5f off on average, %.3f %% of pixels by more than 16/255, %.3f in %s\n", GetParam(),
                area ? ", areas" : "", d.mean, 100 * d.far, d.worst.mean, d.worst.where().c_str());
    EXPECT_LE(d.mean, 1.0 / 255);
    EXPECT_LE(d.far, 0.02);
    EXPECT_LE(d.worst.mean, 0.1) << d.worst.where();
  }
}
INSTANTIATE_TEST_SUITE_P(Svg, DrawingBesideCairo,
                         testing::Values("svg/hud.svg", "svg/clips.svg", "svg/crest.svg", "fetched/svg/tiger.svgz",
                                         "fetched/svg/car.svgz", "fetched/svg/gallardo.svgz"));

} // namespace
