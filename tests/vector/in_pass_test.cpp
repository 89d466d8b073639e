// Patches drawn inside a render pass: coverage against winding numbers, samples counted, maps of all kinds against the
// canvas.
#include "canvas_fixture.h"
#include "fetched_svg.h"
#include "tile_difference.h"

#include <functional>
#include <optional>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr VkFormat kFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

/// A render pass on a half-float image, resolved where it has several samples.
struct Attachment {
  host::HeadlessDevice& device;
  const uint32_t width, height;
  host::Image image;
  std::optional<host::Image> samples;
  VkRenderPass pass = VK_NULL_HANDLE;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  GpgpTargetInfo target = GPGP_TARGET_INFO_INIT;

  Attachment(host::HeadlessDevice& owner, uint32_t w, uint32_t h, uint32_t count)
      : device(owner), width(w), height(h),
        image(owner, {.format = kFormat, .width = w, .height = h, .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}) {
    const bool several = count > 1;
    if (several)
      samples.emplace(device, host::ImageInfo{.format = kFormat,
                                              .width = w,
                                              .height = h,
                                              .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                              .samples = VkSampleCountFlagBits(count)});
    const auto described = [](uint32_t of, VkImageLayout last) {
      return VkAttachmentDescription{0,
                                     kFormat,
                                     VkSampleCountFlagBits(of),
                                     VK_ATTACHMENT_LOAD_OP_CLEAR,
                                     VK_ATTACHMENT_STORE_OP_STORE,
                                     VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                     VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                     VK_IMAGE_LAYOUT_UNDEFINED,
                                     last};
    };
    const VkAttachmentDescription attachments[] = {
        described(count, several ? VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_GENERAL),
        described(1, VK_IMAGE_LAYOUT_GENERAL)};
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
        resolve{1, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    if (several) subpass.pResolveAttachments = &resolve;
    VkRenderPassCreateInfo passInfo{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    passInfo.attachmentCount = several ? 2 : 1;
    passInfo.pAttachments = attachments;
    passInfo.subpassCount = 1;
    passInfo.pSubpasses = &subpass;
    EXPECT_EQ(device.vk().vkCreateRenderPass(device.device(), &passInfo, nullptr, &pass), VK_SUCCESS);
    const VkImageView views[] = {several ? samples->view() : image.view(), image.view()};
    VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    info.renderPass = pass;
    info.attachmentCount = passInfo.attachmentCount;
    info.pAttachments = views;
    info.width = width;
    info.height = height;
    info.layers = 1;
    EXPECT_EQ(device.vk().vkCreateFramebuffer(device.device(), &info, nullptr, &framebuffer), VK_SUCCESS);
    target.renderPass = pass;
    target.colorFormat = kFormat;
    target.samples = VkSampleCountFlagBits(count);
  }
  ~Attachment() {
    device.vk().vkDestroyFramebuffer(device.device(), framebuffer, nullptr);
    device.vk().vkDestroyRenderPass(device.device(), pass, nullptr);
  }
  Attachment(const Attachment&) = delete;
  Attachment& operator=(const Attachment&) = delete;

  void render(VkCommandBuffer commands, uint32_t shownWidth, uint32_t shownHeight,
              const std::function<void()>& draw) const {
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea.extent = {width, height};
    const VkClearValue clear[2] = {};
    begin.clearValueCount = 2;
    begin.pClearValues = clear;
    device.vk().vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport viewport{0, 0, static_cast<float>(shownWidth), static_cast<float>(shownHeight), 0, 1};
    const VkRect2D scissor{{0, 0}, {shownWidth, shownHeight}};
    device.vk().vkCmdSetViewport(commands, 0, 1, &viewport);
    device.vk().vkCmdSetScissor(commands, 0, 1, &scissor);
    draw();
    device.vk().vkCmdEndRenderPass(commands);
  }
};

struct InPassTest : CanvasTest {
  static constexpr uint32_t kLargest = 256;
  inline static std::map<uint32_t, std::unique_ptr<Attachment>> attachments; // by samples; pipelines are made once

  static void TearDownTestSuite() {
    attachments.clear();
    CanvasTest::TearDownTestSuite();
  }

  GpgpAsset makePatchDrawing(const std::vector<GpgpPath>& paths, GpgpDrawingMethods methods = GPGP_DRAWING_IN_PASS,
                             const std::vector<GpgpPathGroup>& groups = {}) {
    GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    info.paths = paths.data();
    info.pathCount = static_cast<uint32_t>(paths.size());
    info.groups = groups.data();
    info.groupCount = static_cast<uint32_t>(groups.size());
    info.methods = methods;
    GpgpAsset drawing = nullptr;
    EXPECT_EQ(gpgpCreateDrawing(context, &info, &drawing), GPGP_SUCCESS) << lastMessage();
    return drawing;
  }
  /// The same map as a canvas item's, which leads to pixels.
  static GpgpPatchItem itemOf(const GpgpCanvasItem& item, uint32_t width, uint32_t height) {
    GpgpPatchItem made{};
    made.drawing = item.drawing;
    made.glyphSet = item.glyphSet;
    made.glyphs = item.glyphs;
    made.glyphCount = item.glyphCount;
    made.opacity = item.opacity;
    const bool affine = item.perspective[0] == 0 && item.perspective[1] == 0 && item.perspective[2] == 0;
    for (int c = 0; c < 3; ++c) {
      float* clip = made.clip + (c == 2 ? 12 : c * 4);
      const float w = affine ? (c == 2 ? 1.0f : 0.0f) : item.perspective[c];
      clip[0] = 2 * item.transform[2 * c] / static_cast<float>(width) - w;
      clip[1] = 2 * item.transform[2 * c + 1] / static_cast<float>(height) - w;
      clip[3] = w;
    }
    return made;
  }
  std::vector<Rgba> draw(const std::vector<GpgpCanvasItem>& shown, uint32_t width, uint32_t height, uint32_t samples,
                         GpgpResult expected = GPGP_SUCCESS) {
    auto& made = attachments[samples];
    if (!made) made = std::make_unique<Attachment>(device, kLargest, kLargest, samples);
    const Attachment& attachment = *made;
    GpgpPatchRecorderCreateInfo info = GPGP_PATCH_RECORDER_CREATE_INFO_INIT;
    info.base = {"patches", device.graphics().family, 0, VK_FALSE};
    const GpgpRecorder patches = recorder(gpgpCreatePatchRecorder, info, &attachment.target);
    std::vector<GpgpPatchItem> items;
    for (const GpgpCanvasItem& item : shown) items.push_back(itemOf(item, width, height));
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      GpgpPatchDrawInfo draw = GPGP_PATCH_DRAW_INFO_INIT;
      draw.target = &attachment.target;
      draw.items = items.data();
      draw.itemCount = static_cast<uint32_t>(items.size());
      draw.viewport[2] = static_cast<float>(width);
      draw.viewport[3] = static_cast<float>(height);
      draw.encodeSrgb = blendSrgb ? VK_TRUE : VK_FALSE;
      attachment.render(commands, width, height, [&] {
        EXPECT_EQ(gpgpRecordDrawPatches(patches, commands, &frame, &draw), expected) << lastMessage();
      });
    });
    const std::vector<uint8_t> bytes = host::downloadImage(device, attachment.image, VK_IMAGE_LAYOUT_GENERAL);
    std::vector<Rgba> pixels(size_t(width) * height);
    for (size_t i = 0; i < pixels.size(); ++i) {
      uint16_t h[4];
      std::memcpy(h, bytes.data() + (i / width * kLargest + i % width) * 8, 8);
      pixels[i] = {fromHalf(h[0]), fromHalf(h[1]), fromHalf(h[2]), fromHalf(h[3])};
    }
    return pixels;
  }
};

