// Glyph sets and text items: against the same glyphs as drawings and against the CPU reference bit for bit, small sizes
// against FreeType's rasteriser, uploads, eviction, budgets, baked glyphs, bad arguments.
#include "canvas_fixture.h"
#include "host/picture.h"
#include "vector/place/placement.h"

#include <bit>
#include <cstdlib>
#include <filesystem>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

namespace {
using namespace gpgp;
using namespace gpgp::test;

/// Something with curves and corners within an em, differently for each seed.
TestPath glyphShape(uint32_t seed) {
  TestPath path = randomShape(seed, 1);
  path.rule = seed % 2 ? GPGP_FILL_EVEN_ODD : GPGP_FILL_NON_ZERO;
  return path;
}

/// Glyphs with one path each, that of glyphShape(key).
struct Shapes {
  std::vector<TestPath> shapes;
  std::vector<GpgpPath> paths;
  std::vector<GpgpGlyph> glyphs;
  Shapes(uint32_t first, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) shapes.push_back(glyphShape(first + i));
    for (const TestPath& shape : shapes) paths.push_back(shape.view());
    for (uint32_t i = 0; i < count; ++i) glyphs.push_back({first + i, &paths[i], 1, nullptr});
  }
  uint32_t count() const { return static_cast<uint32_t>(glyphs.size()); }
};

struct GlyphTest : CanvasTest {
  GpgpAsset makeSet(uint32_t maxGlyphs = 0, VkDeviceSize maxBytes = 0) {
    GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
    info.maxGlyphs = maxGlyphs;
    info.maxBytes = maxBytes;
    GpgpAsset set = nullptr;
    EXPECT_EQ(gpgpCreateGlyphSet(context, &info, &set), GPGP_SUCCESS) << lastMessage();
    return set;
  }
  /// A small canvas of many drawings.
  GpgpCanvasCreateInfo canvasOf(uint32_t drawings) const {
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
    info.maxWidth = info.maxHeight = 128;
    info.maxDrawings = drawings;
    info.targets = canvasTargets;
    return info;
  }
  std::vector<uint32_t> add(GpgpAsset set, const std::vector<GpgpGlyph>& glyphs, GpgpResult expected = GPGP_SUCCESS) {
    std::vector<uint32_t> indices(glyphs.size());
    EXPECT_EQ(gpgpAddGlyphs(set, glyphs.data(), static_cast<uint32_t>(glyphs.size()), indices.data()), expected)
        << lastMessage();
    return indices;
  }
  static GpgpGlyphSetInfo infoOf(GpgpAsset set) {
    GpgpGlyphSetInfo info = GPGP_GLYPH_SET_INFO_INIT;
    EXPECT_EQ(gpgpGetGlyphSetInfo(set, &info), GPGP_SUCCESS);
    return info;
  }
  static GpgpCanvasItem text(GpgpAsset set, const std::vector<GpgpGlyphInstance>& glyphs) {
    GpgpCanvasItem item{nullptr, {1, 0, 0, 1, 0, 0}, 1};
    item.glyphSet = set;
    item.glyphs = glyphs.data();
    item.glyphCount = static_cast<uint32_t>(glyphs.size());
    return item;
  }
  /// Records the item in a small canvas, after an upload or without one.
  GpgpResult recordAt(const GpgpFrame& frame, const GpgpCanvasItem& item, bool upload) {
    // As raster does: lavapipe minds what a descriptor set held before, also where no shader looks at it.
    const host::Image image(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = 32, .height = 32});
    GpgpResult result = GPGP_SUCCESS;
    device.submitAndWait([&](VkCommandBuffer commands) {
      if (upload) {
        EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      }
      GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
      info.width = info.height = 32;
      info.items = &item;
      info.itemCount = 1;
      info.target = image.target(
          {}, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL});
      result = gpgpRecordPrepareCanvas(canvas, commands, &frame, &info);
    });
    return result;
  }
  static bool same(const std::vector<Rgba>& a, const std::vector<Rgba>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgba)) == 0;
  }
};

TEST_F(GlyphTest, ATextEqualsItsGlyphsAsDrawings) {
  makeCanvas(128);
  // A glyph in the text's colour; one whose second path has a colour and an alpha of its own; a blank.
  std::vector<TestPath> shapes{glyphShape(1), glyphShape(2), glyphShape(3)};
  shapes[2].color = {0.125f, 0.75f, 0.5f, 0.5f};
  const std::vector<GpgpPath> paths[] = {{shapes[0].view()}, {shapes[1].view(), shapes[2].view()}};
  const VkBool32 foreground[] = {VK_TRUE, VK_FALSE};
  const GpgpAsset set = makeSet();
  const auto indices = add(set, {{7, paths[0].data(), 1, nullptr},
                                 {uint64_t(7) << 40, paths[1].data(), 2, foreground},
                                 {9, nullptr, 0, nullptr}});
  const float colors[][4] = {{1, 0, 0.3f, 1}, {0.1f, 0.2f, 0.9f, 0.5f}, {0.5f, 0.5f, 0, 0.25f}};
  GpgpAsset drawings[2][3] = {};
  for (size_t k = 0; k < 2; ++k)
    for (size_t c = 0; c < 3; ++c) {
      std::vector<GpgpPath> painted = paths[k];
      std::copy_n(colors[c], 4, painted[0].color);
      if (k == 1) painted[1].color[3] *= colors[c][3];
      drawings[k][c] = makeDrawing(painted);
    }
  TestPath triangle;
  triangle.move(20, 30).line(90, 40).line(60, 110).close();
  triangle.color = {0.5f, 0.25f, 1, 0.75f};
  const GpgpCanvasItem below = place(makeDrawing({triangle.view()})), above = place(below.drawing, 0.5f, 10, 10);

  std::mt19937 random(5);
  std::uniform_int_distribution<int> at(-40, 440);
  std::uniform_int_distribution<size_t> three(0, 2);
  std::vector<GpgpGlyphInstance> glyphs;
  std::vector<std::pair<size_t, size_t>> which;
  for (int i = 0; i < 60; ++i) {
    which.push_back({three(random), three(random)});
    GpgpGlyphInstance g{indices[which.back().first],
                        static_cast<float>(at(random)) / 4,
                        static_cast<float>(at(random)) / 4,
                        i % 3 ? 16.0f : 32.0f,
                        {}};
    std::copy_n(colors[which.back().second], 4, g.color);
    glyphs.push_back(g);
  }
  glyphs.push_back({GPGP_GLYPH_NONE, 0, 0, 100, {1, 1, 1, 1}});
  // Sums and products of these are exact, so that drawings can be given the same map.
  const float maps[][6] = {{1, 0, 0, 1, 0, 0}, {0, 0.5f, -0.5f, 0.25f, 90, 8}, {-1, 0.5f, 0, 2, 100, -60}};
  for (const auto& t : maps)
    for (const bool area : {false, true}) {
      exactArea = area;
      GpgpCanvasItem item = text(set, glyphs);
      item.opacity = 0.5f;
      std::copy_n(t, 6, item.transform);
      std::vector<GpgpCanvasItem> apart{below};
      for (size_t i = 0; i < which.size(); ++i) {
        const GpgpGlyphInstance& g = glyphs[i];
        if (which[i].first == 2) continue;
        const float x = t[0] * g.x + t[2] * g.y + t[4], y = t[1] * g.x + t[3] * g.y + t[5];
        apart.push_back({drawings[which[i].first][which[i].second],
                         {t[0] * g.size, t[1] * g.size, t[2] * g.size, t[3] * g.size, x, y},
                         0.5f});
      }
      apart.push_back(above);
      ASSERT_GT(apart.size(), 30u);
      GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
      ASSERT_TRUE(same(raster({below, item, above}, 128, 128, 16, &report), raster(apart, 128, 128, 16)))
          << "map " << &t - maps << ", area " << area;
      EXPECT_EQ(report.glyphs, apart.size() - 2);
      EXPECT_EQ(report.glyphsGiven, 1024u);
    }
}

