// Drawings with more outlines than a device binds at once: their segments lie in pages, and pictures are those of one
// buffer, bit for bit.
#include "api/check.h"
#include "layers_fixture.h"
#include "random_record.h"
#include "vector/raster/drawing_asset.h"

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr uint32_t kSize = 128;

struct PagesTest : LayersTest {
  const vector::DrawingAsset& assetOf(GpgpAsset drawing) {
    const core::Context* owner = nullptr;
    return static_cast<const vector::DrawingAsset&>(*api::objectOf(drawing, &owner));
  }
  /// A drawing, as if the device of another one bound as many segments at once.
  GpgpAsset makeWithin(uint32_t segments, GpgpAsset like, const std::vector<GpgpPath>& paths,
                       const std::vector<GpgpPathGroup>& groups, GpgpResult expected = GPGP_SUCCESS) {
    auto& limits = assetOf(like).context.device.limits;
    const uint32_t real = limits.maxStorageBufferRange;
    limits.maxStorageBufferRange = segments * uint32_t(sizeof(shader::SegmentRecord));
    const GpgpAsset drawing = makeDrawing(paths, groups, expected);
    limits.maxStorageBufferRange = real;
    return drawing;
  }
  /// The same drawing twice: as it is, and in so many pages.
  std::pair<GpgpAsset, GpgpAsset> twice(const std::vector<GpgpPath>& paths, const std::vector<GpgpPathGroup>& groups,
                                        uint32_t pages) {
    const GpgpAsset one = makeDrawing(paths, groups);
    const vector::DrawingAsset& asset = assetOf(one);
    EXPECT_TRUE(asset.pages().empty());
    const uint32_t segments = asset.segments(asset.paths());
    const GpgpAsset other = makeWithin((segments + pages - 1) / pages, one, paths, groups);
    EXPECT_TRUE(!other || assetOf(other).pages().size() == pages);
    return {one, other};
  }
  static std::vector<GpgpCanvasItem> scene(GpgpAsset drawing, bool layered) {
    std::vector<GpgpCanvasItem> items = {place(drawing, 1.3f, -6, 4), place(drawing, 0.4f, 70, 60)};
    items[1].opacity = 0.6f;
    if (layered) return items; // which have no perspective
    GpgpCanvasItem turned = place(drawing);
    const float map[6] = {0.4f, 0.3f, -0.3f, 0.4f, 50, 20}, perspective[3] = {0.002f, 0.001f, 1};
    std::copy_n(map, 6, turned.transform);
    std::copy_n(perspective, 3, turned.perspective);
    items.push_back(turned);
    return items;
  }
  void compare(GpgpAsset one, GpgpAsset other, const std::string& what) {
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT, paged = GPGP_CANVAS_REPORT_INIT;
    const bool layered = !assetOf(one).plan().empty();
    const std::vector<Rgba> want = raster(scene(one, layered), kSize, kSize, 16, &report);
    const std::vector<Rgba> got = raster(scene(other, layered), kSize, kSize, 16, &paged);
    EXPECT_EQ(report.base.status, GPGP_SUCCESS) << what;
    EXPECT_EQ(paged.base.status, GPGP_SUCCESS) << what;
    EXPECT_EQ(report.tileEntries, paged.tileEntries) << what;
    size_t inked = 0, differ = 0;
    for (size_t i = 0; i < want.size(); ++i) {
      inked += want[i].a > 0;
      differ += std::memcmp(&want[i], &got[i], sizeof want[i]) != 0;
    }
    EXPECT_GT(inked, want.size() / 8) << what;
    EXPECT_EQ(differ, 0u) << what;
  }
};

TEST_F(PagesTest, PicturesAreThoseOfOneBuffer) {
  makeCanvas(kSize);
  for (uint32_t seed = 0; seed < 10; ++seed) {
    Dice dice(seed);
    const Kinds kinds{true, false, true, false, false, false, false};
    RandomPaths from;
    while (from.paths.size() < 24) from.add(dice, kinds, 90, 0, 0, 2, 0);
    for (const uint32_t pages : {2u, 4u}) {
      const auto [one, other] = twice(from.paths, from.groups, pages);
      ASSERT_TRUE(one && other) << seed;
      compare(one, other, "seed " + std::to_string(seed) + ", " + std::to_string(pages) + " pages");
      gpgpDestroyAsset(one);
      gpgpDestroyAsset(other);
    }
  }
}

TEST_F(PagesTest, LayersToo) {
  makeLayerCanvas(kSize);
  Scene scene;
  GpgpLayer blurred = scene.filter({step(GPGP_FILTER_GAUSSIAN_BLUR, {3, 3})}), multiplied = plainLayer();
  multiplied.blend = GPGP_BLEND_MULTIPLY;
  Dice dice(8);
  const Kinds kinds{};
  RandomPaths from;
  std::vector<GpgpPath> paths;
  const uint32_t groups[] = {0, scene.group(0, 0.8f, &blurred), 0, scene.group(0, 1, &multiplied), 0};
  for (const uint32_t group : groups)
    for (int i = 0; i < 6; ++i) from.path(dice, kinds, 90, 0, group);
  const auto [one, other] = twice(from.paths, scene.groups, 3);
  ASSERT_TRUE(one && other);
  ASSERT_FALSE(assetOf(one).plan().empty());
  compare(one, other, "layers");
  gpgpDestroyAsset(one);
  gpgpDestroyAsset(other);
}