TEST_F(InPassTest, ADrawShowsAnyNumberOfDrawings) {
  std::vector<TestPath> shapes;
  std::vector<GpgpPath> all;
  std::vector<GpgpCanvasItem> items;
  for (uint32_t i = 0; i < 100; ++i) {
    TestPath& shape = shapes.emplace_back(randomShape(i, 20));
    for (size_t p = 0; p < shape.points.size(); ++p) shape.points[p] += float((p % 2 ? i / 10 : i % 10) * 24);
    shape.color = {float(i % 3) / 2, float(i % 5) / 4, 1, 1};
    items.push_back(place(makePatchDrawing({shape.view()})));
  }
  for (const TestPath& shape : shapes) all.push_back(shape.view());
  const auto got = draw(items, 240, 240, 1), want = draw({place(makePatchDrawing(all))}, 240, 240, 1);
  double worst = 0, ink = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    worst = std::max({worst, double(std::abs(got[i].r - want[i].r)), double(std::abs(got[i].a - want[i].a))});
    ink += double(got[i].a);
  }
  EXPECT_LE(worst, 1.0 / 1024);
  EXPECT_GT(ink, 1000);
}

/// The area of a path in each pixel, by 64 rows of exact spans; pixels: scale * drawing + shift.
std::vector<double> areas(const GpgpPath& path, double scale, double x, double y, uint32_t size) {
  constexpr int kRows = 64;
  const PathOracle oracle(path);
  std::vector<double> area(size_t(size) * size, 0.0);
  for (uint32_t row = 0; row < size; ++row)
    for (int r = 0; r < kRows; ++r) {
      int winding = 0;
      double from = 0;
      for (const auto& c : oracle.crossings((row + (r + 0.5) / kRows - y) / scale)) {
        const auto inside = [&](int w) { return path.fillRule == GPGP_FILL_EVEN_ODD ? (w & 1) != 0 : w != 0; };
        const bool before = inside(winding);
        winding += c.direction;
        const double at = c.x * scale + x;
        if (!before && inside(winding)) from = at;
        if (!before || inside(winding)) continue;
        const double first = std::max(from, 0.0), last = std::min(at, double(size));
        for (double column = std::floor(first); column < last; ++column)
          area[row * size + static_cast<uint32_t>(column)] +=
              (std::min(last, column + 1) - std::max(first, column)) / kRows;
      }
    }
  return area;
}