/// Small glyphs take passes of their own on GPUs: alone, among others, cut by scissors and by the canvas.
TEST_F(GlyphTest, SmallGlyphsAreDrawnAsDrawingsAre) {
  GpgpCanvasCreateInfo info = canvasOf(160);
  canvas = recorder(gpgpCreateCanvas, info);
  const Shapes shapes(1, 3);
  const GpgpAsset set = makeSet();
  const auto indices = add(set, shapes.glyphs);
  GpgpAsset drawings[3];
  for (size_t k = 0; k < 3; ++k) {
    std::vector<GpgpPath> black{shapes.paths[k]};
    std::copy_n(std::array<float, 4>{0, 0, 0, 1}.data(), 4, black[0].color);
    drawings[k] = makeDrawing(black);
  }
  TestPath triangle;
  triangle.move(20, 30).line(90, 40).line(60, 110).close();
  triangle.color = {0.5f, 0.25f, 1, 0.75f};
  const GpgpCanvasItem other = place(makeDrawing({triangle.view()}));

  std::mt19937 random(11);
  std::uniform_int_distribution<int> at(-60, 560), size(2, 40);
  std::vector<GpgpGlyphInstance> glyphs;
  for (int i = 0; i < 150; ++i)
    glyphs.push_back({indices[static_cast<size_t>(i) % 3],
                      static_cast<float>(at(random)) / 4,
                      static_cast<float>(at(random)) / 4,
                      i % 10 ? static_cast<float>(size(random)) / 4 : 40.0f,
                      {0, 0, 0, 1}});
  // Sums and products of these are exact, so that drawings can be given the same map.
  const float maps[][6] = {{1, 0, 0, 1, 0, 0}, {0.5f, 0.5f, -0.5f, 0.5f, 64, 0}, {-2, 0.5f, 0, 2, 120, -60}};
  const float scissors[][4] = {{0, 0, 0, 0}, {30.5f, 20.25f, 90.75f, 100.5f}};
  for (const auto& t : maps)
    for (const auto& scissor : scissors)
      for (const bool large : {false, true})
        for (const uint32_t samples : {16u, 4u, 1u}) {
          exactArea = samples == 16;
          std::vector<GpgpGlyphInstance> some;
          for (const GpgpGlyphInstance& g : glyphs)
            if (large || g.size < 40) some.push_back(g);
          GpgpCanvasItem item = text(set, some);
          item.opacity = 0.5f;
          std::copy_n(t, 6, item.transform);
          std::copy_n(scissor, 4, item.scissor);
          std::vector<GpgpCanvasItem> apart;
          for (const GpgpGlyphInstance& g : some) {
            const auto which =
                static_cast<size_t>(std::find(indices.begin(), indices.end(), g.glyph) - indices.begin());
            apart.push_back({drawings[which],
                             {t[0] * g.size, t[1] * g.size, t[2] * g.size, t[3] * g.size,
                              t[0] * g.x + t[2] * g.y + t[4], t[1] * g.x + t[3] * g.y + t[5]},
                             0.5f});
            std::copy_n(scissor, 4, apart.back().scissor);
          }
          std::vector<GpgpCanvasItem> together{item};
          if (large) together.push_back(other), apart.push_back(other);
          ASSERT_TRUE(same(raster(together, 128, 128, samples), raster(apart, 128, 128, samples)))
              << "map " << &t - maps << ", scissor " << &scissor - scissors << ", large " << large << ", " << samples
              << " samples";
        }

  // Too few entries: those that are drawn are the first ones, whichever passes they take.
  const GpgpRecorder roomy = canvas;
  GpgpCanvasReport whole = GPGP_CANVAS_REPORT_INIT;
  raster({text(set, glyphs)}, 128, 128, 16, &whole);
  ASSERT_EQ(whole.base.status, GPGP_SUCCESS);
  for (const uint32_t share : {8u, 4u, 2u}) {
    info.maxTileEntries = whole.tileEntries / share;
    canvas = recorder(gpgpCreateCanvas, info);
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    const auto pixels = raster({text(set, glyphs)}, 128, 128, 16, &report);
    EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
    EXPECT_GT(report.tileEntries, report.tileEntriesGiven);
    EXPECT_EQ(report.tileEntriesGiven, info.maxTileEntries);
    ASSERT_GT(report.pathsDropped, 0u);
    ASSERT_LT(report.pathsDropped, 150u);
    canvas = roomy;
    const std::vector<GpgpGlyphInstance> first(glyphs.begin(), glyphs.end() - report.pathsDropped);
    ASSERT_TRUE(same(pixels, raster({text(set, first)}, 128, 128, 16))) << share;
  }
}

/// More small glyphs over one tile than its list has room for, in an order that shows, translucent and opaque.
TEST_F(GlyphTest, SmallGlyphsMayLieOnTopOfEachOther) {
  canvas = recorder(gpgpCreateCanvas, canvasOf(256));
  const Shapes shapes(1, 3);
  const GpgpAsset set = makeSet();
  const auto indices = add(set, shapes.glyphs);
  const float colors[3][4] = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  GpgpAsset drawings[3];
  for (size_t k = 0; k < 3; ++k) {
    std::vector<GpgpPath> painted{shapes.paths[k]};
    std::copy_n(colors[k], 4, painted[0].color);
    drawings[k] = makeDrawing(painted);
  }
  std::mt19937 random(3);
  std::uniform_int_distribution<int> shift(-8, 8), at(0, 480);
  for (const uint32_t stacked : {14u, 16u, 20u, 200u})
    for (const float opacity : {0.125f, 1.0f})
      for (const bool area : {false, true}) {
        exactArea = area;
        std::vector<GpgpGlyphInstance> glyphs;
        std::vector<GpgpCanvasItem> apart;
        for (uint32_t i = 0; i < stacked + 40; ++i) { // in two heaps, and all over the canvas
          const size_t which = random() % 3;
          const bool alone = i % (stacked / 10 + 1) == 0 && i / (stacked / 10 + 1) < 40;
          GpgpGlyphInstance g{
              indices[which], static_cast<float>(at(random)) / 4, static_cast<float>(at(random)) / 4, 8, {}};
          if (!alone) g.x = 36 + static_cast<float>(shift(random)) / 4 + (i % 2 ? 60.0f : 0.0f);
          if (!alone) g.y = 50 + static_cast<float>(shift(random)) / 4;
          std::copy_n(colors[which], 4, g.color);
          glyphs.push_back(g);
          apart.push_back({drawings[which], {g.size, 0, 0, g.size, g.x, g.y}, opacity});
        }
        GpgpCanvasItem item = text(set, glyphs);
        item.opacity = opacity;
        const auto pixels = raster({item}, 128, 128, 16);
        ASSERT_TRUE(same(pixels, raster(apart, 128, 128, 16))) << stacked << ", " << opacity << ", area " << area;
        std::reverse(glyphs.begin(), glyphs.end());
        ASSERT_FALSE(same(pixels, raster({item}, 128, 128, 16))) << stacked;
      }
}

