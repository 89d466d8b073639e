// Dear ImGui in a window, all its text by gpgp, with a drawing and a paragraph as widgets beside the demo window.
#include "sample.h"
#include "gpgp_imgui.hpp"
#include "gpgp_sdl2.hpp"

#include <SDL.h>
#include <imgui/backends/imgui_impl_sdl.h>
#include <imgui/backends/imgui_impl_vulkan.h>

#include <algorithm>
#include <cstdio>

namespace {

using namespace gpgp;
using sample::need;
using sample::Options;
using sample::take;

constexpr const char* kHelp = R"(gpgp_imgui_sample: Dear ImGui with text and drawings by gpgp

  --svg FILE       the drawing (default: the HUD of the mini-engine)
  --font FILE      the font of everything (default: DejaVu Sans where it is installed, else ImGui's own)
  --fallback FILE  a font for what it does not have in the paragraph, emoji for example; may be given several times
  --text TEXT      the paragraph
  --frames N       ends after N frames; otherwise Escape does
  --size WxH       of the window (default 1280x720)
  --device NAME    GPU: part of its name, or an index (default: $GPGP_DEVICE, else the software device)
  --picture FILE   the last frame as BMP
  --validate       under the Khronos validation layer; any message of it is an error

Exit code 0: all is well; 1: an error, a validation message or an exceeded budget; 2: wrong usage.
)";

/// What the widgets show.
struct Content {
  Drawing drawing;
  sample::FontChain fonts;
  Shaper shaper;
  Layout layout;
  const std::string words;
  float width = 0;

  Content(GpgpContext context, const Options& options)
      : drawing(sample::loadDrawing(context, options.svg)), fonts(options), words(options.text) {
    if (fonts.empty()) return;
    shaper = take(Shaper::create(), "gpgpCreateShaper");
    layout = take(shaper.layout(), "gpgpCreateLayout");
  }

  /// Lays the text out anew only where its width has changed.
  void fit(float available) {
    available = std::max(available, 50.0f);
    if (!layout || available == width) return;
    width = available;
    auto info = init<GpgpTextInfo>();
    info.text = words.data();
    info.size = words.size();
    fonts.set(info.style);
    info.style.size = 22;
    std::fill_n(info.style.color, 4, 1.0f);
    info.width = width;
    need(layout.set(info), "gpgpSetLayoutText");
  }

  void window(imgui::Renderer& renderer) {
    ImGui::SetNextWindowPos({20, 20}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({360, 420}, ImGuiCond_FirstUseEver);
    ImGui::Begin("gpgp");
    ImGui::Text("A drawing, %.0f pixels wide:", static_cast<double>(ImGui::GetContentRegionAvail().x));
    const float side = ImGui::GetContentRegionAvail().x;
    renderer.drawing(drawing, {side, side * 9 / 16});
    if (layout) {
      fit(ImGui::GetContentRegionAvail().x);
      renderer.text(layout);
    }
    ImGui::SliderFloat("text scale", &ImGui::GetIO().FontGlobalScale, 0.5f, 4.0f);
    const imgui::FrameReport& report = renderer.report();
    ImGui::Text("%u glyphs in %u pieces and %u layers", report.glyphs, report.pieces, report.layers);
    ImGui::End();
  }
};

/// ImGui with its two backends, until it goes.
struct Toolkit {
  VkDevice device;
  VkDescriptorPool pool = VK_NULL_HANDLE;

