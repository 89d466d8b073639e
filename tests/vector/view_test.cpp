// The two ways out: the draw inside the engine's render pass, and that it gives what a storage image receives.
#include "canvas_fixture.h"
#include "fetched_svg.h"

#include <functional>
#include <optional>

namespace {
using namespace gpgp;
using namespace gpgp::test;

/// An image as the attachment of a render pass, with a depth buffer where a format is given for one.
struct Attachment {
  host::HeadlessDevice& device;
  const uint32_t width, height;
  host::Image image;
  std::optional<host::Image> depth;
  VkRenderPass pass = VK_NULL_HANDLE;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  GpgpTargetInfo target = GPGP_TARGET_INFO_INIT;

  Attachment(host::HeadlessDevice& owner, VkFormat format, uint32_t w, uint32_t h,
             VkFormat depthFormat = VK_FORMAT_UNDEFINED)
      : device(owner), width(w), height(h),
        image(owner, {.format = format, .width = w, .height = h, .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}) {
    const auto described = [](VkFormat of, VkImageLayout last) {
      return VkAttachmentDescription{0,
                                     of,
                                     VK_SAMPLE_COUNT_1_BIT,
                                     VK_ATTACHMENT_LOAD_OP_CLEAR,
                                     VK_ATTACHMENT_STORE_OP_STORE,
                                     VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                     VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                     VK_IMAGE_LAYOUT_UNDEFINED,
                                     last};
    };
    const VkAttachmentDescription attachments[] = {
        described(format, VK_IMAGE_LAYOUT_GENERAL),
        described(depthFormat, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL)};
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
        depthReference{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    if (depthFormat != VK_FORMAT_UNDEFINED)
      depth.emplace(device, host::ImageInfo{.format = depthFormat,
                                            .width = w,
                                            .height = h,
                                            .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT});
    const uint32_t count = depth ? 2 : 1;
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    if (depth) subpass.pDepthStencilAttachment = &depthReference;
    VkRenderPassCreateInfo passInfo{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    passInfo.attachmentCount = count;
    passInfo.pAttachments = attachments;
    passInfo.subpassCount = 1;
    passInfo.pSubpasses = &subpass;
    EXPECT_EQ(device.vk().vkCreateRenderPass(device.device(), &passInfo, nullptr, &pass), VK_SUCCESS);
    const VkImageView views[] = {image.view(), depth ? depth->view() : VK_NULL_HANDLE};
    VkFramebufferCreateInfo framebufferInfo{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    framebufferInfo.renderPass = pass;
    framebufferInfo.attachmentCount = count;
    framebufferInfo.pAttachments = views;
    framebufferInfo.width = width;
    framebufferInfo.height = height;
    framebufferInfo.layers = 1;
    EXPECT_EQ(device.vk().vkCreateFramebuffer(device.device(), &framebufferInfo, nullptr, &framebuffer), VK_SUCCESS);
    target.renderPass = pass;
    target.colorFormat = format; // by which recorders are told apart where a handle comes again
  }
  ~Attachment() {
    device.vk().vkDestroyFramebuffer(device.device(), framebuffer, nullptr);
    device.vk().vkDestroyRenderPass(device.device(), pass, nullptr);
  }
  Attachment(const Attachment&) = delete;
  Attachment& operator=(const Attachment&) = delete;

  void render(VkCommandBuffer commands, VkClearColorValue color, const std::function<void()>& draw) const {
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea.extent = {width, height};
    VkClearValue clear[2] = {{color}, {}};
    clear[1].depthStencil = {1, 0};
    begin.clearValueCount = 2;
    begin.pClearValues = clear;
    device.vk().vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport viewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1};
    const VkRect2D scissor{{0, 0}, {width, height}};
    device.vk().vkCmdSetViewport(commands, 0, 1, &viewport);
    device.vk().vkCmdSetScissor(commands, 0, 1, &scissor);
    draw();
    device.vk().vkCmdEndRenderPass(commands);
  }
  /// All of a view, a pixel a pixel.
  GpgpCanvasDrawInfo drawAll(GpgpHistory view) const {
    GpgpCanvasDrawInfo draw = GPGP_CANVAS_DRAW_INFO_INIT;
    draw.history = view;
    draw.target = &target;
    draw.width = width;
    draw.height = height;
    draw.clip[0] = 2.0f / static_cast<float>(width), draw.clip[5] = 2.0f / static_cast<float>(height);
    draw.clip[10] = draw.clip[15] = 1;
    draw.clip[12] = draw.clip[13] = -1;
    return draw;
  }
  std::vector<uint8_t> bytes() const { return host::downloadImage(device, image, VK_IMAGE_LAYOUT_GENERAL); }
};

/// Histories whose recordings keep what did not change, and others, show the same inside the engine's pass.
TEST_F(CanvasTest, KeptViewsAreThoseOfWholeRecordings) {
  const Attachment one(device, VK_FORMAT_R16G16B16A16_SFLOAT, 64, 48), other(device, one.target.colorFormat, 64, 48);
  canvasTargets = GPGP_CANVAS_TARGET_HISTORY;
  makeCanvas(64, 0, 0, &one.target);
  GpgpCanvasHistoryCreateInfo info = GPGP_CANVAS_HISTORY_CREATE_INFO_INIT;
  info.width = 64;
  info.height = 48;
  info.maxKept = 8;
  GpgpHistory kept = nullptr;
  ASSERT_EQ(gpgpCreateCanvasHistory(context, &info, &kept), GPGP_SUCCESS) << lastMessage();
  const GpgpHistory whole = makeView(64, 48);
  TestPath shape = randomShape(5, 12), ground = randomShape(7, 60);
  shape.color = {1, 0.5f, 0, 0.7f};
  ground.color = {0, 0.5f, 1, 1};
  const GpgpAsset moving = makeDrawing({shape.view()}), still = makeDrawing({ground.view()});
  for (uint32_t k = 0; k < 8; ++k) { // every second frame is that before
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer commands) {
      ASSERT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      const std::vector<GpgpCanvasItem> items = {place(still), place(moving, 1, 5.0f * static_cast<float>(k / 2), 20)};
      GpgpCanvasInfo record = infoOf(items, 64, 48);
      record.history = whole;
      ASSERT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &record), GPGP_SUCCESS) << lastMessage();
      record.history = kept;
      record.keep = VK_TRUE;
      ASSERT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &record), GPGP_SUCCESS) << lastMessage();
      for (const bool first : {true, false}) {
        const Attachment& into = first ? one : other;
        GpgpCanvasDrawInfo draw = into.drawAll(first ? kept : whole);
        draw.target = &one.target; // the passes are compatible
        into.render(commands, {}, [&] {
          ASSERT_EQ(gpgpRecordDrawCanvas(canvas, commands, &frame, &draw), GPGP_SUCCESS) << lastMessage();
        });
      }
    });
    advance();
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    ASSERT_EQ(gpgpGetCanvasReport(canvas, &report), GPGP_SUCCESS);
    ASSERT_EQ(gpgpGetCanvasReport(canvas, &report), GPGP_SUCCESS);
    const bool some = report.tilesDrawn > 0 && report.tilesDrawn < report.tiles / 2;
    EXPECT_TRUE(k == 0 || (k % 2 ? report.tilesDrawn == 0 : some)) << k << ": " << report.tilesDrawn;
    EXPECT_EQ(one.bytes(), other.bytes()) << k;
  }
  for (const GpgpHistory history : {kept, whole}) gpgpDestroyHistory(history);
  for (const GpgpAsset drawing : {moving, still}) gpgpDestroyAsset(drawing);
}

