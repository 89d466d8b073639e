// gpgp::imgui's triangles, clip rectangles and textures: against ImGui's own renderer pixel by pixel, against a
// rasteriser of textured triangles on the CPU, and what is refused.
#include "gpgp_textures.hpp"
#include "imgui_stage.h"

#include <map>
#include <random>

namespace {

using namespace gpgp;
using namespace gpgp::test;

/// The largest mean difference of a channel in 8 x 8 pixels.
double worstTile(const host::Picture& a, const host::Picture& b) {
  double worst = 0;
  for (uint32_t top = 0; top < kHeight; top += 8)
    for (uint32_t left = 0; left < kWidth; left += 8) {
      double sum = 0;
      for (uint32_t y = top; y < top + 8; ++y)
        for (uint32_t x = left; x < left + 8; ++x)
          for (size_t c = 0; c < 3; ++c) sum += std::abs(at(a, x, y)[c] - at(b, x, y)[c]);
      worst = std::max(worst, sum / 192);
    }
  return worst;
}

/// 8 bits a channel, straight, repeated.
struct Texels {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;
  std::array<double, 4> sample(double u, double v) const {
    const double x = u * width - 0.5, y = v * height - 0.5, fx = x - std::floor(x), fy = y - std::floor(y);
    const auto texel = [&](double dx, double dy, size_t c) {
      const auto wrap = [](double at, uint32_t size) {
        const auto i = static_cast<int64_t>(std::floor(at)) % static_cast<int64_t>(size);
        return static_cast<size_t>(i < 0 ? i + static_cast<int64_t>(size) : i);
      };
      return rgba[(wrap(y + dy, height) * width + wrap(x + dx, width)) * 4 + c] / 255.0;
    };
    std::array<double, 4> color{};
    for (size_t c = 0; c < 4; ++c)
      color[c] = (texel(0, 0, c) * (1 - fx) + texel(1, 0, c) * fx) * (1 - fy) +
                 (texel(0, 1, c) * (1 - fx) + texel(1, 1, c) * fx) * fy;
    return color;
  }
};

/// What ImGui's draw data mean: each sample of a pixel by itself, side x side of them.
host::Picture rasterise(const ImDrawData& data, const std::map<ImTextureID, const Texels*>& textures, int side) {
  const int width = kWidth * side, height = kHeight * side;
  std::vector<std::array<float, 3>> samples(size_t(width) * size_t(height), {0.45f, 0.55f, 0.60f});
  const auto x = [&](float v) { return double((v - data.DisplayPos.x) * data.FramebufferScale.x); };
  const auto y = [&](float v) { return double((v - data.DisplayPos.y) * data.FramebufferScale.y); };
  for (int l = 0; l < data.CmdListsCount; ++l) {
    const ImDrawList& list = *data.CmdLists[l];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const double left = std::floor(std::max(x(command.ClipRect.x), 0.0)),
                   top = std::floor(std::max(y(command.ClipRect.y), 0.0));
      const double right = left + std::floor(x(command.ClipRect.z) - std::max(x(command.ClipRect.x), 0.0)),
                   bottom = top + std::floor(y(command.ClipRect.w) - std::max(y(command.ClipRect.y), 0.0));
      const Texels* texels = textures.at(command.TextureId);
      for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
        std::array<const ImDrawVert*, 3> v{};
        for (unsigned k = 0; k < 3; ++k)
          v[k] = &list.VtxBuffer[int(command.VtxOffset + list.IdxBuffer[int(command.IdxOffset + i + k)])];
        std::array<double, 3> px{}, py{};
        for (size_t k = 0; k < 3; ++k) px[k] = x(v[k]->pos.x), py[k] = y(v[k]->pos.y);
        const double area = (px[1] - px[0]) * (py[2] - py[0]) - (py[1] - py[0]) * (px[2] - px[0]);
        if (area == 0) continue;
        const auto clampTo = [&](double at, double low, double high, int limit) {
          return static_cast<int>(std::clamp(std::floor(std::clamp(at, low, high) * side), 0.0, double(limit)));
        };
        const auto [x0, x1] = std::minmax({px[0], px[1], px[2]});
        const auto [y0, y1] = std::minmax({py[0], py[1], py[2]});
        const int firstX = clampTo(x0, left, right, width), lastX = clampTo(x1 + 1, left, right, width);
        const int firstY = clampTo(y0, top, bottom, height), lastY = clampTo(y1 + 1, top, bottom, height);
        for (int sy = firstY; sy < lastY; ++sy)
          for (int sx = firstX; sx < lastX; ++sx) {
            const double cx = (sx + 0.5) / side, cy = (sy + 0.5) / side;
            std::array<double, 3> w{};
            bool inside = true;
            for (size_t k = 0; k < 3; ++k) {
              const size_t a = (k + 1) % 3, b = (k + 2) % 3;
              w[k] = ((px[a] - cx) * (py[b] - cy) - (py[a] - cy) * (px[b] - cx)) / area;
              inside = inside && w[k] > 0;
            }
            if (!inside) continue;
            std::array<double, 4> color{};
            double u = 0, t = 0;
            for (size_t k = 0; k < 3; ++k) {
              const int shifts[4] = {IM_COL32_R_SHIFT, IM_COL32_G_SHIFT, IM_COL32_B_SHIFT, IM_COL32_A_SHIFT};
              for (size_t c = 0; c < 4; ++c) color[c] += w[k] * ((v[k]->col >> shifts[c] & 255u) / 255.0);
              u += w[k] * double(v[k]->uv.x);
              t += w[k] * double(v[k]->uv.y);
            }
            if (texels) {
              const std::array<double, 4> texel = texels->sample(u, t);
              for (size_t c = 0; c < 4; ++c) color[c] *= texel[c];
            }
            auto& to = samples[size_t(sy) * size_t(width) + size_t(sx)];
            for (size_t c = 0; c < 3; ++c) to[c] = float(color[c] * color[3] + double(to[c]) * (1 - color[3]));
          }
      }
    }
  }
  host::Picture picture{kWidth, kHeight, std::vector<uint8_t>(size_t{kWidth} * kHeight * 4, 255)};
  for (uint32_t py = 0; py < kHeight; ++py)
    for (uint32_t px = 0; px < kWidth; ++px)
      for (size_t c = 0; c < 3; ++c) {
        float sum = 0;
        for (int k = 0; k < side * side; ++k)
          sum += samples[size_t(int(py) * side + k / side) * size_t(width) + size_t(int(px) * side + k % side)][c];
        picture.rgba[(size_t{py} * kWidth + px) * 4 + c] =
            static_cast<uint8_t>(std::lround(sum / float(side * side) * 255));
      }
  return picture;
}

