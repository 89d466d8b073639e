// gpgp::glyph_cache: glyphs that are pictures in a canvas, beside what the font says they are; budgets, eviction,
// fonts that go. Under the validation layer. GPGP_GLYPH_CACHE_PICTURES=FOLDER writes what is compared.
#include "gpgp_glyph_cache.hpp"
#include "host/picture.h"
#include "stage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace {

using namespace gpgp;
constexpr uint32_t kSide = 256;
constexpr const char* kFonts = GPGP_TEST_DATA "/fetched/fonts/";

/// A device, and a canvas whose pixels are read back.
struct GlyphCacheTest : testing::Test {
  struct Stage : test::Stage {
    Canvas canvas;

    Stage() : test::Stage(VK_FORMAT_R8G8B8A8_UNORM, kSide, kSide, VK_IMAGE_USAGE_STORAGE_BIT) {
      auto canvasInfo = init<GpgpCanvasCreateInfo>();
      canvasInfo.base.queueFamily = device.family;
      canvasInfo.targets = GPGP_CANVAS_TARGET_RGBA8;
      canvas = *Canvas::create(context, canvasInfo);
      EXPECT_EQ(canvas.prewarm(), GPGP_SUCCESS);
    }
    ~Stage() { vkDeviceWaitIdle(device.device); }
    bool blendSrgb = true; ///< else colours mix in linear light
    /// A list in the frame that `commands` are of, whose uploads they have.
    host::Picture draw(VkCommandBuffer commands, GpgpList list, const std::optional<GpgpCanvasImage>& pictures,
                       const float (&background)[4]) {
      GpgpCanvasItem item{};
      item.list = list;
      item.transform[0] = item.transform[3] = item.opacity = 1;
      auto info = init<GpgpCanvasInfo>();
      info.width = info.height = kSide;
      info.items = &item;
      info.itemCount = 1;
      info.images = pictures ? &*pictures : nullptr;
      info.imageCount = pictures ? 1 : 0;
      info.exactArea = info.encodeSrgb = VK_TRUE;
      info.blendSrgb = blendSrgb;
      std::copy_n(background, 4, info.background);
      const GpgpAccess after{VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                             VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
      info.target = {image, view, VK_FORMAT_R8G8B8A8_UNORM, 0, 0, kSide, kSide, {}, after};
      EXPECT_EQ(canvas.recordPrepare(commands, frames.number(), info), GPGP_SUCCESS);
      VkBufferImageCopy copy{};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      copy.imageExtent = {kSide, kSide, 1};
      vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &copy);
      frames.submit();
      vkDeviceWaitIdle(device.device);
      host::Picture picture{kSide, kSide, std::vector<uint8_t>(size_t{kSide} * kSide * 4)};
      std::memcpy(picture.rgba.data(), mapped, picture.rgba.size());
      return picture;
    }
    integration::GlyphCacheInfo cacheInfo(uint32_t maxPictures) const {
      integration::GlyphCacheInfo info;
      info.context = context;
      info.maxPictures = maxPictures;
      info.pictureDevice.device = device.device;
      info.pictureDevice.getDeviceProcAddr = vkGetDeviceProcAddr;
      vkGetPhysicalDeviceMemoryProperties(device.physical, &info.pictureDevice.memory);
      info.pictureDevice.blendSrgb = blendSrgb;
      return info;
    }
  };
  inline static std::unique_ptr<Stage> stage;
  static void SetUpTestSuite() { stage = std::make_unique<Stage>(); }
  static void TearDownTestSuite() { stage.reset(); }
  Font emoji, latin;
  Shaper shaper;
  Layout layout;
  integration::GlyphCache cache;
  integration::PlacedText placed;

