// Lists: shapes against closed forms and against the same as paths, scissors and clips sample by sample, stacks, images
// and nine-slices.
#include "ui_fixture.h"

#include <bit>

namespace {
using namespace gpgp;
using namespace gpgp::test;

TEST_F(CanvasTest, ShapesCoverWhatTheirClosedFormsSay) {
  makeCanvas(128);
  const GpgpListShape box = rectangle(13.3f, 9.7f, 84.1f, 61.2f);
  const GpgpListShape shapes[] = {rounded(box, 20, 5, 0, 12),
                                  rounded(box, 20, 5, 0, 12, 6),
                                  rounded(box, 0, 0, 0, 0, 3.5f),
                                  rounded(box, 100, 100, 100, 100), // shrink to a capsule
                                  ellipse(box),
                                  ellipse(box, 7),
                                  line(20, 15, 80, 55, 9, GPGP_CAP_BUTT),
                                  line(80, 15, 20, 40, 14, GPGP_CAP_ROUND),
                                  line(20, 50, 75, 50, 5, GPGP_CAP_SQUARE)};
  TestList list(context);
  for (const auto& map : kMaps) {
    GpgpCanvasItem item = list.item();
    std::copy_n(map.data(), 6, item.transform);
    std::copy_n(map.data() + 6, 3, item.perspective);
    const vector::Map m = vector::toMap(item.transform, item.perspective);
    for (const GpgpListShape& from : shapes) {
      list.reset().add(from);
      GpgpListShape shape = from;
      if (shape.radii[0] == 100) std::fill_n(shape.radii, 4, 0.5f * (shape.box[3] - shape.box[1]));
      for (const bool area : {false, true}) {
        exactArea = area;
        const auto pixels = raster({item}, 100, 90, 16);
        double worst = 0, sum = 0;
        for (uint32_t y = 0; y < 90; ++y)
          for (uint32_t x = 0; x < 100; ++x) {
            int covered = 0;
            for (int k = 0; k < 256; ++k) { // through the inverse, by Cramer's rule
              const double px = x + (k % 16 + 0.5) / 16, py = y + (k / 16 + 0.5) / 16;
              const double a = m.a - m.p * px, c = m.c - m.q * px, e = m.r * px - m.e;
              const double b = m.b - m.p * py, d = m.d - m.q * py, f = m.r * py - m.f;
              const double u = (e * d - c * f) / (a * d - c * b), v = (a * f - e * b) / (a * d - c * b);
              if (m.p * u + m.q * v + m.r > 0) covered += inShape(shape, u, v);
            }
            const double difference = std::abs(static_cast<double>(pixels[y * 100 + x].a) - covered / 256.0);
            worst = std::max(worst, difference);
            sum += difference;
          }
        EXPECT_LE(worst, area ? 0.14 : 0.28) << &map - kMaps << ", shape " << &from - shapes;
        EXPECT_LE(sum / 9000, area ? 0.002 : 0.008) << &map - kMaps << ", shape " << &from - shapes;
      }
    }
  }
}

// A group of a list around its only drawing, which fades as the drawing's own group does.
TEST_F(CanvasTest, AListsGroupFadesItsOnlyDrawing) {
  makeCanvas(64);
  TestPath left, right;
  left.move(4, 4).line(40, 4).line(40, 60).line(4, 60).close();
  right.move(24, 4).line(60, 4).line(60, 60).line(24, 60).close();
  left.color = {1, 0, 0, 1};
  right.color = {0, 1, 0, 1};
  TestList list(context);
  list.group(0.5f).add(makeDrawing({left.view(), right.view()})).pop();
  const auto pixels = raster({list.item()}, 64, 64, 16);
  for (uint32_t x = 0; x < 64; ++x) {
    const Rgba& p = pixels[32 * 64 + x];
    EXPECT_NEAR(p.r, x >= 4 && x < 24 ? 0.5f : 0.0f, 0.001f) << x;
    EXPECT_NEAR(p.g, x >= 24 && x < 60 ? 0.5f : 0.0f, 0.001f) << x;
    EXPECT_NEAR(p.a, x >= 4 && x < 60 ? 0.5f : 0.0f, 0.001f) << x;
  }
}

// Each text in a glyph set of its own, all in one list.
TEST_F(CanvasTest, AListShowsAnyNumberOfGlyphSets) {
  makeCanvas(128);
  constexpr uint32_t kSets = 64;
  TestPath square;
  square.move(0, 0).line(1, 0).line(1, 1).line(0, 1).close();
  GpgpPath path = square.view();
  TestList list(context);
  std::vector<GpgpAsset> sets(kSets);
  for (uint32_t i = 0; i < kSets; ++i) {
    const float width = 1 + static_cast<float>(i % 7);
    for (size_t p = 0; p < square.points.size(); p += 2) square.points[p] = square.points[p] > 0 ? width : 0;
    path.points = square.points.data();
    const GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
    ASSERT_EQ(gpgpCreateGlyphSet(context, &info, &sets[i]), GPGP_SUCCESS);
    const VkBool32 foreground = VK_TRUE;
    const GpgpGlyph glyph{1, &path, 1, &foreground};
    uint32_t index = 0;
    ASSERT_EQ(gpgpAddGlyphs(sets[i], &glyph, 1, &index), GPGP_SUCCESS) << lastMessage();
    list.add(sets[i], {{index, float(i % 8 * 16), float(i / 8 * 16), 2, {1, 1, 1, 1}}});
  }
  const auto pixels = raster({list.item()}, 128, 128, 16);
  for (uint32_t y = 0; y < 128; ++y)
    for (uint32_t x = 0; x < 128; ++x) {
      const uint32_t set = y / 16 * 8 + x / 16;
      ASSERT_EQ(pixels[y * 128 + x].a, x % 16 < 2 * (1 + set % 7) && y % 16 < 2 ? 1.0f : 0.0f) << x << " " << y;
    }
  // One more than the canvas was made for.
  const GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  ASSERT_EQ(gpgpCreateGlyphSet(context, &info, &sets.emplace_back()), GPGP_SUCCESS);
  const VkBool32 foreground = VK_TRUE;
  const GpgpGlyph glyph{1, &path, 1, &foreground};
  uint32_t index = 0;
  ASSERT_EQ(gpgpAddGlyphs(sets.back(), &glyph, 1, &index), GPGP_SUCCESS) << lastMessage();
  list.add(sets.back(), {{index, 0, 64, 2, {1, 1, 1, 1}}});
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  const auto without = raster({list.item()}, 128, 128, 16, &report);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(report.pathsDropped, 1u);
  EXPECT_EQ(report.items, kSets + 1);
  EXPECT_EQ(report.itemsGiven, kSets);
  for (size_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(without[i].a, pixels[i].a) << i;
  for (const GpgpAsset set : sets) gpgpDestroyAsset(set);
}

// Tens of thousands of shapes in a small picture, of which dozens meet in each tile and thousands in one.
TEST_F(CanvasTest, DenseRecordsLoseNothing) {
  constexpr uint32_t kWidth = 256, kHeight = 192, kSquares = 40000, kDeep = 3000;
  std::vector<float> last(kWidth * kHeight);
  std::vector<GpgpListShape> shapes;
  for (uint32_t i = 0; i < kSquares; ++i) {
    const uint32_t x = i * 7 % 249, y = i * 13 % 189;
    const float left = static_cast<float>(x), top = static_cast<float>(y), shade = static_cast<float>(i % 31 + 1) / 32;
    shapes.push_back(rectangle(left, top, left + 3, top + 3, {shade, 0, 0, 1}));
    for (uint32_t k = 0; k < 9; ++k) last[(y + k / 3) * kWidth + x + k % 3] = shade;
  }
  shapes.resize(kSquares + kDeep, rectangle(250, 190, 254, 192, {0, 0, 0, 1.0f / 4096}));
  TestList list(context);
  ASSERT_EQ(gpgpAddShapes(list.list, shapes.data(), kSquares + kDeep), GPGP_SUCCESS);
  GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
  info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
  info.maxWidth = info.maxHeight = 256;
  info.maxShapes = kSquares + kDeep;
  info.maxTileEntries = 200000;
  info.targets = canvasTargets;
  ASSERT_EQ(gpgpCreateCanvas(context, &info, &canvas), GPGP_SUCCESS) << lastMessage();
  ASSERT_EQ(gpgpPrewarm(canvas, nullptr), GPGP_SUCCESS);
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  const auto pixels = raster({list.item()}, kWidth, kHeight, 4, &report);
  EXPECT_EQ(report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(report.pathsDropped, 0u);
  uint32_t wrong = 0;
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x)
      if (x < 250 || y < 190) wrong += pixels[y * kWidth + x].r != last[y * kWidth + x];
  EXPECT_EQ(wrong, 0u);
  EXPECT_NEAR(pixels[191 * kWidth + 252].a, 1 - std::pow(1 - 1.0 / 4096, kDeep), 2e-3);
}

TEST_F(CanvasTest, RectanglesEqualPathsAndAbutWithoutSeams) {
  makeCanvas(128);
  TestList list(context);
  for (const auto& map : kMaps) {
    const TestPath path = rectanglePath(13.25f, 9.75f, 84.125f, 61.5f);
    GpgpCanvasItem drawing = place(makeDrawing({path.view()}));
    std::copy_n(map.data(), 6, drawing.transform);
    std::copy_n(map.data() + 6, 3, drawing.perspective);
    list.reset().push(map).add(rectangle(13.25f, 9.75f, 84.125f, 61.5f)).pop();
    for (const bool area : {false, true}) {
      exactArea = area;
      EXPECT_TRUE(same(raster({list.item()}, 100, 90, 16), raster({drawing}, 100, 90, 16))) << &map - kMaps;
    }
  }
  // A chequered floor of one colour, turned: nothing of the background may show.
  for (const bool area : {false, true}) {
    exactArea = area;
    list.reset().push(turned(31, 1.37f, 64.2f, 33.3f));
    for (int i = -16; i < 16; ++i)
      for (int k = -16; k < 16; ++k) {
        const float x = static_cast<float>(i) * 5.3f, y = static_cast<float>(k) * 4.7f;
        list.add(rectangle(x, y, static_cast<float>(i + 1) * 5.3f, static_cast<float>(k + 1) * 4.7f));
      }
    const auto pixels = raster({list.pop().item()}, 96, 96, 16);
    for (size_t i = 0; i < pixels.size(); ++i) ASSERT_NEAR(pixels[i].a, 1, area ? 0.004 : 0) << i;
  }
}

TEST_F(CanvasTest, ScissorsCutSampleBySample) {
  makeCanvas(128);
  TestList list(context);
  const std::array<float, 4> boxes[] = {{17.3f, 11.6f, 71.8f, 60.4f},
                                        {-20, 8, 50.5f, 64}, // down to the edge of a tile
                                        {31.9f, -5, 200, 32.2f},
                                        {40.1f, 33.3f, 40.6f, 33.9f}}; // less than a pixel
  for (uint32_t seed = 0; seed < 3; ++seed) {
    const TestPath path = randomShape(seed + 20, 90);
    const GpgpPath view = path.view();
    const auto cpu = vector::makeDrawing(std::span(&view, 1), std::pmr::get_default_resource());
    const GpgpAsset drawing = makeDrawing({view});
    for (const auto& map : kMaps)
      for (const auto& box : boxes)
        for (const uint32_t samples : {4u, 16u}) {
          list.reset().clip(box).push(map).add(drawing).pop(2);
          const TestPath clipPath = rectanglePath(box[0], box[1], box[2], box[3]);
          const GpgpPath clip = clipPath.view();
          const auto clipCpuReference = vector::makeDrawing(std::span(&clip, 1), std::pmr::get_default_resource());
          shader::ItemRecord record{}, identity{};
          ASSERT_TRUE(vector::placeItem(vector::toMap(map.data(), map.data() + 6), 100, 90, record));
          ASSERT_TRUE(vector::placeItem(vector::Map{}, 100, 90, identity));
          const CpuReference covers(*cpu, record, 100, 90, samples),
              shows(*clipCpuReference, identity, 100, 90, samples);
          record.scissor = {box[0], box[1], box[2], box[3]};
          const CpuReference cut(*cpu, record, 100, 90, samples);
          for (const bool area : {false, true}) {
            exactArea = area;
            const auto pixels = raster({list.item()}, 100, 90, samples);
            for (uint32_t y = 0; y < 90; ++y)
              for (uint32_t x = 0; x < 100; ++x) {
                const uint32_t mask = covers.at(0, x, y).mask & shows.at(0, x, y).mask;
                ASSERT_EQ(cut.at(0, x, y).mask, mask) << x << " " << y;
                float expected = static_cast<float>(std::popcount(mask)) / static_cast<float>(samples);
                if (area)
                  expected = std::clamp(expected + static_cast<float>(cut.at(0, x, y).difference) /
                                                       static_cast<float>(256 * samples),
                                        0.0f, 1.0f);
                ASSERT_NEAR(pixels[y * 100 + x].a, expected, area ? 0.002f : 0)
                    << x << " " << y << ", map " << &map - kMaps << ", box " << &box - boxes << ", seed " << seed;
              }
          }
        }
  }
}

TEST_F(CanvasTest, ScissorsCutWhatReachesBeyondTheCanvas) {
  makeCanvas(128);
  TestList list(context);
  for (const std::array<float, 4>& box : {std::array{60.2f, 30.5f, 210.0f, 70.2f},
                                          {-90, 30.5f, 40.3f, 70.2f},
                                          {20.4f, -50, 60.6f, 61.7f},
                                          {20.4f, 41.3f, 60.6f, 300},
                                          {-50, -50, 150, 150}})
    for (const std::array<float, 4>& clip :
         {std::array{50.3f, 33.3f, 300.0f, 90.0f}, {10.1f, 20.7f, 55.5f, 63.1f}, {-100, 45.4f, 300, 50.9f}}) {
      const GpgpListShape inside = rectangle(std::max(box[0], clip[0]), std::max(box[1], clip[1]),
                                             std::max(std::min(box[2], clip[2]), std::max(box[0], clip[0])),
                                             std::max(std::min(box[3], clip[3]), std::max(box[1], clip[1])));
      list.reset().clip(clip).add(rectangle(box[0], box[1], box[2], box[3])).pop();
      const auto cut = raster({list.item()}, 100, 90, 16),
                 whole = raster({list.reset().add(inside).item()}, 100, 90, 16);
      EXPECT_TRUE(same(cut, whole)) << "box from " << box[0] << ", " << box[1] << ", clip from " << clip[0];
    }
}

TEST_F(CanvasTest, TurnedAndRoundClipsEqualClipsOfDrawings) {
  makeCanvas(128);
  TestList list(context);
  const TestPath shape = randomShape(7, 90);
  const TestPath box = rectanglePath(17.25f, 11.5f, 71.75f, 60.5f);
  GpgpPath path = shape.view();
  const GpgpPath clip = box.view();
  const GpgpAsset plain = makeDrawing({path});
  path.group = 1;
  const GpgpAsset clipped = makeDrawing({path}, {{0, 1, &clip, 1}});
  for (const auto& map : {kMaps[1], kMaps[4], kMaps[5], kMaps[6]}) {
    GpgpCanvasItem item = place(clipped);
    std::copy_n(map.data(), 6, item.transform);
    std::copy_n(map.data() + 6, 3, item.perspective);
    list.reset().push(map).clip({17.25f, 11.5f, 71.75f, 60.5f}).add(plain).pop(2);
    for (const bool area : {false, true}) {
      exactArea = area;
      EXPECT_TRUE(same(raster({list.item()}, 100, 90, 16), raster({item}, 100, 90, 16)));
    }
  }
  // Round, within another, within a scissor: what is left of a rectangle is the product of all.
  exactArea = false;
  const GpgpListShape round = rounded(rectangle(10, 10, 80, 80), 30, 10, 30, 0);
  const GpgpListShape turnedBox = rectangle(-30, -30, 30, 30);
  list.reset().add(round);
  const auto first = raster({list.item()}, 100, 90, 16);
  list.reset().push(turned(40, 1, 50, 45)).add(turnedBox).pop();
  const auto second = raster({list.item()}, 100, 90, 16);
  list.reset().clip({20, 0, 100, 70}).clip({10, 10, 80, 80}, {30, 10, 30, 0}).push(turned(40, 1, 50, 45));
  list.clip({-30, -30, 30, 30}).add(rectangle(-100, -100, 100, 100)).pop(2).add(rectangle(0, 0, 22, 90, {1, 0, 0, 1}));
  const auto all = raster({list.pop(2).item()}, 100, 90, 16);
  for (uint32_t i = 0; i < 9000; ++i) {
    const uint32_t x = i % 100, y = i / 100;
    const bool outside = x < 20 || y >= 70 || first[i].a == 0 || (second[i].a == 0 && x >= 22);
    const bool inside = !outside && first[i].a == 1 && (second[i].a == 1 || x < 22);
    if (outside || inside) {
      ASSERT_EQ(all[i].a, inside ? 1.0f : 0.0f) << x << " " << y;
    }
  }
  show("clips", all, 100, 90);
}

TEST_F(CanvasTest, ListsComposeTransformsAndOpacityAndGoWithOtherItems) {
  makeCanvas(128);
  uint32_t index = 0;
  const GpgpAsset set = makeGlyphSet(context, index);
  TestPath triangle;
  triangle.move(0, 0).line(50, 10).line(20, 60).close();
  triangle.color = {0.5f, 0.25f, 1, 0.75f};
  const GpgpAsset drawing = makeDrawing({triangle.view()});
  const TestPath square = rectanglePath(4, 4, 24, 24);
  const GpgpAsset box = makeDrawing({square.view()});

  TestList list(context);
  list.push({2, 0, 0, 2, 8, 4}).push({1, 0, 0, 1, 3, 5}); // moves and scales
  list.fade(0.5f).add(rectangle(4, 4, 24, 24));
  list.add(set, {{index, 1, 2, 20, {1, 0, 0, 1}}}).pop();
  list.push({0.5f, 0.5f, -0.5f, 0.5f, 20, 0}).add(drawing).pop(3);
  list.add(set, {{index, 60, 70, 30, {0, 1, 0, 0.5f}}});
  GpgpCanvasItem item = list.item();
  std::copy_n(std::array{0.5f, 0.0f, 0.0f, 0.75f, 6.0f, 10.0f}.data(), 6, item.transform);
  item.opacity = 0.5f;

  GpgpCanvasItem first = place(box), second, third = place(drawing), fourth;
  std::copy_n(std::array{1.0f, 0.0f, 0.0f, 1.5f, 13.0f, 20.5f}.data(), 6, first.transform);
  first.opacity = 0.25f;
  const std::vector<GpgpGlyphInstance> red{{index, 1, 2, 20, {1, 0, 0, 1}}},
      green{{index, 60, 70, 30, {0, 1, 0, 0.5f}}};
  second = first;
  second.drawing = nullptr;
  second.glyphSet = set;
  second.glyphs = red.data();
  second.glyphCount = 1;
  fourth = second;
  fourth.glyphs = green.data();
  std::copy_n(item.transform, 6, fourth.transform);
  fourth.opacity = 0.5f;
  std::copy_n(std::array{0.5f, 0.75f, -0.5f, 0.75f, 33.0f, 20.5f}.data(), 6, third.transform);
  third.opacity = 0.5f;
  const auto listed = raster({place(drawing, 1, 30, 20), item, place(box, 1, 50, 60)}, 128, 128, 16);
  const auto items =
      raster({place(drawing, 1, 30, 20), first, second, third, fourth, place(box, 1, 50, 60)}, 128, 128, 16);
  for (size_t i = 0; i < listed.size(); ++i) {
    ASSERT_NEAR(listed[i].r, items[i].r, 0.001f) << i;
    ASSERT_NEAR(listed[i].a, items[i].a, 0.001f) << i;
  }
  show("composed", listed, 128, 128);
}

TEST_F(CanvasTest, ImagesAndNineSlicesKeepTheirCorners) {
  makeCanvas(128);
  // 8 x 8 texels: corners of 2 red, sides green, the middle blue; the left half of an atlas.
  std::vector<uint32_t> texels(16 * 8, 0xff888888);
  for (uint32_t y = 0; y < 8; ++y)
    for (uint32_t x = 0; x < 8; ++x) {
      const bool across = x < 2 || x >= 6, down = y < 2 || y >= 6;
      texels[y * 16 + x] = across && down ? 0xff0000ff : across || down ? 0xff00ff00 : 0xffff0000;
    }
  const Texture atlas(device, 16, 8, texels, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  images = {atlas.view(), atlas.view()};
  GpgpListImage image{1, {0, 0, 0.5f, 1}, {0.125f, 0.25f, 0.125f, 0.25f}, {12, 10, 6, 8}};
  GpgpListShape shape = rectangle(8, 16, 88, 80);
  shape.image = &image;
  TestList list(context);
  list.add(shape);
  const auto expectAt = [&](const std::vector<Rgba>& pixels, float x0, float x1, float y0, float y1) {
    for (uint32_t y = 0; y < 96; ++y)
      for (uint32_t x = 0; x < 96; ++x) {
        const Rgba& p = pixels[y * 96 + x];
        const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
        if (px < 8 || px > 88 || py < 16 || py > 80) {
          ASSERT_EQ(p.a, 0);
          continue;
        }
        const bool across = px < x0 || px > x1, down = py < y0 || py > y1;
        ASSERT_EQ(p.r, across && down ? 1.0f : 0.0f) << x << " " << y;
        ASSERT_EQ(p.g, across != down ? 1.0f : 0.0f) << x << " " << y;
        ASSERT_EQ(p.b, across || down ? 0.0f : 1.0f) << x << " " << y;
      }
  };
  const auto sliced = raster({list.item()}, 96, 96, 16);
  expectAt(sliced, 20, 82, 26, 72);
  show("slices", sliced, 96, 96);
  std::fill_n(image.borders, 4, 0.0f); // evenly: an eighth of the box a texel
  std::fill_n(image.sourceBorders, 4, 0.0f);
  list.reset().push({2, 0, 0, 2, -8, -16});
  for (float& v : shape.box) v = 0.5f * v; // 4, 8, 44, 40
  shape.box[0] += 4, shape.box[2] += 4, shape.box[1] += 8, shape.box[3] += 8;
  list.add(shape).pop();
  expectAt(raster({list.item()}, 96, 96, 16), 28, 68, 32, 64);
  // A tint multiplies, and edges are smooth.
  std::copy_n(std::array{0.5f, 0.25f, 0.5f, 0.5f}.data(), 4, shape.color);
  list.reset().add(rounded(shape, 9, 9, 9, 9));
  const auto tinted = raster({list.item()}, 96, 96, 16);
  EXPECT_NEAR(tinted[28 * 96 + 12].g, 0.125f, 0.001f);
  EXPECT_NEAR(tinted[28 * 96 + 12].a, 0.5f, 0.001f);
  show("tinted", tinted, 96, 96);
  // Borders that do not find room shrink; a gradient goes with the transform.
  image = {0, {0, 0, 0.5f, 1}, {0.125f, 0.25f, 0.125f, 0.25f}, {120, 0, 40, 0}};
  shape = rectangle(8, 16, 88, 80);
  shape.image = &image;
  list.reset().add(shape);
  const auto shrunk = raster({list.item()}, 96, 96, 16);
  EXPECT_EQ(shrunk[40 * 96 + 60].b, 0.0f);
  images.pop_back();
  images.pop_back();
  const GpgpGradientStop stops[] = {{0, {0, 0, 0, 1}}, {1, {1, 1, 1, 1}}};
  GpgpGradient gradient{};
  gradient.transform[0] = gradient.transform[3] = 1;
  gradient.end[0] = 10;
  gradient.stops = stops;
  gradient.stopCount = 2;
  shape = rectangle(0, 0, 10, 10);
  shape.gradient = &gradient;
  list.reset().push({4, 0, 0, 4, 20, 10}).add(shape).pop().push({0, 4, -4, 0, 60, 50}).add(shape).pop();
  const auto ramps = raster({list.item()}, 96, 96, 16);
  for (uint32_t i = 0; i < 40; ++i) {
    const float expected = (static_cast<float>(i) + 0.5f) / 40;
    ASSERT_NEAR(ramps[20 * 96 + 20 + i].r, expected, 0.002f) << i;
    ASSERT_NEAR(ramps[(50 + i) * 96 + 40].r, expected, 0.002f) << i;
  }
  show("ramps", ramps, 96, 96);
}

TEST_F(CanvasTest, GroupsFadeAsOne) {
  makeCanvas(128);
  TestList list(context);
  // Two overlapping rectangles, and a group of two within: the same as paths of a drawing with groups.
  const std::array<float, 4> boxes[] = {
      {10, 12, 70, 60}, {30, 30, 90, 80}, {40, 8, 60, 70}, {50, 50, 85, 85}, {5, 40, 95, 48}};
  const std::array<float, 4> colors[] = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 0.75f}, {1, 1, 0, 1}, {1, 1, 1, 0.5f}};
  std::vector<TestPath> shapes;
  for (size_t i = 0; i < 5; ++i) {
    shapes.push_back(rectanglePath(boxes[i][0], boxes[i][1], boxes[i][2], boxes[i][3]));
    shapes.back().color = colors[i];
  }
  std::vector<GpgpPath> paths;
  for (const TestPath& shape : shapes) paths.push_back(shape.view());
  for (size_t i = 0; i < 4; ++i) paths[i].group = i < 2 ? 1 : 2;
  const GpgpAsset grouped = makeDrawing(paths, {{0, 0.5f, nullptr, 0}, {1, 0.25f, nullptr, 0}});
  const auto add = [&](size_t i) {
    list.add(rectangle(boxes[i][0], boxes[i][1], boxes[i][2], boxes[i][3], colors[i]));
  };
  const GpgpCanvasItem below = place(makeDrawing({shapes[4].view()}), 1, 3, 7);
  for (const auto& map : kMaps)
    for (const bool area : {false, true}) {
      exactArea = area;
      GpgpCanvasItem drawing = place(grouped);
      std::copy_n(map.data(), 6, drawing.transform);
      std::copy_n(map.data() + 6, 3, drawing.perspective);
      list.reset().push(map).group(0.5f);
      add(0);
      add(1);
      list.group(0.25f);
      add(2);
      add(3);
      list.pop(2);
      add(4);
      list.pop();
      EXPECT_TRUE(same(raster({below, list.item()}, 100, 90, 16), raster({below, drawing}, 100, 90, 16)))
          << &map - kMaps << ", area " << area;
    }
  exactArea = false;
  // Opacity around a group, and the item's, is the group's; within it, it is each thing's.
  const auto pixel = [&](const GpgpCanvasItem& item) { return raster({item}, 100, 90, 16)[40 * 100 + 50]; };
  const auto expect = [&](const Rgba& p, float r, float g, float b, float a) {
    const float values[] = {p.r, p.g, p.b, p.a}, expected[] = {r, g, b, a};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(values[i], expected[i], 0.001f) << i;
  };
  list.reset().fade(0.5f).group(1);
  add(0);
  add(1);
  GpgpCanvasItem item = list.pop(2).item();
  expect(pixel(item), 0, 0.5f, 0, 0.5f);
  item.opacity = 0.5f;
  expect(pixel(item), 0, 0.25f, 0, 0.25f);
  list.reset().group(0.5f).fade(0.5f);
  add(0);
  add(1);
  expect(pixel(list.pop(2).item()), 0.125f, 0.25f, 0, 0.375f); // each by half, then both
  list.reset().group(0);
  add(0);
  expect(pixel(list.pop().item()), 0, 0, 0, 0);
  // What is not faded equals what is in no group, sample by sample.
  list.reset();
  for (size_t i = 0; i < 5; ++i) add(i);
  const auto plain = raster({list.item()}, 100, 90, 16);
  list.reset().group(1);
  add(0);
  add(1);
  list.group(1);
  for (size_t i = 2; i < 5; ++i) add(i);
  EXPECT_TRUE(same(raster({list.pop(2).item()}, 100, 90, 16), plain));

  // A group of text, a drawing with groups of its own and a round clip, beside images, equals the group on its own
  // canvas, faded.
  uint32_t index = 0;
  const GpgpAsset set = makeGlyphSet(context, index);
  const auto fill = [&](float opacity) {
    list.reset().group(opacity).clip({8, 8, 92, 82}, {20, 20, 20, 20}).push(turned(10, 1, 10, 0));
    list.add(rectangle(0, 0, 90, 80, {0.25f, 0.25f, 0.5f, 1})).add(grouped);
    list.add(set, {{index, 5, 5, 60, {1, 1, 1, 1}}, {index, 20, 10, 60, {1, 0.5f, 0, 1}}}).pop(3);
    return list.item();
  };
  for (const bool withImages : {false, true}) {
    const std::vector<uint32_t> texel(4, 0xffffffff);
    const Texture white(device, 2, 2, texel, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    TestList marked(context);
    GpgpListShape mark = rectangle(95, 85, 100, 90);
    const GpgpListImage image{};
    mark.image = &image;
    std::vector<GpgpCanvasItem> items(1, marked.add(mark).item());
    if (withImages)
      images = {white.view()};
    else
      items.clear();
    items.push_back(fill(1));
    const auto whole = raster(items, 100, 90, 16);
    items.back() = fill(0.5f);
    const auto faded = raster(items, 100, 90, 16);
    for (size_t i = 0; i < 95 * 90; ++i) {
      if (i % 100 >= 95 || i / 100 >= 85) continue;
      ASSERT_NEAR(faded[i].r, 0.5f * whole[i].r, 0.001f) << i;
      ASSERT_NEAR(faded[i].g, 0.5f * whole[i].g, 0.001f) << i;
      ASSERT_NEAR(faded[i].a, 0.5f * whole[i].a, 0.001f) << i;
    }
    show(withImages ? "group_images" : "group", faded, 100, 90);
    images.clear();
  }

  // Depth: four in each other, those of a drawing among them; budgets count them.
  EXPECT_EQ(gpgpPushGroup(list.reset().list, 1.5f), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpPushGroup(list.list, NAN), GPGP_ERROR_INVALID_ARGUMENT);
  for (int i = 0; i < GPGP_MAX_OPACITY_DEPTH; ++i) list.group(0.5f);
  EXPECT_EQ(gpgpPushGroup(list.list, 0.5f), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("GPGP_MAX_OPACITY_DEPTH"), std::string::npos) << lastMessage();
  list.add(rectangle(0, 0, 100, 90)).pop(GPGP_MAX_OPACITY_DEPTH);
  EXPECT_NEAR(pixel(list.item()).a, 0.0625f, 0.001f);
  const auto refused = [&](const GpgpCanvasItem& shown) {
    GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
    const host::Image target(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = 8, .height = 8});
    info.width = info.height = 8;
    info.items = &shown;
    info.itemCount = 1;
    info.target = target.target({}, {});
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_ERROR_UNSUPPORTED);
    });
  };
  list.reset();
  for (int i = 0; i < 3; ++i) list.group(0.5f);
  list.add(grouped).pop(3);
  refused(list.item());
  EXPECT_NE(lastMessage().find("entry 0: with those of its drawing, more than 4 nested groups"), std::string::npos)
      << lastMessage();
  list.reset();
  for (int i = 0; i < 70; ++i) list.group(0.5f).add(rectangle(0, 0, 4, 4)).pop();
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  raster({list.item()}, 32, 32, 16, &report);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(report.items, 70u);
  EXPECT_EQ(report.itemsGiven, 64u);
}