/// Draw data of lists made by hand.
struct HandMade {
  std::vector<std::unique_ptr<ImDrawList>> lists;
  std::vector<ImDrawList*> pointers;
  ImDrawData data;

  ImDrawList& list(const char* name) {
    lists.push_back(std::make_unique<ImDrawList>(ImGui::GetDrawListSharedData()));
    lists.back()->_OwnerName = name;
    return *lists.back();
  }
  static ImDrawCmd& command(ImDrawList& list, ImTextureID texture, const ImVec4& clip) {
    ImDrawCmd command;
    command.TextureId = texture;
    command.ClipRect = clip;
    command.IdxOffset = static_cast<unsigned>(list.IdxBuffer.Size);
    list.CmdBuffer.push_back(command);
    return list.CmdBuffer.back();
  }
  ImDrawData& finish(ImVec2 position = {0, 0}, ImVec2 scale = {1, 1}) {
    pointers.clear();
    data = {};
    data.Valid = true;
    for (const auto& list : lists) {
      pointers.push_back(list.get());
      data.TotalIdxCount += list->IdxBuffer.Size;
      data.TotalVtxCount += list->VtxBuffer.Size;
    }
    data.CmdLists = pointers.data();
    data.CmdListsCount = static_cast<int>(pointers.size());
    data.DisplayPos = position;
    data.DisplaySize = {kWidth / scale.x, kHeight / scale.y};
    data.FramebufferScale = scale;
    return data;
  }
};

