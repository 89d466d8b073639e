// gpgp::rmlui under RmlUi itself: documents drawn without a window, under the validation layer, against closed forms
// and against documents that say the same otherwise. GPGP_RMLUI_PICTURES=FOLDER writes what is compared.
#include "gpgp_rmlui.hpp"
#include "host/picture.h"
#include "stage.h"

#include <RmlUi/Core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace {

using namespace gpgp;
constexpr uint32_t kWidth = 320, kHeight = 240;

struct Silent final : Rml::SystemInterface {
  std::vector<std::string> warnings;
  double GetElapsedTime() override { return 0; }
  bool LogMessage(Rml::Log::Type type, const Rml::String& message) override {
    if (type <= Rml::Log::LT_WARNING) warnings.push_back(message);
    return true;
  }
};

/// Device, gpgp and RmlUi: shared by all tests.
struct Shared {
  test::PassStage stage{VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight,
                        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
  Silent system;
  rmlui::FontEngine fonts;
  std::unique_ptr<rmlui::Renderer> renderer;
  Rml::Context* ui = nullptr;

  Shared() {
    auto target = init<GpgpTargetInfo>();
    target.renderPass = stage.pass;
    rmlui::RendererInfo info;
    info.context = stage.context;
    info.physicalDevice = stage.device.physical;
    info.device = stage.device.device;
    info.queueFamily = stage.device.family;
    info.fonts = &fonts;
    info.target = &target;
    info.maxWidth = kWidth;
    info.maxHeight = kHeight;
    info.loadImage = [](const std::string& source, rmlui::DecodedImage& image) {
      if (source != "halves") return false;
      image = {2, 1, {255, 0, 0, 255, 0, 0, 128, 128}};
      return true;
    };
    info.loadDrawing = [this](const std::string& source) { return source == "card.svg" ? makeCard() : Drawing{}; };
    renderer = std::make_unique<rmlui::Renderer>(info);
    Rml::SetSystemInterface(&system);
    Rml::SetFontEngineInterface(&fonts);
    Rml::SetRenderInterface(renderer.get());
    EXPECT_TRUE(Rml::Initialise());
    EXPECT_TRUE(Rml::LoadFontFace(GPGP_TEST_DATA "/fetched/fonts/DejaVuSans.ttf"));
    ui = Rml::CreateContext("main", {kWidth, kHeight});
  }
  ~Shared() {
    vkDeviceWaitIdle(stage.device.device);
    Rml::Shutdown();
    renderer.reset();
  }
  /// A red square in the left half of a page of 20 x 10, a blue one that reaches beyond its right side.
  Drawing makeCard() {
    const GpgpPathVerb verbs[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
    const float left[] = {0, 0, 10, 0, 10, 10, 0, 10}, right[] = {15, 0, 30, 0, 30, 10, 15, 10};
    GpgpPath paths[2]{};
    for (int i = 0; i < 2; ++i) {
      paths[i].verbs = verbs;
      paths[i].verbCount = 5;
      paths[i].points = i == 0 ? left : right;
      paths[i].pointCount = 4;
      paths[i].color[i == 0 ? 0 : 2] = 1;
      paths[i].color[3] = 1;
    }
    auto info = init<GpgpDrawingCreateInfo>();
    info.paths = paths;
    info.pathCount = 2;
    return *Drawing::create(stage.context, info);
  }
};

std::unique_ptr<Shared> shared;

struct Picture {
  std::vector<uint8_t> rgba;
  const uint8_t* at(int x, int y) const { return &rgba[(size_t(y) * kWidth + size_t(x)) * 4]; }
};

struct RmlUi : testing::Test {
  void SetUp() override { shared->system.warnings.clear(); }

  /// A document of this style and body; frames: each is drawn, the last one is what is returned.
  Picture draw(const std::string& style, const std::string& body, bool inPass = false, int frames = 1) {
    const std::string whole = "<rml><head><style>body { width: 320px; height: 240px; font-family: 'DejaVu Sans'; "
                              "font-size: 16px; color: white; } div { display: block; } " +
                              style + "</style></head><body>" + body + "</body></rml>";
    Rml::ElementDocument* document = shared->ui->LoadDocumentFromMemory(whole);
    EXPECT_NE(document, nullptr);
    if (!document) return {};
    document->Show();
    Picture picture;
    test::PassStage& stage = shared->stage;
    for (int i = 0; i < frames; ++i) {
      VkCommandBuffer commands = stage.frames.begin();
      EXPECT_EQ(stage.context.advance(stage.frames.number()), GPGP_SUCCESS);
      shared->ui->Update();
      shared->renderer->beginFrame(kWidth, kHeight);
      shared->ui->Render();
      const GpgpImage image{
          stage.image,
          stage.view,
          stage.format,
          0,
          0,
          kWidth,
          kHeight,
          {VK_PIPELINE_STAGE_2_COPY_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED},
          {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}};
      EXPECT_EQ(shared->renderer->prepare(commands, stage.frames.number(), inPass ? nullptr : &image), GPGP_SUCCESS)
          << (stage.messages.empty() ? "" : stage.messages.back());
      if (inPass) {
        const VkClearValue clear{};
        VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
        begin.renderPass = stage.pass;
        begin.framebuffer = stage.framebuffer;
        begin.renderArea = {{0, 0}, {kWidth, kHeight}};
        begin.clearValueCount = 1;
        begin.pClearValues = &clear;
        vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
        const VkViewport viewport{0, 0, kWidth, kHeight, 0, 1};
        vkCmdSetViewport(commands, 0, 1, &viewport);
        vkCmdSetScissor(commands, 0, 1, &begin.renderArea);
        EXPECT_EQ(shared->renderer->draw(commands, stage.frames.number()), GPGP_SUCCESS);
        vkCmdEndRenderPass(commands);
      }
      VkBufferImageCopy copy{};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      copy.imageExtent = {kWidth, kHeight, 1};
      vkCmdCopyImageToBuffer(commands, stage.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, stage.buffer, 1, &copy);
      stage.frames.submit();
      stage.frames.finish();
      EXPECT_EQ(stage.context.advance(stage.frames.number()), GPGP_SUCCESS);
      GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
      while (gpgpGetCanvasReport(shared->renderer->canvas(), &report) == GPGP_SUCCESS)
        EXPECT_EQ(report.base.status, GPGP_SUCCESS);
      EXPECT_EQ(shared->renderer->report().dropped, 0u);
    }
    const auto* from = static_cast<const uint8_t*>(stage.mapped);
    picture.rgba.assign(from, from + size_t{kWidth} * kHeight * 4);
    document->Close();
    shared->ui->Update();
    if (const char* folder = std::getenv("GPGP_RMLUI_PICTURES")) {
      static int number = 0;
      host::writePng(std::string(folder) + "/" + testing::UnitTest::GetInstance()->current_test_info()->name() +
                         std::to_string(number++) + ".png",
                     {kWidth, kHeight, picture.rgba});
    }
    return picture;
  }
  static void expectColor(const Picture& picture, int x, int y, std::array<int, 4> wanted, int tolerance,
                          const char* what) {
    for (size_t c = 0; c < 4; ++c)
      EXPECT_NEAR(picture.at(x, y)[c], wanted[c], tolerance) << what << " at " << x << " " << y << " channel " << c;
  }
  /// Largest mean difference of any tile of 8 x 8 pixels.
  static double worstTile(const Picture& a, const Picture& b) {
    double worst = 0;
    for (int y = 0; y + 8 <= int(kHeight); y += 8)
      for (int x = 0; x + 8 <= int(kWidth); x += 8)
        for (size_t c = 0; c < 4; ++c) {
          double sum = 0;
          for (int i = 0; i < 64; ++i) sum += a.at(x + i % 8, y + i / 8)[c] - b.at(x + i % 8, y + i / 8)[c];
          worst = std::max(worst, std::abs(sum) / 64);
        }
    return worst;
  }
  static size_t inked(const Picture& picture) {
    size_t count = 0;
    for (size_t i = 3; i < picture.rgba.size(); i += 4) count += picture.rgba[i] > 127;
    return count;
  }
};

TEST_F(RmlUi, BoxesBordersAndImages) {
  const Picture p =
      draw("#a { position: absolute; left: 20px; top: 30px; width: 100px; height: 60px; background: #ff0000; "
           "border: 10px #00ff00; border-radius: 30px; } "
           "#b { position: absolute; left: 200px; top: 100px; width: 80px; height: 40px; "
           "decorator: image(halves); }",
           "<div id='a'/><div id='b'/>");
  expectColor(p, 80, 70, {255, 0, 0, 255}, 0, "fill");
  expectColor(p, 80, 34, {0, 255, 0, 255}, 0, "border");
  expectColor(p, 22, 32, {0, 0, 0, 0}, 0, "outside of the corner");
  expectColor(p, 220, 120, {255, 0, 0, 255}, 4, "opaque texel of the picture");
  expectColor(p, 260, 120, {0, 0, 128, 128}, 4, "translucent texel");
  expectColor(p, 240, 120, {127, 0, 64, 191}, 6, "between texels");
}

/// Without a page its bounds are the page: 30 x 10.
TEST_F(RmlUi, DrawingsAreImages) {
  const Picture p = draw("#a { position: absolute; left: 20px; top: 30px; width: 240px; height: 80px; opacity: 0.5; } "
                         "#b { position: absolute; left: 20px; top: 150px; width: 150px; height: 50px; "
                         "decorator: image(card.svg); }",
                         "<img id='a' src='card.svg'/><div id='b'/>");
  expectColor(p, 60, 70, {127, 0, 0, 127}, 1, "the left one, translucent");
  for (const int x : {18, 101, 138, 261}) expectColor(p, x, 70, {0, 0, 0, 0}, 0, "beside them");
  expectColor(p, 99, 70, {127, 0, 0, 127}, 1, "sharp up to its edge");
  expectColor(p, 141, 70, {0, 0, 127, 127}, 1, "the right one");
  expectColor(p, 68, 175, {255, 0, 0, 255}, 0, "in a decorator");
  expectColor(p, 72, 175, {0, 0, 0, 0}, 0, "between");
}

TEST_F(RmlUi, InsideAPassItIsTheSame) {
  const std::string style = "#a { position: absolute; left: 20px; top: 30px; width: 200px; height: 60px; padding: 9px; "
                            "background: #40608080; border-radius: 30px; filter: drop-shadow(#000 6px 6px 3px); }";
  const Picture image = draw(style, "<div id='a'>Words and more words</div>");
  const Picture pass = draw(style, "<div id='a'>Words and more words</div>", true);
  // An attachment of this format stores linear colours, the image encoded ones: alpha is what both have.
  for (size_t i = 3; i < image.rgba.size(); i += 4) ASSERT_NEAR(image.rgba[i], pass.rgba[i], 2) << i / 4;
  EXPECT_GT(inked(pass), 10000u);
}

TEST_F(RmlUi, FiltersAndMasks) {
  const Picture p = draw("div { position: absolute; top: 20px; width: 40px; height: 40px; background: #ff8040; } "
                         "#a { left: 20px; filter: invert(1); } #b { left: 80px; filter: opacity(0.5); } "
                         "#c { left: 140px; filter: brightness(0.5) opacity(0.5) invert(1); } "
                         "#d { left: 200px; mask-image: horizontal-gradient(#0000 #000f); } "
                         "#e { left: 260px; filter: blur(4px); }",
                         "<div id='a'/><div id='b'/><div id='c'/><div id='d'/><div id='e'/>");
  expectColor(p, 40, 40, {0, 127, 191, 255}, 1, "invert");
  expectColor(p, 100, 40, {128, 64, 32, 128}, 2, "opacity");
  expectColor(p, 160, 40, {64, 96, 112, 128}, 3, "a filter after an opacity");
  expectColor(p, 220, 40, {128, 64, 32, 128}, 5, "mask, in its middle");
  expectColor(p, 202, 40, {16, 8, 4, 16}, 5, "mask, at its beginning");
  for (int x = 250; x < 275; ++x) { // a box of 40 pixels is wide enough for one edge alone
    const double wanted = 0.5 * std::erfc((260 - (double(x) + 0.5)) / (4 * std::sqrt(2.0)));
    EXPECT_NEAR(p.at(x, 40)[3] / 255.0, wanted, 0.02) << "blur at " << x;
  }
}

TEST_F(RmlUi, ShadowsAreSavedOnceAndKept) {
  const std::string style = "#a { position: absolute; left: 20px; top: 60px; width: 60px; height: 120px; "
                            "background: #ffffff; box-shadow: #000000ff 150px 0px 20px; }";
  const Picture p = draw(style, "<div id='a'/>", false, 3);
  EXPECT_EQ(shared->renderer->report().saved, 0u) << "in the third frame";
  expectColor(p, 50, 120, {255, 255, 255, 255}, 0, "the box");
  for (int x = 148; x < 252; x += 4) { // deviation 10: half of the blur
    const auto edge = [&](double at) { return 0.5 * std::erfc((at - (double(x) + 0.5)) / (10 * std::sqrt(2.0))); };
    const double wanted = edge(170) - edge(230);
    EXPECT_NEAR(p.at(x, 120)[3] / 255.0, wanted, 0.03) << x;
    EXPECT_EQ(p.at(x, 120)[0], 0) << x;
  }
}

TEST_F(RmlUi, OverflowIsCutByRoundAndTurnedBoxes) {
  const Picture round = draw("#a { position: absolute; left: 40px; top: 40px; width: 100px; height: 100px; "
                             "border-radius: 50px; overflow: hidden; } #b { width: 300px; height: 300px; "
                             "background: #ff0000; }",
                             "<div id='a'><div id='b'/></div>");
  EXPECT_NEAR(double(inked(round)), 3.14159 * 50 * 50, 60);
  const Picture turned = draw("#a { position: absolute; left: 80px; top: 60px; width: 100px; height: 100px; "
                              "transform: rotate(45deg); overflow: hidden; } #b { width: 300px; height: 300px; "
                              "background: #ff0000; }",
                              "<div id='a'><div id='b'/></div>");
  EXPECT_NEAR(double(inked(turned)), 100 * 100, 150);
  expectColor(turned, 82, 62, {0, 0, 0, 0}, 0, "beyond the turned corner");
}

TEST_F(RmlUi, TextIsSharpUnderTransforms) {
  const Picture small = draw("#a { position: absolute; left: 10px; top: 20px; font-size: 12px; transform: scale(5); "
                             "transform-origin: 0 0; }",
                             "<div id='a'>Regular</div>");
  const Picture large =
      draw("#a { position: absolute; left: 10px; top: 20px; font-size: 60px; }", "<div id='a'>Regular</div>");
  EXPECT_GT(inked(large), 3000u);
  // Lines of 12 pixels are rounded to whole ones, five times that is a pixel or two: the best of these places counts.
  double best = 255;
  for (int down = -4; down <= 4; ++down) {
    Picture moved = small;
    for (int y = 0; y < int(kHeight); ++y)
      for (int x = 0; x < int(kWidth) * 4; ++x) {
        const int from = y - down;
        moved.rgba[size_t(y) * kWidth * 4 + size_t(x)] =
            from < 0 || from >= int(kHeight) ? uint8_t{0} : small.rgba[size_t(from) * kWidth * 4 + size_t(x)];
      }
    best = std::min(best, worstTile(moved, large));
  }
  EXPECT_LE(best, 3); // blurred glyphs of 12 pixels are 60 and more
}

TEST_F(RmlUi, EffectsOfFonts) {
  const auto text = [&](const char* effect) {
    return draw(std::string("#a { position: absolute; left: 20px; top: 40px; font-size: 64px; color: #ffffff; ") +
                    effect + " }",
                "<div id='a'>Ib</div>");
  };
  const Picture plain = text("");
  const Picture outline = text("font-effect: outline(6px #ff0000);");
  const Picture shadow = text("font-effect: shadow(10px 12px #0000ff);");
  const Picture glow = text("font-effect: glow(2px 8px #00ff00);");
  EXPECT_GT(inked(outline), inked(plain) * 3 / 2);
  size_t moved = 0, blue = 0;
  for (int y = 12; y < int(kHeight); ++y)
    for (int x = 10; x < int(kWidth); ++x) {
      const bool ink = plain.at(x - 10, y - 12)[3] > 250 && plain.at(x, y)[3] == 0;
      moved += ink;
      blue += ink && shadow.at(x, y)[2] > 250 && shadow.at(x, y)[0] == 0;
    }
  EXPECT_GT(moved, 500u);
  EXPECT_EQ(blue, moved);
  size_t soft = 0;
  for (size_t i = 0; i < glow.rgba.size(); i += 4)
    soft += glow.rgba[i] == 0 && glow.rgba[i + 3] > 10 && glow.rgba[i + 3] < 200;
  EXPECT_GT(soft, 2000u);
}

TEST_F(RmlUi, TextOfBothDirectionsHasItsWidth) {
  Rml::ElementDocument* document = shared->ui->LoadDocumentFromMemory(
      "<rml><head><style>body { font-family: 'DejaVu Sans'; font-size: 20px; } span { display: inline-block; }</style>"
      "</head><body><span id='a'>office</span><span id='b'>o f f i c e</span><span id='c'>שלום</span></body></rml>");
  ASSERT_NE(document, nullptr);
  document->Show();
  shared->ui->Update();
  const auto width = [&](const char* id) { return document->GetElementById(id)->GetBox().GetSize().x; };
  EXPECT_GT(width("a"), 40);
  EXPECT_GT(width("b"), width("a") + 20);
  EXPECT_GT(width("c"), 30);
  document->Close();
  shared->ui->Update();
}

TEST_F(RmlUi, WhatIsNotDrawnIsNamed) {
  draw("#a { width: 90px; height: 90px; decorator: shader(\"creation\"); }", "<div id='a'/>");
  const auto& named = shared->renderer->unsupported();
  EXPECT_NE(std::find(named.begin(), named.end(), "the shader shader(\"creation\")"), named.end());
  EXPECT_TRUE(std::any_of(shared->system.warnings.begin(), shared->system.warnings.end(),
                          [](const std::string& w) { return w.find("creation") != std::string::npos; }));
}

} // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  shared = std::make_unique<Shared>();
  const int result = RUN_ALL_TESTS();
  shared.reset();
  return result;
}
