#include "fake_unity.h"

#include <algorithm>
#include <cstring>
#include <dlfcn.h>
#include <stdexcept>

namespace gpgp::test {
namespace {

FakeUnity* host = nullptr;

void check(VkResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": VkResult " + std::to_string(result));
}

VKAPI_ATTR VkBool32 VKAPI_CALL onValidation(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                            VkDebugUtilsMessageTypeFlagsEXT types,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
  if (types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT) FakeUnity::validation().push_back(data->pMessage);
  return VK_FALSE;
}

VKAPI_ATTR VkResult VKAPI_CALL waitIdleOfLost(VkDevice) { return VK_ERROR_DEVICE_LOST; }

VkDebugUtilsMessengerCreateInfoEXT messengerInfo() {
  VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = onValidation;
  return info;
}

} // namespace

std::vector<std::string>& FakeUnity::validation() {
  static std::vector<std::string> messages;
  return messages;
}

// ---------------------------------------------------------------- interfaces

struct FakeUnity::Interfaces {
  IUnityInterfaces registry{};
  IUnityGraphics graphics{};
  IUnityGraphicsVulkanV2 vulkan{};

  Interfaces() {
    registry.GetInterface = [](UnityInterfaceGUID guid) { return find(guid.m_GUIDHigh, guid.m_GUIDLow); };
    registry.GetInterfaceSplit = find;
    registry.RegisterInterface = [](UnityInterfaceGUID, IUnityInterface*) {};
    registry.RegisterInterfaceSplit = [](unsigned long long, unsigned long long, IUnityInterface*) {};
    graphics.GetRenderer = [] { return host->deviceMade_ ? host->options_.renderer : kUnityGfxRendererNull; };
    graphics.RegisterDeviceEventCallback = [](IUnityGraphicsDeviceEventCallback callback) {
      host->deviceEvents_.push_back(callback);
    };
    graphics.UnregisterDeviceEventCallback = [](IUnityGraphicsDeviceEventCallback callback) {
      if (std::erase(host->deviceEvents_, callback) != 1) host->violate("unregisters what was not registered");
    };
    graphics.ReserveEventIDRange = [](int count) { return count == 1 ? 7001 : -1; };
    vulkan.InterceptInitialization = [](UnityVulkanInitCallback callback, void* data) {
      return host->hook(callback, data, !host->options_.v2);
    };
    vulkan.AddInterceptInitialization = [](UnityVulkanInitCallback callback, void* data, int32_t) {
      return host->hook(callback, data, true);
    };
    vulkan.RemoveInterceptInitialization = [](UnityVulkanInitCallback callback) {
      if (callback != host->hook_) host->violate("removes a hook that is not there");
      host->hook_ = nullptr;
      return true;
    };
    vulkan.ConfigureEvent = [](int id, const UnityVulkanPluginEventConfig* config) { host->configs_[id] = *config; };
    vulkan.Instance = [] { return host->unityInstance(); };
    vulkan.CommandRecordingState = recordingState;
    vulkan.AccessTexture = accessTexture;
    vulkan.EnsureOutsideRenderPass = [] {};
    vulkan.EnsureInsideRenderPass = [] { host->violate("asks for a render pass"); };
  }

