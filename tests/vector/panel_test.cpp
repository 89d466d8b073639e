// Panels in the world: where a camera sees them, the depth test against a scene, and both eyes of a stereo view.
#include "ui_fixture.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <numeric>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr uint32_t kWidth = 64, kHeight = 48;

/// World to clip space as Vulkan has it: +Y down, depth 0 to 1. `eye` is how far the camera stands right of the middle.
glm::mat4 camera(float eye) {
  glm::mat4 projection = glm::perspectiveRH_ZO(glm::radians(60.0f), 4.0f / 3.0f, 0.5f, 20.0f);
  projection[1][1] = -projection[1][1];
  return projection * glm::lookAtRH(glm::vec3(eye, 0.3f, 4), glm::vec3(eye, 0, 0), glm::vec3(0, 1, 0));
}

/// 4 x 3 metres, 100 units a metre, turned: its left side is near, its right side far.
GpgpPanel tilted() {
  const float c = 0.02f / 3, s = 0.02f * 0.37f;
  return {{-1.6f, 1.3f, 1.2f}, {c, 0, -s}, {0.001f, -0.009f, 0}};
}

/// A window: round corners, a bar, a button within a clip that is turned, a text-like row of lines.
void fillWindow(TestList& list) {
  list.reset().add(rounded(rectangle(0, 0, 400, 300, {0.02f, 0.04f, 0.12f, 1}), 40, 40, 40, 40));
  list.add(rounded(rectangle(0, 0, 400, 300, {1, 0.8f, 0.1f, 1}), 40, 40, 40, 40, 12));
  list.clip({30, 30, 370, 270}, {20, 20, 20, 20}).add(rectangle(30, 30, 370, 90, {0.1f, 0.4f, 0.9f, 1}));
  for (int i = 0; i < 5; ++i) {
    const float y = 120 + 30 * static_cast<float>(i);
    GpgpListShape row = line(60, y, 340 - 40 * static_cast<float>(i % 3), y, 12, GPGP_CAP_ROUND);
    list.add(row);
  }
  list.push(turned(30, 1, 300, 200)).add(ellipse(rectangle(-60, -60, 60, 60, {0.9f, 0.1f, 0.1f, 1}))).pop(2);
}

/// The panel's point under a pixel, and its depth there; false behind the camera.
bool panelAt(const GpgpPanel& panel, const glm::mat4& viewProjection, double px, double py, double& u, double& v,
             double& depth) {
  const glm::dmat4 m(viewProjection);
  const auto vector = [](const float* p, double w) { return glm::dvec4(p[0], p[1], p[2], w); };
  const glm::dvec4 a = m * vector(panel.across, 0), b = m * vector(panel.down, 0), o = m * vector(panel.corner, 1);
  const double x = 2 * px / kWidth - 1, y = 2 * py / kHeight - 1;
  // a.x u + b.x v + o.x = x (a.w u + b.w v + o.w), likewise y
  const double p = a.x - x * a.w, q = b.x - x * b.w, r = x * o.w - o.x;
  const double s = a.y - y * a.w, t = b.y - y * b.w, w = y * o.w - o.y;
  const double determinant = p * t - q * s;
  u = (r * t - q * w) / determinant;
  v = (p * w - r * s) / determinant;
  const double distance = a.w * u + b.w * v + o.w;
  depth = (a.z * u + b.z * v + o.z) / distance;
  return distance > 0;
}

struct Targets { // colour and depth, a layer a view
  host::Image color, depth;
  VkRenderingAttachmentInfo colorAttachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO},
      depthAttachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  Targets(host::HeadlessDevice& device, uint32_t layers)
      : color(device, {.format = VK_FORMAT_R8G8B8A8_SRGB,
                       .width = kWidth,
                       .height = kHeight,
                       .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                       .layers = layers}),
        depth(device, {.format = VK_FORMAT_D32_SFLOAT,
                       .width = kWidth,
                       .height = kHeight,
                       .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                       .layers = layers}) {
    for (VkRenderingAttachmentInfo* info : {&colorAttachment, &depthAttachment}) {
      info->imageView = info == &colorAttachment ? color.view() : depth.view();
      info->imageLayout = VK_IMAGE_LAYOUT_GENERAL;
      info->loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
      info->storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    }
    depthAttachment.clearValue.depthStencil.depth = 1;
  }
};
const VkRect2D kBlock{{24, 12}, {20, 30}}; // the scene: a grey block that faces the camera
constexpr float kBlockDepth = 0.9f;