double decibels(double squares, size_t count) { return -10 * std::log10(std::max(squares / double(count), 1e-12)); }

/// Coverage of single paths: 50 dB by area or better, no tile off by more than a hundredth, inside without a seam.
TEST_F(InPassTest, CoverageIsTheAreaAtAnyZoom) {
  constexpr uint32_t kSize = 96;
  for (uint32_t seed = 1; seed <= 4; ++seed) {
    const TestPath path = randomShape(seed, 90);
    const GpgpPath view = path.view();
    const GpgpAsset drawing = makePatchDrawing({view});
    const PathOracle oracle(view);
    const auto row = oracle.crossings(45);
    for (const float zoom : {0.125f, 1.0f, 16.0f, 256.0f}) {
      const float x = zoom > 1 && !row.empty() ? kSize / 2 - zoom * static_cast<float>(row[0].x) : 3;
      const float y = zoom > 1 ? kSize / 2 - zoom * 45 : 3;
      const auto pixels = draw({place(drawing, zoom, x, y)}, kSize, kSize, 1);
      const auto wanted = areas(view, static_cast<double>(zoom), static_cast<double>(x), static_cast<double>(y), kSize);
      double squares = 0;
      size_t seams = 0;
      for (size_t i = 0; i < pixels.size(); ++i) {
        const double off = static_cast<double>(pixels[i].a) - wanted[i];
        squares += off * off;
        seams += wanted[i] > 1 - 1e-9 && pixels[i].a != 1;
      }
      EXPECT_GE(decibels(squares, pixels.size()), 50) << "seed " << seed << ", zoom " << zoom;
      EXPECT_EQ(seams, 0u) << "seed " << seed << ", zoom " << zoom;
      const TileDifference worst = worstTile(kSize, kSize, [&](uint32_t px, uint32_t py) {
        return std::abs(static_cast<double>(pixels[py * kSize + px].a) - wanted[py * kSize + px]);
      });
      EXPECT_LT(worst.mean, 0.01) << worst.where() << ", seed " << seed << ", zoom " << zoom;
    }
  }
}

