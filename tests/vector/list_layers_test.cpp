// Layers of lists against formulas, against groups and drawings that say the same, and what clips and masks leave of
// them.
#include "ui_fixture.h"

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr uint32_t kSide = 96;

GpgpListLayer layerOf(float opacity = 1, GpgpBlendMode blend = GPGP_BLEND_NORMAL) {
  GpgpListLayer layer{};
  layer.opacity = opacity;
  layer.blend = blend;
  return layer;
}
GpgpFilterStep blurOf(float deviation) {
  GpgpFilterStep step{};
  step.kind = GPGP_FILTER_GAUSSIAN_BLUR;
  step.values[0] = step.values[1] = deviation;
  std::copy_n(std::array{-1e6f, -1e6f, 1e6f, 1e6f}.data(), 4, step.region);
  return step;
}
/// An edge at x = 0, blurred: how much of what lies right of it there is.
double edge(double x, double deviation) { return 0.5 * (1 + std::erf(x / (deviation * std::sqrt(2.0)))); }

struct ListLayersTest : CanvasTest {
  void SetUp() override {
    CanvasTest::SetUp();
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
    info.maxWidth = info.maxHeight = kSide;
    info.maxDrawings = 256;
    info.targets = canvasTargets;
    info.maxLayerPixels = 1u << 20;
    canvas = recorder(gpgpCreateCanvas, info);
  }
  std::vector<Rgba> draw(const GpgpCanvasItem& item, GpgpResult status = GPGP_SUCCESS) {
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    const auto pixels = raster({item}, kSide, kSide, 16, &report);
    EXPECT_EQ(report.base.status, status) << report.items << " of " << report.itemsGiven << ", " << report.layerPixels;
    return pixels;
  }
  std::vector<Rgba> draw(const TestList& list) { return draw(list.item()); }
  static void expectNear(const std::vector<Rgba>& a, const std::vector<Rgba>& b, float tolerance, const char* what) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i)
      ASSERT_LE(std::max({std::abs(a[i].r - b[i].r), std::abs(a[i].g - b[i].g), std::abs(a[i].b - b[i].b),
                          std::abs(a[i].a - b[i].a)}),
                tolerance)
          << what << ": " << i % kSide << " " << i / kSide << ": " << a[i].r << " " << a[i].a << ", " << b[i].r << " "
          << b[i].a;
  }
};

TEST_F(ListLayersTest, FadesAsAGroupDoes) {
  TestList layers(context), groups(context);
  const auto things = [](TestList& list) {
    list.add(rectangle(10, 10, 60, 50, {1, 0, 0, 1})).add(ellipse(rectangle(30, 20, 80, 80, {0, 1, 0, 1})));
    list.push(turned(20, 1, 20, 0)).clip({0, 0, 50, 50}, {9, 9, 9, 9}).add(rectangle(20, 20, 90, 90, {0, 0, 1, 1}));
    list.pop(2);
  };
  for (const auto& map : {kMaps[0], kMaps[1], kMaps[2], kMaps[4]}) {
    layers.reset().add(rectangle(0, 0, 50, 96, {0.5f, 0.5f, 0, 1})).push(map).layer(layerOf(0.5f));
    groups.reset().add(rectangle(0, 0, 50, 96, {0.5f, 0.5f, 0, 1})).push(map).group(0.5f);
    for (TestList* list : {&layers, &groups}) {
      things(*list);
      list->pop(2).add(rectangle(70, 70, 90, 90, {1, 1, 1, 0.5f})); // on top, rasterised apart or not
      list->add(rectangle(2, 2, 8, 8, {1, 1, 1, 1}));
    }
    // Layers are composited pixel by pixel, groups sample by sample: edges on edges differ.
    const auto one = draw(layers), other = draw(groups);
    double worst = 0, sum = 0;
    for (size_t i = 0; i < one.size(); ++i) {
      const double d = std::max({std::abs(one[i].r - other[i].r), std::abs(one[i].g - other[i].g),
                                 std::abs(one[i].b - other[i].b), std::abs(one[i].a - other[i].a)});
      worst = std::max(worst, d);
      sum += d;
    }
    EXPECT_LE(worst, 0.13);
    EXPECT_LE(sum / double(one.size()), 0.001);
  }
}