  static IUnityInterface* find(unsigned long long high, unsigned long long low) {
    const auto is = [&](const unsigned long long(&guid)[2]) { return guid[0] == high && guid[1] == low; };
    if (is(kUnityGraphicsGuid)) return &table().graphics;
    if (is(kUnityGraphicsVulkanGuid) || (is(kUnityGraphicsVulkanV2Guid) && host->options_.v2)) return &table().vulkan;
    return nullptr;
  }
  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
    if (host->lost_ && std::strcmp(name, "vkDeviceWaitIdle") == 0)
      return reinterpret_cast<PFN_vkVoidFunction>(waitIdleOfLost);
    return vkGetInstanceProcAddr(instance, name);
  }
  static Interfaces& table() {
    static Interfaces interfaces;
    return interfaces;
  }

  static bool recordingState(UnityVulkanRecordingState* state, UnityVulkanGraphicsQueueAccess access) {
    if (!host->insideEvent_) {
      host->violate("asks for the recording state outside of an event");
      return false;
    }
    if (access != kUnityVulkanGraphicsQueueAccess_DontCare)
      host->violate("asks for queue access that it did not configure");
    *state = {};
    state->commandBuffer = host->commands_;
    state->commandBufferLevel = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    state->renderPass = host->insidePass_ ? host->pass_ : VK_NULL_HANDLE;
    state->framebuffer = host->insidePass_ ? host->framebuffer_ : VK_NULL_HANDLE;
    state->subPassIndex = host->insidePass_ ? 0 : -1;
    state->currentFrameNumber = host->current_;
    state->safeFrameNumber = host->safe_;
    return true;
  }

  /// Records the barrier, and goes on in another command buffer: who still holds the one before has not asked again.
  static bool accessTexture(void* native, const VkImageSubresource*, VkImageLayout layout, VkPipelineStageFlags stages,
                            VkAccessFlags access, UnityVulkanResourceAccessMode mode, UnityVulkanImage* image) {
    const auto found = host->textures_.find(static_cast<FakeTexture*>(native));
    if (!host->insideEvent_) host->violate("accesses a texture outside of an event");
    if (found == host->textures_.end()) return false;
    FakeTexture& texture = *found->second;
    if (mode == kUnityVulkanResourceAccess_PipelineBarrier) {
      if (host->insidePass_) host->violate("asks for a barrier inside a render pass");
      host->transition(texture, layout, stages, access);
      check(vkEndCommandBuffer(host->commands_), "vkEndCommandBuffer");
      host->commands_ = host->nextCommands();
    }
    *image = {};
    image->image = texture.image;
    image->memory.memory = texture.memory;
    image->layout = texture.layout;
    image->aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    image->usage = texture.usage;
    image->format = texture.format;
    image->extent = {texture.extent.width, texture.extent.height, 1};
    image->type = VK_IMAGE_TYPE_2D;
    image->samples = VK_SAMPLE_COUNT_1_BIT;
    image->layers = image->mipCount = 1;
    return true;
  }
};

bool FakeUnity::hook(UnityVulkanInitCallback callback, void* data, bool right) {
  if (deviceMade_ || !right) violate("hooks too late, or through the older interface");
  hook_ = callback;
  hookData_ = data;
  ++hooksTaken_;
  return !deviceMade_;
}

UnityVulkanInstance FakeUnity::unityInstance() const {
  UnityVulkanInstance out{};
  out.instance = instance_;
  out.physicalDevice = physical_;
  out.device = device_;
  out.graphicsQueue = queue_;
  out.getInstanceProcAddr = Interfaces::getInstanceProcAddr;
  out.queueFamilyIndex = family_;
  return out;
}

const UnityVulkanPluginEventConfig* FakeUnity::config(int eventId) const {
  const auto found = configs_.find(eventId);
  return found == configs_.end() ? nullptr : &found->second;
}

// ---------------------------------------------------------------- life

FakeUnity::FakeUnity(const std::string& library, const FakeUnityOptions& options) : options_(options) {
  host = this;
  library_ = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library_) throw std::runtime_error(dlerror());
  const auto load = symbol<void (*)(IUnityInterfaces*)>("UnityPluginLoad");
  if (options.preload) load(&Interfaces::table().registry);
  makeDevice();
  deviceMade_ = true;
  if (!options.preload) load(&Interfaces::table().registry); // finds the device there, and no event comes
  if (options.preload && options.begin) initialize();
}

FakeUnity::~FakeUnity() {
  shutdown();
  destroyDevice();
  unload();
  dlclose(library_);
  host = nullptr;
}

