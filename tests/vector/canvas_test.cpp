// The canvas on the GPU: coverage against the CPU reference bit for bit, seams, budgets, bad arguments, and
// real drawings against a reference of 256 samples a pixel made from winding numbers.
#include "canvas_fixture.h"
#include "cli/vector/reference.h"
#include "fetched_svg.h"
#include "ui_fixture.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <sys/mman.h>

namespace {
using namespace gpgp;
using namespace gpgp::test;

/// Curves that are level somewhere and run down everywhere else, cut near there: their flattened segments turn back a
/// little.
TEST(FlatSegments, MeetEachRowOfTheirSegmentOnce) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0, 1);
  const shader::Grid grid{16, 16 * 64, 64};
  const GpgpCanvasItem here{nullptr, {1, 0, 0, 1, 0, 0}, 1};
  shader::ItemRecord item{};
  ASSERT_TRUE(vector::placeItem(here, 64, 64, item));
  uint32_t cut = 0, back = 0;
  for (int i = 0; i < 200000; ++i) {
    // y = top + size ((t - level)^3 + level^3)
    const float level = unit(random), size = 40 * unit(random), top = 1 + 8 * unit(random);
    const float c1 = 3 * level * level * size, c2 = -3 * level * size;
    const auto y = [&](float t) { return top + t * (c1 + t * (c2 + t * size)); };
    const auto x = [&] { return 60 * unit(random); };
    shader::SegmentRecord s{};
    s.first = {x(), top, x(), top + c1 / 3};
    s.second = {x(), top + (2 * c1 + c2) / 3, x(), top + c1 + c2 + size};
    s.side = 1;
    const float begin = std::clamp(level + 0.2f * (unit(random) - 0.5f), 0.0f, 1.0f);
    const float end = std::min(begin + unit(random), 1.0f);
    s.ends = {30, std::clamp(y(begin), top, s.second.w), 31, std::clamp(y(end), top, s.second.w)};
    if (!(s.ends.y < s.ends.w)) continue;
    ++cut;
    const uint32_t n = shader::flatSegmentCount(grid, item, s);
    std::vector<int> met(static_cast<size_t>(grid.rows), 0);
    for (uint32_t k = 0; k < n; ++k) {
      shader::FlatSegment flatSegment;
      if (!shader::flatSegmentOf(grid, item, s, k, n, shader::flatSegmentStep(n), flatSegment)) continue;
      back += flatSegment.side < 0 && flatSegment.first < flatSegment.last;
      for (int row = flatSegment.first; row < flatSegment.last; ++row)
        met[static_cast<size_t>(row)] += flatSegment.side > 0 ? 1 : -1;
    }
    for (int row = 0; row < grid.rows; ++row)
      ASSERT_EQ(met[static_cast<size_t>(row)],
                row >= shader::rowOf(grid, s.ends.y) && row < shader::rowOf(grid, s.ends.w) ? 1 : 0)
          << "curve " << i << ", row " << row;
  }
  EXPECT_GT(cut, 150000u);
  EXPECT_GT(back, 0u);
}

TEST_F(CanvasTest, CoverageEqualsTheCpuReferenceForEverySampleCountAndTransform) {
  makeCanvas(128);
  for (uint32_t seed = 0; seed < 4; ++seed) {
    TestPath path = randomShape(seed, 90);
    path.rule = seed % 2 ? GPGP_FILL_EVEN_ODD : GPGP_FILL_NON_ZERO;
    const GpgpPath view = path.view();
    const auto cpu = vector::makeDrawing(std::span(&view, 1), std::pmr::get_default_resource());
    ASSERT_TRUE(cpu);
    const GpgpAsset drawing = makeDrawing({view});
    const float transforms[][9] = {{1, 0, 0, 1, 0, 0},
                                   {0.8f, 0.6f, -0.6f, 0.8f, 30, -10},
                                   {7, 0.5f, 1, -9, -250, 400},
                                   {1, 0, 0, 1, 0, 0, 0.004f, 0.002f, 0.8f},        // all before the eye
                                   {0.9f, 0, 0, 1, -20, 0, 0.01f, 0, -0.2f},        // behind it left of x = 20
                                   {-0.9f, 0, 0, 0.4f, 30, 9, -0.01f, 0, 0.5f},     // right of x = 50, mirrored
                                   {1, 0, 0.4f, 0.2f, 0, 3, 0.001f, -0.012f, 0.7f}, // a floor
                                   {0.5f, 0.3f, 0.2f, 0.6f, -10, -30, 0.01f, 0.011f, -1}};
    for (const auto& t : transforms)
      for (const uint32_t samples : {1u, 4u, 8u, 16u}) {
        GpgpCanvasItem item{drawing, {}, 1, {}};
        std::copy_n(t, 6, item.transform);
        std::copy_n(t + 6, 3, item.perspective);
        shader::ItemRecord record{};
        ASSERT_TRUE(vector::placeItem(item, 100, 90, record));
        const CpuReference covers(*cpu, record, 100, 90, samples);
        for (const bool area : {false, true}) {
          exactArea = area;
          const auto pixels = raster({item}, 100, 90, samples);
          size_t different = 0, covered = 0;
          for (uint32_t y = 0; y < 90; ++y)
            for (uint32_t x = 0; x < 100; ++x) {
              const vector::CpuCoverage& pixel = covers.at(0, x, y);
              float expected = static_cast<float>(std::popcount(pixel.mask)) / static_cast<float>(samples);
              if (area)
                expected = std::clamp(
                    expected + static_cast<float>(pixel.difference) / static_cast<float>(256 * samples), 0.0f, 1.0f);
              covered += expected > 0;
              different += std::abs(pixels[y * 100 + x].a - expected) > (area ? 0.001f : 0.0f); // half floats
            }
          EXPECT_EQ(different, 0u) << "seed " << seed << ", transform " << &t - transforms << ", samples " << samples
                                   << ", area " << area;
          EXPECT_GT(covered, 20u) << "seed " << seed << ", transform " << &t - transforms;
        }
        exactArea = false;
      }
    gpgpDestroyAsset(drawing);
  }
}

// Only one sample of each pixel shows through the stripes on top: each lies in a row of its own.
TEST_F(CanvasTest, MasksEqualTheCpuReferencesBitForBit) {
  constexpr uint32_t kSide = 64;
  makeCanvas(kSide);
  for (uint32_t seed = 0; seed < 2; ++seed) {
    TestPath path = randomShape(seed, 90);
    path.rule = seed ? GPGP_FILL_EVEN_ODD : GPGP_FILL_NON_ZERO;
    const GpgpPath view = path.view();
    const auto cpu = vector::makeDrawing(std::span(&view, 1), std::pmr::get_default_resource());
    ASSERT_TRUE(cpu);
    const GpgpCanvasItem places[] = {{nullptr, {0.6f, 0.3f, -0.4f, 0.5f, 30, -10}, 1, {}},
                                     {nullptr, {0.5f, 0.1f, 0.2f, 0.6f, 0, 3}, 1, {0.001f, -0.003f, 0.9f}}};
    const GpgpAsset drawing = makeDrawing({view});
    for (GpgpCanvasItem item : places)
      for (const uint32_t samples : {4u, 8u, 16u}) {
        item.drawing = drawing;
        shader::ItemRecord record{};
        ASSERT_TRUE(vector::placeItem(item, kSide, kSide, record));
        const CpuReference covers(*cpu, record, kSide, kSide, samples);
        uint32_t different = 0, covered = 0;
        for (uint32_t k = 0; k < samples; ++k) {
          TestPath stripes; // black, over all other rows of samples
          const float row = 1 / static_cast<float>(samples);
          for (uint32_t y = 0; y <= kSide; ++y) {
            const float top = static_cast<float>(y) - 1 + static_cast<float>(k + 1) * row, bottom = top + 1 - row;
            stripes.move(-1, top).line(kSide + 1, top).line(kSide + 1, bottom).line(-1, bottom).close();
          }
          const GpgpAsset cover = makeDrawing({stripes.view()});
          const auto pixels = raster({item, place(cover)}, kSide, kSide, samples);
          gpgpDestroyAsset(cover);
          for (uint32_t i = 0; i < kSide * kSide; ++i) {
            const uint32_t bit = covers.at(0, i % kSide, i / kSide).mask >> k & 1;
            covered += bit;
            different += pixels[i].r != static_cast<float>(bit) * row;
          }
        }
        EXPECT_EQ(different, 0u) << "seed " << seed << ", samples " << samples;
        EXPECT_GT(covered, 100 * samples) << "seed " << seed << ", samples " << samples;
      }
    gpgpDestroyAsset(drawing);
  }
}

