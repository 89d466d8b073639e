// The plugin between Unity's device events: what it starts with a device, and what goes with it.
#include "plugin.h"

#include "hooks.h"

namespace gpgp::unity {
namespace {

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
  // The library may stay in memory, and another device come to lie where this one did.
  hookedDevice().device = VK_NULL_HANDLE;
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
  complained_ = true;
  if (surface.complaint == message) return; // once, not every frame
  surface.complaint = message;
  say(message);
}

// ---------------------------------------------------------------- device

void Plugin::onDeviceEvent(UnityGfxDeviceEventType type) {
  const std::scoped_lock lock(mutex_);
  if (type == kUnityGfxDeviceEventShutdown || type == kUnityGfxDeviceEventBeforeReset) stop();
  if (type != kUnityGfxDeviceEventInitialize && type != kUnityGfxDeviceEventAfterReset) return;
  if (graphics_->GetRenderer() == kUnityGfxRendererVulkan) start();
}

void Plugin::start() {
  vulkan_ = find<IUnityGraphicsVulkan>(interfaces_, kUnityGraphicsVulkanGuid);
  if (!vulkan_) return stop();
  if (state_ == GPGP_UNITY_READY && vulkan_->Instance().device == device_.device) return; // said twice: all stays
  stop();
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
  info.maxFramesInFlight = kFramesInFlight;
  info.pipelineCache = device_.pipelineCache; // which Unity keeps on disk
  info.messageFn = onMessage;
  info.messageUserData = this;
  Result<Context> context = Context::create(info);
  if (!context) return fail(context.code(), "gpgp could not start on Unity's device");
  context_ = *std::move(context);
  destroyImageView_ = load<PFN_vkDestroyImageView>("vkDestroyImageView");
  if (const GpgpResult result = makeCanvas(); result < 0) return fail(result, "gpgp could not make its canvas");
  integration::GlyphCacheInfo cacheInfo;
  cacheInfo.context = context_;
  cacheInfo.label = "unity";
  cacheInfo.maxPictures = kPictures;
  cacheInfo.pictureDevice.device = device_.device;
  cacheInfo.pictureDevice.getDeviceProcAddr = load<PFN_vkGetDeviceProcAddr>("vkGetDeviceProcAddr");
  load<PFN_vkGetPhysicalDeviceMemoryProperties>("vkGetPhysicalDeviceMemoryProperties")(device_.physicalDevice,
                                                                                       &cacheInfo.pictureDevice.memory);
  if (const GpgpResult result = glyphs_.create(cacheInfo); result < 0)
    return fail(result, "gpgp could not make its glyph set");
  Result<List> list = List::create(context_);
  if (!list) return fail(list.code(), "gpgp could not make its list");
  list_ = *std::move(list);
  if (!shaper_) {
    auto shaperInfo = init<GpgpShaperCreateInfo>();
    shaperInfo.label = "text";
    shaperInfo.messageFn = onMessage;
    shaperInfo.messageUserData = this;
    Result<Shaper> shaper = Shaper::create(shaperInfo);
    if (!shaper) return fail(shaper.code(), "gpgp could not make its shaper");
    shaper_ = *std::move(shaper);
  }
  state_ = GPGP_UNITY_READY;
}

void Plugin::stop() {
  if (context_) {
    const auto waitIdle = load<PFN_vkDeviceWaitIdle>("vkDeviceWaitIdle");
    waitIdle(device_.device); // also where the device is lost: then nothing runs on it any more
    freeViews(UINT64_MAX);
  }
  texts_.clear();
  drawings_.clear();
  surfaces_.clear();
  glyphs_ = {};
  fonts_.clear();
  list_.reset();
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
  info.maxPaths = budgets_.maxPaths;
  info.maxGlyphs = budgets_.maxGlyphs;
  info.maxDrawings = budgets_.maxItems;
  info.maxShapes = budgets_.maxShapes;
  Result<Canvas> made = Canvas::create(context_, info);
  if (!made) return made.code();
  const GpgpResult result = made->prewarm();
  if (result < 0) return result;
  canvas_ = *std::move(made);
  reportedBudget_ = false;
  return GPGP_SUCCESS;
}

} // namespace gpgp::unity