  void SetUp() override {
    if (!std::filesystem::exists(std::string(kFonts) + "NotoColorEmoji.ttf"))
      GTEST_SKIP() << "no NotoColorEmoji.ttf in " << kFonts << ": run tests/data/fetch.sh";
    emoji = open("NotoColorEmoji.ttf");
    latin = open("DejaVuSans.ttf");
    shaper = *Shaper::create();
    layout = *shaper.layout();
  }
  void TearDown() override {
    vkDeviceWaitIdle(stage->device.device);
    cache = {};
    EXPECT_EQ(stage->device.validationMessages(), 0u);
    for (const std::string& message : stage->messages) ADD_FAILURE() << message;
    stage->messages.clear();
  }
  static Font open(const char* file) {
    const std::string path = std::string(kFonts) + file;
    auto info = init<GpgpFontCreateInfo>();
    info.filePath = path.c_str();
    return *Font::create(info);
  }
  GpgpLayoutInfo layOut(const std::string& words, float size, float alpha = 1) {
    const GpgpFont fonts[] = {latin, emoji};
    auto text = init<GpgpTextInfo>();
    text.text = words.data();
    text.size = words.size();
    text.style.fonts = fonts;
    text.style.fontCount = 2;
    text.style.size = size;
    std::fill_n(text.style.color, 3, 1.0f);
    text.style.color[3] = alpha;
    EXPECT_EQ(layout.set(text), GPGP_SUCCESS);
    return *layout.info();
  }
  /// What was placed, over dark blue.
  host::Picture draw(const float (&background)[4] = {0, 0, 0.2f, 1}) {
    List list = *List::create(stage->context);
    EXPECT_EQ(cache.addTo(list, placed), GPGP_SUCCESS);
    VkCommandBuffer commands = stage->frames.begin();
    const GpgpFrame frame = stage->frames.number();
    EXPECT_EQ(stage->context.advance(frame), GPGP_SUCCESS);
    EXPECT_TRUE(stage->context.recordUpload(commands, frame));
    EXPECT_EQ(cache.recordUpload(commands, frame), GPGP_SUCCESS);
    return stage->draw(commands, list, cache.image(), background);
  }
  static void keep(const host::Picture& picture, const std::string& name) {
    if (const char* folder = std::getenv("GPGP_GLYPH_CACHE_PICTURES"))
      host::writePng(std::string(folder) + "/" + name + ".png", picture);
  }
};

/// Where colours mix as sRGB encodes them, and where they mix in linear light: pictures and canvas alike.
struct GlyphCacheBlending : GlyphCacheTest, testing::WithParamInterface<bool> {
  void SetUp() override {
    stage->blendSrgb = GetParam();
    GlyphCacheTest::SetUp();
  }
  void TearDown() override {
    GlyphCacheTest::TearDown();
    stage->blendSrgb = true;
  }
};
INSTANTIATE_TEST_SUITE_P(Blending, GlyphCacheBlending, testing::Bool(),
                         [](const auto& is) { return is.param ? "AsEncoded" : "InLinearLight"; });