/// A glyph of three paths: in a linear gradient, in a radial one with a transform, in the text's colour.
struct PaintedGlyph {
  TestPath shapes[3] = {glyphShape(4), glyphShape(5), glyphShape(6)};
  GpgpGradientStop stops[2][3] = {{{0, {1, 0, 0, 1}}, {0.5f, {0, 1, 0, 0.5f}}, {1, {0, 0, 1, 1}}},
                                  {{0, {1, 1, 0, 1}}, {1, {0, 0.25f, 1, 0.25f}}, {}}};
  GpgpGradient gradients[2] = {{GPGP_GRADIENT_LINEAR,
                                GPGP_SPREAD_REFLECT,
                                {1, 0, 0, 1, 0, 0},
                                {0.1f, 0.2f},
                                {0.6f, 0.5f},
                                0,
                                0,
                                stops[0],
                                3,
                                VK_TRUE},
                               {GPGP_GRADIENT_RADIAL,
                                GPGP_SPREAD_PAD,
                                {0.8f, 0.3f, -0.2f, 1, 0.1f, 0},
                                {0.4f, 0.4f},
                                {0.5f, 0.5f},
                                0.05f,
                                0.5f,
                                stops[1],
                                2,
                                VK_FALSE}};
  VkBool32 foreground[3] = {VK_FALSE, VK_FALSE, VK_TRUE};
  std::vector<GpgpPath> paths;
  PaintedGlyph() {
    for (const TestPath& shape : shapes) paths.push_back(shape.view());
    for (size_t k = 0; k < 2; ++k) paths[k].gradient = &gradients[k];
    paths[1].color[3] = 0.75f;
  }
  PaintedGlyph(const PaintedGlyph&) = delete;
  GpgpGlyph glyph(uint64_t key) const { return {key, paths.data(), 3, foreground}; }
};

TEST_F(GlyphTest, GradientsGoWithTheirGlyphs) {
  makeCanvas(128);
  const PaintedGlyph painted;
  const Shapes plain(1, 5);
  std::vector<GpgpGlyph> glyphs = plain.glyphs; // before it and behind, of any size
  glyphs.insert(glyphs.begin() + 3, painted.glyph(77));
  glyphs.push_back(painted.glyph(78));
  const GpgpAsset set = makeSet();
  const auto indices = add(set, glyphs);
  uint64_t bytes = 0; // of what can be said without knowing outlines: 2 gradients, 5 stops, and what aligns them
  {
    const GpgpAsset one = makeSet(), none = makeSet();
    add(one, {painted.glyph(1)});
    PaintedGlyph flat;
    for (GpgpPath& path : flat.paths) path.gradient = nullptr;
    add(none, {flat.glyph(1)});
    bytes = infoOf(one).bytes - infoOf(none).bytes;
  }
  EXPECT_EQ(bytes, 2u * 64 + 5 * 32 + 48);
  GpgpGlyphSource source = GPGP_GLYPH_SOURCE_INIT;
  source.glyphs = glyphs.data();
  source.glyphCount = static_cast<uint32_t>(glyphs.size());
  GpgpBlob blob{};
  ASSERT_EQ(gpgpCompileGlyphs(&source, &blob), GPGP_SUCCESS);
  GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  info.data = blob.data;
  info.size = blob.size;
  GpgpAsset baked = nullptr;
  ASSERT_EQ(gpgpCreateGlyphSet(context, &info, &baked), GPGP_SUCCESS) << lastMessage();
  gpgpFreeBlob(&blob);
  const uint64_t keys[] = {77, 78};
  uint32_t found[2] = {};
  ASSERT_EQ(gpgpFindGlyphs(baked, keys, 2, found), GPGP_SUCCESS);

  // As a drawing in the place of each: the third path in the text's colour, all at its alpha.
  const float color[4] = {0.75f, 0.25f, 0.5f, 0.5f};
  std::vector<GpgpPath> coloured = painted.paths;
  std::copy_n(color, 4, coloured[2].color);
  for (size_t k = 0; k < 2; ++k) coloured[k].color[3] *= color[3];
  const GpgpAsset drawing = makeDrawing(coloured);
  const float maps[][9] = {{1, 0, 0, 1, 0, 0},
                           {0.83f, 0.61f, -0.57f, 0.8f, 30, -10},
                           {1, 0, 0, 1, 0, 0, 0.004f, 0.002f, 0.8f},
                           {0.9f, 0, 0, 1, -20, 0, 0.01f, 0, -0.2f}};
  const std::array<float, 3> places[] = {{8, 12, 60}, {40.3f, 50.7f, 33.3f}, {70, 20, 500}};
  for (const auto& t : maps)
    for (const bool area : {false, true}) {
      exactArea = area;
      std::vector<GpgpGlyphInstance> instances, fromBaked;
      std::vector<GpgpCanvasItem> apart;
      for (size_t i = 0; i < 3; ++i) {
        const auto [x, y, size] = places[i];
        instances.push_back({indices[i % 2 ? 6 : 3], x, y, size, {color[0], color[1], color[2], color[3]}});
        fromBaked.push_back(instances.back());
        fromBaked.back().glyph = found[i % 2];
        const vector::Map whole = vector::compose(vector::toMap(t, t + 6), {size, 0, 0, size, x, y});
        GpgpCanvasItem item = place(drawing);
        const double affine[] = {whole.a, whole.b, whole.c, whole.d, whole.e, whole.f};
        std::copy_n(affine, 6, item.transform);
        if (whole.projective())
          item.perspective[0] = static_cast<float>(whole.p), item.perspective[1] = static_cast<float>(whole.q),
          item.perspective[2] = static_cast<float>(whole.r);
        apart.push_back(item);
      }
      const auto placed = [&](GpgpAsset glyphSet, const std::vector<GpgpGlyphInstance>& which) {
        GpgpCanvasItem item = text(glyphSet, which);
        std::copy_n(t, 6, item.transform);
        std::copy_n(t + 6, 3, item.perspective);
        return item;
      };
      const auto shown = raster({placed(set, instances)}, 128, 128, 16), expected = raster(apart, 128, 128, 16);
      double sum = 0, ink = 0;
      for (size_t i = 0; i < shown.size(); ++i) { // maps are rounded apart: an edge may pass a sample on its other side
        const float a[] = {shown[i].r, shown[i].g, shown[i].b, shown[i].a};
        const float b[] = {expected[i].r, expected[i].g, expected[i].b, expected[i].a};
        for (int c = 0; c < 4; ++c) {
          ASSERT_NEAR(a[c], b[c], 0.08f) << i << ", map " << &t - maps;
          sum += std::abs(static_cast<double>(a[c]) - static_cast<double>(b[c]));
        }
        ink += static_cast<double>(b[3]);
      }
      EXPECT_LT(sum / static_cast<double>(shown.size()), 2e-4) << &t - maps;
      EXPECT_GT(ink, 100);
      EXPECT_TRUE(same(raster({placed(baked, fromBaked)}, 128, 128, 16), shown));
    }
}