/// Triangles of all sizes, over edges of the screen and of clip rectangles, sharing corners; commands that begin in the
/// midst of the vertices. With no textures: as the font's texture is white.
HandMade randomLists(uint32_t seed, const std::vector<ImTextureID>& textures, ImVec2 white, bool textured,
                     ImVec2 position = {0, 0}, ImVec2 scale = {1, 1}) {
  std::mt19937 random(seed);
  const auto between = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 100003) / 100002.0f;
  };
  const float width = kWidth / scale.x, height = kHeight / scale.y;
  HandMade made;
  for (int l = 0; l < 3; ++l) {
    ImDrawList& list = made.list("random");
    for (int c = 0; c < 4; ++c) {
      const float left = position.x + between(-0.2f, 0.6f) * width, top = position.y + between(-0.2f, 0.6f) * height;
      ImDrawCmd& command =
          HandMade::command(list, textures[random() % textures.size()],
                            {left, top, left + between(0.1f, 1) * width, top + between(0.1f, 1) * height});
      command.VtxOffset = static_cast<unsigned>(list.VtxBuffer.Size);
      const int corners = 12;
      for (int i = 0; i < corners; ++i) {
        const float reach = i % 3 ? between(2, 160) : between(20, 600);
        const ImVec2 middle{position.x + between(0, width), position.y + between(0, height)};
        list.VtxBuffer.push_back({{middle.x + between(-reach, reach), middle.y + between(-reach, reach)},
                                  textured ? ImVec2{between(-1, 2), between(-1, 2)} : white,
                                  static_cast<ImU32>(random()) | (i % 4 ? 0u : 0xff000000u)});
      }
      command.ElemCount = 3 * 8;
      for (unsigned i = 0; i < command.ElemCount; ++i)
        list.IdxBuffer.push_back(static_cast<ImDrawIdx>(random() % corners));
    }
  }
  return made;
}

struct ImGuiLists : testing::Test {
  static void SetUpTestSuite() { stage = std::make_unique<ImGuiStage>(); }
  static void TearDownTestSuite() { stage.reset(); }
  void TearDown() override {
    for (const std::string& message : stage->messages) ADD_FAILURE() << message;
    stage->messages.clear();
    kept.clear();
    uploads.reset();
    EXPECT_EQ(stage->device.validationMessages(), 0u);
  }
  /// A texture on the device, with its pixels straight in `texels`.
  GpgpCanvasImage texture(const Texels& texels) {
    if (!uploads) uploads = std::make_unique<integration::Textures>(stage->device.physical, stage->device.device);
    std::vector<uint8_t> pixels = texels.rgba;
    for (size_t i = 0; i < pixels.size(); ++i)
      if (i % 4 != 3) pixels[i] = static_cast<uint8_t>((pixels[i] * texels.rgba[i | 3] + 127) / 255);
    kept.push_back(uploads->make(texels.width, texels.height, std::move(pixels)));
    VkCommandBuffer commands = stage->frames.begin();
    EXPECT_EQ(stage->context.advance(stage->frames.number()), GPGP_SUCCESS);
    uint32_t count = 0;
    EXPECT_TRUE(uploads->recordUpload(commands, count));
    stage->frames.submit();
    vkDeviceWaitIdle(stage->device.device);
    return uploads->image(*kept.back());
  }
  static Texels randomTexels(uint32_t seed, uint32_t width, uint32_t height, bool opaque) {
    std::mt19937 random(seed);
    Texels texels{width, height, {}};
    for (uint32_t i = 0; i < width * height * 4; ++i)
      texels.rgba.push_back(static_cast<uint8_t>(opaque ? (i % 4 == 3 ? 255u : random() % 256u)
                                                        : (i % 4 == 3 ? random() % 256u : 40u + 70u * (i % 4))));
    return texels;
  }

  std::unique_ptr<integration::Textures> uploads;
  std::vector<integration::TexturePointer> kept;
};

/// With one sample a pixel and ImGui's own font texture, all of ImGui's window of everything.
TEST_F(ImGuiLists, DemoWindowIsImGuisOwnPixelByPixel) {
  Screen own({.byGpgp = false}), ours({.outlines = false, .samples = 1});
  for (const bool widgets : {false, true}) {
    const std::string name = widgets ? "exact_widgets" : "exact";
    const auto ui = [&] {
      demo(widgets);
      ImDrawList& list = *ImGui::GetForegroundDrawList(); // smooth and round things
      list.AddCircleFilled({500.3f, 200.7f}, 43.6f, IM_COL32(200, 30, 40, 200));
      list.AddCircle({500, 320}, 50, IM_COL32(20, 230, 40, 255), 0, 3.5f);
      list.AddBezierCubic({430, 100}, {500, 150}, {520, 20}, {600, 90}, IM_COL32(255, 255, 0, 255), 5);
      list.AddRectFilledMultiColor({420, 400}, {600, 440}, IM_COL32(255, 0, 0, 255), IM_COL32(0, 255, 0, 255),
                                   IM_COL32(0, 0, 255, 255), IM_COL32(255, 255, 255, 0));
      list.AddLine({400, 250}, {620, 262}, IM_COL32(255, 255, 255, 255), 2);
    };
    const host::Picture theirs = own.render(ui, 4), mine = ours.render(ui, 4);
    keep(theirs, (name + "_imgui").c_str());
    keep(mine, (name + "_gpgp").c_str());
    EXPECT_EQ(ours.prepared, GPGP_SUCCESS) << ours.renderer->error();
    EXPECT_EQ(ours.drawn, GPGP_SUCCESS);
    EXPECT_GT(ours.renderer->report().triangles, 1500u);
    EXPECT_EQ(ours.renderer->report().glyphs, 0u);
    EXPECT_EQ(ours.renderer->report().textures, 1u);
    EXPECT_EQ(ours.renderer->report().dropped, 0u);
    EXPECT_LE(different(mine, theirs, 0, 0, kWidth, kHeight, 3), 40u); // centres that lie on an edge, up to rounding
    EXPECT_LE(worstTile(mine, theirs), 4);
  }
}

