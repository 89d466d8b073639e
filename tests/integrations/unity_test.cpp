// The Unity plugin in a host that behaves as Unity documents: hooks, device events, events while it records, its frame
// numbers, its barriers; the picture in the render texture is that of the same drawing drawn directly.
#include "fake_unity.h"
#include "gpgp_glyph_cache.hpp"
#include "gpgp_unity.h"
#include "host/picture.h"

#include <gpgp/gpgp.hpp>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

namespace {

using namespace gpgp;
using test::FakeTexture;
using test::FakeUnity;

// The binary interface, as compiled plugins have it on 64-bit machines.
static_assert(sizeof(UnityVulkanInstance) == 120 && offsetof(UnityVulkanInstance, queueFamilyIndex) == 48);
static_assert(sizeof(UnityVulkanMemory) == 72 && offsetof(UnityVulkanMemory, memoryTypeIndex) == 36);
static_assert(sizeof(UnityVulkanImage) == 160 && offsetof(UnityVulkanImage, extent) == 96);
static_assert(offsetof(UnityVulkanImage, samples) == 116 && offsetof(UnityVulkanImage, mipCount) == 124);
static_assert(sizeof(UnityVulkanRecordingState) == 88 && offsetof(UnityVulkanRecordingState, subPassIndex) == 32);
static_assert(offsetof(UnityVulkanRecordingState, safeFrameNumber) == 48);
static_assert(sizeof(UnityVulkanPluginEventConfig) == 12);
static_assert(sizeof(IUnityGraphicsVulkan) == 14 * sizeof(void*) &&
              sizeof(IUnityGraphicsVulkanV2) == 16 * sizeof(void*));

// As the scripts' structs are laid out (scripts_test.sh).
static_assert(sizeof(GpgpUnityBudgets) == 28 && sizeof(GpgpUnityText) == 48 && sizeof(GpgpUnityItem) == 32 &&
              sizeof(GpgpUnityCanvas) == 48);

constexpr char kSvg[] = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>"
                        "<rect width='100' height='50' fill='#2040a0'/><circle cx='50' cy='50' r='40' "
                        "fill='#c03020' fill-opacity='0.5'/></svg>";

std::vector<char> fontBytes(const std::string& file = "DejaVuSans.ttf") {
  std::ifstream stream(GPGP_TEST_DATA "/fetched/fonts/" + file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The plugin's functions, as a script has them.
struct Script {
  explicit Script(FakeUnity& unity)
      : getState(unity.symbol<decltype(&gpgpUnityGetState)>("gpgpUnityGetState")),
        takeMessage(unity.symbol<decltype(&gpgpUnityTakeMessage)>("gpgpUnityTakeMessage")),
        getEvent(unity.symbol<decltype(&gpgpUnityGetEvent)>("gpgpUnityGetEvent")),
        getEventId(unity.symbol<decltype(&gpgpUnityGetEventId)>("gpgpUnityGetEventId")),
        setBudgets(unity.symbol<decltype(&gpgpUnitySetBudgets)>("gpgpUnitySetBudgets")),
        createDrawing(unity.symbol<decltype(&gpgpUnityCreateDrawing)>("gpgpUnityCreateDrawing")),
        getBox(unity.symbol<decltype(&gpgpUnityGetBox)>("gpgpUnityGetBox")),
        createFont(unity.symbol<decltype(&gpgpUnityCreateFont)>("gpgpUnityCreateFont")),
        setFallbacks(unity.symbol<decltype(&gpgpUnitySetFallbacks)>("gpgpUnitySetFallbacks")),
        createText(unity.symbol<decltype(&gpgpUnityCreateText)>("gpgpUnityCreateText")),
        setText(unity.symbol<decltype(&gpgpUnitySetText)>("gpgpUnitySetText")),
        createCanvas(unity.symbol<decltype(&gpgpUnityCreateCanvas)>("gpgpUnityCreateCanvas")),
        setCanvas(unity.symbol<decltype(&gpgpUnitySetCanvas)>("gpgpUnitySetCanvas")),
        destroy(unity.symbol<decltype(&gpgpUnityDestroy)>("gpgpUnityDestroy")) {}
  decltype(&gpgpUnityGetState) getState;
  decltype(&gpgpUnityTakeMessage) takeMessage;
  decltype(&gpgpUnityGetEvent) getEvent;
  decltype(&gpgpUnityGetEventId) getEventId;
  decltype(&gpgpUnitySetBudgets) setBudgets;
  decltype(&gpgpUnityCreateDrawing) createDrawing;
  decltype(&gpgpUnityGetBox) getBox;
  decltype(&gpgpUnityCreateFont) createFont;
  decltype(&gpgpUnitySetFallbacks) setFallbacks;
  decltype(&gpgpUnityCreateText) createText;
  decltype(&gpgpUnitySetText) setText;
  decltype(&gpgpUnityCreateCanvas) createCanvas;
  decltype(&gpgpUnitySetCanvas) setCanvas;
  decltype(&gpgpUnityDestroy) destroy;

  std::vector<std::string> messages() const {
    std::vector<std::string> all;
    char text[512];
    while (takeMessage(text, sizeof text) > 0) all.emplace_back(text);
    return all;
  }
};

struct UnityTest : testing::Test {
  std::unique_ptr<FakeUnity> unity;
  std::unique_ptr<Script> script;

  void start(const test::FakeUnityOptions& options = {}) {
    FakeUnity::validation().clear();
    unity = std::make_unique<FakeUnity>(GPGP_UNITY_PLUGIN, options);
    script = std::make_unique<Script>(*unity);
  }
  void frame(int32_t canvas) {
    unity->frame(reinterpret_cast<UnityRenderingEventAndData>(script->getEvent()),
                 {{script->getEventId(), reinterpret_cast<void*>(static_cast<intptr_t>(canvas))}});
  }
  void TearDown() override {
    if (!unity) return;
    for (const std::string& message : script->messages()) ADD_FAILURE() << message;
    const std::vector<std::string> violations = unity->violations();
    unity.reset(); // what was not destroyed is a validation message now
    for (const std::string& violation : violations) ADD_FAILURE() << "the plugin " << violation;
    for (const std::string& message : FakeUnity::validation()) ADD_FAILURE() << message;
  }
  static void expectMessage(const std::vector<std::string>& messages, const char* part) {
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find(part), std::string::npos) << messages[0];
  }
};

GpgpUnityItem item(int32_t object, float scale, float x, float y) { return {object, {scale, 0, 0, scale, x, y}, 1}; }

/// The same with gpgp alone: a drawing, and a text below it.
std::vector<uint8_t> drawDirectly(FakeUnity& unity, uint32_t width, uint32_t height, const GpgpUnityText& words) {
  auto info = init<GpgpContextCreateInfo>();
  info.instance = unity.instance();
  info.physicalDevice = unity.physicalDevice();
  info.device = unity.device();
  info.getInstanceProcAddr = vkGetInstanceProcAddr;
  Context context = *Context::create(info);
  auto source = init<GpgpSvgSource>();
  source.name = "svg";
  source.data = kSvg;
  source.size = sizeof kSvg - 1;
  const Blob blob = *compileSvg(source);
  auto drawingInfo = init<GpgpDrawingCreateInfo>();
  drawingInfo.data = blob.data();
  drawingInfo.size = blob.size();
  Drawing drawing = *Drawing::create(context, drawingInfo);
  const std::vector<char> bytes = fontBytes();
  auto fontInfo = init<GpgpFontCreateInfo>();
  fontInfo.data = bytes.data();
  fontInfo.size = bytes.size();
  Font font = *Font::create(fontInfo);
  Shaper shaper = *Shaper::create();
  Layout layout = *shaper.layout();
  const GpgpFont fonts[] = {font};
  auto text = init<GpgpTextInfo>();
  text.text = words.text;
  text.size = static_cast<size_t>(words.size);
  text.style.fonts = fonts;
  text.style.fontCount = 1;
  text.style.size = words.pixels;
  std::copy_n(words.color, 4, text.style.color);
  EXPECT_EQ(layout.set(text), GPGP_SUCCESS);
  integration::GlyphCache glyphs;
  integration::GlyphCacheInfo cacheInfo;
  cacheInfo.context = context;
  cacheInfo.pictureDevice.device = unity.device();
  cacheInfo.pictureDevice.getDeviceProcAddr = vkGetDeviceProcAddr;
  vkGetPhysicalDeviceMemoryProperties(unity.physicalDevice(), &cacheInfo.pictureDevice.memory);
  EXPECT_EQ(glyphs.create(cacheInfo), GPGP_SUCCESS);
  integration::PlacedText placed;
  EXPECT_EQ(glyphs.place(*layout.info(), 10, 110, 1, placed), GPGP_SUCCESS);
  List list = *List::create(context);
  EXPECT_EQ(glyphs.addTo(list, placed), GPGP_SUCCESS);
  auto canvasInfo = init<GpgpCanvasCreateInfo>();
  canvasInfo.base.queueFamily = unity.family();
  Canvas canvas = *Canvas::create(context, canvasInfo);
  EXPECT_EQ(canvas.prewarm(), GPGP_SUCCESS);
  FakeTexture& texture = *unity.makeTexture(width, height);
  VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  viewInfo.image = texture.image;
  viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
  viewInfo.format = texture.format;
  viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  VkImageView view = VK_NULL_HANDLE;
  EXPECT_EQ(vkCreateImageView(unity.device(), &viewInfo, nullptr, &view), VK_SUCCESS);
  const GpgpFrame frame{1, 0};
  EXPECT_EQ(context.advance(frame), GPGP_SUCCESS);
  GpgpCanvasItem items[2] = {{drawing, {1, 0, 0, 1, 10, 10}, 1}, {nullptr, {1, 0, 0, 1, 0, 0}, 1}};
  items[1].list = list;
  auto record = init<GpgpCanvasInfo>();
  record.width = width;
  record.height = height;
  record.items = items;
  record.itemCount = 2;
  record.exactArea = VK_TRUE;
  record.target = {texture.image,
                   view,
                   texture.format,
                   0,
                   0,
                   width,
                   height,
                   {},
                   {VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_GENERAL}};
  unity.submit([&](VkCommandBuffer commands) {
    EXPECT_TRUE(context.recordUpload(commands, frame));
    EXPECT_EQ(glyphs.recordUpload(commands, frame), GPGP_SUCCESS);
    const std::optional<GpgpCanvasImage> pictures = glyphs.image();
    record.images = pictures ? &*pictures : nullptr;
    record.imageCount = pictures ? 1 : 0;
    EXPECT_EQ(canvas.recordPrepare(commands, frame, record), GPGP_SUCCESS);
  });
  texture.layout = VK_IMAGE_LAYOUT_GENERAL;
  texture.stages = VK_PIPELINE_STAGE_TRANSFER_BIT;
  std::vector<uint8_t> pixels = unity.read(texture);
  vkDestroyImageView(unity.device(), view, nullptr);
  return pixels;
}

TEST_F(UnityTest, CanvasesInARenderTexture) {
  start();
  EXPECT_EQ(unity->hooksTaken(), 1u);
  EXPECT_EQ(script->getState(), GPGP_UNITY_READY);
  const UnityVulkanPluginEventConfig* config = unity->config(script->getEventId());
  ASSERT_TRUE(config);
  EXPECT_EQ(config->renderPassPrecondition, kUnityVulkanRenderPass_EnsureOutside);
  EXPECT_EQ(config->graphicsQueueAccess, kUnityVulkanGraphicsQueueAccess_DontCare);
  EXPECT_TRUE(config->flags & kUnityVulkanEventConfigFlag_ModifiesCommandBuffersState);

  const int32_t drawing = script->createDrawing(kSvg, sizeof kSvg - 1, 0);
  ASSERT_GT(drawing, 0);
  float box[4] = {};
  EXPECT_EQ(script->getBox(drawing, box), GPGP_SUCCESS);
  EXPECT_EQ(box[2], 100);
  const std::vector<char> bytes = fontBytes();
  const int32_t font = script->createFont(bytes.data(), static_cast<int32_t>(bytes.size()));
  ASSERT_GT(font, 0);
  const GpgpUnityText words{"gpgp", 4, font, 30, {1, 1, 1, 1}, 0, 0};
  const int32_t text = script->createText(&words);
  ASSERT_GT(text, 0);
  EXPECT_EQ(script->getBox(text, box), GPGP_SUCCESS);
  EXPECT_GT(box[2], 60);
  const int32_t canvas = script->createCanvas();
  FakeTexture& texture = *unity->makeTexture(120, 160);
  const GpgpUnityItem items[] = {item(drawing, 1, 10, 10), item(text, 1, 10, 110)};
  GpgpUnityCanvas info{&texture, 0, {}, items, 2};
  EXPECT_EQ(script->setCanvas(canvas, &info), GPGP_SUCCESS);
  for (int i = 0; i < 8; ++i) frame(canvas); // numbers far from 1, three in flight
  const std::vector<uint8_t> pixels = unity->read(texture);
  if (const char* folder = std::getenv("GPGP_UNITY_PICTURES"))
    host::writePng(std::string(folder) + "/unity.png", {120, 160, pixels});
  EXPECT_EQ(pixels, drawDirectly(*unity, 120, 160, words));

  // Flipped: the same, the first row last.
  info.flags = GPGP_UNITY_FLIP;
  EXPECT_EQ(script->setCanvas(canvas, &info), GPGP_SUCCESS);
  frame(canvas);
  const std::vector<uint8_t> flipped = unity->read(texture);
  uint64_t difference = 0;
  for (uint32_t y = 0; y < 160; ++y)
    for (uint32_t x = 0; x < 480; ++x)
      difference += static_cast<uint64_t>(std::abs(flipped[(159 - y) * 480 + x] - pixels[y * 480 + x]));
  EXPECT_LT(difference, 160u * 480 / 4);
  EXPECT_NE(flipped, pixels);

  // Another text, another texture, and the objects go while frames are in flight.
  const GpgpUnityText other{"x", 1, font, 30, {1, 0, 0, 1}, 0, 0};
  EXPECT_EQ(script->setText(text, &other), GPGP_SUCCESS);
  FakeTexture& wide = *unity->makeTexture(64, 64, VK_FORMAT_R16G16B16A16_SFLOAT);
  const GpgpUnityItem one = item(text, 1, 0, 0);
  info = {&wide, GPGP_UNITY_ENCODE_SRGB, {0, 0, 0.5f, 1}, &one, 1};
  EXPECT_EQ(script->setCanvas(canvas, &info), GPGP_SUCCESS);
  frame(canvas);
  const std::vector<uint8_t> halves = unity->read(wide);
  uint16_t blue = 0;
  std::memcpy(&blue, &halves[(63 * 64 + 63) * 8 + 4], 2);
  EXPECT_EQ(blue, 0x3800u); // 0.5
  script->destroy(drawing);
  script->destroy(text);
  script->destroy(font);
  frame(canvas);
  script->destroy(canvas);
  frame(canvas);
}

TEST_F(UnityTest, WhatCannotBeDrawnIsSaidOnceAndNothingIsRecorded) {
  start({.v2 = false, .begin = false}); // the older interface's hook
  EXPECT_EQ(unity->hooksTaken(), 1u);
  const GpgpUnityBudgets budgets{64, 64, 1024, 1024, 64};
  EXPECT_EQ(script->setBudgets(&budgets), GPGP_SUCCESS);
  EXPECT_EQ(script->getState(), GPGP_UNITY_OFF);
  unity->initialize();
  ASSERT_EQ(script->getState(), GPGP_UNITY_READY);
  const int32_t canvas = script->createCanvas();
  const auto show = [&](void* texture) {
    const GpgpUnityCanvas info{texture, 0, {1, 1, 1, 1}, nullptr, 0};
    EXPECT_EQ(script->setCanvas(canvas, &info), GPGP_SUCCESS);
    frame(canvas);
    frame(canvas);
  };
  show(unity->makeTexture(16, 16, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT));
  expectMessage(script->messages(), "enableRandomWrite");
  show(unity->makeTexture(16, 16, VK_FORMAT_R32_SFLOAT));
  expectMessage(script->messages(), "R8G8B8A8_UNorm");
  int stranger = 0;
  show(&stranger);
  expectMessage(script->messages(), "none of Unity's");
  show(nullptr);
  EXPECT_TRUE(script->messages().empty());
  show(unity->makeTexture(128, 16)); // beyond the budgets: gpgp says it, each time
  EXPECT_EQ(script->messages().size(), 2u);

  FakeTexture& texture = *unity->makeTexture(16, 16);
  show(&texture);
  EXPECT_EQ(unity->read(texture)[0], 255);
  // Frames pass and none is safe: canvases wait, and go on when they may.
  unity->holdSafe(true);
  const GpgpUnityCanvas black{&texture, 0, {0, 0, 0, 1}, nullptr, 0};
  for (int i = 0; i < 3; ++i) frame(0);
  EXPECT_EQ(script->setCanvas(canvas, &black), GPGP_SUCCESS);
  frame(canvas);
  frame(canvas);
  expectMessage(script->messages(), "frames behind");
  EXPECT_EQ(unity->read(texture)[0], 255);
  unity->holdSafe(false);
  frame(canvas);
  EXPECT_EQ(unity->read(texture)[0], 0);

  EXPECT_LT(script->createDrawing("no SVG", 6, 0), 0);
  EXPECT_LT(script->createDrawing("no drawing", 10, 1), 0);
  EXPECT_LT(script->createDrawing(nullptr, 10, 1), 0);
  EXPECT_LT(script->createFont("no font", 7), 0);
  const GpgpUnityText words{"text", 4, 99, 30, {}, 0, 0};
  EXPECT_LT(script->createText(&words), 0);
  EXPECT_EQ(script->messages().size(), 4u);
  EXPECT_LT(script->setCanvas(12345, &black), 0);
  script->destroy(12345);

  // The renderer goes and comes back: objects are gone, the plugin works on.
  unity->shutdown();
  EXPECT_EQ(script->getState(), GPGP_UNITY_OFF);
  frame(canvas);
  unity->initialize();
  EXPECT_EQ(script->getState(), GPGP_UNITY_READY);
  EXPECT_LT(script->setCanvas(canvas, &black), 0);
  EXPECT_GT(script->createCanvas(), canvas);
}

/// Pixels of a flame, which neither letters nor the background have.
uint32_t orange(const std::vector<uint8_t>& pixels) {
  uint32_t count = 0;
  for (size_t i = 0; i < pixels.size(); i += 4) count += pixels[i] > 200 && pixels[i + 1] > 60 && pixels[i + 2] < 60;
  return count;
}

TEST_F(UnityTest, TextsFallBackToOtherFontsAndToEmojiThatArePictures) {
  const std::vector<char> latin = fontBytes(), emoji = fontBytes("NotoColorEmoji.ttf");
  if (emoji.empty()) GTEST_SKIP() << "no NotoColorEmoji.ttf: run tests/data/fetch.sh";
  start();
  const int32_t font = script->createFont(latin.data(), static_cast<int32_t>(latin.size()));
  const int32_t fallback = script->createFont(emoji.data(), static_cast<int32_t>(emoji.size()));
  const int32_t wrong[] = {fallback, 12345};
  EXPECT_LT(script->setFallbacks(font, wrong, 2), 0);
  expectMessage(script->messages(), "fallback 1 is no font");
  EXPECT_LT(script->setFallbacks(12345, &fallback, 1), 0);
  EXPECT_LT(script->setFallbacks(font, nullptr, 1), 0);
  const std::string words = "A \xF0\x9F\x94\xA5 B"; // fire
  const GpgpUnityText info{words.c_str(), static_cast<int32_t>(words.size()), font, 32, {1, 1, 1, 1}, 0, 0};
  const int32_t text = script->createText(&info);
  ASSERT_GT(text, 0);
  const int32_t canvas = script->createCanvas();
  FakeTexture& texture = *unity->makeTexture(128, 64);
  const GpgpUnityItem one = item(text, 1, 4, 4);
  const GpgpUnityCanvas shown{&texture, GPGP_UNITY_FLIP | GPGP_UNITY_ENCODE_SRGB, {0, 0, 0.2f, 1}, &one, 1};
  EXPECT_EQ(script->setCanvas(canvas, &shown), GPGP_SUCCESS);
  frame(canvas);
  EXPECT_EQ(orange(unity->read(texture)), 0u);
  EXPECT_EQ(script->setFallbacks(font, &fallback, 1), GPGP_SUCCESS);
  EXPECT_EQ(script->setText(text, &info), GPGP_SUCCESS);
  for (int i = 0; i < 4; ++i) frame(canvas);
  const std::vector<uint8_t> pixels = unity->read(texture);
  EXPECT_GT(orange(pixels), 100u);
  if (const char* folder = std::getenv("GPGP_UNITY_PICTURES"))
    host::writePng(std::string(folder) + "/unity_emoji.png", {128, 64, pixels});
  // More emoji than are kept at a time: said once, however often they are drawn and whatever else is.
  std::string many;
  for (int i = 0; i < 70; ++i)
    many += {'\xF0', '\x9F', static_cast<char>(0x90 + i / 64), static_cast<char>(0x80 + i % 64)};
  const GpgpUnityText crowd{many.c_str(), static_cast<int32_t>(many.size()), font, 8, {1, 1, 1, 1}, 100, 0};
  EXPECT_EQ(script->setText(text, &crowd), GPGP_SUCCESS);
  for (int i = 0; i < 4; ++i) frame(canvas);
  expectMessage(script->messages(), "6 glyphs are not drawn");
  EXPECT_EQ(script->setText(text, &info), GPGP_SUCCESS);
  for (int i = 0; i < 4; ++i) frame(canvas);
  EXPECT_EQ(orange(unity->read(texture)), orange(pixels));
  EXPECT_TRUE(script->messages().empty());
  const GpgpUnityText endless{"a", 1, font, std::numeric_limits<float>::quiet_NaN(), {1, 1, 1, 1}, 0, 0};
  EXPECT_LT(script->setText(text, &endless), 0);
  expectMessage(script->messages(), "style.size is nan");
  // A font of the text goes: so does the text, until it is set anew without it.
  script->destroy(fallback);
  frame(canvas);
  EXPECT_EQ(orange(unity->read(texture)), 0u);
  EXPECT_EQ(script->setText(text, &info), GPGP_SUCCESS);
  frame(canvas);
  const std::vector<uint8_t> without = unity->read(texture);
  EXPECT_EQ(orange(without), 0u);
  EXPECT_NE(without, std::vector<uint8_t>(without.size(), 0)) << "letters are there";
}

TEST_F(UnityTest, DeviceEventsInAnyOrderAndADeviceThatIsLostOrReplaced) {
  start();
  unity->loadAgain();
  EXPECT_EQ(unity->hooksTaken(), 1u);
  const int32_t canvas = script->createCanvas();
  const auto drawsInto = [&](int32_t number) {
    FakeTexture& texture = *unity->makeTexture(16, 16);
    const GpgpUnityCanvas white{&texture, 0, {1, 1, 1, 1}, nullptr, 0};
    if (script->setCanvas(number, &white) < 0) return false;
    frame(number);
    frame(number);
    return unity->read(texture)[0] == 255;
  };
  EXPECT_TRUE(drawsInto(canvas));
  unity->send(kUnityGfxDeviceEventInitialize); // said twice
  EXPECT_EQ(script->getState(), GPGP_UNITY_READY);
  EXPECT_TRUE(drawsInto(canvas)) << "objects stay";
  unity->send(kUnityGfxDeviceEventBeforeReset);
  EXPECT_EQ(script->getState(), GPGP_UNITY_OFF);
  frame(canvas);
  unity->send(kUnityGfxDeviceEventShutdown); // there is nothing to shut down
  unity->send(kUnityGfxDeviceEventAfterReset);
  EXPECT_EQ(script->getState(), GPGP_UNITY_READY);
  EXPECT_LT(script->setCanvas(canvas, nullptr), 0);
  EXPECT_TRUE(drawsInto(script->createCanvas()));
  // Frames are under way, and the device is lost: the plugin lets go of all it has, and starts on the next one.
  const int32_t drawing = script->createDrawing(kSvg, sizeof kSvg - 1, 0);
  ASSERT_GT(drawing, 0);
  unity->loseDevice();
  unity->replaceDevice();
  EXPECT_EQ(script->getState(), GPGP_UNITY_READY);
  float box[4];
  EXPECT_LT(script->getBox(drawing, box), 0);
  EXPECT_TRUE(drawsInto(script->createCanvas()));
}

TEST_F(UnityTest, LoadedTooLateOrWithoutVulkanItStaysOff) {
  start({.preload = false});
  EXPECT_EQ(script->getState(), GPGP_ERROR_MISSING_FEATURE);
  expectMessage(script->messages(), "on startup");
  const int32_t canvas = script->createCanvas();
  frame(canvas);
  TearDown();
  start();
  EXPECT_EQ(script->getState(), GPGP_UNITY_READY);
  unity->unload(); // it does not see any more what becomes of its device, which may be destroyed and another made there
  unity->loadAgain();
  EXPECT_EQ(script->getState(), GPGP_ERROR_MISSING_FEATURE);
  expectMessage(script->messages(), "on startup");
  TearDown();
  start({.renderer = kUnityGfxRendererOpenGLCore});
  EXPECT_EQ(script->getState(), GPGP_UNITY_OFF);
  EXPECT_LT(script->createDrawing(kSvg, sizeof kSvg - 1, 0), 0);
  frame(script->createCanvas());
}

} // namespace