/// A path of half the alpha leaves exactly that in each sample it covers: no sample is written twice.
TEST_F(InPassTest, EachSampleIsWrittenOnce) {
  constexpr uint32_t kSize = 96;
  TestPath path = randomShape(5, 90);
  path.color = {1, 1, 1, 0.5f};
  const GpgpPath view = path.view();
  const auto pixels = draw({place(makePatchDrawing({view}), 1, 3, 3)}, kSize, kSize, 4);
  const auto wanted = areas(view, 1, 3, 3, kSize);
  for (size_t i = 0; i < pixels.size(); ++i) {
    const float eighths = pixels[i].a * 8;
    EXPECT_EQ(eighths, std::round(eighths)) << i;
    if (wanted[i] > 1 - 1e-9) {
      EXPECT_EQ(pixels[i].a, 0.5f) << i;
    }
    if (wanted[i] == 0) {
      EXPECT_EQ(pixels[i].a, 0.0f) << i;
    }
    EXPECT_NEAR(static_cast<double>(pixels[i].a) * 2, wanted[i], 0.6) << i;
  }
  // Two paths that share an edge leave nothing between them.
  TestPath left, right;
  left.move(0, 0).line(40, 0).cubic(10, 30, 70, 50, 37, 90).line(0, 90).close();
  right.move(90, 0).line(40, 0).cubic(10, 30, 70, 50, 37, 90).line(90, 90).close();
  const auto both = draw({place(makePatchDrawing({left.view(), right.view()}))}, 90, 90, 4);
  for (size_t i = 0; i < both.size(); ++i) EXPECT_EQ(both[i].a, 1.0f) << i;
}

/// Turned, mirrored, and in perspective with the eye in the page's plane: as the canvas draws it.
TEST_F(InPassTest, MapsAreTheCanvass) {
  constexpr uint32_t kSize = 128;
  makeCanvas(kSize);
  TestPath path = randomShape(9, 90), other = randomShape(12, 90);
  other.color = {0.2f, 0.5f, 0.9f, 1};
  const GpgpAsset drawing =
      makePatchDrawing({path.view(), other.view()}, GPGP_DRAWING_IN_PASS | GPGP_DRAWING_FLATTENED);
  GpgpCanvasItem turned = place(drawing);
  const float turn[6] = {0.8f, 0.6f, -0.6f, 0.8f, 50, -5}, mirrored[6] = {-1, 0.2f, 0, 1.3f, 110, 0};
  std::copy_n(turn, 6, turned.transform);
  GpgpCanvasItem flipped = place(drawing);
  std::copy_n(mirrored, 6, flipped.transform);
  GpgpCanvasItem tilted = place(drawing, 1, 10, 10); // the eye's plane passes through it at y = 60
  const float tilt[6] = {0.8f, 0, -0.9f, 0.3f, 20, 5}, eye[3] = {0.002f, -0.016f, 0.96f};
  std::copy_n(tilt, 6, tilted.transform);
  std::copy_n(eye, 3, tilted.perspective);
  GpgpCanvasItem panel = tilted;
  panel.perspective[1] = 0.004f;
  int n = 0;
  for (const GpgpCanvasItem& item : {turned, flipped, tilted, panel}) {
    const auto wanted = raster({item}, kSize, kSize, 16);
    if (const char* folder = std::getenv("GPGP_IN_PASS_PICTURES")) { // to be looked at
      const auto write = [&](const std::vector<Rgba>& pixels, const std::string& name) {
        std::vector<uint8_t> bytes;
        for (const Rgba& p : pixels)
          for (const float v : {p.r, p.g, p.b, 1.0f}) bytes.push_back(static_cast<uint8_t>(std::lround(255 * v)));
        host::writePng(std::string(folder) + "/map" + std::to_string(n) + name + ".png",
                       host::fromPremultiplied(kSize, kSize, bytes));
      };
      write(wanted, "_canvas"), write(draw({item}, kSize, kSize, 1), "_area"),
          write(draw({item}, kSize, kSize, 4), "_4");
    }
    for (const uint32_t samples : {1u, 4u}) {
      const auto drawn = draw({item}, kSize, kSize, samples);
      const TileDifference worst = worstTile(kSize, kSize, [&](uint32_t x, uint32_t y) {
        const Rgba &a = drawn[y * kSize + x], &b = wanted[y * kSize + x];
        return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b), std::abs(a.a - b.a)});
      });
      EXPECT_LT(worst.mean, samples == 1 ? 0.05 : 0.08) << worst.where() << ", map " << n << ", samples " << samples;
    }
    ++n;
  }
}