// More tiles than are painted beside those without groups (kTilesAside), in a pattern that does not repeat soon.
TEST_F(CanvasTest, GroupsFadeOverAllOfALargeCanvas) {
  constexpr uint32_t kWidth = 1040, kHeight = 536;
  static_assert(kWidth / shader::kTileSize * (kHeight / shader::kTileSize) > 2 * shader::kTilesAside);
  makeCanvas(1040);
  const auto isSquare = [](uint32_t x, uint32_t y) { return (x / 8 * 7 + y / 8 * 13) % 31 * 11 % 31 < 14; };
  TestPath back = rectanglePath(0, 0, kWidth, kHeight), squares;
  back.color = {0, 0, 1, 1};
  squares.color = {1, 0, 0, 1};
  for (uint32_t y = 0; y < kHeight; y += 8)
    for (uint32_t x = 0; x < kWidth; x += 8)
      if (isSquare(x, y)) {
        const float left = static_cast<float>(x), top = static_cast<float>(y);
        squares.move(left, top);
        squares.line(left + 8, top);
        squares.line(left + 8, top + 8);
        squares.line(left, top + 8);
        squares.close();
      }
  std::vector<GpgpPath> paths = {back.view(), squares.view()};
  paths[0].group = paths[1].group = 1;
  const std::vector<Rgba> pixels = raster({place(makeDrawing(paths, {{0, 0.5f, nullptr, 0}}))}, kWidth, kHeight, 4);
  uint32_t wrong = 0;
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x) {
      const bool square = isSquare(x, y);
      const Rgba& p = pixels[y * kWidth + x];
      wrong += std::abs(p.r - (square ? 0.5f : 0)) > 0.001f || std::abs(p.b - (square ? 0 : 0.5f)) > 0.001f ||
               p.g != 0 || std::abs(p.a - 0.5f) > 0.001f;
    }
  EXPECT_EQ(wrong, 0u);
}