/// A picture of the scene and the panel, against the depth of each.
void expectPanel(const GpgpPanel& panel, const glm::mat4& viewProjection, const uint8_t* pixels) {
  uint32_t before = 0, behind = 0;
  for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const uint32_t x = i % kWidth, y = i / kWidth;
    const uint8_t* pixel = pixels + size_t(i) * 4;
    bool inside = true, outside = true; // all of the pixel within the window's border, or beyond it
    double depth = 0;
    for (int k = 0; k < 5; ++k) {
      double u = 0, v = 0;
      const double px = x + (k == 4 ? 0.5 : k % 2), py = y + (k == 4 ? 0.5 : k / 2);
      const bool seen = panelAt(panel, viewProjection, px, py, u, v, depth);
      inside = inside && seen && u > 15 && u < 385 && v > 15 && v < 285;
      outside = outside && (!seen || u < 0 || u > 400 || v < 0 || v > 300);
    }
    const bool block = x >= 24 && x < 44 && y >= 12 && y < 42;
    const bool grey = pixel[0] == 137 && pixel[1] == 137 && pixel[2] == 137;
    if (outside) {
      ASSERT_EQ(block, grey) << x << " " << y;
      ASSERT_EQ(pixel[3], block ? 255 : 0) << x << " " << y;
    }
    if (inside && !block) {
      ASSERT_EQ(pixel[3], 255) << x << " " << y;
    }
    if (!inside || !block || std::abs(depth - static_cast<double>(kBlockDepth)) < 1e-5) continue;
    const bool hidden = depth > static_cast<double>(kBlockDepth);
    ASSERT_EQ(hidden, grey) << x << " " << y << ", depth " << depth;
    ++(hidden ? behind : before);
  }
  EXPECT_GT(before, 50u);
  EXPECT_GT(behind, 50u);
}