/// How much of a pixel a path covers by 64 samples, each taken back through the map in double precision.
double projectedCoverage(const PathOracle& path, const GpgpCanvasItem& item, uint32_t x, uint32_t y) {
  const auto number = [](float v) { return static_cast<double>(v); };
  const double a = number(item.transform[0]), b = number(item.transform[1]), c = number(item.transform[2]),
               d = number(item.transform[3]), e = number(item.transform[4]), f = number(item.transform[5]);
  const double p = number(item.perspective[0]), q = number(item.perspective[1]), r = number(item.perspective[2]);
  int inside = 0;
  for (int i = 0; i < 64; ++i) {
    const double px = x + (i % 8 + 0.5) / 8, py = y + (i / 8 + 0.5) / 8;
    // (a - p px) u + (c - q px) v = r px - e, and the like for y.
    const double k = a - p * px, l = c - q * px, m = b - p * py, n = d - q * py;
    const double s = r * px - e, t = r * py - f, determinant = k * n - l * m;
    const double u = (s * n - l * t) / determinant, v = (k * t - s * m) / determinant;
    inside += p * u + q * v + r > 0 && path.inside(u, v);
  }
  return inside / 64.0;
}

TEST_F(CanvasTest, ProjectiveItemsLookLikeTheReference) {
  makeCanvas(256);
  TestPath rings; // circles in each other from the eye's feet to far away
  for (int i = 1; i < 12; ++i) {
    const float r = 0.25f * std::pow(1.8f, static_cast<float>(i)), k = 0.5522847f * r;
    rings.move(r, 0).cubic(r, k, k, r, 0, r).cubic(-k, r, -r, k, -r, 0).cubic(-r, -k, -k, -r, 0, -r);
    rings.cubic(k, -r, r, -k, r, 0).close();
  }
  rings.rule = GPGP_FILL_EVEN_ODD;
  rings.color = {0, 0, 0, 1};
  const GpgpPath view = rings.view();
  const PathOracle oracle(view);
  const GpgpAsset drawing = makeDrawing({view});
  const float maps[][9] = {
      {40, 0, 64, 40, 64, 90, 0, 1, 1},             // a floor, horizon at y = 40; the eye stands in the rings
      {30, 10, 70, -45, 64, 64, 0.3f, 1, 2},        // tilted, from above
      {64, 64, 30, -30, 64, 64, 1, 0.02f, 0.5f},    // a wall at the left
      {-0.5f, 7, 8, 1, 64, 50, -0.05f, 0.03f, 0.9f} // a panel, turned
  };
  for (const auto& map : maps) {
    constexpr uint32_t width = 96, height = 88;
    GpgpCanvasItem item{drawing, {}, 1, {}};
    std::copy_n(map, 6, item.transform);
    std::copy_n(map + 6, 3, item.perspective);
    std::vector<float> reference;
    double covered = 0;
    for (uint32_t i = 0; i < width * height; ++i) {
      const double coverage = projectedCoverage(oracle, item, i % width, i / width);
      covered += coverage;
      reference.insert(reference.end(), {0, 0, 0, static_cast<float>(coverage)});
    }
    EXPECT_GT(covered, 500) << &map - maps;
    for (const bool area : {false, true}) {
      exactArea = area;
      const auto pixels = raster({item}, width, height, 16);
      double sum = 0;
      for (size_t i = 0; i < pixels.size(); ++i)
        sum += std::pow(static_cast<double>(pixels[i].a) - static_cast<double>(reference[i * 4 + 3]), 2);
      const double db = -10 * std::log10(sum / static_cast<double>(pixels.size()) + 1e-12);
      std::printf("map %td%s: %.1f dB, %.0f pixels covered\n", &map - maps, area ? ", area" : "", db, covered);
      EXPECT_GE(db, area ? 39.0 : 35.0) << &map - maps;
      if (const char* folder = std::getenv("GPGP_TEST_PICTURES")) {
        const std::string base = std::string(folder) + "/projective" + std::to_string(&map - maps) + (area ? "a" : "");
        host::writePng(base + ".gpu.png",
                       host::fromLinearPremultiplied(width, height, std::span(&pixels[0].r, pixels.size() * 4)));
        host::writePng(base + ".reference.png", host::fromLinearPremultiplied(width, height, reference));
      }
    }
  }
}

TEST_F(CanvasTest, ProjectiveMapsOfOneDistanceAreAffineAndGradientsFollowTheMap) {
  makeCanvas(64);
  TestPath square;
  square.move(0, 0).line(64, 0).line(64, 64).line(0, 64).close();
  const GpgpGradientStop stops[] = {{0, {0, 0, 0, 1}}, {1, {1, 1, 1, 1}}};
  GpgpGradient gradient{};
  gradient.transform[0] = gradient.transform[3] = 1;
  gradient.stops = stops;
  gradient.stopCount = 2;
  gradient.end[0] = 64;
  GpgpPath view = square.view();
  view.gradient = &gradient;
  const GpgpAsset drawing = makeDrawing({view});
  GpgpCanvasItem item = place(drawing, 2, 6, -4);
  item.perspective[2] = 2;
  const auto scaled = raster({item}, 64, 64, 4), affine = raster({place(drawing, 1, 3, -2)}, 64, 64, 4);
  for (size_t i = 0; i < scaled.size(); ++i) ASSERT_EQ(scaled[i].r, affine[i].r) << i;
  item.perspective[2] = -2;
  for (const Rgba& p : raster({item}, 64, 64, 4)) ASSERT_EQ(p.a, 0);
  item = place(drawing);
  item.perspective[0] = 1.0f / 64, item.perspective[2] = 1; // x / (1 + x / 64)
  const auto pixels = raster({item}, 64, 64, 4);
  for (size_t i = 0; i < 64 * 32; ++i) {
    const double x = static_cast<double>(i % 64) + 0.5;
    if (i % 64 > 31 || static_cast<double>(i / 64) + 1 > 64 - x) continue; // the square's right edge lies at 32
    ASSERT_NEAR(pixels[i].r, x / (1 - x / 64) / 64, 0.002) << i;
    ASSERT_EQ(pixels[i].a, 1);
  }
}

TEST_F(CanvasTest, AbuttingPathsAndCutsInsidePathsLeaveNoSeams) {
  makeCanvas(256);
  // Two paths that share a curved edge, the same colour and opaque: together they must cover everything.
  TestPath left, right;
  left.move(-50, -50).line(90, -50).cubic(10, 90, 190, 130, 77, 300).line(-50, 300).close();
  right.move(90, -50).line(300, -50).line(300, 300).line(77, 300).cubic(190, 130, 10, 90, 90, -50).close();
  left.color = right.color = {0.25f, 0.5f, 1, 1};
  const GpgpAsset drawing = makeDrawing({left.view(), right.view()});
  for (const bool area : {false, true})
    for (const float scale : {1.0f, 0.37f, 13.0f})
      for (const uint32_t samples : {1u, 4u, 16u}) {
        exactArea = area;
        const auto pixels =
            raster({place(drawing, scale, scale > 1 ? -900.0f : 13.0f, scale > 1 ? -1100.0f : 11.0f)}, 64, 64, samples);
        for (const Rgba& p : pixels) {
          ASSERT_NEAR(p.a, 1.0f, area ? 0.001f : 0.0f) << scale << " " << samples;
          ASSERT_NEAR(p.b, 1.0f, area ? 0.001f : 0.0f);
        }
      }
}

