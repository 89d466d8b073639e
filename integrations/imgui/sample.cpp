// Dear ImGui in a window, drawn by gpgp alone, with a drawing and a paragraph as widgets beside the demo window.
#include "sample.h"
#include "gpgp_imgui.hpp"
#include "gpgp_sdl2.hpp"

#include <SDL.h>
#include <imgui/backends/imgui_impl_sdl.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace {

using namespace gpgp;
using sample::need;
using sample::Options;
using sample::take;

constexpr const char* kHelp = R"(gpgp_imgui_sample: Dear ImGui drawn by gpgp

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
    ImGui::Text("%u triangles, %u glyphs, %u widgets", report.triangles, report.glyphs, report.widgets);
    ImGui::End();
  }
};

/// ImGui's events from SDL, until it goes.
struct Events {
  explicit Events(const sdl2::Window& window) { ImGui_ImplSDL2_InitForVulkan(window.handle()); }
  ~Events() { ImGui_ImplSDL2_Shutdown(); }
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
    auto target = init<GpgpTargetInfo>();
    target.renderPass = pass.handle();
    info.target = &target;
    info.maxWidth = swapchain.maxExtent().width;
    info.maxHeight = swapchain.maxExtent().height;
    imgui::Renderer renderer(info);
    if (sample::isThere(options.font)) renderer.useFonts(*ImGui::GetIO().Fonts); // else ImGui's own, a bitmap
    renderer.createFontTexture(*ImGui::GetIO().Fonts);
    Content content(context, options);
    Events events(window);

    std::optional<sdl2::Screenshot> screenshot;
    const auto onEvent = [](const SDL_Event& event) { ImGui_ImplSDL2_ProcessEvent(&event); };
    for (uint32_t done = 0; window.pollEvents(onEvent) && (options.frames == 0 || done < options.frames); ++done) {
      VkCommandBuffer commands = frames.begin();
      std::optional<sdl2::Swapchain::Acquired> acquired;
      while (!(acquired = swapchain.acquire(frames.slot()))) {
        swapchain.resize();
        pass.attach();
      }
      need(context.advance(frames.number()), "gpgpAdvance");

      ImGui_ImplSDL2_NewFrame();
      ImGui::NewFrame();
      ImGui::ShowDemoWindow();
      content.window(renderer);
      ImGui::Render();

      if (renderer.prepare(*ImGui::GetDrawData(), commands, frames.number()) < 0)
        throw std::runtime_error("gpgp::imgui: " + renderer.error());
      pass.begin(commands, acquired->index, {0.1f, 0.12f, 0.15f, 1});
      need(renderer.draw(commands, frames.number()), "gpgp::imgui");
      vkCmdEndRenderPass(commands);
      const bool last = done + 1 == options.frames && !options.picture.empty();
      if (last) screenshot.emplace(device, swapchain).record(commands, acquired->index);
      frames.submit(acquired->available, swapchain.images()[acquired->index].rendered);
      swapchain.present(*acquired);
      well = well && renderer.report().dropped == 0;
    }
    frames.finish();
    const imgui::FrameReport& report = renderer.report();
    std::printf("frame       %u triangles, %u glyphs, %u widgets, %u textures, %u dropped\n", report.triangles,
                report.glyphs, report.widgets, report.textures, report.dropped);
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