  Toolkit(sdl2::Device& from, const sdl2::Window& window, const sdl2::Swapchain& swapchain, const sdl2::ColorPass& pass)
      : device(from.device) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    sdl2::check(vkCreateDescriptorPool(device, &poolInfo, nullptr, &pool), "vkCreateDescriptorPool");
    ImGui_ImplSDL2_InitForVulkan(window.handle());
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = from.instance;
    info.PhysicalDevice = from.physical;
    info.Device = from.device;
    info.QueueFamily = from.family;
    info.Queue = from.queue;
    info.DescriptorPool = pool;
    info.MinImageCount = 2;
    info.ImageCount = std::max(static_cast<uint32_t>(swapchain.images().size()), 2u);
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = [](VkResult result) { sdl2::check(result, "ImGui's renderer"); };
    ImGui_ImplVulkan_Init(&info, pass.handle());
  }
  ~Toolkit() {
    vkDeviceWaitIdle(device);
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplSDL2_Shutdown();
    vkDestroyDescriptorPool(device, pool, nullptr);
  }
};

struct UiContext {
  UiContext() { ImGui::CreateContext(); }
  ~UiContext() { ImGui::DestroyContext(); }
};

int run(const Options& options) {
  sdl2::Window window({"gpgp and Dear ImGui", options.width, options.height});
  sdl2::DeviceInfo deviceInfo;
  deviceInfo.device = options.device;
  deviceInfo.validate = options.validate;
  deviceInfo.instanceExtensions = window.instanceExtensions();
  deviceInfo.deviceExtensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  sdl2::Device device(deviceInfo);
  bool well = true;
  {
    sdl2::SwapchainInfo swapchainInfo;
    swapchainInfo.maxExtent = {2560, 1440};
    swapchainInfo.srgb = false; // ImGui's colours are meant for images that store them as they are
    sdl2::Swapchain swapchain(device, window, swapchainInfo);
    sdl2::ColorPass pass(device, swapchain);
    sdl2::Frames frames(device);
    GpgpContextCreateInfo contextInfo = device.contextCreateInfo();
    contextInfo.label = "sample";
    contextInfo.maxFramesInFlight = frames.inFlight();
    contextInfo.messageFn = sample::onMessage;
    Context context = take(Context::create(contextInfo), "gpgpCreateContext");

    UiContext ui;
    ImGui::GetIO().IniFilename = nullptr;
    if (sample::isThere(options.font)) ImGui::GetIO().Fonts->AddFontFromFileTTF(options.font.c_str(), 15);
    imgui::RendererInfo info;
    info.context = context;
    info.physicalDevice = device.physical;
    info.device = device.device;
    info.queueFamily = device.family;
    info.renderPass = pass.handle();
    info.maxWidth = swapchain.maxExtent().width;
    info.maxHeight = swapchain.maxExtent().height;
    imgui::Renderer renderer(info);
    renderer.useFonts(*ImGui::GetIO().Fonts);
    Content content(context, options);
    Toolkit toolkit(device, window, swapchain, pass);

    std::optional<sdl2::Screenshot> screenshot;
    const auto onEvent = [](const SDL_Event& event) { ImGui_ImplSDL2_ProcessEvent(&event); };
    for (uint32_t done = 0; window.pollEvents(onEvent) && (options.frames == 0 || done < options.frames); ++done) {
      VkCommandBuffer commands = frames.begin();
      if (done == 0) ImGui_ImplVulkan_CreateFontsTexture(commands);
      std::optional<sdl2::Swapchain::Acquired> acquired;
      while (!(acquired = swapchain.acquire(frames.slot()))) {
        swapchain.resize();
        pass.attach();
      }
      need(context.advance(frames.number()), "gpgpAdvance");

      ImGui_ImplVulkan_NewFrame();
      ImGui_ImplSDL2_NewFrame();
      ImGui::NewFrame();
      ImGui::ShowDemoWindow();
      content.window(renderer);
      ImGui::Render();

      need(renderer.prepare(*ImGui::GetDrawData(), commands, frames.number()), "gpgp::imgui");
      pass.begin(commands, acquired->index, {0.1f, 0.12f, 0.15f, 1});
      renderer.use(commands);
      ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
      vkCmdEndRenderPass(commands);
      const bool last = done + 1 == options.frames && !options.picture.empty();
      if (last) screenshot.emplace(device, swapchain).record(commands, acquired->index);
      frames.submit(acquired->available, swapchain.images()[acquired->index].rendered);
      swapchain.present(*acquired);
      well = well && renderer.report().dropped == 0;
    }
    frames.finish();
    const imgui::FrameReport& report = renderer.report();
    std::printf("frame       %u glyphs in %u pieces and %u layers, %u dropped\n", report.glyphs, report.pieces,
                report.layers, report.dropped);
    if (screenshot) screenshot->save(options.picture);
  }
  std::printf("device      %s\n", device.properties.deviceName);
  if (options.validate) std::printf("validation  %u messages\n", device.validationMessages());
  return well && device.validationMessages() == 0 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
  Options options;
  options.text = "This paragraph is a widget: shaped, with ligatures and kerning, in lines that break to fit.";
  options.width = 1280;
  options.height = 720;
  options.maxWidth = 2560;
  options.maxHeight = 1440;
  return sample::sampleMain(argc, argv, "gpgp_imgui_sample", kHelp, options, run);
}
