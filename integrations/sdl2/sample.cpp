// A window with a drawing and a line of text, both by gpgp: what gpgp::sdl2 is for.
#include "gpgp_sdl2.hpp"

#ifdef GPGP_SDL2_TEXT
#include "gpgp_glyph_cache.hpp"
#endif
#include <gpgp/gpgp.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

namespace {

using namespace gpgp;

constexpr const char* kHelp = R"(gpgp_sdl2_sample: a window with an SVG drawing and a line of text

  --svg FILE       the drawing (default: the HUD of the mini-engine)
  --font FILE      the text's font (default: DejaVu Sans, where it is installed); without one there is no text
  --text TEXT      the line
  --frames N       ends after N frames; otherwise Escape does
  --size WxH       of the window (default 960x540)
  --device NAME    GPU: part of its name, or an index (default: $GPGP_DEVICE, else the software device)
  --picture FILE   the last frame as BMP
  --validate       under the Khronos validation layer; any message of it is an error

Exit code 0: all is well; 1: an error or a validation message; 2: wrong usage.
)";

struct Options {
  std::string svg = GPGP_SAMPLE_SVG, font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", device, picture;
  std::string text = "gpgp in a window";
  uint32_t frames = 0, width = 960, height = 540;
  bool validate = false;
};

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--validate") {
      options.validate = true;
      continue;
    }
    if (i + 1 == argc) return false;
    const char* value = argv[++i];
    char rest = 0;
    if (name == "--svg")
      options.svg = value;
    else if (name == "--font")
      options.font = value;
    else if (name == "--text")
      options.text = value;
    else if (name == "--device")
      options.device = value;
    else if (name == "--picture")
      options.picture = value;
    else if (name == "--frames") {
      if (std::sscanf(value, "%u%c", &options.frames, &rest) != 1 || options.frames == 0) return false;
    } else if (name != "--size" || std::sscanf(value, "%ux%u%c", &options.width, &options.height, &rest) != 2 ||
               options.width == 0 || options.height == 0 || options.width > 4096 || options.height > 4096) {
      return false;
    }
  }
  return true;
}

/// The code of a call that failed, as an exception; statuses are handed back.
GpgpResult need(GpgpResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": " + gpgpResultString(result));
  return result;
}

template <class T> T take(Result<T> result, const char* what) {
  need(result.code(), what);
  return *std::move(result);
}

void GPGP_CALL onMessage(void*, const GpgpMessage* message) {
  std::fprintf(stderr, "%s: %s: %s\n", message->function, message->label, message->text);
}

Drawing loadDrawing(GpgpContext context, const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  auto source = init<GpgpSvgSource>();
  source.name = file.c_str();
  source.data = bytes.data();
  source.size = bytes.size();
  source.messageFn = onMessage;
  const Blob baked = take(compileSvg(source), "gpgpCompileSvg");
  auto info = init<GpgpDrawingCreateInfo>();
  info.label = "drawing";
  info.data = baked.data();
  info.size = baked.size();
  return take(Drawing::create(context, info), "gpgpCreateDrawing");
}

#ifdef GPGP_SDL2_TEXT
/// A line of text, laid out once.
struct Line {
  Font font;
  Shaper shaper;
  Layout layout;
  GpgpLayoutInfo info = GPGP_LAYOUT_INFO_INIT;
  integration::GlyphCache glyphs;
  std::vector<GpgpGlyphInstance> instances;