TEST_F(CanvasTest, PanelsAreInFrontOfTheSceneAndBehindItInBothEyes) {
  const GpgpFeatures features = device.contextCreateInfo().features;
  if (!(features & GPGP_FEATURE_DYNAMIC_RENDERING) || !(features & GPGP_FEATURE_MULTIVIEW))
    GTEST_SKIP() << "the device has no dynamic rendering or no multiview";
  // lavapipe of Mesa 22.3 leaves view 1 of a multiview pass as it was cleared; there, the eyes' own passes are judged.
  const bool judgesMultiview = device.properties().deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU;
  canvasTargets = GPGP_CANVAS_TARGET_HISTORY;
  makeCanvas(128);
  TestList list(context);
  fillWindow(list);
  const GpgpPanel panel = tilted();
  const glm::mat4 cameras[] = {camera(-0.1f), camera(0.1f)};
  std::vector<GpgpCanvasItem> items(2, list.item()); // side by side on one canvas
  float clips[2][16];
  for (uint32_t eye = 0; eye < 2; ++eye) {
    const uint32_t viewport[] = {eye * kWidth, 0, kWidth, kHeight};
    ASSERT_EQ(gpgpPlacePanel(&panel, glm::value_ptr(cameras[eye]), viewport, &items[eye], clips[eye]), GPGP_SUCCESS);
  }
  const GpgpHistory view = makeView(2 * kWidth, kHeight);
  for (const bool multiview : {false, true}) {
    GpgpTargetInfo target = GPGP_TARGET_INFO_INIT;
    target.colorFormat = VK_FORMAT_R8G8B8A8_SRGB;
    target.depthFormat = VK_FORMAT_D32_SFLOAT;
    target.viewMask = multiview ? 3 : 0;
    target.depthTest = VK_TRUE;
    target.depthCompare = VK_COMPARE_OP_LESS;
    GpgpPrewarmInfo prewarm = GPGP_PREWARM_INFO_INIT;
    prewarm.targets = &target;
    prewarm.targetCount = 1;
    ASSERT_EQ(gpgpPrewarm(canvas, &prewarm), GPGP_SUCCESS) << lastMessage();
    const uint32_t passes = multiview ? 1 : 2;
    std::vector<Targets> targets;
    targets.reserve(2);
    for (uint32_t pass = 0; pass < passes; ++pass) targets.emplace_back(device, multiview ? 2 : 1);
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer commands) {
      ASSERT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
      info.width = 2 * kWidth;
      info.height = kHeight;
      info.items = items.data();
      info.itemCount = 2;
      info.history = view;
      ASSERT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_SUCCESS) << lastMessage();
      for (uint32_t pass = 0; pass < passes; ++pass) {
        for (const host::Image* image : {&targets[pass].color, &targets[pass].depth})
          host::imageBarrier(device, commands, *image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
        VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
        rendering.renderArea.extent = {kWidth, kHeight};
        rendering.layerCount = 1;
        rendering.viewMask = target.viewMask;
        rendering.colorAttachmentCount = 1;
        rendering.pColorAttachments = &targets[pass].colorAttachment;
        rendering.pDepthAttachment = &targets[pass].depthAttachment;
        const auto& vk = device.vk();
        vk.vkCmdBeginRenderingKHR(commands, &rendering);
        VkClearAttachment scene[2] = {};
        scene[0].aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
        for (float& channel : scene[0].clearValue.color.float32) channel = 0.25f;
        scene[0].clearValue.color.float32[3] = 1;
        scene[1].aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
        scene[1].clearValue.depthStencil.depth = kBlockDepth;
        const VkClearRect rect{kBlock, 0, 1};
        vk.vkCmdClearAttachments(commands, 2, scene, 1, &rect);
        const VkViewport viewport{0, 0, kWidth, kHeight, 0, 1};
        const VkRect2D scissor{{0, 0}, {kWidth, kHeight}};
        vk.vkCmdSetViewport(commands, 0, 1, &viewport);
        vk.vkCmdSetScissor(commands, 0, 1, &scissor);
        GpgpCanvasDrawInfo draw = GPGP_CANVAS_DRAW_INFO_INIT;
        draw.history = view;
        draw.target = &target;
        draw.width = kWidth;
        draw.height = kHeight;
        std::copy_n(clips[pass], 16, draw.clip);
        draw.x = pass * kWidth;
        draw.secondX = kWidth;
        draw.secondClip = clips[1];
        EXPECT_EQ(gpgpRecordDrawCanvas(canvas, commands, &frame, &draw), GPGP_SUCCESS) << lastMessage();
        draw.x = kWidth + 1;
        EXPECT_EQ(gpgpRecordDrawCanvas(canvas, commands, &frame, &draw), GPGP_ERROR_INVALID_ARGUMENT);
        vk.vkCmdEndRenderingKHR(commands);
      }
    });
    std::vector<uint8_t> bytes;
    for (const Targets& t : targets) {
      const auto pixels = host::downloadImage(device, t.color, VK_IMAGE_LAYOUT_GENERAL);
      bytes.insert(bytes.end(), pixels.begin(), pixels.end());
    }
    ASSERT_EQ(bytes.size(), size_t(8) * kWidth * kHeight);
    for (uint32_t eye = 0; eye < (multiview && !judgesMultiview ? 1u : 2u); ++eye) {
      const uint8_t* layer = &bytes[size_t(eye) * 4 * kWidth * kHeight];
      if (const char* folder = std::getenv("GPGP_TEST_PICTURES"))
        host::writePng(std::string(folder) + "/panel" + (multiview ? "m" : "") + std::to_string(eye) + ".png",
                       {kWidth, kHeight, {layer, layer + size_t(4) * kWidth * kHeight}});
      expectPanel(panel, cameras[eye], layer);
    }
  }
  // What lies under a pixel of the right eye.
  double u = 0, v = 0, depth = 0;
  ASSERT_TRUE(panelAt(panel, cameras[1], 20.5, 20.5, u, v, depth));
  GpgpHitTestInfo hitInfo = GPGP_HIT_TEST_INFO_INIT;
  hitInfo.items = items.data();
  hitInfo.itemCount = 2;
  hitInfo.x = 20.5f + static_cast<float>(kWidth);
  hitInfo.y = 20.5f;
  GpgpHit hit{};
  ASSERT_EQ(gpgpHitTest(context, &hitInfo, &hit), GPGP_SUCCESS);
  EXPECT_EQ(hit.item, 1u);
  EXPECT_NEAR(hit.x, u, 0.01);
  EXPECT_NEAR(hit.y, v, 0.01);
  gpgpDestroyHistory(view);
  GpgpTargetInfo many = GPGP_TARGET_INFO_INIT;
  many.colorFormat = VK_FORMAT_R8G8B8A8_SRGB;
  many.viewMask = 4;
  GpgpPrewarmInfo prewarm = GPGP_PREWARM_INFO_INIT;
  prewarm.targets = &many;
  prewarm.targetCount = 1;
  EXPECT_EQ(gpgpPrewarm(canvas, &prewarm), GPGP_ERROR_UNSUPPORTED);
  GpgpCanvasItem item{};
  const uint32_t nothing[] = {0, 0, 0, 48};
  EXPECT_EQ(gpgpPlacePanel(&panel, glm::value_ptr(camera(0)), nothing, &item, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
}
/// A panel that turns about its upright middle until its edge is all that is seen, reaching past the eye in some.
TEST_F(CanvasTest, PanelsSeenNearlyEdgeOnCoverWhatRaysSay) {
  canvasTargets = 0;
  makeCanvas(128);
  TestList list(context);
  fillWindow(list);
  for (const float width : {4.0f, 12.0f}) // of the second, a side is behind the eye
    for (const float degrees : {60.0f, 80.0f, 88.0f, 89.9f, 89.999f, 90.0f, 90.001f, 91.0f}) {
      SCOPED_TRACE(std::to_string(width) + " m at " + std::to_string(degrees));
      const float a = glm::radians(degrees), c = width * std::cos(a), s = width * std::sin(a);
      const GpgpPanel panel{
          {-c / 2, 1.2f, s / 2}, {c / 400, 0, -s / 400}, {0, -0.008f, 0}}; // its right side is the far one
      const glm::mat4 seenBy = camera(0);
      const uint32_t viewport[] = {0, 0, kWidth, kHeight};
      GpgpCanvasItem item = list.item();
      float clip[16];
      ASSERT_EQ(gpgpPlacePanel(&panel, glm::value_ptr(seenBy), viewport, &item, clip), GPGP_SUCCESS);
      const GpgpListShape window = rounded(rectangle(0, 0, 400, 300), 40, 40, 40, 40);
      std::vector<double> wanted(kWidth * kHeight);
      for (uint32_t i = 0; i < wanted.size(); ++i)
        for (int k = 0; k < 256; ++k) {
          double u = 0, v = 0, depth = 0;
          const double x = i % kWidth + (k % 16 + 0.5) / 16, y = i / kWidth + (k / 16 + 0.5) / 16;
          wanted[i] += panelAt(panel, seenBy, x, y, u, v, depth) && inShape(window, u, v) ? 1 / 256.0 : 0;
        }
      const double seen = std::accumulate(wanted.begin(), wanted.end(), 0.0);
      if (degrees < 85 || degrees > 90.5f) {
        EXPECT_GT(seen, degrees < 85 ? 100 : 1);
      }
      for (const bool area : {false, true}) {
        exactArea = area;
        const auto pixels = raster({item}, kWidth, kHeight, 16);
        double worst = 0, sum = 0;
        for (uint32_t i = 0; i < wanted.size(); ++i) {
          const auto alpha = static_cast<double>(pixels[i].a);
          ASSERT_TRUE(alpha >= 0 && alpha <= 1.001) << alpha;
          worst = std::max(worst, std::abs(alpha - wanted[i]));
          sum += std::abs(alpha - wanted[i]);
        }
        EXPECT_LE(worst, 0.3);
        EXPECT_LE(sum / static_cast<double>(wanted.size()), 0.008);
      }
    }
}

TEST(Panel, NothingOfOneInTheEyesPlaneAndNoNumbersBeyondFloats) {
  const float camera[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.1f, 0}; // at 0, looking along -z
  const uint32_t viewport[4] = {0, 0, 64, 64};
  GpgpPanel panel{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  GpgpCanvasItem item{};
  ASSERT_EQ(gpgpPlacePanel(&panel, camera, viewport, &item, nullptr), GPGP_SUCCESS);
  // w of every point of the panel: below 0 is not drawn; 0, 0, 0 would be an affine item.
  EXPECT_EQ(item.perspective[0], 0.0f);
  EXPECT_EQ(item.perspective[1], 0.0f);
  EXPECT_LT(item.perspective[2], 0.0f);

  float large[16];
  std::copy_n(camera, 16, large);
  large[0] = 1e10f;
  panel.across[0] = 3e38f;
  item.transform[0] = 7;
  float clip[16] = {7};
  EXPECT_EQ(gpgpPlacePanel(&panel, large, viewport, &item, clip), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(item.transform[0], 7.0f) << "written in spite of the error";
  EXPECT_EQ(clip[0], 7.0f);
}

} // namespace