void FakeUnity::destroyDevice() {
  vkDeviceWaitIdle(device_);
  vkDestroyFramebuffer(device_, framebuffer_, nullptr);
  vkDestroyRenderPass(device_, pass_, nullptr);
  vkDestroyImageView(device_, cameraHistory_, nullptr);
  while (!textures_.empty()) destroyTexture(textures_.begin()->first);
  for (const Slot& slot : slots_) {
    vkDestroyFence(device_, slot.fence, nullptr);
    vkDestroyCommandPool(device_, slot.pool, nullptr);
  }
  vkDestroyDevice(device_, nullptr); // what the plugin has left is a message
  const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
  destroy(instance_, messenger_, nullptr);
  vkDestroyInstance(instance_, nullptr);
  recorded_.clear();
  lost_ = false;
}

void* FakeUnity::symbolOf(const char* name) const {
  void* found = dlsym(library_, name);
  if (!found) throw std::runtime_error(std::string("the plugin has no ") + name);
  return found;
}

void FakeUnity::initialize() {
  if (initialized_) return;
  initialized_ = true;
  send(kUnityGfxDeviceEventInitialize);
}

void FakeUnity::send(UnityGfxDeviceEventType type) {
  for (const auto& event : std::vector(deviceEvents_)) event(type);
}

void FakeUnity::loseDevice() {
  vkDeviceWaitIdle(device_); // it has stopped
  lost_ = true;
}

void FakeUnity::replaceDevice() {
  shutdown();
  deviceMade_ = false;
  destroyDevice();
  family_ = 0;
  makeDevice();
  deviceMade_ = true;
  initialize();
}

void FakeUnity::loadAgain() { symbol<void (*)(IUnityInterfaces*)>("UnityPluginLoad")(&Interfaces::table().registry); }

void FakeUnity::unload() { symbol<void (*)()>("UnityPluginUnload")(); }

void FakeUnity::shutdown() {
  if (!initialized_ && options_.preload) return;
  initialized_ = false;
  send(kUnityGfxDeviceEventShutdown);
}