TEST_F(ListLayersTest, BlendsByFormula) {
  TestList list(context);
  list.add(rectangle(0, 0, 96, 96, {0.5f, 0.25f, 1, 1}));
  list.layer(layerOf(1, GPGP_BLEND_MULTIPLY)).add(rectangle(8, 8, 40, 40, {0.5f, 1, 0.25f, 1})).pop();
  list.layer(layerOf(0.5f, GPGP_BLEND_SCREEN)).add(rectangle(50, 8, 90, 40, {0.5f, 1, 0.25f, 1})).pop();
  list.fade(0.5f).layer(layerOf(0.5f)).add(rectangle(8, 50, 40, 90, {0, 0, 0, 1})).pop(2);
  GpgpCanvasItem item = list.item();
  const auto pixels = draw(item);
  const auto at = [&](uint32_t x, uint32_t y, float r, float g, float b) {
    const Rgba& p = pixels[y * kSide + x];
    EXPECT_NEAR(p.r, r, 0.001f) << x;
    EXPECT_NEAR(p.g, g, 0.001f) << x;
    EXPECT_NEAR(p.b, b, 0.001f) << x;
    EXPECT_NEAR(p.a, 1, 0.001f) << x;
  };
  at(4, 4, 0.5f, 0.25f, 1);
  at(20, 20, 0.25f, 0.25f, 0.25f);
  at(70, 20, 0.5f * (0.5f + 0.75f), 0.5f * (0.25f + 1), 1);
  at(20, 70, 0.375f, 0.1875f, 0.75f);
  item.opacity = 0.5f; // of each thing, layers among them
  const Rgba p = draw(item)[20 * kSide + 20];
  EXPECT_NEAR(p.a, 0.75f, 0.001f);
}

TEST_F(ListLayersTest, BlursWithinClipsThatCutAfterwards) {
  const GpgpFilterStep blur = blurOf(4);
  GpgpListLayer layer = layerOf();
  layer.filter = &blur;
  layer.filterCount = 1;
  TestList list(context), square(context);
  list.layer(layer).add(rectangle(30, -100, 300, 300, {1, 1, 1, 1})).pop();
  const auto blurred = draw(list);
  for (uint32_t y = 20; y < kSide; y += 30)
    for (uint32_t x = 0; x < kSide; ++x)
      ASSERT_NEAR(blurred[y * kSide + x].a, edge(x + 0.5 - 30, 4), 0.006) << x << " " << y;
  // What lies beyond the clip or the canvas is blurred in; the clip cuts what comes of it. Scissors and round clips.
  for (const bool round : {false, true}) {
    const std::array<float, 4> box{20, 20, 60, 70}, radii{15, 15, 15, 15}, none{0, 0, 0, 0};
    square.reset().add(
        rounded(rectangle(20, 20, 60, 70), round ? 15.0f : 0, round ? 15.0f : 0, round ? 15.0f : 0, round ? 15.0f : 0));
    const auto coverage = draw(square);
    list.reset().clip(box, round ? radii : none).layer(layer).add(rectangle(30, -100, 300, 300, {1, 1, 1, 1})).pop(2);
    const auto cut = draw(list);
    for (size_t i = 0; i < cut.size(); ++i)
      ASSERT_NEAR(cut[i].a, blurred[i].a * coverage[i].a, 0.002f) << round << ": " << i % kSide << " " << i / kSide;
    // The same inside of another layer, and by the item's scissor.
    list.reset().layer(layerOf()).clip(box, round ? radii : none).layer(layer);
    list.add(rectangle(30, -100, 300, 300, {1, 1, 1, 1})).pop(3);
    expectNear(draw(list), cut, 0.002f, "nested");
  }
  list.reset().layer(layer).add(rectangle(30, -100, 300, 300, {1, 1, 1, 1})).pop();
  GpgpCanvasItem item = list.item();
  std::copy_n(std::array{20.0f, 10.0f, 50.0f, 90.0f}.data(), 4, item.scissor);
  const auto scissored = draw(item);
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    const uint32_t x = i % kSide, y = i / kSide;
    ASSERT_NEAR(scissored[i].a, x >= 20 && x < 50 && y >= 10 && y < 90 ? blurred[i].a : 0, 0.002f) << x << " " << y;
  }
}