/// A font's picture in a box of the canvas by the definition: each pixel the mean of what it covers, in linear light
/// or as sRGB encodes it.
struct Expected {
  host::Picture picture;
  float box[4] = {};
  Expected(const Font& font, const GpgpTextGlyph& glyph, float x, float y) {
    auto info = init<GpgpGlyphOutlineInfo>();
    info.glyph = glyph.glyph;
    font.outline(info, [&](const GpgpGlyphOutline& outline) {
      ASSERT_NE(outline.image, nullptr);
      const GpgpGlyphImage& image = *outline.image;
      picture = {image.width, image.height, {image.pixels, image.pixels + size_t{image.width} * image.height * 4}};
      for (size_t side = 0; side < 4; ++side)
        box[side] = (side % 2 == 0 ? x + glyph.x : y + glyph.y) + image.box[side] * glyph.size;
    });
  }
  /// Premultiplied colour and alpha of a pixel, by 8 x 8 points of it.
  std::array<double, 4> at(uint32_t px, uint32_t py, bool encoded) const {
    std::array<double, 4> sum{};
    constexpr int kPoints = 8;
    for (int j = 0; j < kPoints; ++j)
      for (int i = 0; i < kPoints; ++i) {
        const float x = static_cast<float>(px) + (static_cast<float>(i) + 0.5f) / kPoints;
        const float y = static_cast<float>(py) + (static_cast<float>(j) + 0.5f) / kPoints;
        const float u = (x - box[0]) / (box[2] - box[0]), v = (y - box[1]) / (box[3] - box[1]);
        if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) continue;
        const auto tx = static_cast<uint32_t>(u * static_cast<float>(picture.width));
        const auto ty = static_cast<uint32_t>(v * static_cast<float>(picture.height));
        const uint8_t* texel = &picture.rgba[(size_t{ty} * picture.width + tx) * 4];
        const double alpha = texel[3] / 255.0 / (kPoints * kPoints);
        for (size_t c = 0; c < 3; ++c) {
          const float value = static_cast<float>(texel[c]) / 255;
          sum[c] += double{encoded ? value : host::linearFromSrgb(value)} * alpha;
        }
        sum[3] += alpha;
      }
    return sum;
  }
};

TEST_P(GlyphCacheBlending, PicturesAreTheFontsAtEverySize) {
  ASSERT_EQ(cache.create(stage->cacheInfo(4)), GPGP_SUCCESS);
  // Filters blur small pictures a little.
  for (const auto& [size, limit] : {std::pair(13.0f, 5.5), {27.5f, 3.3}, {60.0f, 1.6}, {150.0f, 1.1}}) {
    const GpgpLayoutInfo info = layOut("🔥", size);
    ASSERT_EQ(info.glyphCount, 1u);
    const float x = 20.25f, y = 30.5f; // between pixels
    placed.clear();
    ASSERT_EQ(cache.place(info, x, y, 1, placed), GPGP_SUCCESS);
    ASSERT_EQ(placed.pictures.size(), 1u);
    EXPECT_TRUE(placed.glyphs.empty());
    const host::Picture picture = draw({0, 0, 0, 1});
    keep(picture, "size" + std::to_string(static_cast<int>(size)));
    const Expected expected(emoji, info.glyphs[0], x, y);
    double difference = 0;
    uint32_t pixels = 0, beyond = 0;
    for (uint32_t py = 0; py < kSide; ++py)
      for (uint32_t px = 0; px < kSide; ++px) {
        const uint8_t* p = &picture.rgba[(size_t{py} * kSide + px) * 4];
        const bool inside = static_cast<float>(px) >= expected.box[0] - 1 &&
                            static_cast<float>(px) <= expected.box[2] &&
                            static_cast<float>(py) >= expected.box[1] - 1 && static_cast<float>(py) <= expected.box[3];
        if (!inside) {
          beyond += p[0] || p[1] || p[2];
          continue;
        }
        const std::array<double, 4> wanted = expected.at(px, py, GetParam()); // over black
        for (size_t c = 0; c < 3; ++c) {
          const auto value = static_cast<float>(wanted[c]);
          difference += std::abs(p[c] - 255.0 * double{GetParam() ? value : host::srgbFromLinear(value)});
        }
        pixels += 3;
      }
    EXPECT_EQ(beyond, 0u) << size;
    EXPECT_LT(difference / pixels, limit) << "of 255 in the mean at " << size;
    EXPECT_GT(pixels, 100u);
  }
}