TEST_F(InPassTest, TheTigerIsTheCanvass) {
  const auto svg = fetchedSvg("fetched/svg/tiger.svgz");
  if (!svg) GTEST_SKIP() << "the tiger is not there";
  constexpr uint32_t kSize = 256;
  makeCanvas(kSize);
  const vector::svg::ImportedViews views(*svg);
  const float scale = float(kSize) / float(std::max(svg->width, svg->height));
  const GpgpAsset drawing = makePatchDrawing(views.paths, GPGP_DRAWING_IN_PASS | GPGP_DRAWING_FLATTENED, views.groups);
  GpgpDrawingInfo info = GPGP_DRAWING_INFO_INIT;
  EXPECT_EQ(gpgpGetDrawingInfo(drawing, &info), GPGP_SUCCESS);
  EXPECT_EQ(info.pathsLeftOut, 0u);
  const auto wanted = raster({place(drawing, scale)}, kSize, kSize, 16);
  for (const uint32_t samples : {1u, 4u}) {
    const auto drawn = draw({place(drawing, scale)}, kSize, kSize, samples);
    double squares = 0;
    for (size_t i = 0; i < drawn.size(); ++i) {
      const double off = static_cast<double>(drawn[i].g - wanted[i].g);
      squares += off * off;
    }
    EXPECT_GT(decibels(squares, drawn.size()), 28) << samples;
    const TileDifference worst = worstTile(kSize, kSize, [&](uint32_t x, uint32_t y) {
      return std::abs(drawn[y * kSize + x].g - wanted[y * kSize + x].g);
    });
    EXPECT_LT(worst.mean, samples == 1 ? 0.08 : 0.1) << worst.where() << ", samples " << samples;
  }
}

/// Gradients have the canvas's colours where nothing has an edge.
TEST_F(InPassTest, GradientsAreTheCanvass) {
  constexpr uint32_t kSize = 64;
  makeCanvas(kSize);
  TestPath square;
  square.move(0, 0).line(64, 0).line(64, 64).line(0, 64).close();
  const GpgpGradientStop stops[] = {{0, {1, 0, 0, 1}}, {0.4f, {0, 1, 0, 0.5f}}, {1, {0, 0, 1, 1}}};
  for (const GpgpGradientKind kind : {GPGP_GRADIENT_LINEAR, GPGP_GRADIENT_RADIAL})
    for (const VkBool32 encoded : {VK_FALSE, VK_TRUE}) {
      GpgpGradient gradient{};
      gradient.kind = kind;
      gradient.spread = GPGP_SPREAD_REFLECT;
      gradient.transform[0] = gradient.transform[3] = 1;
      gradient.start[0] = gradient.start[1] = 20;
      gradient.end[0] = 45, gradient.end[1] = 30;
      gradient.endRadius = 22;
      gradient.stops = stops;
      gradient.stopCount = 3;
      gradient.interpolateSrgb = encoded;
      GpgpPath path = square.view();
      path.gradient = &gradient;
      const GpgpAsset drawing = makePatchDrawing({path}, GPGP_DRAWING_IN_PASS | GPGP_DRAWING_FLATTENED);
      const auto wanted = raster({place(drawing)}, kSize, kSize, 16), drawn = draw({place(drawing)}, kSize, kSize, 1);
      for (size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_NEAR(drawn[i].r, wanted[i].r, 0.004f) << i;
        EXPECT_NEAR(drawn[i].b, wanted[i].b, 0.004f) << i;
        EXPECT_NEAR(drawn[i].a, wanted[i].a, 0.004f) << i;
      }
    }
}