TEST_F(ImGuiLists, RandomListsAreThoseOfImGuisRenderer) {
  Screen own({.byGpgp = false}), ours({.outlines = false, .samples = 1});
  for (uint32_t seed = 0; seed < 3; ++seed) {
    const bool scaled = seed % 3 == 2;
    const ImVec2 position = scaled ? ImVec2{-70, 35} : ImVec2{0, 0}, scale = scaled ? ImVec2{2, 1.6f} : ImVec2{1, 1};
    const auto render = [&](Screen& screen) {
      ImGui::SetCurrentContext(screen.context);
      const ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
      HandMade made = randomLists(seed, {atlas.TexID}, atlas.TexUvWhitePixel, false, position, scale);
      return screen.render(made.finish(position, scale));
    };
    const host::Picture theirs = render(own), mine = render(ours);
    if (seed < 3) keep(mine, ("random_" + std::to_string(seed)).c_str());
    EXPECT_EQ(ours.prepared, GPGP_SUCCESS) << ours.renderer->error();
    EXPECT_GT(different(mine, ours.render([] {}), 0, 0, kWidth, kHeight, 3), 50000u) << seed;
    // Long edges: theirs begin and end at 1/256 of a pixel, as rasterisers have it.
    EXPECT_LE(different(mine, theirs, 0, 0, kWidth, kHeight, 6), 600u) << seed;
    EXPECT_LE(worstTile(mine, theirs), 16) << seed;
  }
}

/// What triangles mean, with and without textures: a rasteriser on the CPU, 1 and 16 samples a pixel.
TEST_F(ImGuiLists, RandomListsAreThoseOfARasteriserOnTheCpu) {
  const Texels opaque = randomTexels(1, 16, 8, true), soft = randomTexels(2, 8, 8, false);
  for (const uint32_t samples : {1u, 16u}) {
    Screen screen({.outlines = false, .samples = samples});
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    const ImTextureID first = screen.renderer->addTexture(texture(opaque)),
                      second = screen.renderer->addTexture(texture(soft));
    ASSERT_TRUE(first && second);
    for (uint32_t seed = 100; seed < 102; ++seed) {
      const bool textured = seed % 2 == 0;
      HandMade made = textured ? randomLists(seed, {first, second}, {}, true)
                               : randomLists(seed, {atlas.TexID}, atlas.TexUvWhitePixel, false);
      ImDrawData& data = made.finish();
      const host::Picture mine = screen.render(data);
      EXPECT_EQ(screen.prepared, GPGP_SUCCESS) << screen.renderer->error();
      EXPECT_EQ(screen.renderer->report().textures, textured ? 2u : 0u);
      const host::Picture wanted =
          rasterise(data, {{first, &opaque}, {second, &soft}, {atlas.TexID, nullptr}}, samples == 1 ? 1 : 4);
      const std::string name = std::to_string(seed) + "_" + std::to_string(samples);
      keep(mine, ("lists_gpgp_" + name).c_str());
      keep(wanted, ("lists_cpu_" + name).c_str());
      EXPECT_LE(worstTile(mine, wanted), samples == 1 ? 12 : 4) << name;
      EXPECT_LE(different(mine, wanted, 0, 0, kWidth, kHeight, samples == 1 ? 6 : 24), 250u) << name;
    }
  }
}