/// As Unity: functions come from the hook, if there is one; the instance is an old one, features are the core's.
void FakeUnity::makeDevice() {
  const PFN_vkGetInstanceProcAddr get = hook_ ? hook_(vkGetInstanceProcAddr, hookData_) : vkGetInstanceProcAddr;
  const auto createInstance = reinterpret_cast<PFN_vkCreateInstance>(get(nullptr, "vkCreateInstance"));
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_1;
  const char* layers[] = {"VK_LAYER_KHRONOS_validation"};
  const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
  const VkValidationFeatureEnableEXT enable = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  VkValidationFeaturesEXT validationFeatures{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  validationFeatures.enabledValidationFeatureCount = 1;
  validationFeatures.pEnabledValidationFeatures = &enable;
  VkInstanceCreateInfo instanceInfo{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  instanceInfo.pNext = &validationFeatures;
  instanceInfo.pApplicationInfo = &application;
  instanceInfo.enabledLayerCount = 1;
  instanceInfo.ppEnabledLayerNames = layers;
  instanceInfo.enabledExtensionCount = 2;
  instanceInfo.ppEnabledExtensionNames = extensions;
  check(createInstance(&instanceInfo, nullptr, &instance_), "vkCreateInstance");
  const VkDebugUtilsMessengerCreateInfoEXT info = messengerInfo();
  const auto createMessenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
  check(createMessenger(instance_, &info, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");

  uint32_t count = 16;
  VkPhysicalDevice all[16];
  vkEnumeratePhysicalDevices(instance_, &count, all);
  for (uint32_t i = 0; i < count; ++i) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(all[i], &properties);
    if (i == 0 || properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) physical_ = all[i];
  }
  uint32_t families = 16;
  VkQueueFamilyProperties queues[16];
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &families, queues);
  while (!(queues[family_].queueFlags & VK_QUEUE_GRAPHICS_BIT)) ++family_;
  const float priority = 1;
  VkDeviceQueueCreateInfo queueInfo{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queueInfo.queueFamilyIndex = family_;
  queueInfo.queueCount = 1;
  queueInfo.pQueuePriorities = &priority;
  VkPhysicalDeviceFeatures features{};
  VkPhysicalDeviceMultiviewFeatures multiview{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES};
  VkDeviceCreateInfo deviceInfo{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  deviceInfo.pNext = &multiview; // a chain of Unity's own
  deviceInfo.queueCreateInfoCount = 1;
  deviceInfo.pQueueCreateInfos = &queueInfo;
  deviceInfo.pEnabledFeatures = &features;
  const auto createDevice = reinterpret_cast<PFN_vkCreateDevice>(get(instance_, "vkCreateDevice"));
  check(createDevice(physical_, &deviceInfo, nullptr, &device_), "vkCreateDevice");
  vkGetDeviceQueue(device_, family_, 0, &queue_);
  for (Slot& slot : slots_) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = family_;
    check(vkCreateCommandPool(device_, &pool, nullptr, &slot.pool), "vkCreateCommandPool");
    VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
    check(vkCreateFence(device_, &fence, nullptr, &slot.fence), "vkCreateFence");
  }
  makeCamera();
}

void FakeUnity::makeCamera() {
  camera_ = makeTexture(64, 64, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  viewInfo.image = camera_->image;
  viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
  viewInfo.format = camera_->format;
  viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  check(vkCreateImageView(device_, &viewInfo, nullptr, &cameraHistory_), "vkCreateImageView");
  VkAttachmentDescription attachment{};
  attachment.format = camera_->format;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD; // also when it is resumed after an event
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.initialLayout = attachment.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  VkRenderPassCreateInfo passInfo{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  passInfo.attachmentCount = passInfo.subpassCount = 1;
  passInfo.pAttachments = &attachment;
  passInfo.pSubpasses = &subpass;
  check(vkCreateRenderPass(device_, &passInfo, nullptr, &pass_), "vkCreateRenderPass");
  VkFramebufferCreateInfo framebufferInfo{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  framebufferInfo.renderPass = pass_;
  framebufferInfo.attachmentCount = 1;
  framebufferInfo.pAttachments = &cameraHistory_;
  framebufferInfo.width = framebufferInfo.height = 64;
  framebufferInfo.layers = 1;
  check(vkCreateFramebuffer(device_, &framebufferInfo, nullptr, &framebuffer_), "vkCreateFramebuffer");
}

// ---------------------------------------------------------------- textures

FakeTexture* FakeUnity::makeTexture(uint32_t width, uint32_t height, VkFormat format, VkImageUsageFlags usage) {
  auto texture = std::make_unique<FakeTexture>();
  texture->format = format;
  texture->extent = {width, height};
  texture->usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {width, height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = texture->usage;
  check(vkCreateImage(device_, &info, nullptr, &texture->image), "vkCreateImage");
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device_, texture->image, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  while (!(needs.memoryTypeBits >> allocate.memoryTypeIndex & 1u)) ++allocate.memoryTypeIndex;
  check(vkAllocateMemory(device_, &allocate, nullptr, &texture->memory), "vkAllocateMemory");
  check(vkBindImageMemory(device_, texture->image, texture->memory, 0), "vkBindImageMemory");
  FakeTexture* address = texture.get();
  textures_.emplace(address, std::move(texture));
  return address;
}

void FakeUnity::destroyTexture(FakeTexture* texture) {
  vkDeviceWaitIdle(device_);
  vkDestroyImage(device_, texture->image, nullptr);
  vkFreeMemory(device_, texture->memory, nullptr);
  textures_.erase(texture);
}

void FakeUnity::transition(FakeTexture& texture, VkImageLayout layout, VkPipelineStageFlags stages,
                           VkAccessFlags access) {
  VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.srcAccessMask = texture.access;
  barrier.dstAccessMask = access;
  barrier.oldLayout = texture.layout;
  barrier.newLayout = layout;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = texture.image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  vkCmdPipelineBarrier(commands_, texture.stages, stages, 0, 0, nullptr, 0, nullptr, 1, &barrier);
  texture.layout = layout;
  texture.stages = stages;
  texture.access = access;
}

std::vector<uint8_t> FakeUnity::read(FakeTexture& texture) {
  std::vector<uint8_t> pixels(size_t{texture.extent.width} * texture.extent.height *
                              (texture.format == VK_FORMAT_R16G16B16A16_SFLOAT ? 8 : 4));
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = pixels.size();
  info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VkBuffer buffer = VK_NULL_HANDLE;
  check(vkCreateBuffer(device_, &info, nullptr, &buffer), "vkCreateBuffer");
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device_, buffer, &needs);
  VkPhysicalDeviceMemoryProperties types{};
  vkGetPhysicalDeviceMemoryProperties(physical_, &types);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  const VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  while (!(needs.memoryTypeBits >> allocate.memoryTypeIndex & 1u) ||
         (types.memoryTypes[allocate.memoryTypeIndex].propertyFlags & wanted) != wanted)
    ++allocate.memoryTypeIndex;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  check(vkAllocateMemory(device_, &allocate, nullptr, &memory), "vkAllocateMemory");
  check(vkBindBufferMemory(device_, buffer, memory, 0), "vkBindBufferMemory");
  submit([&](VkCommandBuffer commands) {
    commands_ = commands;
    transition(texture, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
               VK_ACCESS_TRANSFER_READ_BIT);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {texture.extent.width, texture.extent.height, 1};
    vkCmdCopyImageToBuffer(commands, texture.image, texture.layout, buffer, 1, &copy);
  });
  void* mapped = nullptr;
  check(vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  std::memcpy(pixels.data(), mapped, pixels.size());
  vkDestroyBuffer(device_, buffer, nullptr);
  vkFreeMemory(device_, memory, nullptr);
  return pixels;
}

void FakeUnity::submit(const std::function<void(VkCommandBuffer)>& record) {
  vkDeviceWaitIdle(device_);
  VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  poolInfo.queueFamilyIndex = family_;
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device_, &poolInfo, nullptr, &pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = pool;
  allocate.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device_, &allocate, &commands), "vkAllocateCommandBuffers");
  const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  record(commands);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  check(vkQueueSubmit(queue_, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
  vkDeviceWaitIdle(device_);
  vkDestroyCommandPool(device_, pool, nullptr);
}

// ---------------------------------------------------------------- frames

VkCommandBuffer FakeUnity::nextCommands() {
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = slots_[current_ % kLag].pool;
  allocate.commandBufferCount = 1;
  check(vkAllocateCommandBuffers(device_, &allocate, &recorded_.emplace_back()), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(recorded_.back(), &begin), "vkBeginCommandBuffer");
  return recorded_.back();
}

void FakeUnity::beginPass() {
  transition(*camera_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
             VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
  VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  begin.renderPass = pass_;
  begin.framebuffer = framebuffer_;
  begin.renderArea.extent = {64, 64};
  vkCmdBeginRenderPass(commands_, &begin, VK_SUBPASS_CONTENTS_INLINE);
  insidePass_ = true;
}

void FakeUnity::frame(UnityRenderingEventAndData event, const std::vector<std::pair<int, void*>>& issued) {
  ++current_;
  const Slot& slot = slots_[current_ % kLag];
  check(vkWaitForFences(device_, 1, &slot.fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  if (!held_) safe_ = current_ - kLag;
  check(vkResetFences(device_, 1, &slot.fence), "vkResetFences");
  check(vkResetCommandPool(device_, slot.pool, VK_COMMAND_POOL_RESET_RELEASE_RESOURCES_BIT), "vkResetCommandPool");
  recorded_.clear();
  commands_ = nextCommands();
  beginPass();
  for (const auto& [id, data] : issued) {
    const UnityVulkanPluginEventConfig* how = config(id);
    const bool outside = how && how->renderPassPrecondition == kUnityVulkanRenderPass_EnsureOutside;
    if (outside && insidePass_) {
      vkCmdEndRenderPass(commands_);
      insidePass_ = false;
    }
    insideEvent_ = true;
    event(id, data);
    insideEvent_ = false;
    if (outside) beginPass(); // Unity goes on with its pass
  }
  vkCmdEndRenderPass(commands_);
  insidePass_ = false;
  check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = static_cast<uint32_t>(recorded_.size());
  submit.pCommandBuffers = recorded_.data();
  check(vkQueueSubmit(queue_, 1, &submit, slot.fence), "vkQueueSubmit");
}

} // namespace gpgp::test