TEST_F(PagesTest, MoreThanARecordingBindsIsRefused) {
  Dice dice(3);
  const Kinds kinds{};
  RandomPaths from;
  for (int i = 0; i < 40; ++i) from.path(dice, kinds, 90, 0, 0);
  const auto [one, other] = twice(from.paths, {}, 4);
  ASSERT_TRUE(one && other);
  const uint32_t segments = assetOf(one).segments(assetOf(one).paths());
  EXPECT_EQ(makeWithin(segments / 5, one, from.paths, {}, GPGP_ERROR_UNSUPPORTED), nullptr);
  EXPECT_NE(lastMessage().find("outlines"), std::string::npos) << lastMessage();
  gpgpDestroyAsset(one);
  gpgpDestroyAsset(other);
}

/// A canvas has room for so many pages; what lies above the first one without room is left out, and the report says so.
TEST_F(PagesTest, WhatFindsNoRoomIsReported) {
  makeCanvas(kSize);
  Dice dice(4);
  const Kinds kinds{};
  RandomPaths from;
  for (int i = 0; i < 30; ++i) from.path(dice, kinds, 90, 0, 0);
  const auto [one, other] = twice(from.paths, {}, 4);
  ASSERT_TRUE(one && other);
  const std::vector<GpgpCanvasItem> all(20, place(other)), shown(16, place(one));
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  const std::vector<Rgba> got = raster(all, kSize, kSize, 16, &report), want = raster(shown, kSize, kSize, 16);
  EXPECT_EQ(report.pathsDropped, 4u * 30);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(std::memcmp(got.data(), want.data(), want.size() * sizeof want[0]), 0);
  gpgpDestroyAsset(one);
  gpgpDestroyAsset(other);
}

/// A drawing of one frame that is kept is one thing, whatever it lies in.
TEST_F(PagesTest, KeptRecordingsDrawWhatChanged) {
  makeCanvas(kSize);
  Dice dice(6);
  const Kinds kinds{true, false, true, false, false, false, false};
  RandomPaths from;
  while (from.paths.size() < 24) from.add(dice, kinds, 60, 0, 0, 2, 0);
  const auto [one, other] = twice(from.paths, from.groups, 3);
  ASSERT_TRUE(one && other);
  GpgpCanvasHistoryCreateInfo create = GPGP_CANVAS_HISTORY_CREATE_INFO_INIT;
  create.maxKept = 16;
  GpgpHistory history = nullptr;
  ASSERT_EQ(gpgpCreateCanvasHistory(context, &create, &history), GPGP_SUCCESS);
  const host::Image image(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = kSize, .height = kSize});
  const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
  for (uint32_t k = 0; k < 5; ++k) {
    const float x = 70 + static_cast<float>(k / 2) * 8; // moves every other frame
    const std::vector<GpgpCanvasItem> items = {place(other, 0.8f, 0, 0), place(other, 0.3f, x, 90)};
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      GpgpCanvasInfo info = infoOf(items, kSize, kSize);
      info.history = history;
      info.keep = VK_TRUE;
      info.target = image.target(k ? after : GpgpAccess{}, after);
      EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_SUCCESS) << lastMessage();
    });
    advance();
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    EXPECT_EQ(gpgpGetCanvasReport(canvas, &report), GPGP_SUCCESS);
    EXPECT_TRUE(k == 0 || report.redraw == GPGP_CANVAS_REDRAW_NONE) << k;
    const uint32_t drawn = report.tilesDrawn;
    EXPECT_TRUE(k == 0       ? drawn == report.tiles
                : k % 2 == 1 ? drawn == 0
                             : drawn > 0 && drawn < report.tiles)
        << k << ", " << drawn;
    const std::vector<uint8_t> bytes = host::downloadImage(device, image, VK_IMAGE_LAYOUT_GENERAL);
    const std::vector<Rgba> want = raster({place(one, 0.8f, 0, 0), place(one, 0.3f, x, 90)}, kSize, kSize, 16);
    size_t differ = 0;
    for (size_t i = 0; i < want.size(); ++i) {
      uint16_t h[4];
      std::memcpy(h, bytes.data() + i * 8, 8);
      differ += fromHalf(h[0]) != want[i].r || fromHalf(h[1]) != want[i].g || fromHalf(h[2]) != want[i].b ||
                fromHalf(h[3]) != want[i].a;
    }
    EXPECT_EQ(differ, 0u) << k;
  }
  gpgpDestroyHistory(history);
  gpgpDestroyAsset(one);
  gpgpDestroyAsset(other);
}

} // namespace