/// More textures in a frame than a device binds at once.
TEST_F(ImGuiLists, ManyTexturesAreShownEachAtItsPlace) {
  Screen screen({});
  std::vector<ImTextureID> ids;
  std::vector<Color> colors;
  for (int i = 0; i < 20; ++i) {
    colors.push_back({i * 12, 255 - i * 12, i * 37 % 256});
    Texels texels{2, 2, {}};
    for (int t = 0; t < 4; ++t)
      for (const int value : {colors.back()[0], colors.back()[1], colors.back()[2], 255})
        texels.rgba.push_back(static_cast<uint8_t>(value));
    ids.push_back(screen.renderer->addTexture(texture(texels)));
  }
  const host::Picture picture = screen.render([&] {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({640, 480});
    ImGui::Begin("pictures", nullptr, ImGuiWindowFlags_NoDecoration);
    for (size_t i = 0; i < ids.size(); ++i) {
      ImGui::SetCursorPos({20 + 60 * static_cast<float>(i % 10), 20 + 60 * static_cast<float>(i / 10)});
      ImGui::Image(ids[i], {40, 40});
    }
    ImGui::GetWindowDrawList()->AddImageRounded(ids[3], {100, 200}, {200, 300}, {0, 0}, {1, 1},
                                                IM_COL32(255, 255, 255, 255), 50);
    ImGui::End();
  });
  keep(picture, "textures");
  EXPECT_EQ(screen.prepared, GPGP_SUCCESS) << screen.renderer->error();
  EXPECT_GE(screen.renderer->report().textures, 20u);
  for (size_t i = 0; i < ids.size(); ++i)
    EXPECT_EQ(at(picture, 40 + 60 * static_cast<uint32_t>(i % 10), 40 + 60 * static_cast<uint32_t>(i / 10)), colors[i])
        << i;
  EXPECT_EQ(at(picture, 150, 250), colors[3]);
  EXPECT_NE(at(picture, 103, 203), colors[3]) << "round";
  for (const ImTextureID id : ids) EXPECT_EQ(screen.renderer->removeTexture(id), GPGP_SUCCESS);
}