TEST_F(CanvasTest, DrawsTheViewInsideARenderPass) {
  const Attachment attachment(device, VK_FORMAT_R8G8B8A8_UNORM, 64, 48);
  canvasTargets = GPGP_CANVAS_TARGET_HISTORY;
  makeCanvas(64, 0, 0, &attachment.target);
  const GpgpHistory view = makeView(64, 48);
  TestPath square;
  square.move(10, 10).line(40, 10).line(40, 30).line(10, 30).close();
  square.color = {1, 0.5f, 0, 1};
  const GpgpAsset drawing = makeDrawing({square.view()});
  const GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer commands) {
    ASSERT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
    const std::vector<GpgpCanvasItem> items{place(drawing)};
    GpgpCanvasInfo info = infoOf(items, 64, 48);
    info.history = view;
    const GpgpCanvasDrawInfo draw = attachment.drawAll(view);
    EXPECT_EQ(gpgpRecordDrawCanvas(canvas, commands, &frame, &draw), GPGP_NOT_READY);
    ASSERT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_SUCCESS) << lastMessage();
    attachment.render(commands, {{0, 0, 1, 0}}, [&] {
      EXPECT_EQ(gpgpRecordDrawCanvas(canvas, commands, &frame, &draw), GPGP_SUCCESS) << lastMessage();
    });
  });
  const auto pixels = attachment.bytes();
  const auto at = [&](size_t x, size_t y) {
    return std::vector<uint8_t>(&pixels[(y * 64 + x) * 4], &pixels[(y * 64 + x) * 4] + 3);
  };
  EXPECT_EQ(at(5, 5), (std::vector<uint8_t>{0, 0, 255}));
  EXPECT_EQ(at(20, 20)[0], 255);
  EXPECT_NEAR(at(20, 20)[1], 128, 1);
  EXPECT_EQ(at(20, 20)[2], 0);
  EXPECT_EQ(at(39, 29)[0], 255);
  EXPECT_EQ(at(40, 30)[0], 0);
}

