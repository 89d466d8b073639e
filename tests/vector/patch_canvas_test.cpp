// Canvases that draw by patches: samples and areas against winding numbers, pictures against flattened canvases.
#include "canvas_fixture.h"
#include "fetched_svg.h"
#include "tile_difference.h"

#include <cstdlib>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct PatchCanvasTest : CanvasTest {
  PatchCanvasTest() { drawingMethods = GPGP_DRAWING_FLATTENED | GPGP_DRAWING_PATCHES; }
  /// Canvases of both methods, each made once a test.
  std::map<GpgpCanvasMethod, GpgpRecorder> canvases;
  std::vector<Rgba> rasterBy(GpgpCanvasMethod method, const std::vector<GpgpCanvasItem>& items, uint32_t width,
                             uint32_t height, uint32_t samples) {
    if (!canvases[method]) {
      canvasMethod = method;
      makeCanvas(256);
      canvases[method] = canvas;
    }
    canvas = canvases[method];
    return raster(items, width, height, samples);
  }
  std::vector<Rgba> byPatches(const std::vector<GpgpCanvasItem>& items, uint32_t size, uint32_t samples) {
    return rasterBy(GPGP_CANVAS_PATCHES, items, size, size, samples);
  }
  std::vector<Rgba> flattened(const std::vector<GpgpCanvasItem>& items, uint32_t size, uint32_t samples) {
    return rasterBy(GPGP_CANVAS_FLATTENED, items, size, size, samples);
  }
};

/// The share of 16 x 16 points of each pixel that lie in a path; pixels: zoom * drawing + shift.
std::vector<double> shares(const PathOracle& oracle, bool evenOdd, double zoom, double x, double y, uint32_t size) {
  std::vector<double> share(size_t(size) * size, 0.0);
  for (uint32_t row = 0; row < size * 16; ++row) {
    int winding = 0;
    double from = 0;
    for (const auto& c : oracle.crossings(((row + 0.5) / 16 - y) / zoom)) {
      const auto inside = [&](int w) { return evenOdd ? (w & 1) != 0 : w != 0; };
      const bool before = inside(winding);
      winding += c.direction;
      const double at = c.x * zoom + x;
      if (!before && inside(winding)) from = at;
      if (!before || inside(winding)) continue;
      const int first = static_cast<int>(std::ceil(std::max(from, 0.0) * 16 - 0.5)),
                last = static_cast<int>(std::ceil(std::min(at, double(size)) * 16 - 0.5));
      for (int column = first; column < last; ++column)
        share[row / 16 * size + static_cast<uint32_t>(column) / 16] += 1.0 / 256;
    }
  }
  return share;
}
double decibels(double squares, size_t count) { return -10 * std::log10(std::max(squares / double(count), 1e-12)); }
double squaresOf(const std::vector<Rgba>& pixels, const std::vector<double>& wanted) {
  double squares = 0;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const double off = static_cast<double>(pixels[i].a) - wanted[i];
    squares += off * off;
  }
  return squares;
}

/// Single paths: by area 50 dB or better and no tile off by more than a hundredth; by samples each is what the winding
/// number says, but for those within a thousandth of a pixel of an edge; no worse than flattened.
TEST_F(PatchCanvasTest, SamplesAndAreasAreThePathsAtAnyZoom) {
  constexpr uint32_t kSize = 96;
  for (const uint32_t seed : {2u, 4u}) {
    TestPath path = randomShape(seed, 90);
    path.color = {1, 1, 1, 1};
    const GpgpPath view = path.view();
    const GpgpAsset drawing = makeDrawing({view});
    const PathOracle oracle(view);
    const auto row = oracle.crossings(45);
    for (const float zoom : {1.0f, 16.0f, 256.0f, 4096.0f}) {
      const std::string what = "seed " + std::to_string(seed) + ", zoom " + std::to_string(zoom);
      const float x = zoom > 1 && !row.empty() ? kSize / 2 - zoom * static_cast<float>(row[0].x) : 3;
      const float y = zoom > 1 ? kSize / 2 - zoom * 45 : 3;
      const GpgpCanvasItem item = place(drawing, zoom, x, y);
      const bool evenOdd = view.fillRule == GPGP_FILL_EVEN_ODD;
      const auto wanted =
          shares(oracle, evenOdd, static_cast<double>(zoom), static_cast<double>(x), static_cast<double>(y), kSize);
      exactArea = true;
      const auto area = byPatches({item}, kSize, 16);
      exactArea = false;
      EXPECT_GE(decibels(squaresOf(area, wanted), area.size()), 50) << what;
      size_t seams = 0, wrong = 0;
      for (size_t i = 0; i < area.size(); ++i) seams += wanted[i] == 1 && area[i].a != 1;
      EXPECT_EQ(seams, 0u) << what;
      const TileDifference worst = worstTile(kSize, kSize, [&](uint32_t px, uint32_t py) {
        return std::abs(static_cast<double>(area[py * kSize + px].a) - wanted[py * kSize + px]);
      });
      EXPECT_LT(worst.mean, 0.01) << worst.where() << ", " << what;
      for (const uint32_t samples : {1u, 16u}) {
        const auto found = byPatches({item}, kSize, samples);
        for (uint32_t i = 0; i < kSize * kSize; ++i) {
          uint32_t least = 0, most = 0;
          const double n = samples, z = static_cast<double>(zoom);
          for (uint32_t r = 0; r < samples; ++r) {
            const double px = i % kSize + (shader::sampleColumn(r, samples) + 0.5) / n, py = i / kSize + (r + 0.5) / n;
            const double dx = (px - static_cast<double>(x)) / z, dy = (py - static_cast<double>(y)) / z;
            // Floats place the drawing's points themselves no nearer than their last digit.
            const double near = 1e-3 / z + 2e-5;
            const bool inside = oracle.inside(dx, dy), certain = oracle.certain(dx, dy, near);
            least += inside && certain;
            most += inside || !certain;
          }
          const double count = std::round(static_cast<double>(found[i].a) * n);
          wrong += count < least || count > most;
        }
        EXPECT_EQ(wrong, 0u) << what << ", samples " << samples;
      }
      const auto sixteen = byPatches({item}, kSize, 16), lines = flattened({item}, kSize, 16);
      if (zoom > 256) continue; // where float transforms are off by hundredths of a pixel
      EXPECT_GE(decibels(squaresOf(sixteen, wanted), kSize * kSize),
                decibels(squaresOf(lines, wanted), kSize * kSize) - 0.25)
          << what;
    }
  }
}