/// A text equals its glyphs as drawings, and is one draw.
TEST_F(InPassTest, ATextEqualsItsGlyphsAsDrawings) {
  TestPath letter = randomShape(21, 1), dot = randomShape(22, 1);
  const GpgpPath paths[] = {letter.view(), dot.view()};
  const GpgpGlyph glyphs[] = {{1, paths, 1, nullptr}, {2, paths, 2, nullptr}};
  GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  info.methods = GPGP_DRAWING_IN_PASS;
  GpgpAsset set = nullptr;
  ASSERT_EQ(gpgpCreateGlyphSet(context, &info, &set), GPGP_SUCCESS) << lastMessage();
  uint32_t indices[2] = {};
  ASSERT_EQ(gpgpAddGlyphs(set, glyphs, 2, indices), GPGP_SUCCESS) << lastMessage();
  const GpgpGlyphInstance instances[] = {{indices[0], 5.3f, 7.1f, 30, {1, 1, 1, 1}},
                                         {indices[1], 40, 20, 14, {1, 1, 1, 1}},
                                         {indices[0], 10, 50, 9, {1, 1, 1, 1}}};
  GpgpCanvasItem text{};
  text.transform[0] = text.transform[3] = text.opacity = 1;
  text.glyphSet = set;
  text.glyphs = instances;
  text.glyphCount = 3;
  const GpgpAsset one = makePatchDrawing({paths[0]}), two = makePatchDrawing({paths[0], paths[1]});
  for (const uint32_t samples : {1u, 4u}) {
    const auto drawn = draw({text}, 64, 64, samples);
    const auto wanted =
        draw({place(one, 30, 5.3f, 7.1f), place(two, 14, 40, 20), place(one, 9, 10, 50)}, 64, 64, samples);
    double sum = 0;
    for (size_t i = 0; i < drawn.size(); ++i) {
      EXPECT_NEAR(drawn[i].a, wanted[i].a, samples == 1 ? 0.004f : 0.26f) << i;
      sum += static_cast<double>(std::abs(drawn[i].a - wanted[i].a));
    }
    EXPECT_LT(sum / double(drawn.size()), 0.001);
  }
  GpgpCanvasItem wrong = text;
  makeCanvas(64);
  const GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer commands) {
    GpgpCanvasInfo canvasInfo = GPGP_CANVAS_INFO_INIT;
    canvasInfo.width = canvasInfo.height = 64;
    canvasInfo.items = &wrong;
    canvasInfo.itemCount = 1;
    EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &canvasInfo), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(lastMessage().find("GPGP_DRAWING_FLATTENED"), std::string::npos) << lastMessage();
  });
}

TEST_F(InPassTest, NamesWhatItDoesNotDraw) {
  TestPath square;
  square.move(0, 0).line(20, 0).line(20, 20).line(0, 20).close();
  GpgpPath paths[4] = {square.view(), square.view(), square.view(), square.view()};
  GpgpPath clip = square.view();
  const std::vector<GpgpPathGroup> groups{{0, 1, &clip, 1}, {0, 0.5f, nullptr, 0}, {0, 0.5f, nullptr, 0}};
  paths[0].group = 1;
  paths[1].group = 2; // alone: its opacity becomes the path's
  paths[2].group = paths[3].group = 3;
  const GpgpAsset drawing = makePatchDrawing({paths[0], paths[1], paths[2], paths[3]}, GPGP_DRAWING_IN_PASS, groups);
  EXPECT_NE(lastMessage().find("paths[3] is left out of the patches: it is in a group"), std::string::npos)
      << lastMessage();
  GpgpDrawingInfo info = GPGP_DRAWING_INFO_INIT;
  EXPECT_EQ(gpgpGetDrawingInfo(drawing, &info), GPGP_SUCCESS);
  EXPECT_EQ(info.pathsLeftOut, 3u);
  EXPECT_EQ(draw({place(drawing)}, 16, 16, 1)[0].a, 0.5f);
  const GpgpAsset flattened = makePatchDrawing({paths[1]}, GPGP_DRAWING_FLATTENED, groups);
  draw({place(flattened)}, 16, 16, 1, GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("GPGP_DRAWING_IN_PASS"), std::string::npos) << lastMessage();
}

} // namespace