TEST_F(CanvasTest, TheDrawTestsDepthAndWritesNone) {
  Attachment attachment(device, VK_FORMAT_R8G8B8A8_UNORM, 64, 48, VK_FORMAT_D32_SFLOAT);
  attachment.target.depthFormat = VK_FORMAT_D32_SFLOAT;
  attachment.target.depthTest = VK_TRUE;
  attachment.target.depthCompare = VK_COMPARE_OP_LESS;
  canvasTargets = GPGP_CANVAS_TARGET_HISTORY;
  makeCanvas(64, 0, 0, &attachment.target);
  const GpgpHistory view = makeView(64, 48);
  TestPath all;
  all.move(0, 0).line(64, 0).line(64, 48).line(0, 48).close();
  all.color = {1, 1, 1, 0.5f};
  const GpgpAsset drawing = makeDrawing({all.view()});
  const GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer commands) {
    ASSERT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
    const std::vector<GpgpCanvasItem> items{place(drawing)};
    GpgpCanvasInfo info = infoOf(items, 64, 48);
    info.history = view;
    ASSERT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_SUCCESS) << lastMessage();
    attachment.render(commands, {{0, 0, 0, 0}}, [&] {
      // What is there: at the left nearer than the view, in the middle farther, at the right farther still.
      const float depths[] = {0.25f, 0.6f, 0.9f};
      for (int32_t i = 0; i < 3; ++i) {
        VkClearAttachment clear{VK_IMAGE_ASPECT_DEPTH_BIT, 0, {}};
        clear.clearValue.depthStencil = {depths[i], 0};
        const VkClearRect part{{{20 * i, 0}, {20, 48}}, 0, 1};
        device.vk().vkCmdClearAttachments(commands, 1, &clear, 1, &part);
      }
      GpgpCanvasDrawInfo draw = attachment.drawAll(view);
      draw.clip[14] = 0.5f; // the upper half
      draw.height = 24;
      EXPECT_EQ(gpgpRecordDrawCanvas(canvas, commands, &frame, &draw), GPGP_SUCCESS) << lastMessage();
      draw = attachment.drawAll(view);
      draw.clip[14] = 0.75f;
      EXPECT_EQ(gpgpRecordDrawCanvas(canvas, commands, &frame, &draw), GPGP_SUCCESS) << lastMessage();
    });
  });
  const auto pixels = attachment.bytes();
  const auto red = [&](size_t x, size_t y) { return int(pixels[(y * 64 + x) * 4]); };
  for (const size_t y : {2u, 20u}) {
    EXPECT_EQ(red(10, y), 0);
    EXPECT_NEAR(red(30, y), 128, 1) << "only the first is in front";
    EXPECT_NEAR(red(50, y), 191, 1) << "both are, and the first has left no depth";
  }
  for (const size_t y : {28u, 45u}) {
    EXPECT_EQ(red(10, y), 0);
    EXPECT_EQ(red(30, y), 0);
    EXPECT_NEAR(red(50, y), 128, 1);
  }
}