TEST_F(CanvasTest, NoSeamsAtAnyZoom) {
  makeCanvas(64);
  // A shared curve, and behind it a path that crosses itself all over: neither may show from 1/64 to 4096.
  const float far = 20000;
  TestPath left, right, web;
  left.move(-far, -far).line(91.7f, -far).line(91.7f, -50).cubic(10.3f, 90, 190.1f, 130, 77.9f, 300).line(77.9f, far);
  left.line(-far, far).close();
  right.move(91.7f, -far).line(far, -far).line(far, far).line(77.9f, far).line(77.9f, 300);
  right.cubic(190.1f, 130, 10.3f, 90, 91.7f, -50).close();
  web.move(-far, -far).line(far, -far).line(far, far).line(-far, far).close();
  for (int i = 0; i < 60; ++i) { // all run the same way round, so that the union is everything
    const float a = static_cast<float>(i) * 0.7f, x = 90 + 30 * std::cos(a), y = 100 + 60 * std::sin(a);
    web.move(x, y).cubic(x + 80, y - 40, x + 90, y + 70, x + 3, y + 50).close();
  }
  left.color = right.color = {0.25f, 0.5f, 1, 1};
  web.color = {1, 0.5f, 1, 1};
  const GpgpAsset shared = makeDrawing({left.view(), right.view()}), alone = makeDrawing({web.view()});
  for (int zoom = -6; zoom <= 12; zoom += 2)
    for (const float t : {0.21f, 0.5f, 0.83f}) {
      const float scale = std::ldexp(1.0f, zoom), u = 1 - t;
      const float x = u * u * u * 91.7f + 3 * u * u * t * 10.3f + 3 * u * t * t * 190.1f + t * t * t * 77.9f;
      const float y = u * u * u * -50 + 3 * u * u * t * 90 + 3 * u * t * t * 130 + t * t * t * 300;
      for (const GpgpAsset drawing : {shared, alone})
        for (const uint32_t samples : {4u, 16u}) {
          exactArea = samples == 16 && t == 0.5f;
          const auto pixels = raster({place(drawing, scale, 32.3f - scale * x, 31.8f - scale * y)}, 64, 64, samples);
          for (size_t i = 0; i < pixels.size(); ++i)
            ASSERT_NEAR(pixels[i].a, 1.0f, exactArea ? 0.001f : 0.0f)
                << "zoom " << scale << ", " << samples << " samples, pixel " << i % 64 << " " << i / 64;
        }
    }
}

TEST_F(CanvasTest, PaintsInOrderWithAlphaAndOpacity) {
  makeCanvas(64);
  TestPath below, above;
  below.move(0, 0).line(64, 0).line(64, 64).line(0, 64).close();
  above = below;
  below.color = {1, 0, 0, 1};
  above.color = {0, 1, 0, 0.5f};
  const GpgpAsset a = makeDrawing({below.view()}), b = makeDrawing({above.view()});
  GpgpCanvasItem top = place(b);
  top.opacity = 0.5f;
  const auto pixels = raster({place(a), top}, 64, 64, 16);
  for (const Rgba& p : pixels) {
    ASSERT_FLOAT_EQ(p.r, 0.75f);
    ASSERT_FLOAT_EQ(p.g, 0.25f);
    ASSERT_FLOAT_EQ(p.a, 1);
  }
  const auto reversed = raster({top, place(a)}, 64, 64, 4);
  EXPECT_EQ(reversed[100].r, 1);
  EXPECT_EQ(reversed[100].g, 0);
}