TEST_F(GlyphTest, CoverageEqualsTheCpuReferenceForAffineAndProjectiveText) {
  makeCanvas(128);
  const Shapes shapes(10, 3);
  const GpgpAsset set = makeSet();
  const auto indices = add(set, shapes.glyphs);
  const float transforms[][9] = {{1, 0, 0, 1, 0, 0},
                                 {0.83f, 0.61f, -0.57f, 0.8f, 30, -10},
                                 {1, 0, 0, 1, 0, 0, 0.004f, 0.002f, 0.8f},
                                 {0.9f, 0, 0, 1, -20, 0, 0.01f, 0, -0.2f},
                                 {-0.9f, 0, 0, 0.4f, 30, 9, -0.01f, 0, 0.5f},
                                 {1, 0, 0.4f, 0.2f, 0, 3, 0.001f, -0.012f, 0.7f}};
  size_t covered = 0;
  for (const auto& t : transforms)
    for (uint32_t k = 0; k < 3; ++k)
      for (const uint32_t samples : {4u, 16u}) {
        const std::vector<GpgpGlyphInstance> glyphs{
            {indices[k], 3.3f + static_cast<float>(k), 11.1f, 51.7f + 13.3f * static_cast<float>(k), {1, 1, 1, 1}}};
        GpgpCanvasItem item = text(set, glyphs);
        std::copy_n(t, 6, item.transform);
        std::copy_n(t + 6, 3, item.perspective);
        shader::ItemRecord source{};
        ASSERT_TRUE(vector::placeItem(item, 100, 90, source));
        shader::PlacementRecord placement{};
        placement.x = glyphs[0].x, placement.y = glyphs[0].y, placement.size = glyphs[0].size;
        const auto drawing = vector::makeDrawing(std::span(&shapes.paths[k], 1), std::pmr::get_default_resource());
        ASSERT_TRUE(drawing);
        const CpuReference covers(*drawing, shader::placed(source, placement), 100, 90, samples);
        const auto pixels = raster({item}, 100, 90, samples);
        size_t different = 0;
        for (uint32_t i = 0; i < 100 * 90; ++i) {
          const uint32_t mask = covers.at(0, i % 100, i / 100).mask;
          covered += mask != 0;
          different += pixels[i].a != static_cast<float>(std::popcount(mask)) / static_cast<float>(samples);
        }
        EXPECT_EQ(different, 0u) << "transform " << &t - transforms << ", glyph " << k << ", samples " << samples;
      }
  EXPECT_GT(covered, 10000u);
}

TEST_F(GlyphTest, OnlyWhatIsNewIsUploadedAndWhatNeverRanAgain) {
  makeCanvas(64);
  const GpgpAsset set = makeSet(64, 1 << 20);
  const Shapes first(1, 20), second(21, 2);
  const auto a = add(set, first.glyphs);
  const VkDeviceSize before = infoOf(set).bytes;
  const std::vector<GpgpGlyphInstance> old{{a[0], 4, 4, 20, {1, 0, 0, 1}}};
  GpgpFrame frame = advance();
  EXPECT_EQ(recordAt(frame, text(set, old), false), GPGP_NOT_READY);
  EXPECT_EQ(recordAt(frame, text(set, old), true), GPGP_SUCCESS);
  const auto b = add(set, second.glyphs);
  const VkDeviceSize added = infoOf(set).bytes - before;
  const std::vector<GpgpGlyphInstance> fresh{{b[1], 4, 4, 20, {1, 0, 0, 1}}};
  EXPECT_EQ(recordAt(frame, text(set, fresh), false), GPGP_NOT_READY);
  EXPECT_EQ(recordAt(frame, text(set, old), false), GPGP_SUCCESS) << "glyphs that are there can be drawn";
  VkBool32 resident = VK_TRUE;
  ASSERT_EQ(gpgpGetResidency(set, &resident), GPGP_SUCCESS);
  EXPECT_FALSE(resident);
  frame = advance();
  VkDeviceSize pending = 0;
  { // recorded, never submitted
    host::FrameRing ring(device);
    const VkCommandBuffer commands = ring.begin();
    ASSERT_EQ(gpgpRecordUpload(context, commands, &frame, 16, &pending), GPGP_SUCCESS);
    EXPECT_EQ(pending + 16, added) << "only the new glyphs";
    ASSERT_EQ(gpgpRecordUpload(context, commands, &frame, 0, &pending), GPGP_SUCCESS);
    EXPECT_EQ(pending, 0u);
    ring.drop();
  }
  ASSERT_EQ(gpgpGetResidency(set, &resident), GPGP_SUCCESS);
  EXPECT_TRUE(resident);
  frame = advance();
  EXPECT_EQ(recordAt(frame, text(set, fresh), false), GPGP_NOT_READY) << "its upload never ran";
  EXPECT_EQ(recordAt(frame, text(set, old), false), GPGP_SUCCESS);
  EXPECT_EQ(recordAt(frame, text(set, fresh), true), GPGP_SUCCESS);
}

TEST_F(GlyphTest, WhatWasUsedLongestAgoMakesRoom) {
  makeCanvas(64);
  const Shapes shapes(1, 12);
  const GpgpAsset set = makeSet(8);
  const auto indices = add(set, {shapes.glyphs.begin(), shapes.glyphs.begin() + 8});
  const auto draw = [&](const std::vector<uint32_t>& which) {
    std::vector<GpgpGlyphInstance> glyphs;
    for (const uint32_t index : which) glyphs.push_back({index, 8, 8, 40, {1, 1, 1, 1}});
    return raster({text(set, glyphs)}, 64, 64, 16);
  };
  draw(indices);
  draw({indices[1], indices[3], indices[5], indices[6]});
  draw({indices[6], indices[3]});
  EXPECT_EQ(infoOf(set).evicted, 0u);
  // Six are in use at most until the last frame is safe; two of those used longest ago go, the first added first.
  const auto more = add(set, {shapes.glyphs[8], shapes.glyphs[9]});
  EXPECT_EQ(infoOf(set).evicted, 2u);
  std::vector<uint64_t> keys;
  for (uint64_t key = 1; key <= 12; ++key) keys.push_back(key);
  std::vector<uint32_t> found(12);
  EXPECT_EQ(gpgpFindGlyphs(set, keys.data(), 12, found.data()), GPGP_INCOMPLETE);
  for (size_t i = 0; i < 12; ++i) {
    const uint32_t expected = i == 0 || i == 2 || i > 9 ? uint32_t(GPGP_GLYPH_NONE) : i < 8 ? indices[i] : more[i - 8];
    EXPECT_EQ(found[i], expected) << "key " << keys[i];
  }
  // An index of what is gone is known as such, also where another glyph has its place.
  const std::vector<GpgpGlyphInstance> gone{{indices[3], 0, 0, 10, {}}, {indices[2], 0, 0, 10, {}}};
  const GpgpFrame frame = advance();
  EXPECT_EQ(recordAt(frame, text(set, gone), true), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("items[0].glyphs[1].glyph is not, or no longer, in the set"), std::string::npos)
      << lastMessage();
  // What took the places looks as it should, and so does what stayed.
  const GpgpAsset fresh = makeSet();
  const auto all = add(fresh, shapes.glyphs);
  for (size_t i = 1; i < 10; ++i) {
    if (i == 2) continue;
    const std::vector<GpgpGlyphInstance> own{{found[i], 8, 8, 40, {1, 1, 1, 1}}},
        other{{all[i], 8, 8, 40, {1, 1, 1, 1}}};
    ASSERT_TRUE(same(raster({text(set, own)}, 64, 64, 4), raster({text(fresh, other)}, 64, 64, 4)))
        << "key " << keys[i];
  }
}