struct TwoWays : CanvasTest {
  static constexpr uint32_t kWidth = 160, kHeight = 120;
  /// What an attachment and a storage image hold of the same items: prepared apart, or by one record.
  std::pair<std::vector<uint8_t>, std::vector<uint8_t>> bothWays(const std::vector<GpgpCanvasItem>& items,
                                                                 const Attachment& attachment, GpgpHistory view,
                                                                 const host::Image& direct, bool opaque, bool apart,
                                                                 bool drawEncodes = false) {
    const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      GpgpCanvasInfo info = infoOf(items, kWidth, kHeight);
      if (opaque)
        info.background[0] = 0.9f, info.background[1] = 0.3f, info.background[2] = 0.05f, info.background[3] = 1;
      info.target = direct.target({}, after);
      if (!apart) info.history = view;
      EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_SUCCESS) << lastMessage();
      if (apart) {
        info.history = view;
        info.target = {};
        EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_SUCCESS) << lastMessage();
      }
      GpgpCanvasDrawInfo draw = attachment.drawAll(view);
      draw.encodeSrgb = drawEncodes ? VK_TRUE : VK_FALSE;
      attachment.render(commands, {}, [&] {
        EXPECT_EQ(gpgpRecordDrawCanvas(canvas, commands, &frame, &draw), GPGP_SUCCESS) << lastMessage();
      });
    });
    advance();
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    while (gpgpGetCanvasReport(canvas, &report) == GPGP_SUCCESS) EXPECT_EQ(report.base.status, GPGP_SUCCESS);
    return {attachment.bytes(), host::downloadImage(device, direct, VK_IMAGE_LAYOUT_GENERAL)};
  }
  void compare(const char* file) {
    const auto svg = fetchedSvg(file);
    if (!svg) GTEST_SKIP() << file << " is not there";
    const vector::svg::ImportedViews views(*svg);
    const float scale = std::min(float(kWidth) / float(svg->width), float(kHeight) / float(svg->height));
    TestPath veil = randomShape(7, 160); // the half of it through which what lies below shows
    veil.color = {0.1f, 0.4f, 0.8f, 0.37f};
    const std::vector<GpgpCanvasItem> items{place(makeDrawing(views.paths, views.groups), scale),
                                            place(makeDrawing({veil.view()}), 0.6f)};
    for (const VkFormat format : {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB}) {
      const Attachment attachment(device, format, kWidth, kHeight);
      canvasTargets = 0;
      makeCanvas(256, 0, 1u << 18, &attachment.target);
      const GpgpHistory view = makeView(kWidth, kHeight);
      const bool encodes = format == VK_FORMAT_R8G8B8A8_SRGB;
      const auto image = [&](VkFormat of) {
        return host::Image(device, {.format = of, .width = kWidth, .height = kHeight});
      };
      const host::Image wide = image(VK_FORMAT_R16G16B16A16_SFLOAT), narrow = image(VK_FORMAT_R8G8B8A8_UNORM);
      for (const int k : {0, 5, 10, 15}) {
        blendSrgb = (k & 1) != 0, exactArea = (k & 2) != 0, encodeSrgb = false;
        const bool opaque = (k & 4) != 0, apart = (k & 8) != 0;
        const std::string where =
            std::string(file) + ", format " + std::to_string(format) + ", mixing " + std::to_string(k);
        const auto [drawn, stored] =
            bothWays(items, attachment, view, format == VK_FORMAT_R8G8B8A8_UNORM ? narrow : wide, opaque, apart);
        if (format == VK_FORMAT_R16G16B16A16_SFLOAT) {
          ASSERT_EQ(drawn.size(), stored.size());
          int worst = 0; // in units of the last place: none is below 0
          for (size_t i = 0; i < drawn.size(); i += 2) {
            uint16_t a, b;
            std::memcpy(&a, &drawn[i], 2);
            std::memcpy(&b, &stored[i], 2);
            worst = std::max(worst, std::abs(a - b));
          }
          EXPECT_LE(worst, 1) << where;
        } else {
          int worst = 0;
          for (size_t i = 0; i < drawn.size(); ++i) {
            double expected = stored[encodes ? 0 : i];
            if (encodes) { // what sRGB encodes of premultiplied light
              uint16_t half;
              std::memcpy(&half, &stored[i * 2], 2);
              const float light = std::clamp(fromHalf(half), 0.0f, 1.0f);
              expected = std::round(255 * static_cast<double>(i % 4 == 3 ? light : host::srgbFromLinear(light)));
            }
            worst = std::max(worst, std::abs(drawn[i] - static_cast<int>(expected)));
          }
          EXPECT_LE(worst, 1) << where;
        }
        if (format == VK_FORMAT_R16G16B16A16_SFLOAT || (encodes && !opaque)) continue;
        encodeSrgb = true; // by the attachment's format, or by the draw
        const auto [again, encoded] = bothWays(items, attachment, view, narrow, opaque, apart, !encodes);
        int worst = 0;
        for (size_t i = 0; i < again.size(); ++i) worst = std::max(worst, std::abs(again[i] - encoded[i]));
        EXPECT_LE(worst, 1) << where;
      }
    }
  }
};

