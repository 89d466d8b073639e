// What tests of gpgp::imgui draw on, beside ImGui's own Vulkan renderer. GPGP_IMGUI_PICTURES=FOLDER writes pictures.
#pragma once
#include "gpgp_imgui.hpp"
#include "host/picture.h"
#include "stage.h"

#include <imgui/backends/imgui_impl_vulkan.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>

namespace gpgp::test {

constexpr uint32_t kWidth = 640, kHeight = 480;

/// With textures of ImGui's: shared by all tests.
struct ImGuiStage : PassStage {
  VkDescriptorPool pool = VK_NULL_HANDLE;

  explicit ImGuiStage(VkFormat f = VK_FORMAT_R8G8B8A8_UNORM)
      : PassStage(f, kWidth, kHeight, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 8;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    sdl2::check(vkCreateDescriptorPool(device.device, &poolInfo, nullptr, &pool), "pool");
  }
  ~ImGuiStage() {
    vkDeviceWaitIdle(device.device);
    vkDestroyDescriptorPool(device.device, pool, nullptr);
  }
};

inline std::unique_ptr<ImGuiStage> stage;

struct ScreenInfo {
  bool byGpgp = true;   ///< otherwise by ImGui's own renderer
  bool outlines = true; ///< useFonts
  uint32_t samples = 16;
  float fontSize = 13;
  const char* emoji = nullptr; ///< a font for cups
  uint32_t maxTriangles = 32768, maxTextures = 64;
};

/// An ImGui context with a renderer.
struct Screen {
  const ScreenInfo screenInfo;
  ImGuiContext* context = ImGui::CreateContext();
  std::unique_ptr<imgui::Renderer> renderer;
  GpgpResult prepared = GPGP_SUCCESS, drawn = GPGP_SUCCESS;

  explicit Screen(const ScreenInfo& wanted) : screenInfo(wanted) {
    ImGui::SetCurrentContext(context);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {kWidth, kHeight};
    ImFontConfig config;
    config.SizePixels = wanted.fontSize;
    config.OversampleH = 3;
    io.Fonts->AddFontFromFileTTF(GPGP_TEST_DATA "/fetched/fonts/DejaVuSans.ttf", wanted.fontSize, &config);
    static const ImWchar drinks[] = {0x2615, 0x2615, 0};
    config.MergeMode = true;
    if (wanted.emoji) io.Fonts->AddFontFromFileTTF(wanted.emoji, wanted.fontSize, &config, drinks);
    if (wanted.byGpgp)
      makeOurs();
    else
      makeTheirs();
  }
  void makeOurs() {
    GpgpTargetInfo target = GPGP_TARGET_INFO_INIT;
    target.renderPass = stage->pass;
    imgui::RendererInfo info;
    info.context = stage->context;
    info.physicalDevice = stage->device.physical;
    info.device = stage->device.device;
    info.queueFamily = stage->device.family;
    info.target = &target;
    info.maxWidth = kWidth;
    info.maxHeight = kHeight;
    info.samples = screenInfo.samples;
    info.maxTriangles = screenInfo.maxTriangles;
    info.maxTextures = screenInfo.maxTextures;
    info.srgbTarget = stage->format == VK_FORMAT_R8G8B8A8_SRGB;
    renderer = std::make_unique<imgui::Renderer>(info);
    if (screenInfo.outlines) renderer->useFonts(*ImGui::GetIO().Fonts);
    renderer->createFontTexture(*ImGui::GetIO().Fonts);
  }
  void makeTheirs() {
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = stage->device.instance;
    info.PhysicalDevice = stage->device.physical;
    info.Device = stage->device.device;
    info.QueueFamily = stage->device.family;
    info.Queue = stage->device.queue;
    info.DescriptorPool = stage->pool;
    info.MinImageCount = info.ImageCount = 2;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    ImGui_ImplVulkan_Init(&info, stage->pass);
    VkCommandBuffer commands = stage->frames.begin();
    ImGui_ImplVulkan_CreateFontsTexture(commands);
    EXPECT_EQ(stage->context.advance(stage->frames.number()), GPGP_SUCCESS);
    stage->frames.submit();
    vkDeviceWaitIdle(stage->device.device);
    ImGui_ImplVulkan_DestroyFontUploadObjects();
  }
  ~Screen() {
    vkDeviceWaitIdle(stage->device.device);
    ImGui::SetCurrentContext(context);
    if (!renderer) ImGui_ImplVulkan_Shutdown();
    ImGui::DestroyContext(context);
  }

