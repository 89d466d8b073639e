// A window with a drawing and a line of text, both by gpgp.
#include "window_sample.h"

#ifdef GPGP_SAMPLE_TEXT
#include "text_line.h"
#endif

#include <algorithm>
#include <cstdio>

namespace gpgp {
namespace {

using sample::need;
using sample::Options;
using sample::take;

class Sample {
public:
  Sample(integration::Device& device, integration::Swapchain& swapchain, const Options& options)
      : swapchain_(swapchain), pass_(device, swapchain), frames_(device) {
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.label = "sample";
    info.maxFramesInFlight = frames_.inFlight();
    info.messageFn = sample::onMessage;
    context_ = take(Context::create(info), "gpgpCreateContext");
    drawing_ = sample::loadDrawing(context_, options.svg);
    drawingInfo_ = take(drawing_.info(), "gpgpGetDrawingInfo");
#ifdef GPGP_SAMPLE_TEXT
    integration::PictureDevice pictures; // for emoji that are pictures
    pictures.device = device.device;
    pictures.getDeviceProcAddr = vkGetDeviceProcAddr;
    pictures.memory = device.memory;
    line_.emplace(pictures, context_, options, 0.06f * static_cast<float>(options.height));
#endif
    auto canvasInfo = init<GpgpCanvasCreateInfo>();
    canvasInfo.base.label = "window";
    canvasInfo.base.queueFamily = device.family;
    canvasInfo.base.queueFlags = device.queueFlags;
    canvasInfo.maxWidth = swapchain.maxExtent().width;
    canvasInfo.maxHeight = swapchain.maxExtent().height;
    canvasInfo.targets = GPGP_CANVAS_TARGET_HISTORY;
    canvas_ = take(Canvas::create(context_, canvasInfo), "gpgpCreateCanvas");
    target_ = init<GpgpTargetInfo>();
    target_.renderPass = pass_.handle();
    auto prewarm = init<GpgpPrewarmInfo>();
    prewarm.targets = &target_;
    prewarm.targetCount = 1;
    need(canvas_.prewarm(prewarm), "gpgpPrewarm");
    makeView();
  }

  void frame(integration::Screenshot* screenshot) {
    VkCommandBuffer commands = frames_.begin();
    std::optional<integration::Swapchain::Acquired> acquired;
    while (!(acquired = swapchain_.acquire(frames_.slot()))) {
      swapchain_.resize();
      pass_.attach();
      makeView();
    }
    need(context_.advance(frames_.number()), "gpgpAdvance");
    std::vector<GpgpCanvasItem> items{fitted()};
#ifdef GPGP_SAMPLE_TEXT
    const VkExtent2D extent = swapchain_.extent();
    GpgpCanvasItem text{};
    text.list = line_->at((static_cast<float>(extent.width) - line_->info.width) / 2,
                          static_cast<float>(extent.height) * 0.97f - line_->info.height);
    text.transform[0] = text.transform[3] = text.opacity = 1;
    if (text.list) items.push_back(text);
#endif
    need(context_.recordUpload(commands, frames_.number()).code(), "gpgpRecordUpload"); // what the items brought
    auto info = init<GpgpCanvasInfo>();
#ifdef GPGP_SAMPLE_TEXT
    need(line_->glyphs.recordUpload(commands, frames_.number()), "the upload of pictures");
    const std::optional<GpgpCanvasImage> pictures = line_->glyphs.image();
    info.images = pictures ? &*pictures : nullptr;
    info.imageCount = pictures ? 1 : 0;
#endif
    info.width = swapchain_.extent().width;
    info.height = swapchain_.extent().height;
    info.items = items.data();
    info.itemCount = static_cast<uint32_t>(items.size());
    info.history = view_;
    info.exactArea = VK_TRUE; // small letters want it
    need(canvas_.recordPrepare(commands, frames_.number(), info), "gpgpRecordPrepareCanvas");

    pass_.begin(commands, acquired->index, {0.02f, 0.03f, 0.05f, 1});
    auto draw = init<GpgpCanvasDrawInfo>();
    draw.history = view_;
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
  void makeView() {
    auto info = init<GpgpCanvasHistoryCreateInfo>();
    info.label = "window";
    info.width = swapchain_.extent().width;
    info.height = swapchain_.extent().height;
    view_ = take(CanvasHistory::create(context_, info), "gpgpCreateCanvasHistory");
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

  integration::Swapchain& swapchain_;
  integration::ColorPass pass_;
  integration::Frames frames_; // waits for its frames before what they use goes
  Context context_;
  Drawing drawing_;
  GpgpDrawingInfo drawingInfo_ = GPGP_DRAWING_INFO_INIT;
#ifdef GPGP_SAMPLE_TEXT
  std::optional<sample::TextLine> line_;
#endif
  Canvas canvas_;
  CanvasHistory view_;
  GpgpTargetInfo target_ = GPGP_TARGET_INFO_INIT;
};

} // namespace

int sample::runInWindow(const Options& options, integration::Window& window, const std::function<bool()>& pollEvents) {
  integration::DeviceInfo deviceInfo;
  deviceInfo.device = options.device;
  deviceInfo.validate = options.validate;
  deviceInfo.instanceExtensions = window.instanceExtensions();
  deviceInfo.deviceExtensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  integration::Device device(deviceInfo);
  bool well = false;
  {
    integration::Swapchain swapchain(device, window);
    Sample sample(device, swapchain, options);
    uint32_t done = 0;
    while (pollEvents() && (options.frames == 0 || done + 1 < options.frames)) {
      sample.frame(nullptr);
      ++done;
    }
    std::optional<integration::Screenshot> screenshot;
    if (!options.picture.empty()) screenshot.emplace(device, swapchain);
    sample.frame(screenshot ? &*screenshot : nullptr);
    well = sample.finish();
    if (screenshot) screenshot->save(options.picture);
  }
  std::printf("device      %s\n", device.properties.deviceName);
  if (options.validate) std::printf("validation  %u messages\n", device.validationMessages());
  return well && device.validationMessages() == 0 ? 0 : 1;
}

int sample::windowMain(int argc, char** argv, const char* name, int (*run)(const Options&)) {
  Options options;
  options.text = "gpgp in a window";
  options.width = 960;
  options.height = 540;
  options.maxWidth = options.maxHeight = 4096;
  const std::string help = std::string(name) + R"(: a window with an SVG drawing and a line of text

  --svg FILE       the drawing (default: the HUD of the mini-engine)
  --font FILE      the text's font (default: DejaVu Sans, where it is installed); without one there is no text
  --fallback FILE  a font for what it does not have, emoji for example; may be given several times
  --text TEXT      the line
  --frames N       ends after N frames; otherwise Escape does
  --size WxH       of the window (default 960x540)
  --device NAME    GPU: part of its name, or an index (default: $GPGP_DEVICE, else the software device)
  --picture FILE   the last frame as BMP
  --validate       under the Khronos validation layer; any message of it is an error

Exit code 0: all is well; 1: an error or a validation message; 2: wrong usage.
)";
  return sampleMain(argc, argv, name, help.c_str(), options, run);
}

} // namespace gpgp