TEST_F(ListLayersTest, IsWhatADrawingWithTheSameLayerIs) {
  const GpgpFilterStep steps[] = {[] {
    GpgpFilterStep shadow = blurOf(3);
    shadow.kind = GPGP_FILTER_DROP_SHADOW;
    const std::array<float, 8> values{3, 3, 6, 4, 0, 0, 0.5f, 0.75f};
    std::copy_n(values.data(), 8, shadow.values);
    return shadow;
  }()};
  GpgpLayer of{};
  of.filter = steps;
  of.filterCount = 1;
  of.filterTransform[0] = of.filterTransform[3] = 1;
  std::copy_n(std::array{-1e6f, -1e6f, 1e6f, 1e6f}.data(), 4, of.filterRegion);
  GpgpPathGroup group{};
  group.opacity = 0.75f;
  group.layer = &of;
  TestPath square = rectanglePath(20, 20, 60, 60), other = rectanglePath(40, 40, 70, 80);
  other.color = {1, 0, 0, 1};
  std::vector<GpgpPath> paths = {square.view(), other.view()};
  for (GpgpPath& path : paths) path.group = 1;
  const GpgpAsset drawing = makeDrawing(paths, {group});
  TestList list(context);
  GpgpListLayer layer = layerOf(0.75f);
  layer.filter = steps;
  layer.filterCount = 1;
  list.add(rectangle(0, 0, 40, 40, {0, 1, 0, 1})).layer(layer);
  list.add(rectangle(20, 20, 60, 60)).add(rectangle(40, 40, 70, 80, {1, 0, 0, 1})).pop();
  TestList with(context);
  with.add(rectangle(0, 0, 40, 40, {0, 1, 0, 1})).add(drawing);
  for (const auto& map : {kMaps[0], kMaps[1], kMaps[3]}) {
    GpgpCanvasItem one = list.item(), two = with.item();
    std::copy_n(map.data(), 6, one.transform);
    std::copy_n(map.data(), 6, two.transform);
    const auto drawn = draw(two);
    expectNear(draw(one), drawn, 0.004f, "layers of a list and of a drawing");
    // A drawing with layers inside clips, which it could not be in before.
    with.reset().clip({10, 10, 66, 70}, {8, 8, 8, 8}).add(drawing).pop();
    TestList cover(context), alone(context);
    cover.add(rounded(rectangle(10, 10, 66, 70), 8, 8, 8, 8));
    alone.add(drawing);
    GpgpCanvasItem clipped = with.item(), covered = cover.item(), whole = alone.item();
    for (GpgpCanvasItem* item : {&clipped, &covered, &whole}) std::copy_n(map.data(), 6, item->transform);
    const auto a = draw(clipped), b = draw(covered), c = draw(whole);
    for (size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i].a, b[i].a * c[i].a, 0.003f) << &map - kMaps << " " << i;
    with.reset().add(rectangle(0, 0, 40, 40, {0, 1, 0, 1})).add(drawing);
  }
  device.waitIdle();
  gpgpDestroyAsset(drawing);
}

TEST_F(ListLayersTest, MasksAndTheirInversesAddUp) {
  TestList list(context);
  const auto fill = [&](bool inverted, GpgpMaskKind kind) {
    uint32_t mask = 0;
    list.reset().push(turned(10, 1, 5, 0));
    ASSERT_EQ(gpgpPushMask(list.list, &mask), GPGP_SUCCESS);
    list.add(ellipse(rectangle(20, 20, 70, 60, {1, 1, 1, 1}))).add(rectangle(40, 50, 60, 90, {1, 1, 1, 0.5f})).pop();
    GpgpListLayer layer = layerOf();
    layer.mask = mask;
    layer.maskKind = kind;
    layer.maskInverted = inverted;
    list.layer(layer).add(rectangle(10, 10, 85, 85, {1, 0.5f, 0, 1})).pop(2);
  };
  fill(false, GPGP_MASK_ALPHA);
  const auto inside = draw(list);
  fill(false, GPGP_MASK_LUMINANCE);
  expectNear(draw(list), inside, 0.003f, "white has its alpha's luminance");
  fill(true, GPGP_MASK_ALPHA);
  const auto outside = draw(list);
  TestList whole(context), mask(context);
  whole.push(turned(10, 1, 5, 0)).add(rectangle(10, 10, 85, 85, {1, 0.5f, 0, 1})).pop();
  mask.push(turned(10, 1, 5, 0)).add(ellipse(rectangle(20, 20, 70, 60, {1, 1, 1, 1})));
  mask.add(rectangle(40, 50, 60, 90, {1, 1, 1, 0.5f})).pop();
  const auto all = draw(whole), shape = draw(mask);
  size_t masked = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    ASSERT_NEAR(inside[i].a + outside[i].a, all[i].a, 0.003f) << i;
    ASSERT_NEAR(inside[i].r, all[i].r * shape[i].a, 0.003f) << i;
    masked += inside[i].a > 0.9f;
  }
  EXPECT_GT(masked, 1000u);
}