  /// ImGui takes a frame to size its windows: the picture is the second's.
  host::Picture render(const std::function<void()>& ui, int frames = 2) {
    ImGui::SetCurrentContext(context);
    for (int i = 0; i < frames; ++i) frame(ui);
    return picture();
  }
  /// Of draw data that are not ImGui's.
  host::Picture render(ImDrawData& given) {
    ImGui::SetCurrentContext(context);
    frame([] {}, &given);
    return picture();
  }
  host::Picture picture() {
    host::Picture shown{kWidth, kHeight, std::vector<uint8_t>(size_t{kWidth} * kHeight * 4)};
    vkDeviceWaitIdle(stage->device.device);
    std::memcpy(shown.rgba.data(), stage->mapped, shown.rgba.size());
    for (size_t i = 3; i < shown.rgba.size(); i += 4) shown.rgba[i] = 255;
    return shown;
  }
  void frame(const std::function<void()>& ui, ImDrawData* given = nullptr) {
    ImGui::GetIO().DeltaTime = 1.0f / 60;
    ImGui::NewFrame();
    ui();
    ImGui::Render();
    ImDrawData& data = given ? *given : *ImGui::GetDrawData();
    VkCommandBuffer commands = stage->frames.begin();
    EXPECT_EQ(stage->context.advance(stage->frames.number()), GPGP_SUCCESS);
    if (renderer) prepared = renderer->prepare(data, commands, stage->frames.number());
    VkClearValue clear{};
    clear.color = {{0.45f, 0.55f, 0.60f, 1}};
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = stage->pass;
    begin.framebuffer = stage->framebuffer;
    begin.renderArea.extent = {kWidth, kHeight};
    begin.clearValueCount = 1;
    begin.pClearValues = &clear;
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    if (renderer)
      drawn = renderer->draw(commands, stage->frames.number());
    else
      ImGui_ImplVulkan_RenderDrawData(&data, commands);
    vkCmdEndRenderPass(commands);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {kWidth, kHeight, 1};
    vkCmdCopyImageToBuffer(commands, stage->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, stage->buffer, 1, &copy);
    VkMemoryBarrier toHost{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    toHost.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    toHost.dstAccessMask = VK_ACCESS_HOST_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &toHost, 0, nullptr, 0,
                         nullptr);
    stage->frames.submit();
    if (!renderer) return;
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT; // only so many are kept
    while (gpgpGetCanvasReport(renderer->canvas(), &report) == GPGP_SUCCESS)
      EXPECT_TRUE(report.base.status == GPGP_SUCCESS || report.base.status == GPGP_NOT_EXECUTED);
  }
};

/// A page of 100 x 100 with a red disc of radius 50 on a blue square.
inline Drawing makeDrawing() {
  static const char svg[] = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>"
                            "<rect width='100' height='100' fill='#2040a0'/><circle cx='50' cy='50' r='50' "
                            "fill='#c03020'/></svg>";
  auto source = init<GpgpSvgSource>();
  source.name = "disc";
  source.data = svg;
  source.size = sizeof svg - 1;
  const Result<Blob> blob = compileSvg(source);
  auto info = init<GpgpDrawingCreateInfo>();
  info.data = blob->data();
  info.size = blob->size();
  return *Drawing::create(stage->context, info);
}

using Color = std::array<int, 3>;
inline Color at(const host::Picture& picture, uint32_t x, uint32_t y) {
  const uint8_t* p = &picture.rgba[(size_t{y} * picture.width + x) * 4];
  return {p[0], p[1], p[2]};
}
/// The pixels of a rectangle that differ by more than `tolerance` in a channel.
inline uint32_t different(const host::Picture& a, const host::Picture& b, uint32_t left, uint32_t top, uint32_t right,
                          uint32_t bottom, int tolerance = 0) {
  uint32_t count = 0;
  for (uint32_t y = top; y < bottom; ++y)
    for (uint32_t x = left; x < right; ++x)
      for (size_t c = 0; c < 3; ++c)
        if (std::abs(at(a, x, y)[c] - at(b, x, y)[c]) > tolerance) {
          ++count;
          break;
        }
  return count;
}
inline void keep(const host::Picture& picture, const char* name) {
  if (const char* folder = std::getenv("GPGP_IMGUI_PICTURES"))
    host::writePng(std::string(folder) + "/" + name + ".png", picture);
}

struct ImGuiTest : testing::Test {
  static void SetUpTestSuite() {
    stage = std::make_unique<ImGuiStage>();
    gpgpScreen = std::make_unique<Screen>(ScreenInfo{});
  }
  static void TearDownTestSuite() {
    gpgpScreen.reset();
    stage.reset();
  }
  void TearDown() override {
    EXPECT_EQ(stage->device.validationMessages(), 0u);
    for (const std::string& message : stage->messages) ADD_FAILURE() << message;
    stage->messages.clear();
  }
  inline static std::unique_ptr<Screen> gpgpScreen;
  Screen& screen = *gpgpScreen;
};

inline void demo(bool widgets) {
  const char* name = "Dear ImGui Demo";
  ImGui::ShowDemoWindow();
  ImGui::SetWindowPos(name, {10, 10});
  ImGui::SetWindowSize(name, {620, 460});
  ImGuiWindow* window = ImGui::FindWindowByName(name);
  for (const char* header : {"Widgets", "Basic", "Color/Picker Widgets"})
    window->StateStorage.SetInt(window->GetID(header), widgets ? 1 : 0);
  window->StateStorage.SetInt(window->GetID("Help"), widgets ? 0 : 1);
  ImGui::SetScrollY(window, widgets ? 110.0f : 0.0f);
}

} // namespace gpgp::test
