#include "plugin.h"

#include "hooks.h"

#include <algorithm>
#include <cstring>

namespace gpgp::unity {
namespace {

constexpr uint64_t kFramesInFlight = 4;
constexpr size_t kMaxMessages = 64;

template <class Interface> Interface* find(IUnityInterfaces& interfaces, const unsigned long long (&guid)[2]) {
  return static_cast<Interface*>(interfaces.GetInterfaceSplit(guid[0], guid[1]));
}

PFN_vkGetInstanceProcAddr UNITY_INTERFACE_API intercept(PFN_vkGetInstanceProcAddr loader, void*) {
  hookedDevice() = {};
  hookedDevice().loader = loader;
  return hookedGetInstanceProcAddr;
}

} // namespace

Plugin::Plugin(IUnityInterfaces& interfaces, IUnityGraphicsDeviceEventCallback deviceEvent)
    : interfaces_(interfaces), deviceEvent_(deviceEvent) {
  graphics_ = find<IUnityGraphics>(interfaces, kUnityGraphicsGuid);
  if (!graphics_) return;
  eventId_ = graphics_->ReserveEventIDRange(1);
  graphics_->RegisterDeviceEventCallback(deviceEvent);
  // No renderer yet: the plugin is loaded on startup, and the device is still to be made.
  if (graphics_->GetRenderer() != kUnityGfxRendererNull) {
    onDeviceEvent(kUnityGfxDeviceEventInitialize);
    return;
  }
  vulkan2_ = find<IUnityGraphicsVulkanV2>(interfaces, kUnityGraphicsVulkanV2Guid);
  if (vulkan2_)
    vulkan2_->AddInterceptInitialization(intercept, nullptr, 0);
  else if (auto* vulkan = find<IUnityGraphicsVulkan>(interfaces, kUnityGraphicsVulkanGuid))
    vulkan->InterceptInitialization(intercept, nullptr);
}

Plugin::~Plugin() {
  if (graphics_) graphics_->UnregisterDeviceEventCallback(deviceEvent_);
  if (vulkan2_) vulkan2_->RemoveInterceptInitialization(intercept);
  const std::scoped_lock lock(mutex_);
  stop();
}

void Plugin::onMessage(void* user, const GpgpMessage* message) {
  static_cast<Plugin*>(user)->say(std::string(message->function ? message->function : "") + ": " +
                                  (message->label && message->label[0] ? std::string(message->label) + ": " : "") +
                                  message->text);
}

void Plugin::say(const std::string& message) {
  const std::scoped_lock lock(messageMutex_);
  if (messages_.size() < kMaxMessages) messages_.push_back(message);
}

void Plugin::complain(Surface& surface, const std::string& message) {
  if (surface.complaint == message) return; // once, not every frame
  surface.complaint = message;
  say(message);
}

// ---------------------------------------------------------------- device

void Plugin::onDeviceEvent(UnityGfxDeviceEventType type) {
  const std::scoped_lock lock(mutex_);
  if (type == kUnityGfxDeviceEventInitialize && graphics_->GetRenderer() == kUnityGfxRendererVulkan) start();
  if (type == kUnityGfxDeviceEventShutdown) stop();
}

void Plugin::start() {
  stop();
  vulkan_ = find<IUnityGraphicsVulkan>(interfaces_, kUnityGraphicsVulkanGuid);
  if (!vulkan_) return;
  const auto fail = [this](GpgpResult result, const std::string& message) {
    say(message);
    stop();
    state_ = result;
  };
  UnityVulkanPluginEventConfig config{};
  config.renderPassPrecondition = kUnityVulkanRenderPass_EnsureOutside;
  config.graphicsQueueAccess = kUnityVulkanGraphicsQueueAccess_DontCare;
  config.flags = kUnityVulkanEventConfigFlag_EnsurePreviousFrameSubmission |
                 kUnityVulkanEventConfigFlag_ModifiesCommandBuffersState;
  vulkan_->ConfigureEvent(eventId_, &config);
  device_ = vulkan_->Instance();
  const HookedDevice& hooked = hookedDevice();
  if (hooked.device != device_.device)
    return fail(GPGP_ERROR_MISSING_FEATURE,
                "gpgp must be loaded on startup (in the plugin's import settings): Unity's device was made without it");
  if (hooked.apiVersion < VK_API_VERSION_1_2)
    return fail(GPGP_ERROR_MISSING_FEATURE, "gpgp needs Vulkan 1.2; this machine's loader offers less");
  auto info = init<GpgpContextCreateInfo>();
  info.label = "unity";
  info.instance = device_.instance;
  info.physicalDevice = device_.physicalDevice;
  info.device = device_.device;
  info.getInstanceProcAddr = device_.getInstanceProcAddr;
  info.apiVersion = VK_API_VERSION_1_2;
  info.features = hooked.features;
  info.maxFramesInFlight = kFramesInFlight;
  info.pipelineCache = device_.pipelineCache; // which Unity keeps on disk
  info.messageFn = onMessage;
  info.messageUserData = this;
  Result<Context> context = Context::create(info);
  if (!context) return fail(context.code(), "gpgp could not start on Unity's device");
  context_ = *std::move(context);
  destroyImageView_ = load<PFN_vkDestroyImageView>("vkDestroyImageView");
  if (const GpgpResult result = makeCanvas(); result < 0) return fail(result, "gpgp could not make its canvas");
  if (const GpgpResult result = glyphs_.create(context_, "unity"); result < 0)
    return fail(result, "gpgp could not make its glyph set");
  if (!shaper_) {
    Result<Shaper> shaper = Shaper::create();
    if (!shaper) return fail(shaper.code(), "gpgp could not make its shaper");
    shaper_ = *std::move(shaper);
  }
  state_ = GPGP_UNITY_READY;
}

void Plugin::stop() {
  if (context_) {
    const auto waitIdle = load<PFN_vkDeviceWaitIdle>("vkDeviceWaitIdle");
    waitIdle(device_.device);
    freeViews(UINT64_MAX);
  }
  texts_.clear();
  drawings_.clear();
  surfaces_.clear();
  glyphs_ = {};
  fonts_.clear();
  canvas_.reset();
  context_.reset();
  frame_ = 0;
  state_ = GPGP_UNITY_OFF;
}

GpgpResult Plugin::makeCanvas() {
  auto info = init<GpgpCanvasCreateInfo>();
  info.base.label = "unity";
  info.base.queueFamily = device_.queueFamilyIndex;
  info.maxWidth = budgets_.maxWidth;
  info.maxHeight = budgets_.maxHeight;
  info.maxTileEntries = budgets_.maxTileEntries;
  info.maxPatches = budgets_.maxPatches;
  info.maxGlyphs = budgets_.maxGlyphs;
  Result<Canvas> made = Canvas::create(context_, info);
  if (!made) return made.code();
  const GpgpResult result = made->prewarm();
  if (result < 0) return result;
  canvas_ = *std::move(made);
  reportedBudget_ = false;
  return GPGP_SUCCESS;
}

// ---------------------------------------------------------------- recording

void Plugin::onRenderEvent(int eventId, int32_t number) {
  const std::scoped_lock lock(mutex_);
  if (state_ != GPGP_UNITY_READY || eventId != eventId_) return;
  const auto found = surfaces_.find(number);
  if (found == surfaces_.end() || !found->second.texture) return;
  Surface& surface = found->second;
  UnityVulkanImage image{};
  if (!vulkan_->AccessTexture(surface.texture, UnityVulkanWholeImage, VK_IMAGE_LAYOUT_UNDEFINED, 0, 0,
                              kUnityVulkanResourceAccess_ObserveOnly, &image))
    return complain(surface, "the canvas's texture is none of Unity's");
  if (image.format != VK_FORMAT_R8G8B8A8_UNORM && image.format != VK_FORMAT_R16G16B16A16_SFLOAT)
    return complain(surface, "a canvas's texture has the format R8G8B8A8_UNorm or R16G16B16A16_SFloat");
  if (!(image.usage & VK_IMAGE_USAGE_STORAGE_BIT))
    return complain(surface, "a canvas's texture needs enableRandomWrite, before it is created");
  if (image.samples != VK_SAMPLE_COUNT_1_BIT) return complain(surface, "a canvas's texture has one sample a pixel");
  // Unity knows from here on what state the texture is in, and brings it into the next one by itself.
  if (!vulkan_->AccessTexture(
          surface.texture, UnityVulkanWholeImage, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
          VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT, kUnityVulkanResourceAccess_PipelineBarrier, &image))
    return complain(surface, "the canvas's texture cannot be written");
  UnityVulkanRecordingState state{}; // asked for last: accesses may go on in another command buffer
  if (!vulkan_->CommandRecordingState(&state, kUnityVulkanGraphicsQueueAccess_DontCare)) return;
  if (state.subPassIndex >= 0)
    return complain(surface, "the event was issued where Unity cannot leave its render pass");
  if (advance(surface, state)) record(surface, state, image);
}

/// Tells gpgp of Unity's frame, once.
bool Plugin::advance(Surface& surface, const UnityVulkanRecordingState& state) {
  if (state.currentFrameNumber <= frame_) return true;
  const GpgpFrame frame{state.currentFrameNumber, std::min(state.safeFrameNumber, state.currentFrameNumber - 1)};
  if (frame.current - frame.safe > kFramesInFlight) {
    complain(surface, "the GPU is more than " + std::to_string(kFramesInFlight) +
                          " frames behind Unity; canvases keep what they show until it has caught up");
    return false;
  }
  if (context_.advance(frame) < 0) return false;
  frame_ = frame.current;
  freeViews(frame.safe);
  for (auto report = canvas_.report(); report; report = canvas_.report())
    if (report->base.status == GPGP_BUDGET_EXCEEDED && !reportedBudget_) {
      reportedBudget_ = true;
      say("a canvas needs maxTileEntries " + std::to_string(report->tileEntries) + " and maxGlyphs " +
          std::to_string(report->glyphs) + "; it has " + std::to_string(report->tileEntriesGiven) + " and " +
          std::to_string(report->glyphsGiven) + " (gpgpUnitySetBudgets)");
    }
  return true;
}

void Plugin::freeViews(uint64_t safe) {
  std::erase_if(views_, [&](const View& view) {
    if (view.frame > safe) return false;
    destroyImageView_(device_.device, view.view, nullptr);
    return true;
  });
}

void Plugin::record(Surface& surface, const UnityVulkanRecordingState& state, const UnityVulkanImage& image) {
  const GpgpFrame frame{state.currentFrameNumber, std::min(state.safeFrameNumber, state.currentFrameNumber - 1)};
  const float height = static_cast<float>(image.extent.height);
  const bool flip = (surface.flags & GPGP_UNITY_FLIP) != 0;
  std::vector<GpgpCanvasItem> items;
  std::deque<std::vector<GpgpGlyphInstance>> instances;
  for (const GpgpUnityItem& from : surface.items) {
    GpgpCanvasItem item{};
    if (const auto drawing = drawings_.find(from.object); drawing != drawings_.end()) {
      item.drawing = drawing->second;
    } else if (const auto text = texts_.find(from.object); text != texts_.end()) {
      const Result<GpgpLayoutInfo> layout = text->second.layout.info();
      if (!layout || !fonts_.count(text->second.font)) continue;
      std::vector<GpgpGlyphInstance>& placed = instances.emplace_back();
      if (glyphs_.place(*layout, 0, 0, 1, placed) == GPGP_BUDGET_EXCEEDED)
        complain(surface, "the glyph set is full: some glyphs are not drawn");
      item = glyphs_.item(placed);
    } else {
      continue;
    }
    std::copy_n(from.transform, 6, item.transform);
    item.opacity = from.opacity;
    if (flip) {
      item.transform[1] = -item.transform[1];
      item.transform[3] = -item.transform[3];
      item.transform[5] = height - item.transform[5];
    }
    items.push_back(item);
  }
  VkImageViewCreateInfo viewInfo{};
  viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  viewInfo.image = image.image;
  viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
  viewInfo.format = image.format;
  viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  View& view = views_.emplace_back();
  view.frame = frame.current;
  // Made anew for each event: Unity may give another image the handle of one that it has destroyed.
  if (load<PFN_vkCreateImageView>("vkCreateImageView")(device_.device, &viewInfo, nullptr, &view.view) != VK_SUCCESS) {
    views_.pop_back();
    return complain(surface, "no view of the canvas's texture could be made");
  }
  if (!context_.recordUpload(state.commandBuffer, frame)) return;
  auto info = init<GpgpCanvasInfo>();
  info.base.accessMode = GPGP_ACCESS_SYNCHRONISED; // Unity's barriers
  info.width = image.extent.width;
  info.height = image.extent.height;
  info.items = items.data();
  info.itemCount = static_cast<uint32_t>(items.size());
  std::copy_n(surface.background, 4, info.background);
  info.exactArea = VK_TRUE; // small letters want it
  info.encodeSrgb = info.blendSrgb = (surface.flags & GPGP_UNITY_ENCODE_SRGB) ? VK_TRUE : VK_FALSE;
  info.target.image = image.image;
  info.target.view = view.view;
  info.target.format = image.format;
  info.target.width = image.extent.width;
  info.target.height = image.extent.height;
  const GpgpResult result = canvas_.recordPrepare(state.commandBuffer, frame, info); // errors are messages already
  if (result == GPGP_SUCCESS) surface.complaint.clear();
}

// ---------------------------------------------------------------- objects

int32_t Plugin::state() {
  const std::scoped_lock lock(mutex_);
  return state_;
}

int32_t Plugin::takeMessage(char* text, int32_t capacity) {
  const std::scoped_lock lock(messageMutex_);
  if (messages_.empty() || !text || capacity < 1) return 0;
  const std::string message = std::move(messages_.front());
  messages_.pop_front();
  const size_t fits = std::min(message.size(), static_cast<size_t>(capacity) - 1);
  std::memcpy(text, message.data(), fits);
  text[fits] = 0;
  return static_cast<int32_t>(message.size());
}

int32_t Plugin::setBudgets(const GpgpUnityBudgets& budgets) {
  const std::scoped_lock lock(mutex_);
  const GpgpUnityBudgets before = budgets_;
  budgets_ = budgets;
  if (state_ != GPGP_UNITY_READY) return GPGP_SUCCESS; // those that the device begins with
  const GpgpResult result = makeCanvas();
  if (result < 0) budgets_ = before;
  return result;
}

int32_t Plugin::createDrawing(const void* data, size_t size, bool baked) {
  Blob blob;
  if (!baked) { // without the lock: it may take a while
    auto source = init<GpgpSvgSource>();
    source.name = "SVG";
    source.data = data;
    source.size = size;
    source.messageFn = onMessage;
    source.messageUserData = this;
    Result<Blob> compiled = compileSvg(source);
    if (!compiled) return compiled.code();
    blob = *std::move(compiled);
  }
  const std::scoped_lock lock(mutex_);
  if (state_ != GPGP_UNITY_READY) return GPGP_ERROR_INVALID_HANDLE;
  auto info = init<GpgpDrawingCreateInfo>();
  info.label = "drawing";
  info.data = baked ? data : blob.data();
  info.size = baked ? size : blob.size();
  Result<Drawing> made = Drawing::create(context_, info);
  if (!made) return made.code();
  drawings_.emplace(nextObject_, *std::move(made));
  return nextObject_++;
}

int32_t Plugin::createFont(const void* data, size_t size) {
  auto info = init<GpgpFontCreateInfo>();
  info.label = "font";
  info.data = data;
  info.size = size;
  info.messageFn = onMessage;
  info.messageUserData = this;
  Result<Font> made = Font::create(info);
  if (!made) return made.code();
  const std::scoped_lock lock(mutex_);
  fonts_.emplace(nextObject_, *std::move(made));
  return nextObject_++;
}

GpgpResult Plugin::layOut(Text& to, const GpgpUnityText& text) {
  const auto font = fonts_.find(text.font);
  if (font == fonts_.end()) {
    say("a text's font is none, or has been destroyed");
    return GPGP_ERROR_INVALID_HANDLE;
  }
  if ((!text.text && text.size > 0) || text.size < 0) return GPGP_ERROR_INVALID_ARGUMENT;
  const GpgpFont fonts[] = {font->second};
  auto info = init<GpgpTextInfo>();
  info.text = text.text ? text.text : "";
  info.size = static_cast<size_t>(text.size);
  info.style.fonts = fonts;
  info.style.fontCount = 1;
  info.style.size = text.pixels;
  std::copy_n(text.color, 4, info.style.color);
  info.width = text.width;
  info.align = text.align;
  const GpgpResult result = to.layout.set(info);
  if (result < 0) say(std::string("a text could not be laid out: ") + gpgpResultString(result));
  if (result >= 0) to.font = text.font;
  return result;
}

int32_t Plugin::createText(const GpgpUnityText& text) {
  const std::scoped_lock lock(mutex_);
  if (!shaper_) return GPGP_ERROR_INVALID_HANDLE;
  Result<Layout> layout = shaper_.layout();
  if (!layout) return layout.code();
  Text made;
  made.layout = *std::move(layout);
  if (const GpgpResult result = layOut(made, text); result < 0) return result;
  texts_.emplace(nextObject_, std::move(made));
  return nextObject_++;
}

int32_t Plugin::setText(int32_t object, const GpgpUnityText& text) {
  const std::scoped_lock lock(mutex_);
  const auto found = texts_.find(object);
  return found == texts_.end() ? GPGP_ERROR_INVALID_HANDLE : layOut(found->second, text);
}

int32_t Plugin::getBox(int32_t object, float* box) {
  const std::scoped_lock lock(mutex_);
  if (!box) return GPGP_ERROR_INVALID_ARGUMENT;
  if (const auto drawing = drawings_.find(object); drawing != drawings_.end()) {
    const Result<GpgpDrawingInfo> info = drawing->second.info();
    if (info) std::copy_n(info->viewport, 4, box);
    return info.code();
  }
  if (const auto text = texts_.find(object); text != texts_.end()) {
    const Result<GpgpLayoutInfo> info = text->second.layout.info();
    const float size[4] = {0, 0, info->width, info->height};
    if (info) std::copy_n(size, 4, box);
    return info.code();
  }
  return GPGP_ERROR_INVALID_HANDLE;
}

int32_t Plugin::createCanvas() {
  const std::scoped_lock lock(mutex_);
  surfaces_.try_emplace(nextObject_);
  return nextObject_++;
}

int32_t Plugin::setCanvas(int32_t object, const GpgpUnityCanvas& info) {
  const std::scoped_lock lock(mutex_);
  const auto found = surfaces_.find(object);
  if (found == surfaces_.end()) return GPGP_ERROR_INVALID_HANDLE;
  if (info.itemCount < 0 || (info.itemCount > 0 && !info.items)) return GPGP_ERROR_INVALID_ARGUMENT;
  Surface& surface = found->second;
  surface.texture = info.texture;
  surface.flags = info.flags;
  std::copy_n(info.background, 4, surface.background);
  surface.items.assign(info.items, info.items + info.itemCount);
  return GPGP_SUCCESS;
}

void Plugin::destroy(int32_t object) {
  const std::scoped_lock lock(mutex_);
  if (const auto font = fonts_.find(object); font != fonts_.end()) {
    glyphs_.forget(font->second);
    fonts_.erase(font);
  }
  drawings_.erase(object);
  texts_.erase(object);
  surfaces_.erase(object);
}

} // namespace gpgp::unity