  Line(GpgpContext context, const std::string& file, const std::string& text, float size) {
    auto fontInfo = init<GpgpFontCreateInfo>();
    fontInfo.filePath = file.c_str();
    fontInfo.messageFn = onMessage;
    font = take(Font::create(fontInfo), "gpgpCreateFont");
    shaper = take(Shaper::create(), "gpgpCreateShaper");
    layout = take(shaper.layout(), "gpgpCreateLayout");
    auto textInfo = init<GpgpTextInfo>();
    const GpgpFont fonts[] = {font};
    textInfo.text = text.data();
    textInfo.size = text.size();
    textInfo.style.fonts = fonts;
    textInfo.style.fontCount = 1;
    textInfo.style.size = size;
    std::fill_n(textInfo.style.color, 4, 1.0f);
    need(layout.set(textInfo), "gpgpSetLayoutText");
    info = take(layout.info(), "gpgpGetLayoutInfo");
    need(glyphs.create(context, "line"), "gpgpCreateGlyphSet");
  }
  GpgpCanvasItem at(float x, float y) {
    instances.clear();
    need(glyphs.place(info, x, y, 1, instances), "gpgpAddGlyphs");
    return glyphs.item(instances);
  }
};
#endif

class Sample {
public:
  Sample(sdl2::Device& device, sdl2::Swapchain& swapchain, const Options& options)
      : swapchain_(swapchain), pass_(device, swapchain), frames_(device) {
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.label = "sample";
    info.maxFramesInFlight = frames_.inFlight();
    info.messageFn = onMessage;
    context_ = take(Context::create(info), "gpgpCreateContext");
    drawing_ = loadDrawing(context_, options.svg);
    drawingInfo_ = take(drawing_.info(), "gpgpGetDrawingInfo");
#ifdef GPGP_SDL2_TEXT
    if (std::ifstream(options.font).good())
      line_.emplace(context_, options.font, options.text, 0.06f * static_cast<float>(options.height));
    else
      std::fprintf(stderr, "%s is not there: no text (--font)\n", options.font.c_str());
#endif
    auto canvasInfo = init<GpgpCanvasCreateInfo>();
    canvasInfo.base.label = "window";
    canvasInfo.base.queueFamily = device.family;
    canvasInfo.base.queueFlags = device.queueFlags;
    canvasInfo.maxWidth = canvasInfo.maxHeight = kMaxSide;
    canvas_ = take(Canvas::create(context_, canvasInfo), "gpgpCreateCanvas");
    target_ = init<GpgpTargetInfo>();
    target_.renderPass = pass_.handle();
    auto prewarm = init<GpgpPrewarmInfo>();
    prewarm.targets = &target_;
    prewarm.targetCount = 1;
    need(canvas_.prewarm(prewarm), "gpgpPrewarm");
    makeView();
  }

  void frame(sdl2::Screenshot* screenshot) {
    VkCommandBuffer commands = frames_.begin();
    std::optional<sdl2::Swapchain::Acquired> acquired;
    while (!(acquired = swapchain_.acquire(frames_.slot()))) {
      swapchain_.resize();
      pass_.attach();
      makeView();
    }
    need(context_.advance(frames_.number()), "gpgpAdvance");
    std::vector<GpgpCanvasItem> items{fitted()};
#ifdef GPGP_SDL2_TEXT
    const VkExtent2D extent = swapchain_.extent();
    if (line_)
      items.push_back(line_->at((static_cast<float>(extent.width) - line_->info.width) / 2,
                                static_cast<float>(extent.height) * 0.97f - line_->info.height));
#endif
    need(context_.recordUpload(commands, frames_.number()).code(), "gpgpRecordUpload"); // what the items brought
    auto info = init<GpgpCanvasInfo>();
    info.width = swapchain_.extent().width;
    info.height = swapchain_.extent().height;
    info.items = items.data();
    info.itemCount = static_cast<uint32_t>(items.size());
    info.view = view_;
    info.exactArea = VK_TRUE; // small letters want it
    need(canvas_.recordPrepare(commands, frames_.number(), info), "gpgpRecordPrepareCanvas");

    pass_.begin(commands, acquired->index, {0.02f, 0.03f, 0.05f, 1});
    auto draw = init<GpgpCanvasDrawInfo>();
    draw.view = view_;
    draw.target = &target_;
    draw.width = info.width;
    draw.height = info.height;
    draw.clip[0] = 2 / static_cast<float>(draw.width); // pixels to clip space
    draw.clip[5] = 2 / static_cast<float>(draw.height);
    draw.clip[10] = draw.clip[15] = 1;
    draw.clip[12] = draw.clip[13] = -1;
    need(canvas_.recordDraw(commands, frames_.number(), draw), "gpgpRecordDrawCanvas");
    vkCmdEndRenderPass(commands);
    if (screenshot) screenshot->record(commands, acquired->index);
    frames_.submit(acquired->available, swapchain_.images()[acquired->index].rendered);
    swapchain_.present(*acquired);
  }