TEST_F(GlyphTest, UnfinishedFramesKeepTheirGlyphs) {
  makeCanvas(64);
  const Shapes shapes(1, 6);
  const GpgpAsset set = makeSet(4);
  const auto indices = add(set, {shapes.glyphs.begin(), shapes.glyphs.begin() + 4});
  const std::vector<GpgpGlyphInstance> two{{indices[0], 0, 0, 30, {}}, {indices[2], 0, 0, 30, {}}};
  EXPECT_EQ(recordAt(advance(), text(set, two), true), GPGP_SUCCESS);
  EXPECT_EQ(recordAt(advance(), text(set, two), false), GPGP_SUCCESS);
  const GpgpFrame frame = advance(2); // the last one is under way: its two glyphs stay, the two others may go
  const auto added =
      add(set, {shapes.glyphs[4], shapes.glyphs[5], {77, &shapes.paths[0], 1, nullptr}}, GPGP_BUDGET_EXCEEDED);
  EXPECT_NE(added[0], uint32_t(GPGP_GLYPH_NONE));
  EXPECT_NE(added[1], uint32_t(GPGP_GLYPH_NONE));
  EXPECT_EQ(added[2], uint32_t(GPGP_GLYPH_NONE));
  GpgpGlyphSetInfo info = infoOf(set);
  EXPECT_EQ(info.evicted, 2u);
  EXPECT_EQ(info.glyphs, 4u);
  EXPECT_EQ(info.glyphsNeeded, 5u);
  EXPECT_EQ(recordAt(frame, text(set, two), true), GPGP_SUCCESS);
  advance();
  EXPECT_NE(add(set, {{77, &shapes.paths[0], 1, nullptr}})[0], uint32_t(GPGP_GLYPH_NONE));
  EXPECT_EQ(infoOf(set).evicted, 3u);
}

TEST_F(GlyphTest, WhatDoesNotFitIsReportedWithTheSizeThatWould) {
  makeCanvas(64);
  const Shapes shapes(1, 10);
  const GpgpAsset small = makeSet(0, 4096);
  const auto some = add(small, shapes.glyphs, GPGP_BUDGET_EXCEEDED);
  const GpgpGlyphSetInfo info = infoOf(small);
  EXPECT_LE(info.bytes, info.maxBytes);
  EXPECT_EQ(info.evicted, 0u);
  EXPECT_EQ(info.glyphsNeeded, 10u);
  size_t placed = 0;
  for (const uint32_t index : some) placed += index != GPGP_GLYPH_NONE;
  EXPECT_EQ(placed, info.glyphs);
  ASSERT_GT(placed, 0u);
  ASSERT_LT(placed, 10u);
  const GpgpAsset enough = makeSet(info.glyphsNeeded, info.bytesNeeded);
  const auto all = add(enough, shapes.glyphs);
  EXPECT_EQ(infoOf(enough).bytes, info.bytesNeeded);
  for (size_t i = 0; i < 10; ++i) { // those that found room are whole
    if (some[i] == GPGP_GLYPH_NONE) continue;
    const std::vector<GpgpGlyphInstance> a{{some[i], 8, 8, 40, {1, 1, 1, 1}}}, b{{all[i], 8, 8, 40, {1, 1, 1, 1}}};
    ASSERT_TRUE(same(raster({text(small, a)}, 64, 64, 4), raster({text(enough, b)}, 64, 64, 4))) << i;
  }
}

TEST_F(GlyphTest, ManyAdditionsAndEvictionsKeepTheSetWhole) {
  // A set that is always too small, against a list of what must be in it.
  makeCanvas(64);
  const GpgpAsset set = makeSet(24, 40000);
  std::mt19937 random(3);
  std::uniform_int_distribution<uint32_t> key(1, 90), count(1, 6);
  uint64_t evicted = 0;
  for (int round = 0; round < 60; ++round) {
    const Shapes shapes(key(random), count(random));
    const GpgpGlyphSetInfo before = infoOf(set);
    std::vector<uint32_t> there(shapes.count());
    std::vector<uint64_t> keys;
    for (const GpgpGlyph& glyph : shapes.glyphs) keys.push_back(glyph.key);
    gpgpFindGlyphs(set, keys.data(), shapes.count(), there.data());
    const auto indices = add(set, shapes.glyphs);
    const GpgpGlyphSetInfo info = infoOf(set);
    size_t fresh = 0;
    for (size_t i = 0; i < there.size(); ++i) {
      ASSERT_NE(indices[i], uint32_t(GPGP_GLYPH_NONE));
      if (there[i]) {
        ASSERT_EQ(indices[i], there[i]);
      }
      fresh += there[i] == GPGP_GLYPH_NONE;
    }
    ASSERT_EQ(info.glyphs, before.glyphs + fresh - (info.evicted - before.evicted));
    evicted = info.evicted;
    std::vector<GpgpGlyphInstance> glyphs;
    for (const uint32_t index : indices) glyphs.push_back({index, 2, 2, 28, {1, 1, 1, 1}});
    const GpgpFrame frame = advance();
    ASSERT_EQ(recordAt(frame, text(set, glyphs), true), GPGP_SUCCESS) << lastMessage();
    advance();
    if (round % 10 != 9) continue; // what is seen is what was asked for
    const GpgpAsset alone = makeSet();
    const auto own = add(alone, shapes.glyphs);
    std::vector<GpgpGlyphInstance> same2 = glyphs;
    for (size_t i = 0; i < same2.size(); ++i) same2[i].glyph = own[i];
    ASSERT_TRUE(same(raster({text(set, glyphs)}, 32, 32, 4), raster({text(alone, same2)}, 32, 32, 4))) << round;
  }
  EXPECT_GT(evicted, 50u);
}