/// A circle has its own area, and so has one of two pixels.
TEST_F(PatchCanvasTest, CirclesHaveTheirArea) {
  constexpr double kPi = 3.14159265358979323846;
  exactArea = true;
  for (const float radius : {1.0f, 2.0f, 5.0f, 20.0f}) {
    TestPath circle;
    const float c = 24.3f;
    circle.move(c - radius, c)
        .add(GPGP_PATH_ARC, {radius, radius, 0, GPGP_ARC_SWEEP, c + radius, c})
        .add(GPGP_PATH_ARC, {radius, radius, 0, GPGP_ARC_SWEEP, c - radius, c})
        .close();
    double sum = 0;
    for (const Rgba& p : byPatches({place(makeDrawing({circle.view()}))}, 48, 16)) sum += static_cast<double>(p.a);
    const double r = static_cast<double>(radius);
    EXPECT_NEAR(sum / (kPi * r * r), 1, 0.02 / (r * r)) << radius;
  }
}

/// Turned, mirrored, in perspective, and with the eye in the page's plane: as flattened.
TEST_F(PatchCanvasTest, MapsAreThoseOfFlattenedCanvases) {
  constexpr uint32_t kSize = 128;
  TestPath path = randomShape(9, 90), other = randomShape(12, 90);
  other.color = {0.2f, 0.5f, 0.9f, 1};
  const GpgpAsset drawing = makeDrawing({path.view(), other.view()});
  const auto mapped = [&](std::array<float, 6> transform, std::array<float, 3> perspective = {}) {
    GpgpCanvasItem item = place(drawing);
    std::copy_n(transform.data(), 6, item.transform);
    std::copy_n(perspective.data(), 3, item.perspective);
    return item;
  };
  GpgpCanvasItem cut = mapped({0.8f, 0.6f, -0.6f, 0.8f, 50, -5});
  std::copy_n(std::array{20.3f, 10.6f, 90.5f, 99.0f}.data(), 4, cut.scissor);
  const GpgpCanvasItem items[] = {mapped({0.8f, 0.6f, -0.6f, 0.8f, 50, -5}), mapped({-1, 0.2f, 0, 1.3f, 110, 0}),
                                  mapped({0.8f, 0, -0.9f, 0.3f, 20, 5}, {0.002f, -0.016f, 0.96f}),
                                  mapped({0.8f, 0, -0.9f, 0.3f, 20, 5}, {0.002f, 0.004f, 0.96f}), cut};
  for (size_t n = 0; n < std::size(items); ++n)
    for (const bool area : {false, true}) {
      if (area && n < 3) continue;
      exactArea = area;
      const auto wanted = flattened({items[n]}, kSize, 16), drawn = byPatches({items[n]}, kSize, 16);
      double ink = 0;
      for (const Rgba& p : drawn) ink += static_cast<double>(p.a);
      EXPECT_GT(ink, 200) << "map " << n;
      if (const char* folder = std::getenv("GPGP_PATCH_PICTURES")) { // to be looked at
        std::vector<uint8_t> bytes;
        for (const Rgba& p : drawn)
          for (const float v : {p.r, p.g, p.b, 1.0f}) bytes.push_back(static_cast<uint8_t>(std::lround(255 * v)));
        host::writePng(std::string(folder) + "/map" + std::to_string(n) + ".png",
                       host::fromPremultiplied(kSize, kSize, bytes));
      }
      const TileDifference worst = worstTile(kSize, kSize, [&](uint32_t x, uint32_t y) {
        const Rgba &a = drawn[y * kSize + x], &b = wanted[y * kSize + x];
        return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b), std::abs(a.a - b.a)});
      });
      EXPECT_LT(worst.mean, 0.02) << worst.where() << ", map " << n << (area ? ", areas" : "");
    }
}