TEST_F(GlyphCacheTest, TextAndPicturesGoTogetherAndFade) {
  ASSERT_EQ(cache.create(stage->cacheInfo(4)), GPGP_SUCCESS);
  const auto red = [&](float alpha) {
    placed.clear();
    EXPECT_EQ(cache.place(layOut("A🔴 🔴B", 40, alpha), 8, 8, 1, placed), GPGP_SUCCESS);
    EXPECT_EQ(placed.pictures.size(), 2u); // one picture at two places
    EXPECT_EQ(placed.dropped, 0u);
    const host::Picture picture = draw({0, 0, 0, 1});
    keep(picture, "text" + std::to_string(static_cast<int>(alpha * 100)));
    const float* box = placed.pictures[0].box;
    const auto px = static_cast<size_t>((box[0] + box[2]) / 2), py = static_cast<size_t>((box[1] + box[3]) / 2);
    return picture.rgba[(py * kSide + px) * 4];
  };
  const int whole = red(1), half = red(0.5f);
  EXPECT_GT(whole, 200);
  EXPECT_NEAR(half, whole / 2.0, 2); // mixed as sRGB encodes colours
}

TEST_F(GlyphCacheTest, UnderlinesLieBelowAndStrikesOver) {
  ASSERT_EQ(cache.create(stage->cacheInfo(4)), GPGP_SUCCESS);
  const std::string words = "x💚";
  const GpgpFont fonts[] = {latin, emoji};
  auto text = init<GpgpTextInfo>();
  text.text = words.data();
  text.size = words.size();
  text.style = {.fonts = fonts, .fontCount = 2, .size = 96, .color = {1, 0, 0, 1}, .underline = 1, .strike = 1};
  ASSERT_EQ(layout.set(text), GPGP_SUCCESS);
  const GpgpLayoutInfo info = *layout.info();
  ASSERT_EQ(info.decorationCount, 2u);
  placed.clear();
  ASSERT_EQ(cache.place(info, 4, 4, 0.5f, placed), GPGP_SUCCESS); // as ever after a scale
  ASSERT_EQ(placed.lines.size(), 2u);
  ASSERT_EQ(placed.pictures.size(), 1u);
  const host::Picture picture = draw();
  keep(picture, "lines");
  const auto at = [&](float x, const GpgpTextDecoration& line) {
    return &picture.rgba[(static_cast<size_t>(4 + (line.rect.y + line.rect.height / 2) / 2) * kSide +
                          static_cast<size_t>(x)) *
                         4];
  };
  const float* heart = placed.pictures[0].box;
  const float middle = (heart[0] + heart[2]) / 2, corner = heart[0] + 1;
  for (uint32_t i = 0; i < 2; ++i) {
    const GpgpTextDecoration& line = info.decorations[i];
    EXPECT_EQ(at(corner, line)[0], 255) << "beside the heart's tip, or over it";
    EXPECT_EQ(at(middle, line)[0] == 255, line.strike != 0);
  }
}