TEST_F(CanvasTest, ExceededBudgetsLeaveOutWholePathsAndSayHowMany) {
  std::vector<TestPath> shapes;
  for (uint32_t i = 0; i < 20; ++i) shapes.push_back(randomShape(i, 120));
  for (size_t i = 0; i < shapes.size(); ++i) shapes[i].color = {0, 0, 0, 0.5f};
  std::vector<GpgpPath> views;
  for (const TestPath& s : shapes) views.push_back(s.view());
  makeCanvas(128);
  GpgpAsset all = makeDrawing(views);
  GpgpCanvasReport whole = GPGP_CANVAS_REPORT_INIT;
  raster({place(all)}, 128, 128, 4, &whole);
  EXPECT_EQ(whole.base.status, GPGP_SUCCESS);
  EXPECT_EQ(whole.pathsDropped, 0u);
  ASSERT_GT(whole.tileEntries, 100u);
  const GpgpRecorder roomy = canvas;
  makeCanvas(128, whole.tileEntries / 2);
  GpgpCanvasReport part = GPGP_CANVAS_REPORT_INIT;
  const auto pixels = raster({place(all)}, 128, 128, 4, &part);
  EXPECT_EQ(part.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(part.tileEntries, whole.tileEntries);
  EXPECT_EQ(part.tileEntriesGiven, whole.tileEntries / 2);
  ASSERT_GT(part.pathsDropped, 0u);
  ASSERT_LT(part.pathsDropped, 20u);
  // The picture is that of the paths that remain.
  canvas = roomy;
  const GpgpAsset few = makeDrawing({views.begin(), views.end() - part.pathsDropped});
  const auto expected = raster({place(few)}, 128, 128, 4);
  for (size_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(pixels[i].a, expected[i].a) << i;

  makeCanvas(128, 0, 10); // too few paths
  GpgpCanvasReport paths = GPGP_CANVAS_REPORT_INIT;
  raster({place(all)}, 128, 128, 4, &paths);
  EXPECT_EQ(paths.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(paths.paths, 20u);
  EXPECT_EQ(paths.pathsGiven, 10u);
  EXPECT_EQ(paths.pathsDropped, 10u);
}

// What a report says is needed is what suffices, and a path less does not.
TEST_F(CanvasTest, ReportsSayHowManyPathsAreNeeded) {
  std::vector<TestPath> shapes;
  for (uint32_t i = 0; i < 6; ++i) shapes.push_back(randomShape(i, 60));
  shapes.push_back(TestPath().move(1, 1).close()); // a path without patches
  std::vector<GpgpPath> views;
  for (const TestPath& s : shapes) views.push_back(s.view());
  const GpgpAsset drawing = makeDrawing(views), empty = makeDrawing(std::vector<GpgpPath>(900, views.back()));
  TestList list(context);
  for (int i = 0; i < 4; ++i) list.add(rectangle(0, 0, 8, 8));
  list.clip({0, 0, 40, 40}, {9, 9, 9, 9}).add(rectangle(0, 0, 50, 50)).pop();
  const struct {
    std::vector<GpgpCanvasItem> items;
    uint32_t needed;
    std::vector<uint32_t> given;
  } cases[] = {{{place(drawing), list.item(), place(drawing), list.item()}, 26, {10, 25, 26}},
               {{place(empty), list.item()}, 906, {905, 906}}};
  for (const auto& c : cases) {
    const std::string which = "case " + std::to_string(&c - cases);
    for (const uint32_t given : c.given) {
      makeCanvas(64, 0, given);
      GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
      raster(c.items, 64, 64, 4, &report);
      EXPECT_EQ(report.paths, c.needed) << which << ", given " << given;
      EXPECT_EQ(report.pathsGiven, given) << which;
      EXPECT_EQ(report.base.status, given < c.needed ? GPGP_BUDGET_EXCEEDED : GPGP_SUCCESS) << which;
      EXPECT_EQ(report.pathsDropped > 0, given < c.needed) << which;
    }
  }
}

// The canvas holds paths, not their patches: one of thousands is one.
TEST_F(CanvasTest, APathIsOneHoweverManyPatchesItHas) {
  TestPath zigzag;
  for (int i = 0; i < 2000; ++i) {
    const float x = static_cast<float>(i % 50) * 2.5f, y = static_cast<float>(i / 50) * 3;
    zigzag.move(x, y).line(x + 2, y + 1).line(x, y + 2.5f).close();
  }
  const GpgpAsset drawing = makeDrawing({zigzag.view()});
  GpgpDrawingInfo info = GPGP_DRAWING_INFO_INIT;
  ASSERT_EQ(gpgpGetDrawingInfo(drawing, &info), GPGP_SUCCESS);
  ASSERT_GE(info.patches, 2000u);
  makeCanvas(128);
  const auto expected = raster({place(drawing)}, 128, 128, 4);
  makeCanvas(128, 0, 1);
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  const auto pixels = raster({place(drawing)}, 128, 128, 4, &report);
  EXPECT_EQ(report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(report.paths, 1u);
  EXPECT_EQ(report.pathsDropped, 0u);
  for (size_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(pixels[i].a, expected[i].a) << i;
}

TEST_F(CanvasTest, HardwareHasPassesThatSoftwareDevicesHaveNot) {
  makeCanvas();
  uint32_t count = 0;
  ASSERT_EQ(gpgpGetPasses(canvas, &count, nullptr), GPGP_SUCCESS);
  std::vector<const char*> names(count);
  ASSERT_EQ(gpgpGetPasses(canvas, &count, names.data()), GPGP_SUCCESS);
  const bool packs = std::any_of(names.begin(), names.end(), [](const char* n) { return !std::strcmp(n, "pack"); });
  EXPECT_EQ(packs, std::getenv("GPGP_TEST_HARDWARE") || !device.isSoftware());
}

TEST_F(CanvasTest, TooFewTileWordsLeaveOutTheLastPaths) {
  makeCanvas(512, 65536); // as many tile words, of which a path across the whole canvas takes 128
  std::vector<TestPath> squares(700);
  std::vector<GpgpPath> views;
  for (TestPath& s : squares) {
    s.move(0, 0).line(512, 0).line(512, 512).line(0, 512).close();
    s.color = {1, 1, 1, 1.0f / 1024};
    views.push_back(s.view());
  }
  const GpgpAsset drawing = makeDrawing(views);
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  const auto pixels = raster({place(drawing)}, 512, 512, 4, &report);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(report.pathsDropped, 188u);
  EXPECT_EQ(report.tileWords, 700u * 128);
  EXPECT_EQ(report.tileWordsGiven, 65536u);
  EXPECT_LE(report.tileEntries, report.tileEntriesGiven);
  EXPECT_EQ(report.tileEntriesGiven, 65536u);
  // Words are a budget of their own, and as many as are needed suffice.
  const GpgpRecorder few = canvas;
  for (const uint32_t words : {report.tileWords - 1, report.tileWords}) {
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
    info.maxWidth = info.maxHeight = 512;
    info.maxTileEntries = 65536;
    info.maxTileWords = words;
    info.targets = canvasTargets;
    canvas = recorder(gpgpCreateCanvas, info);
    GpgpCanvasReport again = GPGP_CANVAS_REPORT_INIT;
    raster({place(drawing)}, 512, 512, 4, &again);
    EXPECT_EQ(again.pathsDropped, report.tileWords - words);
    EXPECT_EQ(again.tileWords, report.tileWords);
    EXPECT_EQ(again.tileWordsGiven, words);
  }
  canvas = few;
  const float expected = 1 - std::pow(1 - 1.0f / 1024, 512.0f);
  for (const Rgba& p : pixels) ASSERT_NEAR(p.a, expected, 0.002f);
}

TEST_F(CanvasTest, ThousandsOfInstancesOfOneDrawingInOneRecord) {
  GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
  info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
  info.maxWidth = info.maxHeight = 512;
  info.maxDrawings = 4096;
  info.targets = canvasTargets;
  ASSERT_EQ(gpgpCreateCanvas(context, &info, &canvas), GPGP_SUCCESS) << lastMessage();
  ASSERT_EQ(gpgpPrewarm(canvas, nullptr), GPGP_SUCCESS);
  TestPath square, dot;
  square.move(0, 0).line(4, 0).line(4, 4).line(0, 4).close();
  dot.move(1, 1).line(3, 1).line(3, 3).line(1, 3).close();
  square.color = {0, 0, 1, 1};
  dot.color = {1, 0, 0, 1};
  const GpgpAsset drawing = makeDrawing({square.view(), dot.view()});
  std::vector<GpgpCanvasItem> items;
  for (int i = 0; i < 4096; ++i) // turned by quarters: all look alike
    items.push_back(
        i % 2 ? place(drawing, 1, static_cast<float>(i % 64 * 8), static_cast<float>(i / 64 * 8))
              : GpgpCanvasItem{
                    drawing, {0, 1, -1, 0, static_cast<float>(i % 64 * 8 + 4), static_cast<float>(i / 64 * 8)}, 1});
  const auto pixels = raster(items, 512, 512, 16);
  for (size_t y = 0; y < 512; ++y)
    for (size_t x = 0; x < 512; ++x) {
      const size_t u = x % 8, v = y % 8;
      const bool in = u < 4 && v<4, red = u> 0 && u < 3 && v > 0 && v < 3;
      const Rgba& p = pixels[y * 512 + x];
      ASSERT_EQ(p.a, in ? 1.0f : 0.0f) << x << " " << y;
      ASSERT_EQ(p.r, red ? 1.0f : 0.0f) << x << " " << y;
    }
}

// 300 drawings, each with paint and a group that fades, against one drawing that has all of it.
TEST_F(CanvasTest, ARecordingShowsAnyNumberOfDrawings) {
  constexpr uint32_t kDrawings = 300, kSize = 128;
  GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
  info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
  info.maxWidth = info.maxHeight = kSize;
  info.maxDrawings = 300;
  info.targets = canvasTargets;
  canvas = recorder(gpgpCreateCanvas, info);
  std::mt19937 random(5);
  const auto unit = [&] { return static_cast<float>(random() % 256) / 255; };
  std::vector<TestPath> shapes;
  std::vector<std::array<GpgpGradientStop, 3>> stops(kDrawings);
  std::vector<GpgpGradient> gradients(kDrawings);
  std::vector<GpgpPath> all;
  std::vector<GpgpPathGroup> groups;
  std::vector<GpgpAsset> drawings;
  shapes.reserve(2 * kDrawings);
  for (uint32_t i = 0; i < kDrawings; ++i) {
    for (int k = 0; k < 2; ++k) {
      TestPath& shape = shapes.emplace_back(randomShape(2 * i + k, 40));
      const float x = static_cast<float>(random() % 88), y = static_cast<float>(random() % 88);
      for (size_t p = 0; p < shape.points.size(); ++p) shape.points[p] += p % 2 ? y : x;
      shape.color = {unit(), unit(), unit(), 0.5f + unit() / 2};
    }
    for (int k = 0; k < 3; ++k) stops[i][k] = {float(k) / 2, {unit(), unit(), unit(), 1}};
    gradients[i].transform[0] = gradients[i].transform[3] = 1;
    gradients[i].end[0] = gradients[i].end[1] = kSize;
    gradients[i].stops = stops[i].data();
    gradients[i].stopCount = 3;
    GpgpPath painted = shapes[2 * i].view(), faded = shapes[2 * i + 1].view();
    painted.gradient = &gradients[i];
    faded.group = 1;
    const GpgpPathGroup group{0, 0.25f + unit() / 2, nullptr, 0};
    drawings.push_back(makeDrawing({painted, faded}, {group}));
    groups.push_back(group);
    faded.group = static_cast<uint32_t>(groups.size());
    all.push_back(painted);
    all.push_back(faded);
  }
  std::vector<GpgpCanvasItem> items;
  for (const GpgpAsset drawing : drawings) items.push_back(place(drawing));
  const auto got = raster(items, kSize, kSize, 16);
  const auto want = raster({place(makeDrawing(all, groups)), place(drawings[0], 1, 1000)}, kSize, kSize, 16);
  for (size_t i = 0; i < got.size(); ++i) {
    ASSERT_EQ(got[i].r, want[i].r) << i;
    ASSERT_EQ(got[i].g, want[i].g) << i;
    ASSERT_EQ(got[i].b, want[i].b) << i;
    ASSERT_EQ(got[i].a, want[i].a) << i;
  }
}

TEST_F(CanvasTest, GradientsFollowTheirSpreadsAndCircles) {
  makeCanvas(64);
  TestPath square;
  square.move(0, 0).line(64, 0).line(64, 64).line(0, 64).close();
  const GpgpGradientStop stops[] = {{0, {0, 0, 0, 1}}, {0.5f, {1, 0, 0, 1}}, {1, {1, 1, 0, 0.5f}}};
  GpgpGradient gradient{};
  gradient.transform[0] = 2, gradient.transform[3] = 2; // the gradient's space has half the size
  gradient.stops = stops;
  gradient.stopCount = 3;
  gradient.start[0] = 8, gradient.end[0] = 16; // pixels 16 to 32
  const auto expectAt = [&](const Rgba& p, double t, double tolerance, const std::string& where) {
    const double a = t <= 0.5 ? 1 : 1 - (t - 0.5), r = std::min(1.0, 2 * t) * a, g = t <= 0.5 ? 0 : (2 * t - 1) * a;
    ASSERT_NEAR(p.a, a, tolerance) << where;
    ASSERT_NEAR(p.r, r, tolerance) << where;
    ASSERT_NEAR(p.g, g, tolerance) << where;
  };
  for (const GpgpSpread spread : {GPGP_SPREAD_PAD, GPGP_SPREAD_REPEAT, GPGP_SPREAD_REFLECT}) {
    gradient.spread = spread;
    GpgpPath view = square.view();
    view.gradient = &gradient;
    const GpgpAsset elsewhere = makeDrawing({square.view()}); // two drawings take other shaders than one
    const auto pixels = raster({place(elsewhere, 1, 200, 200), place(makeDrawing({view}))}, 64, 64, 4);
    for (size_t i = 0; i < pixels.size(); ++i) {
      double t = (static_cast<double>(i % 64) + 0.5 - 16) / 16;
      if (spread == GPGP_SPREAD_PAD) t = std::clamp(t, 0.0, 1.0);
      if (spread == GPGP_SPREAD_REPEAT) t -= std::floor(t);
      if (spread == GPGP_SPREAD_REFLECT) t = std::abs(t - 2 * std::floor(t / 2 + 0.5));
      expectAt(pixels[i], t, 0.002, "spread " + std::to_string(spread) + ", pixel " + std::to_string(i));
    }
  }
  // Two circles: every point of the circle for t has the colour of t.
  gradient.kind = GPGP_GRADIENT_RADIAL;
  gradient.spread = GPGP_SPREAD_PAD;
  gradient.start[0] = 13, gradient.start[1] = 15, gradient.startRadius = 2;
  gradient.end[0] = gradient.end[1] = 16, gradient.endRadius = 14;
  GpgpPath view = square.view();
  view.gradient = &gradient;
  const auto pixels = raster({place(makeDrawing({view}))}, 64, 64, 4);
  for (double t = 0.02; t < 0.98; t += 0.01)
    for (double angle = 0; angle < 6.28; angle += 0.1) {
      const double radius = 2 + 12 * t;
      const double x = 2 * (13 + 3 * t + radius * std::cos(angle)), y = 2 * (15 + t + radius * std::sin(angle));
      expectAt(pixels[static_cast<size_t>(y) * 64 + static_cast<size_t>(x)], t, 0.09, "circle");
    }
}

TEST_F(CanvasTest, ImagesPaintThroughTheirTransformAndSampler) {
  makeCanvas(72); // no other test's: lavapipe follows descriptors of images that are gone
  const uint32_t red = 0xff0000ff, green = 0xff00ff00, half = 0x80ff0000, white = 0xffffffff;
  const uint32_t first[] = {red, green, half, white}, second[] = {white, red};
  const Texture chess(device, 2, 2, first, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT);
  const Texture ramp(device, 2, 1, second, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  TestPath square, lower;
  square.move(0, 0).line(64, 0).line(64, 64).line(0, 64).close();
  lower.move(0, 32).line(64, 32).line(64, 64).line(0, 64).close();
  const GpgpImagePaint tiles{0, {16, 0, 0, 16, 8, 8}}, smooth{1, {32, 0, 0, 1, 16, 0}};
  GpgpPath below = square.view(), above = lower.view();
  below.image = &tiles;
  below.color[3] = 0.5f;
  above.image = &smooth;
  const GpgpAsset drawing = makeDrawing({below, above});
  for (const bool premultiplied : {false, true}) {
    images = {ramp.view(), chess.view(premultiplied), ramp.view()};
    GpgpCanvasItem item = place(drawing);
    item.firstImage = 1;
    const auto pixels = raster({item}, 64, 64, 4);
    for (uint32_t y = 0; y < 64; ++y)
      for (uint32_t x = 0; x < 64; ++x) {
        const Rgba& p = pixels[y * 64 + x];
        if (y < 32) { // tiles of 16 pixels from 8, 8 on, half as opaque
          const bool right = (x + 8) % 16 >= 8, down = (y + 8) % 16 >= 8;
          const float alpha = down && !right ? 0.5f * 128 / 255 : 0.5f;
          const Rgba expected = down && right ? Rgba{0.5f, 0.5f, 0.5f, 0.5f}
                                : down        ? Rgba{0, 0, premultiplied ? 0.5f : alpha, alpha}
                                : right       ? Rgba{0, 0.5f, 0, 0.5f}
                                              : Rgba{0.5f, 0, 0, 0.5f};
          ASSERT_NEAR(p.r, expected.r, 0.002f) << x << " " << y;
          ASSERT_NEAR(p.g, expected.g, 0.002f) << x << " " << y;
          ASSERT_NEAR(p.b, expected.b, 0.002f) << x << " " << y;
          ASSERT_NEAR(p.a, expected.a, 0.002f) << x << " " << y;
        } else { // white to 24, red from 40 on
          const float t = std::clamp((static_cast<float>(x) + 0.5f - 24) / 16, 0.0f, 1.0f);
          ASSERT_NEAR(p.g, 1 - t, 0.006f) << x << " " << y;
          ASSERT_EQ(p.a, 1) << x << " " << y;
        }
      }
  }
  // Through a projective map: pixel x shows the drawing's x / (1 - x / 64).
  images = {chess.view(), ramp.view()};
  GpgpCanvasItem item = place(drawing);
  item.perspective[0] = 1.0f / 64, item.perspective[2] = 1;
  const auto pixels = raster({item}, 64, 64, 4);
  for (uint32_t x = 0; x < 31; ++x) {
    const float at = (static_cast<float>(x) + 0.5f) / (1 - (static_cast<float>(x) + 0.5f) / 64);
    const float y = 0.5f * (1 + at / 64);
    const bool right = std::fmod(at + 8, 16.0f) >= 8, down = std::fmod(y + 8, 16.0f) >= 8;
    ASSERT_EQ(pixels[x].g > 0.2f, right) << x << " " << down;
  }
}

TEST_F(CanvasTest, MissingAndTooManyImagesAreRefusedWithWords) {
  canvasTargets = 0;
  makeCanvas(64);
  const uint32_t texel[] = {0xffffffff};
  const Texture white(device, 1, 1, texel, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT);
  TestPath square;
  square.move(0, 0).line(64, 0).line(64, 64).close();
  GpgpImagePaint paint{1, {1, 0, 0, 1, 0, 0}};
  GpgpPath path = square.view();
  path.image = &paint;
  const GpgpAsset drawing = makeDrawing({path});
  const GpgpHistory view = makeView(64, 64);
  const GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer commands) {
    ASSERT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
    GpgpCanvasItem item = place(drawing);
    GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
    info.width = info.height = 32;
    info.items = &item;
    info.itemCount = 1;
    info.history = view;
    const auto expect = [&](GpgpResult result, const char* words) {
      info.images = images.data();
      info.imageCount = static_cast<uint32_t>(images.size());
      EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), result) << words;
      EXPECT_NE(lastMessage().find(words), std::string::npos) << lastMessage();
    };
    images = {white.view()};
    expect(GPGP_ERROR_INVALID_ARGUMENT, "needs 2 images from images[0] on; imageCount is 1");
    images.push_back(white.view());
    item.firstImage = 1;
    expect(GPGP_ERROR_INVALID_ARGUMENT, "from images[1] on");
    item.firstImage = ~0u;
    expect(GPGP_ERROR_INVALID_ARGUMENT, "from images[4294967295] on");
    item.firstImage = 0;
    images[1].view = VK_NULL_HANDLE;
    expect(GPGP_ERROR_INVALID_ARGUMENT, "images[1].view");
    images[1] = white.view();
    images[1].sampler = VK_NULL_HANDLE;
    expect(GPGP_ERROR_INVALID_ARGUMENT, "images[1].sampler");
    images[1] = white.view();
    images[0].layout = VK_IMAGE_LAYOUT_UNDEFINED;
    expect(GPGP_ERROR_INVALID_ARGUMENT, "images[0].layout");
    images.assign(9, white.view());
    expect(GPGP_ERROR_INVALID_ARGUMENT, "imageCount is 9; the canvas was made for 8");
  });
  const auto refused = [&](const char* words) {
    GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    info.paths = &path;
    info.pathCount = 1;
    GpgpAsset none = nullptr;
    EXPECT_EQ(gpgpCreateDrawing(context, &info, &none), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(lastMessage().find(words), std::string::npos) << lastMessage();
  };
  paint.image = GPGP_MAX_IMAGES;
  refused("image.image is 1024");
  paint = {0, {1, 2, 2, 4, 0, 0}};
  refused("no inverse");
  paint = {0, {NAN, 0, 0, 1, 0, 0}};
  refused("not finite");
  const GpgpGradientStop stop{0, {0, 0, 0, 1}};
  GpgpGradient gradient{};
  gradient.stops = &stop;
  gradient.stopCount = 1;
  path.gradient = &gradient;
  refused("both gradient and image");
}

TEST_F(CanvasTest, ClipsAreTheUnionOfTheirPathsWithinThoseAbove) {
  makeCanvas(128);
  // Sample for sample what the clipped path's mask and its clips' masks leave.
  std::vector<TestPath> shapes;
  for (uint32_t i = 0; i < 4; ++i) shapes.push_back(randomShape(20 + i, 90));
  std::vector<GpgpPath> views;
  for (const TestPath& s : shapes) views.push_back(s.view());
  const auto cpuDrawing = vector::makeDrawing(views, std::pmr::get_default_resource());
  ASSERT_TRUE(cpuDrawing);
  const GpgpPath either[] = {views[1], views[2]};
  const std::vector<GpgpPathGroup> groups = {{0, 1, either, 2}, {1, 1, &views[3], 1}, {0, 1, &views[3], 0}};
  GpgpPath none = views[0], one = views[0], both = views[0];
  none.group = 3;
  one.group = 1;
  both.group = 2;
  for (const uint32_t samples : {4u, 16u})
    for (const bool nested : {false, true}) {
      const GpgpAsset drawing = makeDrawing({none, nested ? both : one, none}, groups);
      const GpgpCanvasItem item = place(drawing, 0.9f, 3, 2);
      shader::ItemRecord record{};
      ASSERT_TRUE(vector::placeItem(item, 100, 90, record));
      const CpuReference cpu(*cpuDrawing, record, 100, 90, samples);
      const auto pixels = raster({item}, 100, 90, samples);
      size_t different = 0, covered = 0, cut = 0;
      for (uint32_t y = 0; y < 90; ++y)
        for (uint32_t x = 0; x < 100; ++x) {
          uint32_t mask = cpu.at(0, x, y).mask & (cpu.at(1, x, y).mask | cpu.at(2, x, y).mask);
          if (nested) mask &= cpu.at(3, x, y).mask;
          const float expected = static_cast<float>(std::popcount(mask)) / static_cast<float>(samples);
          covered += mask != 0;
          cut += mask != cpu.at(0, x, y).mask;
          different += pixels[y * 100 + x].a != expected;
        }
      EXPECT_EQ(different, 0u) << samples << " " << nested;
      EXPECT_GT(covered, 100u);
      EXPECT_GT(cut, 100u);
    }
  // With exact areas: a clip of half pixels, around a path without edges there, counts by its area.
  exactArea = true;
  TestPath square, window;
  square.move(-9, -9).line(99, -9).line(99, 99).line(-9, 99).close();
  window.move(10.3f, 10).line(50, 10).line(50, 50).line(10.3f, 50).close();
  GpgpPath clipped = square.view();
  clipped.group = 1;
  const GpgpPath hole = window.view();
  const auto pixels = raster({place(makeDrawing({clipped}, {{0, 1, &hole, 1}}))}, 64, 64, 4);
  EXPECT_NEAR(pixels[20 * 64 + 10].a, 0.7f, 0.005f);
  EXPECT_EQ(pixels[20 * 64 + 9].a, 0);
  EXPECT_EQ(pixels[20 * 64 + 11].a, 1);
}

/// Straight colours over each other from the bottom up, premultiplied in the end.
Rgba over(Rgba below, const std::array<float, 4>& color, float alpha = 1) {
  const float a = color[3] * alpha, keep = 1 - a;
  return {color[0] * a + below.r * keep, color[1] * a + below.g * keep, color[2] * a + below.b * keep,
          a + below.a * keep};
}

TEST_F(CanvasTest, GroupsFadeAsAWhole) {
  makeCanvas(64);
  // Columns of 8 pixels that paths cover or do not: every combination of five of them.
  const auto column = [](uint32_t bit, std::array<float, 4> color) {
    TestPath path;
    for (uint32_t x = 0; x < 32; ++x)
      if (x >> bit & 1) {
        const float left = static_cast<float>(2 * x);
        path.move(left, 0).line(left + 2, 0).line(left + 2, 64).line(left, 64).close();
      }
    path.color = color;
    return path;
  };
  const TestPath paths[] = {column(0, {1, 0, 0, 1}), column(1, {0, 1, 0, 0.5f}), column(2, {0, 0, 1, 1}),
                            column(3, {1, 1, 0, 1}), column(4, {0, 1, 1, 0.75f})};
  std::vector<GpgpPath> views;
  for (const TestPath& p : paths) views.push_back(p.view());
  // Path 0 below; group 1 holds path 1 and group 2, which holds paths 2 and 3; path 4 above all.
  views[1].group = 1;
  views[2].group = views[3].group = 2;
  const std::vector<GpgpPathGroup> groups = {{0, 0.5f, nullptr, 0}, {1, 0.25f, nullptr, 0}};
  const GpgpAsset drawing = makeDrawing(views, groups);
  const auto plus = [](Rgba below, Rgba group, float alpha) {
    const float keep = 1 - group.a * alpha;
    return Rgba{group.r * alpha + below.r * keep, group.g * alpha + below.g * keep, group.b * alpha + below.b * keep,
                group.a * alpha + below.a * keep};
  };
  const auto expected = [&](uint32_t bits) {
    const auto paint = [&](Rgba below, uint32_t k) { return bits >> k & 1 ? over(below, paths[k].color) : below; };
    const Rgba inner = paint(paint({}, 2), 3), outer = plus(paint({}, 1), inner, 0.25f);
    return paint(plus(paint({}, 0), outer, 0.5f), 4);
  };
  for (const bool area : {false, true})
    for (const float shift : {0.0f, 0.5f}) { // edges between pixels, and inside them
      exactArea = area;
      const auto pixels = raster({place(drawing, 1, shift, 0), place(drawing, 1, 200, 0)}, 64, 64, 16);
      for (uint32_t x = 1; x < 64; ++x) {
        const Rgba a = expected(x / 2), b = expected((x - 1) / 2);
        const float half = shift > 0 && x % 2 == 0 ? 0.5f : 0.0f; // of the column left of it
        const Rgba& p = pixels[30 * 64 + x];
        const float tolerance = area && half > 0 ? 0.03f : 0.002f; // several edges in a pixel
        ASSERT_NEAR(p.r, a.r * (1 - half) + b.r * half, tolerance) << x << " " << shift << " " << area;
        ASSERT_NEAR(p.g, a.g * (1 - half) + b.g * half, tolerance) << x << " " << shift << " " << area;
        ASSERT_NEAR(p.b, a.b * (1 - half) + b.b * half, tolerance) << x << " " << shift << " " << area;
        ASSERT_NEAR(p.a, a.a * (1 - half) + b.a * half, tolerance) << x << " " << shift << " " << area;
      }
    }
}

TEST_F(CanvasTest, GroupsThatCannotBeAreRefusedWithWords) {
  TestPath square;
  square.move(0, 0).line(4, 0).line(4, 4).close();
  GpgpPath path = square.view(), outside = path;
  path.group = 1;
  const auto refused = [&](const std::vector<GpgpPath>& paths, const std::vector<GpgpPathGroup>& groups,
                           GpgpResult result, const char* words) {
    messages.clear();
    EXPECT_EQ(makeDrawing(paths, groups, result), nullptr);
    EXPECT_NE(lastMessage().find(words), std::string::npos) << lastMessage();
  };
  refused({path}, {}, GPGP_ERROR_INVALID_ARGUMENT, "paths[0].group is 1; there are 0 groups");
  refused({path}, {{1, 1, nullptr, 0}}, GPGP_ERROR_INVALID_ARGUMENT, "groups[0].parent is 1");
  refused({path}, {{0, NAN, nullptr, 0}}, GPGP_ERROR_INVALID_ARGUMENT, "groups[0].opacity");
  refused({path}, {{0, 1, nullptr, 2}}, GPGP_ERROR_INVALID_ARGUMENT, "groups[0].clip is NULL");
  refused({path, outside, path}, {{0, 0.5f, nullptr, 0}}, GPGP_ERROR_INVALID_ARGUMENT, "paths[2]: others lie");
  GpgpPath bad = outside;
  bad.fillRule = 7;
  refused({path}, {{0, 1, &bad, 1}}, GPGP_ERROR_INVALID_ARGUMENT, "groups[0].clip[0]: fillRule is 7");
  std::vector<GpgpPathGroup> deep;
  for (uint32_t i = 0; i < 200; ++i) deep.push_back({i, 0.5f, nullptr, 0}); // layers from the fifth on
  path.group = 200;
  refused({path}, deep, GPGP_ERROR_UNSUPPORTED, "more than 32 nested layers");
  path.group = 1;
  deep.clear();
  for (uint32_t i = 0; i < 17; ++i) deep.push_back({i, 1, &outside, 1});
  refused({path}, deep, GPGP_ERROR_UNSUPPORTED, "groups[16]: more than 16");
  EXPECT_NE(makeDrawing({path, path, outside}, {{0, 0.5f, nullptr, 0}}), nullptr);
}

TEST_F(CanvasTest, EditedDrawingsLookAsIfMadeAnew) {
  makeCanvas(128);
  std::vector<TestPath> shapes;
  for (uint32_t seed = 0; seed < 6; ++seed) {
    shapes.push_back(randomShape(seed, 128));
    shapes.back().color = {0.2f * static_cast<float>(seed), 0.5f, 1 - 0.2f * static_cast<float>(seed), 0.7f};
  }
  std::vector<GpgpPath> paths;
  for (const TestPath& shape : shapes) paths.push_back(shape.view());
  for (size_t i = 3; i < 5; ++i) paths[i].group = 1;
  const TestPath clipShape = randomShape(77, 128);
  const GpgpPath clipPath = clipShape.view();
  const std::vector<GpgpPathGroup> groups = {{0, 0.5f, &clipPath, 1}};
  GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
  info.paths = paths.data();
  info.pathCount = static_cast<uint32_t>(paths.size());
  info.groups = groups.data();
  info.groupCount = 1;
  info.editable = VK_TRUE;
  GpgpAsset drawing = nullptr;
  ASSERT_EQ(gpgpCreateDrawing(context, &info, &drawing), GPGP_SUCCESS) << lastMessage();
  std::vector<TestPath> moving;
  for (uint32_t frame = 0; frame < 4; ++frame) moving.push_back(randomShape(100 + frame, 128));
  for (uint32_t frame = 0; frame < 4; ++frame) { // a path that changes every frame, each drawing made from the last one
    const uint32_t index = frame == 3 ? 0 : 4;
    const uint32_t group = paths[index].group;
    paths[index] = moving[frame].view();
    paths[index].group = group;
    GpgpDrawingCreateInfo edited = GPGP_DRAWING_CREATE_INFO_INIT;
    const GpgpPathEdit edit{index, paths[index]};
    edited.base = drawing;
    edited.edits = &edit;
    edited.editCount = 1;
    edited.editable = VK_TRUE;
    GpgpAsset next = nullptr;
    ASSERT_EQ(gpgpCreateDrawing(context, &edited, &next), GPGP_SUCCESS) << lastMessage();
    gpgpDestroyAsset(drawing);
    drawing = next;
    const auto seen = raster({place(drawing)}, 128, 128, 16);
    const auto anew = raster({place(makeDrawing(paths, groups))}, 128, 128, 16);
    ASSERT_EQ(std::memcmp(seen.data(), anew.data(), seen.size() * sizeof(Rgba)), 0) << "frame " << frame;
  }
  const auto refused = [&](GpgpDrawingCreateInfo wrong, GpgpResult code, const char* words) {
    GpgpAsset none = nullptr;
    EXPECT_EQ(gpgpCreateDrawing(context, &wrong, &none), code);
    EXPECT_EQ(none, nullptr);
    EXPECT_NE(lastMessage().find(words), std::string::npos) << lastMessage();
  };
  GpgpDrawingCreateInfo wrong = GPGP_DRAWING_CREATE_INFO_INIT;
  const GpgpPathEdit beyond{6, paths[0]};
  wrong.base = drawing;
  wrong.edits = &beyond;
  wrong.editCount = 1;
  refused(wrong, GPGP_ERROR_INVALID_ARGUMENT, "edits[0].index is 6; the drawing has 6 paths");
  wrong.paths = paths.data();
  refused(wrong, GPGP_ERROR_INVALID_ARGUMENT, "exactly one of data, filePath, paths and base");
  wrong.base = nullptr;
  refused(wrong, GPGP_ERROR_INVALID_ARGUMENT, "editCount is 1 without edits or without base");
  wrong.paths = nullptr;
  wrong.base = makeDrawing(paths, groups);
  refused(wrong, GPGP_ERROR_INVALID_ARGUMENT, "base was not made editable");
}

TEST_F(CanvasTest, BlendsAsSrgbEncodesWhereAsked) {
  makeCanvas(64);
  TestPath white;
  white.move(0, 0).line(64, 0).line(64, 64).line(0, 64).close();
  white.color = {1, 1, 1, 0.5f};
  TestPath black = white;
  black.color = {0, 0, 0, 1};
  const GpgpAsset drawing = makeDrawing({black.view(), white.view()});
  blendSrgb = true;
  EXPECT_NEAR(raster({place(drawing)}, 64, 64, 4)[100].r, host::linearFromSrgb(0.5f), 0.001f);
  blendSrgb = false;
  EXPECT_NEAR(raster({place(drawing)}, 64, 64, 4)[100].r, 0.5f, 0.001f);
}

// Stops and shapes brighter than white, in either way of mixing; an edge mixes them with what lies behind.
TEST_F(CanvasTest, ColorsBrighterThanWhiteReachFloatTargets) {
  makeCanvas(64);
  GpgpGradientStop stops[] = {{0, {8, 2, 0, 1}}, {1, {0, 2, 1000, 0.5f}}};
  GpgpGradient gradient{};
  gradient.transform[0] = gradient.transform[3] = 32;
  gradient.end[0] = 1;
  gradient.stops = stops;
  gradient.stopCount = 2;
  TestPath square;
  square.move(0, 0).line(32, 0).line(32, 32).line(0, 32).close();
  GpgpPath view = square.view();
  view.gradient = &gradient;
  const GpgpAsset drawing = makeDrawing({view});
  TestList list(context);
  list.add(rectangle(0, 0, 16.5f, 32, {10000, 4, 0.5f, 1}));
  for (const bool encoded : {false, true}) {
    blendSrgb = encoded;
    const auto shapes = raster({list.item()}, 32, 32, 4), ramp = raster({place(drawing)}, 32, 32, 4);
    EXPECT_NEAR(shapes[5].r, 10000, 10);
    EXPECT_NEAR(shapes[5].g, 4, 0.01);
    EXPECT_NEAR(shapes[5].b, 0.5, 0.001);
    EXPECT_EQ(shapes[5].a, 1);
    EXPECT_EQ(shapes[16].a, 0.5f);
    EXPECT_NEAR(shapes[16].g, 2, 0.01);
    for (uint32_t x = 0; x < 32; ++x) { // stops mix as light
      const float t = (static_cast<float>(x) + 0.5f) / 32, a = 1 - t / 2;
      EXPECT_NEAR(ramp[x].r, (1 - t) * 8 * a, 0.02f) << x;
      EXPECT_NEAR(ramp[x].g, 2 * a, 0.01f) << x;
      EXPECT_NEAR(ramp[x].b, t * 1000 * a, 2) << x;
    }
  }
  gradient.interpolateSrgb = VK_TRUE;
  stops[1].color[2] = 0;
  const auto mixed = raster({place(makeDrawing({view}))}, 32, 32, 4);
  EXPECT_GT(mixed[1].r, 6);
  EXPECT_NEAR(mixed[16].g / mixed[16].a, 2, 0.01f);
  for (const float bad : {-0.01f, 10001.0f, std::numeric_limits<float>::infinity()}) {
    stops[0].color[1] = bad;
    GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    info.paths = &view;
    info.pathCount = 1;
    GpgpAsset none = nullptr;
    EXPECT_EQ(gpgpCreateDrawing(context, &info, &none), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(lastMessage().find("gradient.stops[0].color"), std::string::npos) << lastMessage();
    const GpgpListShape shape = rectangle(0, 0, 4, 4, {0, bad, 0, 1});
    EXPECT_EQ(gpgpAddShapes(list.list, &shape, 1), GPGP_ERROR_INVALID_ARGUMENT);
  }
}

TEST_F(CanvasTest, BadArgumentsAreRefusedWithWords) {
  canvasTargets = 0;
  makeCanvas(64);
  TestPath square;
  square.move(1, 1).line(4, 1).line(4, 3).close();
  const GpgpAsset drawing = makeDrawing({square.view()});
  const GpgpHistory view = makeView(64, 64);
  GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer commands) {
    const GpgpCanvasItem good = place(drawing);
    GpgpCanvasItem item = good;
    GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
    const auto reset = [&] {
      item = good;
      info = GPGP_CANVAS_INFO_INIT;
      info.width = info.height = 32;
      info.items = &item;
      info.itemCount = 1;
      info.history = view;
    };
    const auto expect = [&](GpgpResult result, const char* words) {
      messages.clear();
      EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), result) << words;
      if (result < 0) {
        EXPECT_NE(lastMessage().find(words), std::string::npos) << lastMessage();
      }
      reset();
    };
    reset();
    expect(GPGP_NOT_READY, "");
    ASSERT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
    expect(GPGP_SUCCESS, "");
    info.sType = 7, expect(GPGP_ERROR_INVALID_STRUCT, "sType");
    info.width = 0, expect(GPGP_ERROR_INVALID_ARGUMENT, "0 x 32");
    info.width = 65, expect(GPGP_ERROR_INVALID_ARGUMENT, "65 x 32");
    info.samples = 3, expect(GPGP_ERROR_INVALID_ARGUMENT, "samples");
    info.history = nullptr, expect(GPGP_ERROR_INVALID_ARGUMENT, "neither history nor target");
    info.items = nullptr, expect(GPGP_ERROR_INVALID_ARGUMENT, "items is NULL");
    info.itemCount = 65, expect(GPGP_ERROR_INVALID_ARGUMENT, "itemCount");
    item.opacity = 2, expect(GPGP_ERROR_INVALID_ARGUMENT, "opacity");
    item.transform[3] = NAN, expect(GPGP_ERROR_INVALID_ARGUMENT, "transform");
    item.perspective[1] = INFINITY, expect(GPGP_ERROR_INVALID_ARGUMENT, "perspective");
    item.perspective[1] = 3e38f, expect(GPGP_SUCCESS, "");
    item.drawing = nullptr, expect(GPGP_ERROR_INVALID_HANDLE, "drawing");
    info.background[1] = INFINITY, expect(GPGP_ERROR_INVALID_ARGUMENT, "background");
    EXPECT_EQ(gpgpRecordPrepareCanvas(nullptr, commands, &frame, &info), GPGP_ERROR_INVALID_HANDLE);
  });
  GpgpDrawingCreateInfo none = GPGP_DRAWING_CREATE_INFO_INIT;
  GpgpAsset asset = nullptr;
  EXPECT_EQ(gpgpCreateDrawing(context, &none, &asset), GPGP_ERROR_INVALID_ARGUMENT);
  none.data = "nonsense";
  none.size = 8;
  EXPECT_EQ(gpgpCreateDrawing(context, &none, &asset), GPGP_ERROR_INVALID_DATA);
  EXPECT_EQ(asset, nullptr);
}