/// Of the three pipelines that each pass has, those that no record needs are not made, and records that would need them
/// are refused.
TEST_F(CanvasTest, WritesOnlyTheTargetsItWasMadeFor) {
  TestPath square;
  square.move(0, 0).line(4, 0).line(4, 4).line(0, 4).close();
  const std::vector<GpgpCanvasItem> items{place(makeDrawing({square.view()}))};
  const GpgpHistory view = makeView(64, 64);
  const host::Image narrow(device, {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = 64, .height = 64});
  const host::Image wide(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = 64, .height = 64});
  const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
  const std::pair<GpgpCanvasTargets, const host::Image*> ways[] = {
      {GPGP_CANVAS_TARGET_HISTORY, nullptr},
      {GPGP_CANVAS_TARGET_RGBA8, &narrow},
      {GPGP_CANVAS_TARGET_RGBA16F, &wide},
      {GPGP_CANVAS_TARGET_HISTORY | GPGP_CANVAS_TARGET_RGBA8, &narrow}, // on software devices, a pass for each
      {GPGP_CANVAS_TARGET_HISTORY | GPGP_CANVAS_TARGET_RGBA16F, &wide}};
  const auto passCount = [&](GpgpCanvasTargets wanted) {
    canvasTargets = wanted;
    makeCanvas(56);
    uint32_t count = 0;
    EXPECT_EQ(gpgpGetPasses(canvas, &count, nullptr), GPGP_SUCCESS);
    return count;
  };
  const uint32_t all = passCount(0);
  for (const GpgpCanvasTargets made : {1, 2, 4, 3, 5}) {
    EXPECT_LT(passCount(made), all * (made == 3 || made == 5 ? 1 : 0.75)) << made;
    for (const auto& [written, image] : ways) {
      const GpgpFrame frame = advance();
      device.submitAndWait([&](VkCommandBuffer commands) {
        EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
        GpgpCanvasInfo info = infoOf(items, 56, 56);
        if (written & GPGP_CANVAS_TARGET_HISTORY) info.history = view;
        if (image) info.target = image->target({}, after);
        const bool may = (written & ~made) == 0;
        EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info),
                  may ? GPGP_SUCCESS : GPGP_ERROR_INVALID_ARGUMENT);
        if (!may) {
          EXPECT_NE(lastMessage().find("GpgpCanvasCreateInfo::targets"), std::string::npos) << lastMessage();
        }
      });
    }
  }
  GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
  info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
  info.targets = 8;
  GpgpRecorder none = nullptr;
  EXPECT_EQ(gpgpCreateCanvas(context, &info, &none), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(none, nullptr);
}

TEST_F(TwoWays, OfAPanelHaveTheSamePixels) { compare("svg/hud.svg"); }
TEST_F(TwoWays, OfClipsAndGroupsHaveTheSamePixels) { compare("svg/clips.svg"); }
TEST_F(TwoWays, OfTheTigerHaveTheSamePixels) { compare("fetched/svg/tiger.svgz"); }

} // namespace