TEST_F(CanvasTest, NineSlicesRepeat) {
  makeCanvas(128);
  // 8 x 8 texels of different colours within an atlas of 16 x 8; borders of 2, so that the middle is 4.
  std::vector<uint32_t> texels(16 * 8, 0xffffffff);
  for (uint32_t y = 0; y < 8; ++y)
    for (uint32_t x = 0; x < 8; ++x) texels[y * 16 + x] = 0xff000000 | x * 30 | y * 30 << 8;
  const Texture nearest(device, 16, 8, texels, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  images = {nearest.view()};
  GpgpListImage image{0, {0, 0, 0.5f, 1}, {0.125f, 0.25f, 0.125f, 0.25f}, {12, 10, 6, 8}, {}, {}};
  GpgpListShape shape = rectangle(8, 16, 88, 80);
  shape.image = &image;
  TestList list(context);
  // Which texel is at a place of the box, along one axis: borders of `begin` and `end`, a middle of `tile` each time.
  const auto texelAt = [](float place, float side, float begin, float end, float tile) {
    if (place < begin) return static_cast<int>(place / begin * 2);
    if (place >= side - end) return 6 + static_cast<int>((place - side + end) / end * 2);
    return 2 + static_cast<int>(std::fmod(place - begin, tile) / tile * 4);
  };
  const auto check = [&](float across, float down, const char* name) {
    const auto pixels = raster({list.reset().add(shape).item()}, 96, 96, 16);
    show(name, pixels, 96, 96);
    for (uint32_t y = 16; y < 80; ++y)
      for (uint32_t x = 8; x < 88; ++x) {
        const float px = static_cast<float>(x) - 8 + 0.5f, py = static_cast<float>(y) - 16 + 0.5f;
        ASSERT_NEAR(pixels[y * 96 + x].r * 255 / 30,
                    static_cast<float>(texelAt(px, 80, image.borders[0], image.borders[2], across)), 0.02f)
            << x << " " << y << " " << name;
        ASSERT_NEAR(pixels[y * 96 + x].g * 255 / 30,
                    static_cast<float>(texelAt(py, 64, image.borders[1], image.borders[3], down)), 0.02f)
            << x << " " << y << " " << name;
      }
  };
  check(62, 46, "tile_stretch");
  image.tiles[0] = GPGP_TILE_REPEAT; // 18 units for 4 texels of border: 18 for the middle's 4
  check(18, 46, "tile_repeat_across");
  image.tiles[1] = GPGP_TILE_ROUND; // 46 / 18: thrice
  check(18, 46 / 3.0f, "tile_repeat_round");
  image.tiles[0] = GPGP_TILE_ROUND;
  image.tileSize[0] = 25; // 62 / 25: twice
  image.tileSize[1] = 1000;
  check(31, 46, "tile_round");
  // Without borders: the image as a pattern, under a scale.
  std::fill_n(image.borders, 4, 0.0f);
  std::fill_n(image.sourceBorders, 4, 0.0f);
  image.tiles[0] = image.tiles[1] = GPGP_TILE_REPEAT;
  image.tileSize[0] = 8, image.tileSize[1] = 4;
  shape = rectangle(0, 0, 40, 32);
  shape.image = &image;
  const auto pattern = raster({list.reset().push({2, 0, 0, 2, 8, 16}).add(shape).pop().item()}, 96, 96, 16);
  for (uint32_t y = 16; y < 80; ++y)
    for (uint32_t x = 8; x < 88; ++x) {
      ASSERT_NEAR(pattern[y * 96 + x].r * 255 / 30, static_cast<float>((x - 8) % 16 / 2), 0.02f) << x << " " << y;
      ASSERT_NEAR(pattern[y * 96 + x].g * 255 / 30, static_cast<float>((y - 16) % 8), 0.02f) << x << " " << y;
    }
  // Filtered, nothing of the borders' colours comes into the middle, and nothing of what is beside the source.
  for (uint32_t y = 0; y < 8; ++y)
    for (uint32_t x = 0; x < 8; ++x) texels[y * 16 + x] = x < 2 || x >= 6 || y < 2 || y >= 6 ? 0xff0000ff : 0xffff0000;
  const Texture smooth(device, 16, 8, texels, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  images = {smooth.view()};
  image = {0, {0, 0, 0.5f, 1}, {0.125f, 0.25f, 0.125f, 0.25f}, {12, 12, 12, 12}, {1, 1}, {7.3f, 11.1f}};
  shape = rectangle(8, 16, 88, 80);
  shape.image = &image;
  const auto filtered = raster({list.reset().add(shape).item()}, 96, 96, 16);
  for (uint32_t y = 29; y < 67; ++y)
    for (uint32_t x = 21; x < 75; ++x) ASSERT_EQ(filtered[y * 96 + x].r, 0) << x << " " << y;
  show("tile_filtered", filtered, 96, 96);

  const auto refused = [&](auto change, const char* words) {
    GpgpListImage bad = image;
    change(bad);
    GpgpListShape one = shape;
    one.image = &bad;
    EXPECT_EQ(gpgpAddShapes(list.list, &one, 1), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(lastMessage().find(words), std::string::npos) << lastMessage();
  };
  refused([](GpgpListImage& i) { i.tiles[1] = 3; }, "image.tiles[1] is 3");
  refused([](GpgpListImage& i) { i.tileSize[0] = -1; }, "image.tileSize");
  refused([](GpgpListImage& i) { i.tileSize[0] = NAN; }, "image.tileSize");
  refused(
      [](GpgpListImage& i) {
        i.tileSize[0] = 0;
        i.borders[0] = i.borders[2] = 0;
      },
      "image.tileSize[0] is 0");
}

TEST_F(CanvasTest, ListsStandWhatNobodyWouldDesign) {
  makeCanvas(80); // no other test's, which may have left a report
  TestList list(context);
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  const auto green = [&](const std::vector<Rgba>& pixels) { return pixels[10 * 32 + 10].g; };
  // A million shapes: as many as fit, from the bottom, and a report of what they would need.
  const std::vector<GpgpListShape> million(1000000, rectangle(0, 0, 20, 20, {0, 1, 0, 1}));
  ASSERT_EQ(gpgpAddShapes(list.list, million.data(), 1000000), GPGP_SUCCESS);
  EXPECT_EQ(green(raster({list.item()}, 32, 32, 4, &report)), 1);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(report.shapes, 1000000u);
  EXPECT_EQ(report.shapesGiven, 1024u);
  // More clips, transforms and groups than there is room for, one after another.
  list.reset().add(million[0]);
  for (int i = 0; i < 20000; ++i)
    list.group(0.5f).push(turned(1, 1, 0, 0)).clip({0, 0, 9, 9}, {3, 3, 3, 3}).add(million[0]).pop(3);
  raster({list.item()}, 32, 32, 4, &report);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_GE(report.items, 20000u);
  // Nothing to be seen: no extent, no scale, what scales beyond numbers.
  list.reset().add(million[0]);
  for (const std::array<float, 4>& box : {std::array{5.0f, 5.0f, 5.0f, 5.0f},
                                          {0.0f, 5.0f, 30.0f, 5.0f},
                                          {1e7f, 1e7f, 1e7f, 1e7f},
                                          {0, 0, 1e-38f, 1e-38f}}) {
    const GpgpListShape shape = rectangle(box[0], box[1], box[2], box[3]);
    list.add(shape).add(rounded(shape, 1, 2, 3, 4)).add(rounded(shape, 9, 9, 9, 9, 5)).add(ellipse(shape));
    list.add(ellipse(shape, 1e7f)).clip(box, {1e7f, 0, 1e7f, 0}).add(million[0]).pop();
  }
  list.add(line(5, 5, 5, 5, 1e-38f, GPGP_CAP_ROUND)).push({0, 0, 0, 0, 0, 0}).add(million[0]).pop();
  list.push({1e-38f, 0, 0, 1e-38f, 0, 0}).push({1e-38f, 0, 0, 1e-38f, 0, 0}).add(million[0]).clip({0, 0, 9, 9}).pop(3);
  list.push({1e38f, 0, 0, -1e38f, 0, 0}).push({1e38f, 0, 0, -1e38f, 0, 0}).add(million[0]).pop(2);
  list.push({1, 0, 0, 1, 0, 0, 0, 0, 1e-38f}).add(rectangle(0, 0, 1e-30f, 1e-30f)).pop();
  EXPECT_EQ(green(raster({list.item()}, 32, 32, 16, &report)), 1);
  EXPECT_EQ(report.base.status, GPGP_SUCCESS);
  // What no number can hold is refused, with words, and changes nothing.
  const auto refused = [&](GpgpResult result, const char* words) {
    EXPECT_EQ(result, GPGP_ERROR_INVALID_ARGUMENT) << words;
    EXPECT_NE(lastMessage().find(words), std::string::npos) << lastMessage();
  };
  const float box[4] = {0, 0, 9, 9}, bad[4] = {0, 0, NAN, 9}, radii[4] = {-1, 0, 0, 0};
  list.reset();
  for (int i = 0; i < 20; ++i) list.push({1e38f, 0, 0, 1e38f, 1, 0});
  refused(gpgpAddShapes(list.list, million.data(), 1), "beyond 1e7");
  refused(gpgpPushClip(list.list, box, nullptr), "beyond 1e7");
  list.pop(20);
  refused(gpgpPopState(list.list), "has been popped");
  refused(gpgpPushClip(list.list, bad, nullptr), "box is 0, 0, nan, 9");
  refused(gpgpPushClip(list.list, box, radii), "radius");
  for (int i = 0; i < GPGP_MAX_LIST_DEPTH; ++i) list.fade(1);
  refused(gpgpPushOpacity(list.list, 1), "GPGP_MAX_LIST_DEPTH");
  EXPECT_EQ(green(raster({list.pop(GPGP_MAX_LIST_DEPTH).item()}, 32, 32, 4)), 0);
}
} // namespace