TEST_F(ListLayersTest, BackdropsAreWhatLiesBehind) {
  const GpgpFilterStep blur = blurOf(3);
  GpgpListLayer layer = layerOf();
  layer.filter = &blur;
  layer.filterCount = 1;
  layer.backdrop = VK_TRUE;
  TestList list(context);
  // Red left of 48, green right of it; a panel of frosted glass from 20 to 80; what follows is not in it.
  list.add(rectangle(0, 0, 48, 96, {1, 0, 0, 1})).add(rectangle(48, 0, 96, 96, {0, 1, 0, 1}));
  list.clip({20, 20, 80, 70}).layer(layer).add(rectangle(30, 30, 40, 40, {0, 0, 1, 0.5f})).pop(2);
  list.add(rectangle(76, 76, 90, 90, {1, 1, 1, 1})).add(rectangle(60, 50, 78, 68, {1, 1, 1, 1}));
  const auto pixels = draw(list);
  show("backdrop", pixels, kSide, kSide);
  for (uint32_t y = 2; y < kSide; y += 3)
    for (uint32_t x = 0; x < kSide; ++x) {
      const Rgba& p = pixels[y * kSide + x];
      const bool glass = x >= 20 && x < 80 && y >= 20 && y < 70, note = x >= 30 && x < 40 && y >= 30 && y < 40;
      const bool white = (x >= 76 && x < 90 && y >= 76 && y < 90) || (x >= 60 && x < 78 && y >= 50 && y < 68);
      const double right = glass ? edge(x + 0.5 - 48, 3) : x >= 48;
      const double light = note ? 0.5 : 1;
      ASSERT_NEAR(p.g, white ? 1 : right * light, 0.008) << x << " " << y;
      ASSERT_NEAR(p.r, white ? 1 : (1 - right) * light, 0.008) << x << " " << y;
      ASSERT_NEAR(p.b, white ? 1 : note ? 0.5 : 0, 0.008) << x << " " << y;
    }
}

TEST_F(ListLayersTest, OtherItemsLieBelowAndAbove) {
  TestList below(context), layers(context), above(context);
  below.add(rectangle(10, 10, 50, 50, {1, 0, 0, 1}));
  layers.layer(layerOf(0.5f)).add(rectangle(20, 20, 60, 60, {0, 1, 0, 1})).pop();
  above.clip({0, 0, 90, 40}, {3, 3, 3, 3}).add(rectangle(30, 30, 70, 70, {0, 0, 1, 1})).pop();
  const auto pixels = raster({below.item(), layers.item(), above.item(), layers.item()}, kSide, kSide, 16);
  const auto at = [&](uint32_t x, uint32_t y) { return pixels[y * kSide + x]; };
  EXPECT_NEAR(at(15, 15).r, 1, 0.001f);
  EXPECT_NEAR(at(25, 25).r, 0.25f, 0.001f);
  EXPECT_NEAR(at(25, 25).g, 0.75f, 0.001f);
  EXPECT_NEAR(at(35, 35).b, 0.5f, 0.001f);
  EXPECT_NEAR(at(35, 35).g, 0.5f, 0.001f);
  EXPECT_NEAR(at(65, 35).b, 1, 0.001f);
  EXPECT_NEAR(at(55, 55).g, 0.75f, 0.001f);
  EXPECT_NEAR(at(55, 55).a, 0.75f, 0.001f);
}