  /// The last frame's report, once all is finished.
  bool finish() {
    frames_.finish();
    need(context_.advance(frames_.number()), "gpgpAdvance");
    GpgpResult status = GPGP_NOT_READY;
    for (auto report = canvas_.report(); report; report = canvas_.report()) status = report->base.status;
    std::printf("canvas      %s\n", gpgpResultString(status));
    return status == GPGP_SUCCESS;
  }

private:
  static constexpr uint32_t kMaxSide = 4096;
  void makeView() {
    auto info = init<GpgpCanvasViewCreateInfo>();
    info.label = "window";
    info.width = swapchain_.extent().width;
    info.height = swapchain_.extent().height;
    view_ = take(CanvasView::create(context_, info), "gpgpCreateCanvasView");
  }
  /// The drawing's page in the middle of the window.
  GpgpCanvasItem fitted() const {
    const float* page = drawingInfo_.viewport;
    const float width = static_cast<float>(swapchain_.extent().width);
    const float height = static_cast<float>(swapchain_.extent().height);
    const float scale = std::min(width / page[2], height / page[3]);
    GpgpCanvasItem item{};
    item.drawing = drawing_;
    item.opacity = 1;
    item.transform[0] = item.transform[3] = scale;
    item.transform[4] = (width - page[2] * scale) / 2 - page[0] * scale;
    item.transform[5] = (height - page[3] * scale) / 2 - page[1] * scale;
    return item;
  }

  sdl2::Swapchain& swapchain_;
  sdl2::ColorPass pass_;
  sdl2::Frames frames_; // waits for its frames before what they use goes
  Context context_;
  Drawing drawing_;
  GpgpDrawingInfo drawingInfo_ = GPGP_DRAWING_INFO_INIT;
#ifdef GPGP_SDL2_TEXT
  std::optional<Line> line_;
#endif
  Canvas canvas_;
  CanvasView view_;
  GpgpTargetInfo target_ = GPGP_TARGET_INFO_INIT;
};

int run(const Options& options) {
  sdl2::Window window({"gpgp", options.width, options.height});
  sdl2::DeviceInfo deviceInfo;
  deviceInfo.device = options.device;
  deviceInfo.validate = options.validate;
  deviceInfo.instanceExtensions = window.instanceExtensions();
  deviceInfo.deviceExtensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  sdl2::Device device(deviceInfo);
  bool well = false;
  {
    sdl2::Swapchain swapchain(device, window);
    Sample sample(device, swapchain, options);
    uint32_t done = 0;
    while (window.pollEvents() && (options.frames == 0 || done + 1 < options.frames)) {
      sample.frame(nullptr);
      ++done;
    }
    std::optional<sdl2::Screenshot> screenshot;
    if (!options.picture.empty()) screenshot.emplace(device, swapchain);
    sample.frame(screenshot ? &*screenshot : nullptr);
    well = sample.finish();
    if (screenshot) screenshot->save(options.picture);
  }
  std::printf("device      %s\n", device.properties.deviceName);
  if (options.validate) std::printf("validation  %u messages\n", device.validationMessages());
  return well && device.validationMessages() == 0 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--help") == 0 || std::strcmp(argv[i], "-h") == 0) {
      std::fputs(kHelp, stdout);
      return EXIT_SUCCESS;
    }
  Options options;
  if (!parse(argc, argv, options)) {
    std::fputs(kHelp, stderr);
    return 2;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gpgp_sdl2_sample: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