TEST_F(CanvasTest, ABakedDrawingIsReadOutOfAMappedFile) {
  const TestPath shape = randomShape(3, 64);
  const GpgpPath view = shape.view();
  const auto converted = vector::makeDrawing(std::span(&view, 1), std::pmr::get_default_resource());
  ASSERT_TRUE(converted);
  const auto baked = vector::bake(*converted, std::pmr::get_default_resource());
  struct File {
    std::FILE* file = std::tmpfile();
    ~File() { std::fclose(file); }
  } file;
  ASSERT_TRUE(file.file);
  ASSERT_EQ(std::fputc('x', file.file), 'x'); // what follows is not aligned
  ASSERT_EQ(std::fwrite(baked.data(), 1, baked.size(), file.file), baked.size());
  ASSERT_EQ(std::fflush(file.file), 0);
  void* mapped = mmap(nullptr, baked.size() + 1, PROT_READ, MAP_PRIVATE, fileno(file.file), 0);
  ASSERT_NE(mapped, MAP_FAILED);
  GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
  info.data = static_cast<const char*>(mapped) + 1;
  info.size = baked.size();
  GpgpAsset drawing = nullptr;
  const GpgpResult result = gpgpCreateDrawing(context, &info, &drawing);
  munmap(mapped, baked.size() + 1); // before it is uploaded
  ASSERT_EQ(result, GPGP_SUCCESS) << lastMessage();
  makeCanvas(64);
  const auto pixels = raster({place(drawing)}, 64, 64, 16), expected = raster({place(makeDrawing({view}))}, 64, 64, 16);
  ASSERT_EQ(pixels.size(), expected.size());
  EXPECT_EQ(std::memcmp(pixels.data(), expected.data(), pixels.size() * sizeof(Rgba)), 0);
  const auto inked = std::count_if(pixels.begin(), pixels.end(), [](const Rgba& p) { return p.a > 0; });
  EXPECT_GT(inked, 100);
}