TEST_F(ListLayersTest, HitsLieInClipsOfLayers) {
  TestList list(context);
  GpgpListShape hit = rectangle(0, 0, 90, 90);
  hit.id = 5;
  uint32_t mask = 0;
  ASSERT_EQ(gpgpPushMask(list.list, &mask), GPGP_SUCCESS);
  list.add(rectangle(0, 0, 96, 96)).pop();
  GpgpListLayer layer = layerOf();
  layer.mask = mask;
  layer.bounds[2] = layer.bounds[3] = 60;
  list.clip({10, 10, 80, 80}).layer(layer).add(hit).pop(2);
  EXPECT_EQ(hitAt(context, {list.item()}, 50, 50).id, 5u);
  EXPECT_EQ(hitAt(context, {list.item()}, 5, 50).item, GPGP_HIT_NONE);
  EXPECT_EQ(hitAt(context, {list.item()}, 70, 50).item, GPGP_HIT_NONE);
}

TEST_F(ListLayersTest, WrongOnesAndBudgets) {
  TestList list(context);
  const auto refused = [&](GpgpResult code, const char* why, auto&& change) {
    GpgpListLayer layer = layerOf();
    change(layer);
    EXPECT_EQ(gpgpPushLayer(list.list, &layer), code) << why;
    EXPECT_NE(lastMessage().find(why), std::string::npos) << lastMessage();
  };
  GpgpFilterStep step = blurOf(-1);
  const auto bad = GPGP_ERROR_INVALID_ARGUMENT;
  refused(bad, "opacity is 2", [](GpgpListLayer& l) { l.opacity = 2; });
  refused(bad, "blend is unknown", [](GpgpListLayer& l) { l.blend = 99; });
  refused(bad, "mask is 1", [](GpgpListLayer& l) { l.mask = 1; });
  refused(bad, "bounds", [](GpgpListLayer& l) { l.bounds[0] = 3; });
  refused(bad, "the standard deviation", [&](GpgpListLayer& l) { l.filter = &step, l.filterCount = 1; });
  refused(bad, "filter is NULL", [](GpgpListLayer& l) { l.filterCount = 1; });
  std::array<float, 1024> table{};
  step = blurOf(0);
  step.kind = GPGP_FILTER_COMPONENT_TRANSFER;
  step.table = table.data();
  step.tableCount = 1024;
  refused(GPGP_ERROR_UNSUPPORTED, "filter[0].kind is 5",
          [&](GpgpListLayer& l) { l.filter = &step, l.filterCount = 1; });
  list.group(0.5f);
  refused(GPGP_ERROR_UNSUPPORTED, "inside a group", [](GpgpListLayer&) {});
  list.pop();
  uint32_t mask = 0;
  ASSERT_EQ(gpgpPushMask(list.list, &mask), GPGP_SUCCESS);
  refused(bad, "no mask that was popped", [&](GpgpListLayer& l) { l.mask = mask; });
  list.pop();
  // Masks of masks that double what is drawn each time are refused, not drawn for ever.
  for (int k = 0; k < 24; ++k) {
    uint32_t next = 0;
    ASSERT_EQ(gpgpPushMask(list.list, &next), GPGP_SUCCESS);
    GpgpListLayer layer = layerOf();
    layer.mask = mask;
    for (int twice = 0; twice < 2; ++twice) list.layer(layer).add(rectangle(0, 0, 90, 90)).pop();
    list.pop();
    mask = next;
  }
  GpgpListLayer last = layerOf();
  last.mask = mask;
  list.layer(last).add(rectangle(0, 0, 90, 90)).pop();
  const host::Image target(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = kSide, .height = kSide});
  const GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer commands) {
    EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
    const GpgpCanvasItem item = list.item();
    GpgpCanvasInfo info = infoOf({}, kSide, kSide);
    info.items = &item;
    info.itemCount = 1;
    info.target = target.target({}, {});
    EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_ERROR_UNSUPPORTED);
    EXPECT_NE(lastMessage().find("more than 65536 parts"), std::string::npos) << lastMessage();
  });
  // More layers side by side than there is room for: the list is left out, and said.
  list.reset();
  for (int k = 0; k < 400; ++k) list.layer(layerOf(0.5f)).add(rectangle(0, 0, 96, 96)).pop();
  const auto pixels = draw(list.item(), GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(pixels[50 * kSide + 50].a, 0);
}

} // namespace