/// Paths that share an edge leave nothing between them.
TEST_F(PatchCanvasTest, NothingShowsBetweenPaths) {
  TestPath left, right;
  left.move(0, 0).line(40, 0).cubic(10, 30, 70, 50, 37, 90).line(0, 90).close();
  right.move(90, 0).line(40, 0).cubic(10, 30, 70, 50, 37, 90).line(90, 90).close();
  const GpgpAsset drawing = makeDrawing({left.view(), right.view()});
  for (const uint32_t samples : {1u, 4u, 8u, 16u})
    for (const float zoom : {1.0f, 17.3f, 300.0f}) {
      const float shift = 45 - 45 * zoom;
      for (const Rgba& p : byPatches({place(drawing, zoom, shift, shift)}, 90, samples)) ASSERT_EQ(p.a, 1.0f) << zoom;
    }
}

TEST_F(PatchCanvasTest, TheTigerIsTheFlattenedOne) {
  const auto svg = fetchedSvg("fetched/svg/tiger.svgz");
  if (!svg) GTEST_SKIP() << "the tiger is not there";
  constexpr uint32_t kSize = 256;
  const vector::svg::ImportedViews views(*svg);
  const float scale = float(kSize) / float(std::max(svg->width, svg->height));
  const GpgpAsset drawing = makeDrawing(views.paths, views.groups);
  for (const uint32_t samples : {1u, 16u}) {
    const auto wanted = flattened({place(drawing, scale)}, kSize, samples);
    const auto drawn = byPatches({place(drawing, scale)}, kSize, samples);
    double squares = 0;
    for (size_t i = 0; i < drawn.size(); ++i) {
      const double off = static_cast<double>(drawn[i].g - wanted[i].g);
      squares += off * off;
    }
    EXPECT_GT(decibels(squares, drawn.size()), samples == 1 ? 25 : 38) << samples;
    const TileDifference worst = worstTile(kSize, kSize, [&](uint32_t x, uint32_t y) {
      return std::abs(drawn[y * kSize + x].g - wanted[y * kSize + x].g);
    });
    EXPECT_LT(worst.mean, samples == 1 ? 0.1 : 0.02) << worst.where() << ", samples " << samples;
  }
}

/// A budget that is short leaves out what patches draw and all above it, and the report says what suffices.
TEST_F(PatchCanvasTest, ReportsWhatPatchesNeed) {
  TestPath below = randomShape(4, 90), above = randomShape(5, 90);
  drawingMethods = GPGP_DRAWING_FLATTENED;
  const GpgpAsset lines = makeDrawing({below.view()});
  drawingMethods |= GPGP_DRAWING_PATCHES;
  const std::vector<GpgpCanvasItem> items = {place(lines), place(makeDrawing({above.view()}))};
  const auto whole = byPatches(items, 96, 16);
  const auto only = byPatches({items[0]}, 96, 16);
  GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
  info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
  info.maxWidth = info.maxHeight = 256;
  info.targets = canvasTargets;
  info.method = GPGP_CANVAS_PATCHES;
  info.maxTilePatches = 1;
  canvas = recorder(gpgpCreateCanvas, info);
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  const auto same = [](const std::vector<Rgba>& a, const std::vector<Rgba>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
  };
  EXPECT_TRUE(same(raster(items, 96, 96, 16, &report), only));
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(report.pathsDropped, 1u);
  EXPECT_EQ(report.tilePatchesGiven, 1u);
  ASSERT_GT(report.tilePatches, 1u);
  info.maxTilePatches = report.tilePatches;
  canvas = recorder(gpgpCreateCanvas, info);
  EXPECT_TRUE(same(raster(items, 96, 96, 16, &report), whole));
  EXPECT_EQ(report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(report.pathsDropped, 0u);
}

TEST_F(PatchCanvasTest, NamesWhatIsWrong) {
  GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
  info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
  info.method = 7;
  GpgpRecorder none = nullptr;
  EXPECT_EQ(gpgpCreateCanvas(context, &info, &none), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("method is 7"), std::string::npos) << lastMessage();
  const TestPath path = randomShape(1, 90);
  const GpgpPath view = path.view();
  GpgpDrawingCreateInfo drawing = GPGP_DRAWING_CREATE_INFO_INIT;
  drawing.paths = &view;
  drawing.pathCount = 1;
  drawing.methods = GPGP_DRAWING_PATCHES;
  GpgpAsset asset = nullptr;
  EXPECT_EQ(gpgpCreateDrawing(context, &drawing, &asset), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("GPGP_DRAWING_FLATTENED"), std::string::npos) << lastMessage();
  GpgpGlyphSetCreateInfo glyphs = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  glyphs.methods = GPGP_DRAWING_FLATTENED | GPGP_DRAWING_PATCHES;
  EXPECT_EQ(gpgpCreateGlyphSet(context, &glyphs, &asset), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("GPGP_DRAWING_PATCHES"), std::string::npos) << lastMessage();
}

} // namespace