/// Nothing is shown in silence, and the frame after is whole.
TEST_F(ImGuiLists, WhatCannotBeDrawnIsAnErrorWithItsPlace) {
  Screen screen({.maxTriangles = 20, .maxTextures = 2});
  const Texels texels = randomTexels(3, 4, 4, true);
  const GpgpCanvasImage image = texture(texels);
  const ImTextureID removed = screen.renderer->addTexture(image);
  EXPECT_EQ(screen.renderer->removeTexture(removed), GPGP_SUCCESS);
  EXPECT_EQ(screen.renderer->removeTexture(removed), GPGP_ERROR_INVALID_HANDLE);
  const ImTextureID again = screen.renderer->addTexture(image);
  EXPECT_NE(again, removed) << "an old ID is not taken for the new one";
  EXPECT_EQ(screen.renderer->addTexture({}), nullptr);
  GpgpCanvasImage noSampler = image;
  noSampler.sampler = VK_NULL_HANDLE;
  EXPECT_EQ(screen.renderer->addTexture(noSampler), nullptr);

  const host::Picture empty = screen.render([] {});
  const auto box = [](ImTextureID id) {
    ImGui::GetForegroundDrawList()->AddRectFilled({5, 5}, {25, 25}, IM_COL32(255, 0, 0, 255));
    ImGui::GetForegroundDrawList()->AddImage(id, {30, 30}, {90, 90});
  };
  const auto refused = [&](const std::function<void()>& ui, GpgpResult result, const char* words) {
    const host::Picture shown = screen.render(ui, 1);
    EXPECT_EQ(screen.prepared, result) << words;
    EXPECT_EQ(screen.drawn, GPGP_NOT_READY) << words;
    EXPECT_EQ(shown.rgba, empty.rgba) << words;
    const std::string& error = screen.renderer->error();
    EXPECT_NE(error.find(words), std::string::npos) << error;
    EXPECT_EQ(error.find("draw list "), 0u) << error;
    screen.render([&] { box(again); }, 1);
    EXPECT_EQ(screen.prepared, GPGP_SUCCESS) << screen.renderer->error();
    EXPECT_EQ(screen.drawn, GPGP_SUCCESS);
    EXPECT_EQ(screen.renderer->error(), "");
  };
  VkDescriptorSet set{}; // what the program gave ImGui's own backend
  std::memset(&set, 0x5a, sizeof set);
  for (const ImTextureID wrong : {removed, ImTextureID{}, reinterpret_cast<ImTextureID>(set),
                                  reinterpret_cast<ImTextureID>(uintptr_t{UINT32_MAX})})
    refused([&] { box(wrong); }, GPGP_ERROR_INVALID_HANDLE, "is none of createFontTexture's and addTexture's");
  refused([&] { ImGui::GetForegroundDrawList()->AddCallback([](const ImDrawList*, const ImDrawCmd*) {}, nullptr); },
          GPGP_ERROR_UNSUPPORTED, "a draw callback");
  const ImTextureID second = screen.renderer->addTexture(image), third = screen.renderer->addTexture(image);
  refused(
      [&] {
        box(again);
        box(second);
        box(third);
      },
      GPGP_ERROR_INVALID_ARGUMENT, "one more than RendererInfo::maxTextures");
  // Its own reset is nothing to do.
  screen.render([&] { ImGui::GetForegroundDrawList()->AddCallback(ImDrawCallback_ResetRenderState, nullptr); }, 1);
  EXPECT_EQ(screen.prepared, GPGP_SUCCESS);

  // Indices beyond the vertices, and beyond the indices.
  const ImTextureID font = ImGui::GetIO().Fonts->TexID;
  for (const bool vertices : {true, false}) {
    HandMade made;
    ImDrawList& list = made.list("broken");
    HandMade::command(list, font, {0, 0, 640, 480}).ElemCount = vertices ? 3 : 6;
    for (const float x : {0.0f, 100.0f, 50.0f}) list.VtxBuffer.push_back({{x, x * x / 50}, {0, 0}, 0xffffffff});
    for (const int index : {0, 1, vertices ? 3 : 2}) list.IdxBuffer.push_back(static_cast<ImDrawIdx>(index));
    screen.render(made.finish());
    EXPECT_EQ(screen.prepared, GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(screen.renderer->error().find("draw list 0 (broken), command 0: ind"), std::string::npos)
        << screen.renderer->error();
  }
  // Corners that are no numbers, and more triangles than there is room for, are counted; the others are drawn.
  const host::Picture some = screen.render([&] {
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddTriangleFilled({10, 10}, {NAN, 50}, {50, 10}, IM_COL32(255, 0, 0, 255));
    for (int i = 0; i < 15; ++i) {
      const float x = 20.0f * static_cast<float>(i);
      list.AddRectFilled({x, 100}, {x + 20, 120}, IM_COL32(0, 255, 0, 255));
    }
  });
  EXPECT_EQ(screen.prepared, GPGP_SUCCESS);
  EXPECT_EQ(screen.renderer->report().triangles, 20u);
  EXPECT_GT(screen.renderer->report().dropped, 10u);
  EXPECT_EQ(at(some, 190, 110), (Color{0, 255, 0}));
  EXPECT_NE(at(some, 210, 110), (Color{0, 255, 0}));
}

/// A font that was added later: the atlas is built anew and its texture is another one.
TEST_F(ImGuiLists, FontTexturesAreMadeAgain) {
  Screen screen({.outlines = false});
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  const ImTextureID before = atlas.TexID;
  const auto text = [&](ImFont* font) {
    return [font] { ImGui::GetForegroundDrawList()->AddText(font, 40, {20, 20}, IM_COL32_WHITE, "Mm"); };
  };
  const host::Picture small = screen.render(text(atlas.Fonts[0]));
  ImFont* large = atlas.AddFontFromFileTTF(GPGP_TEST_DATA "/fetched/fonts/DejaVuSans.ttf", 40);
  screen.renderer->createFontTexture(atlas);
  EXPECT_NE(atlas.TexID, before);
  EXPECT_EQ(screen.renderer->removeTexture(before), GPGP_ERROR_INVALID_HANDLE);
  const host::Picture sharp = screen.render(text(large));
  EXPECT_EQ(screen.prepared, GPGP_SUCCESS) << screen.renderer->error();
  keep(sharp, "font_again");
  const auto seam = [](const host::Picture& picture) {
    uint32_t count = 0;
    for (uint32_t y = 0; y < 80; ++y)
      for (uint32_t x = 0; x < 200; ++x) count += at(picture, x, y)[0] > 125 && at(picture, x, y)[0] < 245;
    return count;
  };
  EXPECT_GT(seam(sharp), 50u);
  EXPECT_LT(seam(sharp), seam(small));
}

} // namespace