TEST_F(GlyphTest, CanvasBudgetsLeaveOutWholeGlyphs) {
  std::vector<TestPath> shapes{glyphShape(4), glyphShape(5)};
  const std::vector<GpgpPath> paths{shapes[0].view(), shapes[1].view()};
  const GpgpAsset set = makeSet();
  const uint32_t glyph = add(set, {{1, paths.data(), 2, nullptr}})[0];
  std::vector<GpgpGlyphInstance> glyphs;
  for (int i = 0; i < 30; ++i)
    glyphs.push_back({glyph, static_cast<float>(i % 6) * 20, static_cast<float>(i / 6) * 24, 22, {0, 0, 0, 0.5f}});
  makeCanvas(128);
  GpgpCanvasReport whole = GPGP_CANVAS_REPORT_INIT;
  raster({text(set, glyphs)}, 128, 128, 4, &whole);
  EXPECT_EQ(whole.base.status, GPGP_SUCCESS);
  EXPECT_EQ(whole.glyphs, 30u);
  const GpgpRecorder roomy = canvas;
  const auto firstOnly = [&](size_t count) {
    canvas = roomy;
    return raster({text(set, {glyphs.begin(), glyphs.begin() + static_cast<long>(count)})}, 128, 128, 4);
  };
  GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
  info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
  info.maxWidth = info.maxHeight = 128;
  info.targets = canvasTargets;
  const auto check = [&](const char* what) {
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    const auto pixels = raster({text(set, glyphs)}, 128, 128, 4, &report);
    EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED) << what;
    EXPECT_EQ(report.glyphs, 30u) << what;
    EXPECT_EQ(report.paths, whole.paths) << what;
    EXPECT_EQ(report.pathsGiven, info.maxPaths ? info.maxPaths : 262144u) << what;
    EXPECT_GT(report.pathsDropped, 0u) << what;
    EXPECT_LT(report.pathsDropped, 60u) << what;
    ASSERT_EQ(report.pathsDropped % 2, 0u) << what;
    ASSERT_TRUE(same(pixels, firstOnly(30 - report.pathsDropped / 2))) << what;
  };
  // Budgets in turn, each odd enough to end within a glyph.
  const auto make = [&] { canvas = recorder(gpgpCreateCanvas, info); };
  info.maxGlyphs = 11;
  make();
  check("maxGlyphs");
  info.maxGlyphs = 0;
  for (uint32_t entries = whole.tileEntries / 2; entries < whole.tileEntries / 2 + 2; ++entries) {
    info.maxTileEntries = entries;
    make();
    check("maxTileEntries");
  }
  info.maxTileEntries = 0;
  info.maxPaths = whole.paths / 2 + 1;
  make();
  check("maxPaths");
  info.maxPaths = whole.paths;
  make();
  GpgpCanvasReport fits = GPGP_CANVAS_REPORT_INIT;
  raster({text(set, glyphs)}, 128, 128, 4, &fits);
  EXPECT_EQ(fits.base.status, GPGP_SUCCESS);
  info.maxPaths = 1; // nothing fits, which is reported as well
  make();
  GpgpCanvasReport none = GPGP_CANVAS_REPORT_INIT;
  raster({text(set, glyphs)}, 128, 128, 4, &none);
  EXPECT_EQ(none.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(none.pathsDropped, 60u);
  EXPECT_EQ(none.paths, whole.paths);
  EXPECT_EQ(none.glyphs, 30u);
}