struct RealDrawing : CanvasTest, testing::WithParamInterface<const char*> {};

TEST_P(RealDrawing, LooksLikeTheReferenceOf256Samples) {
  const auto svg = fetchedSvg(GetParam());
  if (!svg) GTEST_SKIP() << GetParam() << " is not there";
  const vector::svg::ImportedViews views(*svg);
  ASSERT_GT(views.paths.size(), 5u);
  const uint32_t size = 256;
  const float s = std::min(float(size) / float(svg->width), float(size) / float(svg->height));
  GpgpCanvasItem item = place(nullptr, s);
  makeCanvas(size, 0, 1u << 18);
  item.drawing = makeDrawing(views.paths, views.groups);
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  const auto pixels = raster({item}, size, size, 16, &report);
  EXPECT_EQ(report.pathsDropped, 0u);
  const float nothing[4] = {};
  const std::vector<float> expected =
      cli::vectorReference(views.paths, views.groups, item.transform, nothing, size, size);
  const auto psnr = [&expected](const std::vector<Rgba>& picture) {
    return cli::psnrOverWhite(std::span(&picture[0].r, picture.size() * 4), expected);
  };
  const double db = psnr(pixels);
  RecordProperty("psnr_centibel", static_cast<int>(db * 10));
  std::printf("%s: %.1f dB, %zu paths, %u entries\n", GetParam(), db, views.paths.size(), report.tileEntries);
  EXPECT_GE(db, 38.0);
  exactArea = true;
  const double areaDb = psnr(raster({item}, size, size, 16));
  std::printf("%s: %.1f dB with the area of first edges\n", GetParam(), areaDb);
  EXPECT_GE(areaDb, 42.0);
  if (const char* folder = std::getenv("GPGP_TEST_PICTURES")) {
    const std::string base = std::string(folder) + "/" + std::filesystem::path(GetParam()).stem().string();
    host::writePng(base + ".gpu.png",
                   host::fromLinearPremultiplied(size, size, std::span(&pixels[0].r, pixels.size() * 4)));
    host::writePng(base + ".reference.png", host::fromLinearPremultiplied(size, size, expected));
  }
}
INSTANTIATE_TEST_SUITE_P(Svg, RealDrawing,
                         testing::Values("svg/hud.svg", "svg/clips.svg", "fetched/svg/tiger.svgz",
                                         "fetched/svg/car.svgz", "fetched/svg/gallardo.svgz"));

} // namespace
