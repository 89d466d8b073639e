// gpgp::imgui's text and widgets: beside ImGui's look, under other windows, clipped, at scales, within budgets, under
// the validation layer.
#include "imgui_stage.h"

#include <filesystem>
#include <set>

namespace {

using namespace gpgp;
using namespace gpgp::test;

/// ImGui's own window of everything: laid out to the pixel as with ImGui's glyphs, nothing of which is drawn.
TEST_F(ImGuiTest, DemoWindowLooksAsImGuisOwn) {
  Screen own({.byGpgp = false});
  for (const bool widgets : {false, true}) { // its help, and widgets of all kinds
    const std::string name = widgets ? "demo_widgets" : "demo";
    const auto ui = [&] { demo(widgets); };
    const host::Picture theirs = own.render(ui, 4), ours = screen.render(ui, 4);
    EXPECT_EQ(screen.prepared, GPGP_SUCCESS);
    EXPECT_EQ(screen.renderer->report().dropped, 0u);
    EXPECT_GT(screen.renderer->report().glyphs, 300u);
    keep(ours, (name + "_gpgp").c_str());
    keep(theirs, (name + "_imgui").c_str());
    const host::PictureDifference difference = host::compare(ours, theirs);
    EXPECT_GT(difference.pixelsDifferent, 100u) << "is the text gpgp's at all?";
    EXPECT_LT(difference.mean, 1.0);
    EXPECT_LT(different(ours, theirs, 0, 0, kWidth, kHeight, 100), 60u); // pixels that are quite another colour
  }
}

TEST_F(ImGuiTest, WindowsCoverTextAndWidgetsBelow) {
  Drawing drawing = makeDrawing();
  const auto above = [] {
    ImGui::SetNextWindowPos({150, 100});
    ImGui::SetNextWindowSize({250, 200});
    ImGui::SetNextWindowBgAlpha(1);
    ImGui::Begin("above");
    ImGui::Text("text of the window above\nand a second line");
    ImGui::End();
  };
  const auto both = [&] {
    ImGui::SetNextWindowPos({50, 50});
    ImGui::SetNextWindowSize({300, 250});
    ImGui::Begin("below");
    for (int i = 0; i < 4; ++i) ImGui::Text("text of the window below, long enough");
    screen.renderer->drawing(drawing, {150, 100});
    ImGui::End();
    above();
    ImGui::SetWindowFocus("above");
  };
  const host::Picture alone = screen.render(above), together = screen.render(both, 3);
  keep(together, "covered");
  EXPECT_EQ(screen.renderer->report().dropped, 0u);
  // Below the title bar, whose colour tells the focus.
  EXPECT_EQ(different(alone, together, 151, 119, 399, 299, 1), 0u);
  EXPECT_GT(different(alone, together, 50, 50, 149, 299), 1000u);
}

TEST_F(ImGuiTest, ADrawingKeepsItsBoxAndColoursAndIsClipped) {
  Drawing drawing = makeDrawing();
  const auto window = [&](bool withDrawing) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({400, 400});
    ImGui::Begin("window", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::SetCursorPos({20, 20});
    ImGui::BeginChild("child", {100, 100}, false, ImGuiWindowFlags_NoScrollbar);
    ImGui::SetCursorPos({50, 50}); // half of it lies outside of the child
    if (withDrawing) screen.renderer->drawing(drawing, {100, 100});
    ImGui::EndChild();
    ImGui::GetWindowDrawList()->AddRectFilled({200, 200}, {300, 300}, IM_COL32(10, 200, 30, 255));
    ImGui::End();
  };
  const host::Picture without = screen.render([&] { window(false); });
  const host::Picture with = screen.render([&] { window(true); });
  keep(with, "clipped");
  EXPECT_EQ(at(with, 72, 72), (Color{0x20, 0x40, 0xa0}));
  EXPECT_EQ(at(with, 112, 112), (Color{0xc0, 0x30, 0x20}));
  EXPECT_EQ(at(with, 250, 250), (Color{10, 200, 30})) << "ImGui draws on after the widget";
  EXPECT_EQ(different(without, with, 0, 0, kWidth, 70), 0u);
  EXPECT_EQ(different(without, with, 120, 0, kWidth, kHeight), 0u);
  EXPECT_EQ(different(without, with, 0, 120, kWidth, kHeight), 0u);
  EXPECT_EQ(different(without, with, 70, 70, 120, 120), 2500u);
}

/// One font size in the atlas, drawn six times as large.
TEST_F(ImGuiTest, TextIsSharpAtEveryScale) {
  const auto large = [] {
    ImGui::GetForegroundDrawList()->AddText(ImGui::GetFont(), 78, {20, 100}, IM_COL32(255, 255, 255, 255),
                                            "Sharp & go");
  };
  const host::Picture ours = screen.render(large);
  Screen small({.byGpgp = false}), exact({.byGpgp = false, .fontSize = 78});
  const host::Picture stretched = small.render(large), wanted = exact.render(large);
  keep(ours, "large_gpgp");
  keep(stretched, "large_imgui");
  // Pixels that are neither ground nor text: a seam along the edges.
  const auto seam = [](const host::Picture& picture) {
    uint32_t count = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
      for (uint32_t x = 0; x < kWidth; ++x) {
        const int red = at(picture, x, y)[0];
        count += red > 0x73 + 8 && red < 247 ? 1 : 0;
      }
    return count;
  };
  EXPECT_GT(seam(ours), 300u);
  EXPECT_LT(seam(ours), seam(wanted) * 13 / 10);
  EXPECT_GT(seam(stretched), seam(ours) * 2);
}

/// One colour on another: 16 samples a pixel would mix them in at most 17 ways.
TEST_F(ImGuiTest, SmallTextHasTheAreaOfItsEdges) {
  const host::Picture picture = screen.render([] {
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddRectFilled({0, 0}, {300, 100}, IM_COL32(0, 0, 0, 255));
    list.AddText(ImGui::GetFont(), 9, {10, 10}, IM_COL32(255, 255, 255, 255), "Sphinx of black quartz, judge my vow");
    list.AddText(ImGui::GetFont(), 12, {10, 30}, IM_COL32(255, 255, 255, 255), "Sphinx of black quartz, judge my vow");
  });
  keep(picture, "small");
  std::set<int> levels;
  for (uint32_t y = 5; y < 95; ++y)
    for (uint32_t x = 5; x < 295; ++x) levels.insert(at(picture, x, y)[0]);
  EXPECT_GT(levels.size(), 100u);
}

TEST_F(ImGuiTest, LayoutsAreWidgets) {
  auto fontInfo = init<GpgpFontCreateInfo>();
  fontInfo.filePath = GPGP_TEST_DATA "/fetched/fonts/DejaVuSerif.ttf";
  Font font = *Font::create(fontInfo);
  Shaper shaper = *Shaper::create();
  Layout layout = *shaper.layout();
  const GpgpFont fonts[] = {font};
  auto text = init<GpgpTextInfo>();
  const std::string words = "A paragraph that gpgp lays out: finds ligatures, kerns AV To, wraps.";
  text.text = words.data();
  text.size = words.size();
  text.style.fonts = fonts;
  text.style.fontCount = 1;
  text.style.size = 24;
  text.style.underline = VK_TRUE;
  for (float& value : text.style.color) value = 1;
  text.width = 250;
  ASSERT_EQ(layout.set(text), GPGP_SUCCESS);
  float below = 0;
  const host::Picture picture = screen.render([&] {
    ImGui::SetNextWindowPos({10, 10});
    ImGui::SetNextWindowSize({300, 300});
    ImGui::Begin("window", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::Text("above");
    screen.renderer->text(layout);
    below = ImGui::GetCursorScreenPos().y;
    ImGui::Text("below");
    ImGui::End();
  });
  keep(picture, "layout");
  const GpgpLayoutInfo info = *layout.info();
  EXPECT_GE(info.lineCount, 3u);
  EXPECT_GT(below, info.height + 20);
  EXPECT_EQ(screen.renderer->report().widgets, 1u);
  uint32_t white = 0;
  for (uint32_t y = 30; y < 30 + static_cast<uint32_t>(info.height); ++y)
    for (uint32_t x = 10; x < 300; ++x) white += at(picture, x, y) == Color{255, 255, 255} ? 1 : 0;
  EXPECT_GT(white, 500u);
  // Lines at the right of the width: the widget reaches as far.
  text.size = 11; // A paragraph
  text.align = GPGP_TEXT_ALIGN_RIGHT;
  ASSERT_EQ(layout.set(text), GPGP_SUCCESS);
  float widget = 0;
  const host::Picture aligned = screen.render([&] {
    ImGui::SetNextWindowPos({10, 10});
    ImGui::SetNextWindowSize({300, 300});
    ImGui::Begin("window", nullptr, ImGuiWindowFlags_NoDecoration);
    screen.renderer->text(layout);
    widget = ImGui::GetItemRectSize().x;
    ImGui::SetCursorScreenPos({-200, 60}); // only the letters at the right are in the window
    screen.renderer->text(layout);
    ImGui::End();
  });
  keep(aligned, "aligned");
  EXPECT_NEAR(widget, 250, 0.1f);
  uint32_t shown = 0;
  for (uint32_t y = 60; y < 90; ++y)
    for (uint32_t x = 0; x < 60; ++x) shown += at(aligned, x, y) == Color{255, 255, 255} ? 1 : 0;
  EXPECT_GT(shown, 30u);
  EXPECT_EQ(at(aligned, 5, 80), at(aligned, 5, 400)) << "clipped to the window";
  screen.renderer->forget(font);
}

/// Underlines and strikes that are thinner than a pixel, at no whole pixel.
TEST_F(ImGuiTest, LinesOfLayoutsAreAsThickAsTheyAre) {
  auto fontInfo = init<GpgpFontCreateInfo>();
  fontInfo.filePath = GPGP_TEST_DATA "/fetched/fonts/DejaVuSerif.ttf";
  Font font = *Font::create(fontInfo);
  Shaper shaper = *Shaper::create();
  Layout layout = *shaper.layout();
  const GpgpFont fonts[] = {font};
  auto text = init<GpgpTextInfo>();
  text.text = "i          i";
  text.size = 12;
  text.style = {.fonts = fonts, .fontCount = 1, .size = 9, .color = {1, 1, 1, 1}, .underline = 1, .strike = 1};
  ASSERT_EQ(layout.set(text), GPGP_SUCCESS);
  const GpgpLayoutInfo info = *layout.info();
  ASSERT_EQ(info.decorationCount, 2u);
  float thickness = 0;
  for (uint32_t i = 0; i < 2; ++i) thickness += info.decorations[i].rect.height;
  ASSERT_LT(thickness, 1.5f);
  for (const float y : {20.0f, 20.3f, 20.6f}) {
    const host::Picture picture = screen.render([&] {
      ImDrawList& list = *ImGui::GetForegroundDrawList();
      list.AddRectFilled({0, 0}, {300, 200}, IM_COL32(0, 0, 0, 255));
      screen.renderer->addText(list, layout, {10, y});
    });
    uint32_t sum = 0; // down a column between the letters
    const auto middle = static_cast<uint32_t>(10 + info.width / 2);
    for (uint32_t row = 0; row < 100; ++row) sum += at(picture, middle, row)[0];
    EXPECT_NEAR(static_cast<float>(sum) / 255, thickness, 0.15f) << y; // counted in 16 rows a pixel
    EXPECT_EQ(screen.renderer->report().dropped, 0u);
  }
  screen.renderer->forget(font);
}

/// Emoji of a font of pictures: in a layout, and in ImGui's own text, at two sizes.
TEST_F(ImGuiTest, GlyphsThatArePicturesAreShown) {
  const std::string file = GPGP_TEST_DATA "/fetched/fonts/NotoColorEmoji.ttf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << ": run tests/data/fetch.sh";
  Screen emoji({.fontSize = 20, .emoji = file.c_str()});
  auto fontInfo = init<GpgpFontCreateInfo>();
  fontInfo.filePath = file.c_str();
  Font font = *Font::create(fontInfo);
  Shaper shaper = *Shaper::create();
  Layout layout = *shaper.layout();
  const GpgpFont fonts[] = {font};
  auto text = init<GpgpTextInfo>();
  const std::string words = "\xF0\x9F\x94\xA5"; // fire, beyond ImWchar
  text.text = words.data();
  text.size = words.size();
  text.style.fonts = fonts;
  text.style.fontCount = 1;
  text.style.size = 40;
  ASSERT_EQ(layout.set(text), GPGP_SUCCESS);
  const host::Picture picture = emoji.render([&] {
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddRectFilled({0, 0}, {300, 200}, IM_COL32(0, 0, 0, 255));
    emoji.renderer->addText(list, layout, {10, 10});
    list.AddText({100, 20}, IM_COL32(255, 255, 255, 255), "tea \xE2\x98\x95 time"); // hot beverage
    list.AddText(ImGui::GetFont(), 60, {100, 80}, IM_COL32(255, 255, 255, 128), "\xE2\x98\x95");
  });
  keep(picture, "emoji");
  EXPECT_EQ(emoji.renderer->report().dropped, 0u);
  // One picture at more places than a frame has: those beyond are counted.
  std::string many;
  for (int i = 0; i < 1100; ++i) many += words;
  text.text = many.data();
  text.size = many.size();
  text.style.size = 8;
  text.width = 600;
  Layout crowd = *shaper.layout();
  ASSERT_EQ(crowd.set(text), GPGP_SUCCESS);
  emoji.render([&] { emoji.renderer->addText(*ImGui::GetForegroundDrawList(), crowd, {10, 10}); });
  EXPECT_EQ(emoji.renderer->report().glyphs, 1024u);
  EXPECT_EQ(emoji.renderer->report().dropped, 1100u - 1024u);
  const auto coloured = [&](uint32_t left, uint32_t top, uint32_t right, uint32_t bottom) {
    uint32_t count = 0;
    for (uint32_t y = top; y < bottom; ++y)
      for (uint32_t x = left; x < right; ++x) {
        const Color color = at(picture, x, y);
        count += *std::max_element(color.begin(), color.end()) - *std::min_element(color.begin(), color.end()) > 40;
      }
    return count;
  };
  EXPECT_GT(coloured(10, 10, 70, 70), 500u);
  EXPECT_GT(coloured(100, 15, 180, 45), 20u); // coffee
  uint32_t halfBright = 0;                    // the larger cup: white at alpha 128
  for (uint32_t y = 80; y < 160; ++y)
    for (uint32_t x = 100; x < 180; ++x) {
      EXPECT_LT(at(picture, x, y)[0], 135);
      halfBright += at(picture, x, y)[0] > 90 ? 1 : 0;
    }
  EXPECT_GT(halfBright, 500u);
  EXPECT_EQ(coloured(180, 0, 300, 200), 0u);
  emoji.renderer->forget(font);
}

/// One piece of text over another, under a box, over a box: all in the order of the list.
TEST_F(ImGuiTest, TextLiesBetweenWhatLiesBelowAndAboveIt) {
  const host::Picture picture = screen.render([] {
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    for (int i = 0; i < 12; ++i) {
      const float y = 10 + 30.0f * static_cast<float>(i);
      list.AddText(ImGui::GetFont(), 26, {20, y}, IM_COL32(255, 0, 0, 255), "below");
      list.AddRectFilled({10, y}, {60, y + 26}, IM_COL32(0, 0, 0, 255));
      list.AddText(ImGui::GetFont(), 26, {20, y}, IM_COL32(0, 255, 0, 255), "above");
    }
  });
  keep(picture, "order");
  EXPECT_EQ(screen.renderer->report().dropped, 0u);
  EXPECT_EQ(screen.renderer->report().glyphs, 120u);
  for (uint32_t i = 0; i < 12; ++i) {
    uint32_t red = 0, green = 0, redBelow = 0;
    for (uint32_t y = 10 + 30 * i; y < 36 + 30 * i; ++y)
      for (uint32_t x = 10; x < 120; ++x) {
        const Color color = at(picture, x, y);
        (x < 60 ? redBelow : red) += color[0] > 200 && color[1] < 60;
        green += color[1] > 200 && color[0] < 60;
      }
    EXPECT_EQ(redBelow, 0u) << i;
    EXPECT_GT(red, 5u) << i;
    EXPECT_GT(green, 50u) << i;
  }
}

/// Text that ImGui cuts itself, between pixels: by texture coordinates, not by a clip rectangle.
TEST_F(ImGuiTest, TextThatImGuiCutsIsCut) {
  const ImVec4 cut{30, 104, 71.5f, 140};
  const host::Picture picture = screen.render([&] {
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddRectFilled({0, 0}, {300, 200}, IM_COL32(0, 0, 0, 255));
    list.AddText(ImGui::GetFont(), 40, {10, 90}, IM_COL32(255, 255, 255, 255), "WWWW", nullptr, 0, &cut);
  });
  keep(picture, "cut");
  uint32_t inside = 0;
  for (uint32_t y = 60; y < 190; ++y)
    for (uint32_t x = 0; x < 250; ++x) {
      const bool in = x >= 30 && x < 72 && y >= 104 && y < 140;
      inside += in && at(picture, x, y)[0] > 200;
      if (!in) {
        EXPECT_EQ(at(picture, x, y), (Color{0, 0, 0})) << x << ", " << y;
      }
    }
  EXPECT_GT(inside, 200u);
}

/// ImGui's colours are linear then, and the image encodes all of them; a drawing has its own colours.
TEST_F(ImGuiTest, ImagesThatEncodeSrgb) {
  auto srgb = std::make_unique<ImGuiStage>(VK_FORMAT_R8G8B8A8_SRGB);
  std::swap(stage, srgb);
  {
    Screen byGpgp({}), own({.byGpgp = false});
    Drawing drawing = makeDrawing();
    const auto ui = [&](bool both) {
      ImGui::SetNextWindowPos({10, 10});
      ImGui::SetNextWindowSize({400, 300});
      ImGui::Begin("window", nullptr, ImGuiWindowFlags_NoDecoration);
      for (int i = 0; i < 5; ++i) ImGui::TextColored({0.9f, 0.5f, 0.2f, 1}, "text in a colour of its own");
      if (both) byGpgp.renderer->addDrawing(*ImGui::GetWindowDrawList(), drawing, {200, 200}, {300, 300});
      ImGui::End();
    };
    const host::Picture theirs = own.render([&] { ui(false); }), ours = byGpgp.render([&] { ui(false); });
    EXPECT_LT(host::compare(ours, theirs).mean, 0.5);
    EXPECT_LT(different(ours, theirs, 0, 0, kWidth, kHeight, 100), 20u);
    EXPECT_GT(different(ours, theirs, 0, 0, kWidth, kHeight), 50u);
    const host::Picture with = byGpgp.render([&] { ui(true); });
    EXPECT_EQ(at(with, 202, 202), (Color{0x20, 0x40, 0xa0}));
    EXPECT_EQ(at(with, 250, 250), (Color{0xc0, 0x30, 0x20}));
  }
  std::swap(stage, srgb);
}

/// Frames that draw no gpgp, frames that are not drawn, the same draw data twice.
TEST_F(ImGuiTest, FramesMayBeEmptySkippedOrRepeated) {
  screen.render([] {});
  EXPECT_EQ(screen.prepared, GPGP_SUCCESS);
  EXPECT_EQ(screen.renderer->report().glyphs, 0u);
  Drawing drawing = makeDrawing();
  const auto ui = [&] {
    ImGui::GetForegroundDrawList()->AddText({20, 20}, IM_COL32(255, 255, 255, 255), "text");
    screen.renderer->addDrawing(*ImGui::GetForegroundDrawList(), drawing, {100, 100}, {200, 200});
  };
  for (int i = 0; i < 3; ++i) { // never drawn
    ImGui::NewFrame();
    ui();
    ImGui::Render();
  }
  const host::Picture once = screen.render(ui);
  EXPECT_EQ(screen.renderer->report().widgets, 1u);
  VkCommandBuffer commands = stage->frames.begin();
  EXPECT_EQ(stage->context.advance(stage->frames.number()), GPGP_SUCCESS);
  EXPECT_EQ(screen.renderer->prepare(*ImGui::GetDrawData(), commands, stage->frames.number()), GPGP_SUCCESS);
  EXPECT_EQ(screen.renderer->report().widgets, 1u);
  EXPECT_EQ(screen.renderer->report().glyphs, 4u);
  stage->frames.submit();
  EXPECT_EQ(at(once, 150, 150), (Color{0xc0, 0x30, 0x20}));
}

/// A framebuffer beyond maxWidth or maxHeight is refused with the draw data as it was, and prepared after a resize.
TEST_F(ImGuiTest, AFramebufferBeyondTheLimitsIsRefusedAndCanBeMadeRoomFor) {
  const auto ui = [] { ImGui::GetForegroundDrawList()->AddText({20, 20}, IM_COL32(255, 255, 255, 255), "text"); };
  const host::Picture before = screen.render(ui);
  const auto sizes = [] {
    std::vector<int> all;
    for (int i = 0; i < ImGui::GetDrawData()->CmdListsCount; ++i) {
      const ImDrawList& list = *ImGui::GetDrawData()->CmdLists[i];
      all.insert(all.end(), {list.CmdBuffer.Size, list.IdxBuffer.Size, list.VtxBuffer.Size});
    }
    return all;
  };
  const auto prepare = [&] {
    VkCommandBuffer commands = stage->frames.begin();
    EXPECT_EQ(stage->context.advance(stage->frames.number()), GPGP_SUCCESS);
    const GpgpResult result = screen.renderer->prepare(*ImGui::GetDrawData(), commands, stage->frames.number());
    stage->frames.submit();
    return result;
  };
  std::vector<int> given;
  for (const ImVec2 size : {ImVec2{kWidth * 2, kHeight}, ImVec2{kWidth, kHeight + 1}}) {
    ImGui::GetIO().DisplaySize = size;
    ImGui::NewFrame();
    ui();
    ImGui::Render();
    given = sizes();
    EXPECT_EQ(prepare(), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(screen.renderer->error().find("maxWidth"), std::string::npos) << screen.renderer->error();
    EXPECT_EQ(sizes(), given);
    EXPECT_EQ(screen.renderer->report().glyphs, 0u);
  }
  vkDeviceWaitIdle(stage->device.device);
  EXPECT_THROW(screen.renderer->resize(1u << 30, 1), std::runtime_error);
  EXPECT_EQ(prepare(), GPGP_ERROR_INVALID_ARGUMENT); // all is as it was
  screen.renderer->resize(kWidth, kHeight + 1);
  EXPECT_EQ(prepare(), GPGP_SUCCESS);
  EXPECT_EQ(screen.renderer->report().glyphs, 4u);
  EXPECT_EQ(screen.renderer->error(), "");
  EXPECT_EQ(sizes(), given);
  ImGui::GetIO().DisplaySize = {kWidth, kHeight};
  EXPECT_EQ(screen.render(ui).rgba, before.rgba); // smaller again
}

} // namespace