TEST_F(GlyphTest, BakedGlyphsAreTheSameAndDamageIsFound) {
  const Shapes shapes(1, 7);
  const std::vector<GpgpPath> two{shapes.paths[0], shapes.paths[3]};
  const VkBool32 foreground[] = {VK_FALSE, VK_TRUE};
  std::vector<GpgpGlyph> glyphs = shapes.glyphs;
  glyphs.push_back({100, nullptr, 0, nullptr});
  glyphs.push_back({101, two.data(), 2, foreground});
  GpgpGlyphSource source = GPGP_GLYPH_SOURCE_INIT;
  source.glyphs = glyphs.data();
  source.glyphCount = static_cast<uint32_t>(glyphs.size());
  source.messageUserData = &messages;
  source.messageFn = [](void* user, const GpgpMessage* m) {
    static_cast<std::vector<std::string>*>(user)->push_back(m->text);
  };
  GpgpBlob blob{};
  ASSERT_EQ(gpgpCompileGlyphs(&source, &blob), GPGP_SUCCESS) << lastMessage();
  const auto load = [&](const void* data, size_t size, uint32_t maxGlyphs = 0, VkDeviceSize maxBytes = 0) {
    GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
    info.data = data;
    info.size = size;
    info.maxGlyphs = maxGlyphs;
    info.maxBytes = maxBytes;
    GpgpAsset set = nullptr;
    return std::pair(gpgpCreateGlyphSet(context, &info, &set), set);
  };
  const auto [result, baked] = load(blob.data, blob.size);
  ASSERT_EQ(result, GPGP_SUCCESS) << lastMessage();
  const GpgpGlyphSetInfo facts = infoOf(baked);
  EXPECT_EQ(facts.glyphs, glyphs.size());
  EXPECT_EQ(facts.bytes, facts.maxBytes);
  makeCanvas(128);
  const GpgpAsset live = makeSet();
  const auto own = add(live, glyphs);
  std::vector<GpgpGlyphInstance> a, b;
  for (size_t i = 0; i < glyphs.size(); ++i) {
    uint32_t index = 0;
    ASSERT_EQ(gpgpFindGlyphs(baked, &glyphs[i].key, 1, &index), GPGP_SUCCESS);
    a.push_back({index, static_cast<float>(i % 3) * 40, static_cast<float>(i / 3) * 40, 38, {0.2f, 0.4f, 0.9f, 1}});
    b.push_back(a.back());
    b.back().glyph = own[i];
  }
  EXPECT_TRUE(same(raster({text(baked, a)}, 128, 128, 16), raster({text(live, b)}, 128, 128, 16)));

  // Budgets beyond what is baked leave room to add; those below are refused with what is needed.
  EXPECT_EQ(load(blob.data, blob.size, 20, facts.bytes + 100000).first, GPGP_SUCCESS);
  EXPECT_EQ(load(blob.data, blob.size, 3, 0).first, GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("need maxGlyphs 9 and maxBytes " + std::to_string(facts.bytes)), std::string::npos)
      << lastMessage();
  EXPECT_EQ(load(blob.data, blob.size, 0, facts.bytes - 16).first, GPGP_ERROR_INVALID_ARGUMENT);
  for (size_t i = 0; i < blob.size; i += 1 + blob.size / 97) {
    std::vector<uint8_t> bytes(static_cast<uint8_t*>(blob.data), static_cast<uint8_t*>(blob.data) + blob.size);
    EXPECT_EQ(load(bytes.data(), i).first, GPGP_ERROR_INVALID_DATA) << "cut at " << i;
    bytes[i] ^= 4;
    EXPECT_EQ(load(bytes.data(), bytes.size()).first, GPGP_ERROR_INVALID_DATA) << "damaged at " << i;
  }
  gpgpFreeBlob(&blob);
  glyphs[2].key = 1;
  EXPECT_EQ(gpgpCompileGlyphs(&source, &blob), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(lastMessage(), "two glyphs have the key 1");
}

TEST_F(GlyphTest, BadArgumentsAreRefusedWithWords) {
  makeCanvas(64);
  const Shapes shapes(1, 2);
  const GpgpAsset set = makeSet();
  uint32_t indices[2] = {5, 5};
  const auto refused = [&](GpgpResult got, GpgpResult expected, const char* words) {
    EXPECT_EQ(got, expected) << words;
    EXPECT_NE(lastMessage().find(words), std::string::npos) << lastMessage();
  };
  std::vector<GpgpGlyph> glyphs = shapes.glyphs;
  const auto tryAdd = [&] { return gpgpAddGlyphs(set, glyphs.data(), 2, indices); };
  GpgpPath path = shapes.paths[1];
  glyphs[1].paths = &path;
  path.color[2] = 20000;
  refused(tryAdd(), GPGP_ERROR_INVALID_ARGUMENT, "glyphs[1].paths[0]: ");
  EXPECT_EQ(indices[0], 5u);
  EXPECT_EQ(infoOf(set).glyphs, 0u) << "nothing is added";
  path = shapes.paths[1];
  path.group = 1;
  refused(tryAdd(), GPGP_ERROR_UNSUPPORTED, "glyphs[1].paths[0] has an image or a group");
  glyphs[1].paths = nullptr;
  refused(tryAdd(), GPGP_ERROR_INVALID_ARGUMENT, "glyphs[1].paths is NULL");
  refused(gpgpAddGlyphs(set, nullptr, 2, indices), GPGP_ERROR_INVALID_ARGUMENT, "glyphs or indices is NULL");
  refused(gpgpFindGlyphs(set, nullptr, 2, indices), GPGP_ERROR_INVALID_ARGUMENT, "keys or indices is NULL");
  const GpgpAsset drawing = makeDrawing({shapes.paths[0]});
  refused(gpgpFindGlyphs(drawing, nullptr, 0, nullptr), GPGP_ERROR_INVALID_HANDLE, "glyphSet is a drawing");
  GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  GpgpAsset none = nullptr;
  info.data = "nonsense, but long enough to have a header";
  info.size = 40;
  refused(gpgpCreateGlyphSet(context, &info, &none), GPGP_ERROR_INVALID_DATA, "not baked glyphs");
  info.filePath = "both";
  refused(gpgpCreateGlyphSet(context, &info, &none), GPGP_ERROR_INVALID_ARGUMENT, "both data and filePath");
  info.data = nullptr;
  info.filePath = nullptr;
  info.maxGlyphs = 262145;
  refused(gpgpCreateGlyphSet(context, &info, &none), GPGP_ERROR_UNSUPPORTED, "262145 glyphs");
  EXPECT_EQ(none, nullptr);

  const uint32_t index = add(set, shapes.glyphs)[0];
  const GpgpFrame frame = advance();
  std::vector<GpgpGlyphInstance> one{{index, 1, 2, 10, {1, 1, 1, 1}}};
  EXPECT_EQ(recordAt(frame, text(set, one), true), GPGP_SUCCESS);
  const auto wrong = [&](auto change, const char* words) {
    GpgpCanvasItem item = text(set, one);
    std::vector<GpgpGlyphInstance> glyph = one;
    item.glyphs = glyph.data();
    change(item, glyph[0]);
    refused(recordAt(frame, item, false), GPGP_ERROR_INVALID_ARGUMENT, words);
  };
  using Item = GpgpCanvasItem;
  using Glyph = GpgpGlyphInstance;
  wrong([&](Item& item, Glyph&) { item.drawing = drawing; }, "items[0]: both drawing and glyphSet");
  wrong([](Item& item, Glyph&) { item.glyphs = nullptr; }, "items[0].glyphs is NULL");
  wrong([](Item&, Glyph& glyph) { glyph.glyph = 12345678; }, "items[0].glyphs[0].glyph is not");
  wrong([](Item&, Glyph& glyph) { glyph.x = NAN; }, "items[0].glyphs[0]: x, y or size");
  wrong([](Item&, Glyph& glyph) { glyph.size = -1; }, "items[0].glyphs[0]: x, y or size");
  wrong([](Item&, Glyph& glyph) { glyph.color[3] = 1.5f; }, "items[0].glyphs[0].color");
  GpgpCanvasItem item = text(drawing, one);
  EXPECT_EQ(recordAt(frame, item, false), GPGP_ERROR_INVALID_HANDLE);
  for (const float huge : {1e30f, 3e38f}) { // covers nothing, as a drawing's would
    item = text(set, one);
    item.transform[0] = huge;
    EXPECT_EQ(recordAt(advance(), item, false), GPGP_SUCCESS) << lastMessage();
  }
}

/// A font's glyph as a path in em units, and as FreeType draws it.
struct Font {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  explicit Font(const std::string& file) {
    if (FT_Init_FreeType(&library) || FT_New_Face(library, file.c_str(), 0, &face)) face = nullptr;
  }
  ~Font() {
    FT_Done_Face(face);
    FT_Done_FreeType(library);
  }
  Font(const Font&) = delete;
  TestPath outline(FT_UInt glyph) const {
    struct Sink {
      TestPath path;
      float scale;
      float x(const FT_Vector* v) const { return static_cast<float>(v->x) * scale; }
      float y(const FT_Vector* v) const { return -static_cast<float>(v->y) * scale; }
    } sink{{}, 1.0f / static_cast<float>(face->units_per_EM)};
    FT_Load_Glyph(face, glyph, FT_LOAD_NO_SCALE);
    FT_Outline_Funcs functions{};
    functions.move_to = [](const FT_Vector* a, void* user) {
      Sink& s = *static_cast<Sink*>(user);
      s.path.move(s.x(a), s.y(a));
      return 0;
    };
    functions.line_to = [](const FT_Vector* a, void* user) {
      Sink& s = *static_cast<Sink*>(user);
      s.path.line(s.x(a), s.y(a));
      return 0;
    };
    functions.conic_to = [](const FT_Vector* a, const FT_Vector* b, void* user) {
      Sink& s = *static_cast<Sink*>(user);
      s.path.quad(s.x(a), s.y(a), s.x(b), s.y(b));
      return 0;
    };
    functions.cubic_to = [](const FT_Vector* a, const FT_Vector* b, const FT_Vector* c, void* user) {
      Sink& s = *static_cast<Sink*>(user);
      s.path.cubic(s.x(a), s.y(a), s.x(b), s.y(b), s.x(c), s.y(c));
      return 0;
    };
    FT_Outline_Decompose(&face->glyph->outline, &functions, &sink);
    return sink.path;
  }
  /// Onto a picture of a byte a pixel, its 0, 0 at x, y in 1/64 of a pixel.
  void draw(FT_UInt glyph, uint32_t size, int x, int y, uint32_t width, uint32_t height, uint8_t* pixels) const {
    FT_Set_Pixel_Sizes(face, 0, size);
    FT_Load_Glyph(face, glyph, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP);
    FT_Outline_Translate(&face->glyph->outline, x, static_cast<int>(height) * 64 - y);
    FT_Bitmap bitmap{};
    bitmap.width = width;
    bitmap.rows = height;
    bitmap.pitch = static_cast<int>(width);
    bitmap.buffer = pixels;
    bitmap.num_grays = 256;
    bitmap.pixel_mode = FT_PIXEL_MODE_GRAY;
    FT_Outline_Get_Bitmap(library, &face->glyph->outline, &bitmap);
  }
};

/// Adds what a glyph covers of each pixel, exact along x, in so many rows a pixel.
void cover(const PathOracle& path, const GpgpGlyphInstance& at, uint32_t rows, uint32_t width, uint32_t height,
           std::vector<double>& pixels) {
  const double x = static_cast<double>(at.x), y = static_cast<double>(at.y), size = static_cast<double>(at.size);
  const auto first = static_cast<uint32_t>(std::max(0., std::floor(y + path.top * size)));
  const uint32_t end = std::min(height, static_cast<uint32_t>(std::ceil(y + path.bottom * size)));
  for (uint32_t row = first * rows; row < end * rows; ++row) {
    int winding = 0;
    double from = 0;
    for (const auto& [crossing, direction] : path.crossings(((row + 0.5) / rows - y) / size)) {
      const double to = x + crossing * size;
      if (winding == 0) from = to;
      winding += direction;
      if (winding != 0) continue;
      for (auto column = static_cast<uint32_t>(from); column < to && column < width; ++column)
        pixels[size_t(row / rows) * width + column] +=
            255. / rows * (std::min(to, column + 1.) - std::max(from, static_cast<double>(column)));
    }
  }
}

struct SmallText : GlyphTest, testing::WithParamInterface<const char*> {};

TEST_P(SmallText, CoversWhatFreeTypeCovers) {
  const std::string file = std::string(GPGP_TEST_DATA) + "/fetched/fonts/" + GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there: run tests/data/fetch.sh --only fonts";
  const Font font(file);
  ASSERT_NE(font.face, nullptr);
  // All of ASCII, each glyph in a cell of its own and at a place of its own in the pixel.
  std::vector<TestPath> outlines;
  std::vector<FT_UInt> ids;
  for (char c = '!'; c <= '~'; ++c) {
    ids.push_back(FT_Get_Char_Index(font.face, static_cast<FT_ULong>(c)));
    outlines.push_back(font.outline(ids.back()));
  }
  std::vector<GpgpPath> paths;
  std::vector<GpgpGlyph> glyphs;
  paths.reserve(ids.size());
  for (size_t i = 0; i < ids.size(); ++i) {
    paths.push_back(outlines[i].view());
    glyphs.push_back({ids[i], &paths.back(), 1, nullptr});
  }
  const GpgpAsset set = makeSet();
  const auto indices = add(set, glyphs);
  makeCanvas(512);
  std::vector<PathOracle> oracles;
  std::vector<bool> straight; // lines only, as A and H
  for (const GpgpPath& path : paths) {
    oracles.emplace_back(path);
    straight.push_back(std::all_of(path.verbs, path.verbs + path.verbCount, [](GpgpPathVerb verb) {
      return verb != GPGP_PATH_QUAD && verb != GPGP_PATH_CUBIC;
    }));
  }
  for (const uint32_t size : {8u, 9u, 10u, 12u, 16u}) {
    const uint32_t cell = 2 * size, width = 16 * cell, height = 6 * cell;
    // FreeType rounds points to 1/64 of a pixel, so once more sixteen times as large, and reduced: the same rasteriser,
    // on points that are as good as not rounded.
    constexpr uint32_t kFine = 16;
    std::vector<uint8_t> coarse(size_t(width) * height, 0), fine(coarse.size() * kFine * kFine, 0);
    std::vector<GpgpGlyphInstance> instances;
    for (uint32_t i = 0; i < ids.size(); ++i) {
      const uint32_t x = i % 16 * cell * 64 + cell * 16 + i * 23 % 64,
                     y = (i / 16 * cell + cell * 3 / 4) * 64 + i * 41 % 64;
      font.draw(ids[i], size, static_cast<int>(x), static_cast<int>(y), width, height, coarse.data());
      font.draw(ids[i], size * kFine, static_cast<int>(x * kFine), static_cast<int>(y * kFine), width * kFine,
                height * kFine, fine.data());
      instances.push_back(
          {indices[i], static_cast<float>(x) / 64, static_cast<float>(y) / 64, static_cast<float>(size), {0, 0, 0, 1}});
    }
    std::vector<double> finest(coarse.size(), 0), ofRows(coarse.size(), 0), ofCurves(coarse.size(), 0);
    for (size_t i = 0; i < fine.size(); ++i)
      finest[i / (size_t(width) * kFine) / kFine * width + i % (size_t(width) * kFine) / kFine] +=
          static_cast<double>(fine[i]) / (kFine * kFine);
    for (size_t i = 0; i < ids.size(); ++i) {
      cover(oracles[i], instances[i], 16, width, height, ofRows);
      cover(oracles[i], instances[i], 1024, width, height, ofCurves);
    }
    for (const bool area : {false, true}) {
      exactArea = area;
      const auto pixels = raster({text(set, instances)}, width, height, 16);
      // Mean differences of pixels with ink, of 255.
      double sum = 0, fromFreeType = 0, fromFine = 0, fromReference = 0, freeType = 0, reference = 0, fromRows = 0,
             rows = 0;
      size_t inked = 0, inkedStraight = 0;
      for (size_t i = 0; i < finest.size(); ++i) {
        const double seen = static_cast<double>(pixels[i].a) * 255, wanted = static_cast<double>(coarse[i]);
        if (seen == 0 && wanted == 0) continue;
        ++inked;
        sum += seen - wanted;
        fromFreeType += std::abs(seen - wanted);
        fromFine += std::abs(seen - finest[i]);
        fromReference += std::abs(seen - ofCurves[i]);
        if (const size_t glyph = i / width / cell * 16 + i % width / cell; glyph < ids.size() && straight[glyph]) {
          ++inkedStraight;
          fromRows += std::abs(seen - ofRows[i]);
          rows += std::abs(ofRows[i] - ofCurves[i]);
        }
        freeType += std::abs(wanted - ofCurves[i]);
        reference += std::abs(finest[i] - ofCurves[i]);
      }
      const double n = static_cast<double>(inked), m = static_cast<double>(inkedStraight);
      std::printf("%s, %u px%s: %zu pixels with ink; of coverage %.3f; mean difference from FreeType %.2f, with no "
                  "rounding %.2f, from the curves %.2f; FreeType's from the curves %.2f, with none %.2f; letters "
                  "without curves from 16 exact rows a pixel %.2f, such rows from the letters %.2f\n",
                  GetParam(), size, area ? ", area" : "", inked, sum / n, fromFreeType / n, fromFine / n,
                  fromReference / n, freeType / n, reference / n, fromRows / m, rows / m);
      EXPECT_GT(inked, ids.size() * size);
      EXPECT_GT(inkedStraight, inked / 8);
      EXPECT_LE(std::abs(sum) / n, 2.0) << size << ": as much ink as FreeType";
      EXPECT_LE(reference / n, 0.4) << size << ": the curves are what FreeType comes to without its rounding";
      if (area) {
        EXPECT_LE(fromFine / n, 1.5) << size << ": the pixels of FreeType's rasteriser where it does not round points";
        EXPECT_LE(fromReference / n, 1.5) << size << ": the pixels of the curves themselves";
        EXPECT_LT(fromReference, freeType) << size << ": nearer to the curves than FreeType at this size";
        EXPECT_LE(fromRows / m, 0.4) << size << ": without curves all that is off comes of 16 rows a pixel";
      }
      if (const char* folder = std::getenv("GPGP_TEST_PICTURES")) {
        std::vector<uint8_t> rgba;
        for (uint32_t y = 0; y < 2 * height; ++y)
          for (uint32_t x = 0; x < width; ++x) {
            const size_t at = size_t(y % height) * width + x;
            const auto level = static_cast<uint8_t>(
                255 -
                (y < height ? static_cast<int>(std::lround(static_cast<double>(pixels[at].a) * 255)) : coarse[at]));
            rgba.insert(rgba.end(), {level, level, level, 255});
          }
        host::writePng(std::string(folder) + "/text" + std::to_string(size) + (area ? "a.png" : ".png"),
                       {width, 2 * height, rgba});
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Fonts, SmallText,
                         testing::Values("DejaVuSans.ttf", "DejaVuSerif.ttf", "NotoSans-Regular.ttf",
                                         "Cantarell-Regular.otf", "NotoSansCJK-Regular.ttc"));

} // namespace