TEST_P(GlyphCacheBlending, LargePicturesAreShrunkNoMoreThanTheyMust) {
  integration::GlyphPictures pictures(stage->cacheInfo(1).pictureDevice, 1000);
  EXPECT_EQ(pictures.capacity(), 625u) << "as many as 4096 texels a side hold";
  for (const auto& [width, height, wide, tall] :
       {std::array{160u, 160u, 144u, 144u}, {300u, 10u, 144u, 4u}, {136u, 128u, 136u, 128u}, {2000u, 1u, 144u, 1u}}) {
    const std::vector<uint8_t> white(size_t{width} * height * 4, 255);
    uint32_t place = 0;
    ASSERT_EQ(pictures.add({white.data(), width, height, {}}, place), GPGP_SUCCESS);
    const auto& source = pictures.source(place);
    EXPECT_NEAR((source[2] - source[0]) * 25 * 160, static_cast<float>(wide), 0.01f) << width;
    EXPECT_NEAR((source[3] - source[1]) * 25 * 160, static_cast<float>(tall), 0.01f) << height;
  }
  // Stripes of a texel become grey, half as bright in linear light or as it is encoded, and keep their alpha.
  std::vector<uint8_t> stripes(size_t{288} * 288 * 4, 255);
  for (size_t i = 0; i < stripes.size(); i += 8) stripes[i] = stripes[i + 1] = stripes[i + 2] = 0;
  integration::GlyphPictures one(stage->cacheInfo(1).pictureDevice, 1);
  uint32_t place = 0;
  ASSERT_EQ(one.add({stripes.data(), 288, 288, {}}, place), GPGP_SUCCESS);
  VkCommandBuffer commands = stage->frames.begin();
  EXPECT_EQ(stage->context.advance(stage->frames.number()), GPGP_SUCCESS);
  EXPECT_EQ(one.recordUpload(commands, stage->frames.number()), GPGP_SUCCESS);
  List list = *List::create(stage->context);
  GpgpListImage image{};
  std::copy_n(one.source(place).begin(), 4, image.source);
  GpgpListShape shape{};
  shape.box[2] = shape.box[3] = 144;
  std::fill_n(shape.color, 4, 1.0f);
  shape.image = &image;
  EXPECT_EQ(list.add(shape), GPGP_SUCCESS);
  const host::Picture seen = stage->draw(commands, list, one.image(), {0, 0, 0, 1});
  for (const uint32_t at : {20u, 70u, 120u})
    EXPECT_NEAR(seen.rgba[(size_t{at} * kSide + at) * 4], 255 * (GetParam() ? 0.5f : host::srgbFromLinear(0.5f)), 2);
}

TEST_F(GlyphCacheTest, APictureUnusedMakesRoomAndWhatFindsNoneIsCounted) {
  ASSERT_EQ(cache.create(stage->cacheInfo(2)), GPGP_SUCCESS);
  placed.clear();
  EXPECT_EQ(cache.place(layOut("🔥🌍🚀", 30), 8, 8, 1, placed), GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(placed.pictures.size(), 2u);
  EXPECT_EQ(placed.dropped, 1u);
  const host::Picture two = draw();
  // In later frames there is room for the one that was left out, where another is not shown any more.
  placed.clear();
  EXPECT_EQ(cache.place(layOut("🚀🌍", 30), 8, 8, 1, placed), GPGP_SUCCESS);
  EXPECT_EQ(placed.dropped, 0u);
  const host::Picture later = draw();
  placed.clear();
  EXPECT_EQ(cache.place(layOut("🔥🌍", 30), 8, 8, 1, placed), GPGP_SUCCESS);
  const host::Picture again = draw();
  keep(two, "two");
  keep(later, "later");
  EXPECT_NE(later.rgba, two.rgba);
  EXPECT_EQ(again.rgba, two.rgba) << "it came back as it was";
}

TEST_F(GlyphCacheTest, WithoutADeviceThereAreNoPicturesAndFontsMayGo) {
  integration::GlyphCacheInfo info;
  info.context = stage->context;
  ASSERT_EQ(cache.create(info), GPGP_SUCCESS);
  EXPECT_EQ(cache.place(layOut("A🔥", 30), 8, 8, 1, placed), GPGP_SUCCESS);
  EXPECT_TRUE(placed.pictures.empty());
  const host::Picture without = draw();
  cache = {};
  ASSERT_EQ(cache.create(stage->cacheInfo(2)), GPGP_SUCCESS);
  placed.clear();
  EXPECT_EQ(cache.place(layOut("A🔥", 30), 8, 8, 1, placed), GPGP_SUCCESS);
  const host::Picture with = draw();
  EXPECT_NE(with.rgba, without.rgba);
  cache.forget(emoji);
  cache.forget(latin);
  emoji = open("NotoColorEmoji.ttf"); // at the same address or another
  latin = open("DejaVuSans.ttf");
  placed.clear();
  EXPECT_EQ(cache.place(layOut("A🔥", 30), 8, 8, 1, placed), GPGP_SUCCESS);
  EXPECT_LE(host::compare(draw(), with).largest, 1u); // another place of the texture: coordinates are rounded
}

} // namespace
