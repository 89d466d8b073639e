// Instance, device and queues without a window; validation messages are collected, not printed.
#include "host/device.h"

#include "host/features.h"
#include "host/select.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace gpgp::host {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool hasLayer(const char* name) {
  uint32_t count = 0;
  check(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
  std::vector<VkLayerProperties> layers(count);
  check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "vkEnumerateInstanceLayerProperties");
  return std::any_of(layers.begin(), layers.end(),
                     [name](const VkLayerProperties& l) { return std::strcmp(l.layerName, name) == 0; });
}

bool hasInstanceExtension(const char* layer, const char* name) {
  uint32_t count = 0;
  if (vkEnumerateInstanceExtensionProperties(layer, &count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkExtensionProperties> extensions(count);
  if (vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data()) < 0) return false;
  return std::any_of(extensions.begin(), extensions.end(),
                     [name](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

/// GPGP_VALIDATION=outside: the layer works where it is not seen from here. Under Wine that is in the loader of the
/// host, which has been told to use it and to write its messages into a file (tests/windows.sh).
bool isValidatedOutside() {
  const char* where = std::getenv("GPGP_VALIDATION");
  return where && std::strcmp(where, "outside") == 0;
}

/// volk's loading functions write its globals; devices may be made on many threads.
std::mutex& volkMutex() {
  static std::mutex mutex;
  return mutex;
}

} // namespace

std::string resultName(VkResult result) {
  switch (result) {
  case VK_SUCCESS: return "VK_SUCCESS";
  case VK_NOT_READY: return "VK_NOT_READY";
  case VK_TIMEOUT: return "VK_TIMEOUT";
  case VK_INCOMPLETE: return "VK_INCOMPLETE";
  case VK_ERROR_OUT_OF_HOST_MEMORY: return "VK_ERROR_OUT_OF_HOST_MEMORY";
  case VK_ERROR_OUT_OF_DEVICE_MEMORY: return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
  case VK_ERROR_INITIALIZATION_FAILED: return "VK_ERROR_INITIALIZATION_FAILED";
  case VK_ERROR_DEVICE_LOST: return "VK_ERROR_DEVICE_LOST";
  case VK_ERROR_LAYER_NOT_PRESENT: return "VK_ERROR_LAYER_NOT_PRESENT";
  case VK_ERROR_EXTENSION_NOT_PRESENT: return "VK_ERROR_EXTENSION_NOT_PRESENT";
  case VK_ERROR_FEATURE_NOT_PRESENT: return "VK_ERROR_FEATURE_NOT_PRESENT";
  case VK_ERROR_INCOMPATIBLE_DRIVER: return "VK_ERROR_INCOMPATIBLE_DRIVER";
  case VK_ERROR_FORMAT_NOT_SUPPORTED: return "VK_ERROR_FORMAT_NOT_SUPPORTED";
  default: return "VkResult " + std::to_string(static_cast<int>(result));
  }
}

void check(VkResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": " + resultName(result));
}

HeadlessDevice::HeadlessDevice(const DeviceOptions& options) {
  loadVulkan();
  try {
    createInstance(options);
    createDevice(options);
  } catch (...) {
    destroy();
    throw;
  }
}

HeadlessDevice::~HeadlessDevice() { destroy(); }

void HeadlessDevice::destroy() noexcept {
  if (device_) {
    vk_.vkDeviceWaitIdle(device_);
    vk_.vkDestroyDevice(device_, nullptr);
  }
  if (messenger_) vki_.destroyDebugUtilsMessenger(instance_, messenger_, nullptr);
  if (instance_) vki_.destroyInstance(instance_, nullptr);
}

PFN_vkGetInstanceProcAddr HeadlessDevice::getInstanceProcAddr() const { return vkGetInstanceProcAddr; }

VkBool32 HeadlessDevice::onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                   VkDebugUtilsMessageTypeFlagsEXT types,
                                   const VkDebugUtilsMessengerCallbackDataEXT* data, void* userData) {
  // The loader's own remarks (drivers it could not open) are "general" and say nothing about how Vulkan is used.
  const VkDebugUtilsMessageTypeFlagsEXT about =
      VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  if (!(types & about) || severity < VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT) return VK_FALSE;
  auto* log = static_cast<MessageLog*>(userData);
  const std::lock_guard lock(log->mutex);
  if (log->messages.size() < 1000) log->messages.emplace_back(data->pMessage ? data->pMessage : "");
  return VK_FALSE;
}

void HeadlessDevice::createInstance(const DeviceOptions& options) {
  const bool validated = options.validation && !isValidatedOutside();
  if (validated && !hasLayer(kValidationLayer))
    throw std::runtime_error(
        "the Khronos validation layer is missing (Debian: apt-get install vulkan-validationlayers)");
  std::vector<const char*> layers, extensions;
  if (validated) layers.push_back(kValidationLayer);
  debugUtils_ = hasInstanceExtension(nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) ||
                (validated && hasInstanceExtension(kValidationLayer, VK_EXT_DEBUG_UTILS_EXTENSION_NAME));
  if (debugUtils_) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  if (validated) extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);

  apiVersion_ = options.apiVersion;
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "gpgp host";
  application.apiVersion = apiVersion_;
  VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  messenger.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  messenger.messageType =
      VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  messenger.pfnUserCallback = onMessage;
  messenger.pUserData = &log_;
  const VkValidationFeatureEnableEXT enable = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  VkValidationFeaturesEXT validation{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  validation.enabledValidationFeatureCount = 1;
  validation.pEnabledValidationFeatures = &enable;
  validation.pNext = &messenger; // instance creation and destruction are listened to as well

  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  if (validated) info.pNext = &validation;
  info.pApplicationInfo = &application;
  info.enabledLayerCount = static_cast<uint32_t>(layers.size());
  info.ppEnabledLayerNames = layers.data();
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  check(vkCreateInstance(&info, nullptr, &instance_), "vkCreateInstance");
  {
    const std::lock_guard lock(volkMutex());
    volkLoadInstanceOnly(instance_); // for vkGetDeviceProcAddr, which volkLoadDeviceTable uses
    vki_ = loadInstanceTable(instance_);
  }
  if (validated) check(vki_.createDebugUtilsMessenger(instance_, &messenger, nullptr, &messenger_), "debug messenger");
}

void HeadlessDevice::createDevice(const DeviceOptions& options) {
  const std::vector<VkPhysicalDevice> handles = physicalDevices(vki_, instance_);
  const std::vector<DeviceSummary> summaries = summarise(vki_, handles);
  const char* fromEnvironment = std::getenv("GPGP_DEVICE");
  const std::string wanted = !options.device.empty() ? options.device : fromEnvironment ? fromEnvironment : "";
  index_ = selectDevice(summaries, wanted);
  physicalDevice_ = handles[index_];
  name_ = summaries[index_].name;
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
  vki_.getPhysicalDeviceProperties2(physicalDevice_, &properties);
  properties_ = properties.properties;
  vki_.getPhysicalDeviceMemoryProperties(physicalDevice_, &memoryProperties_);
  if (properties_.apiVersion < VK_API_VERSION_1_2) throw std::runtime_error(name_ + " has no Vulkan 1.2");

  uint32_t familyCount = 0;
  vki_.getPhysicalDeviceQueueFamilyProperties(physicalDevice_, &familyCount, nullptr);
  std::vector<VkQueueFamilyProperties> families(familyCount);
  vki_.getPhysicalDeviceQueueFamilyProperties(physicalDevice_, &familyCount, families.data());
  std::optional<uint32_t> both, compute;
  for (uint32_t i = 0; i < familyCount; ++i) {
    const VkQueueFlags flags = families[i].queueFlags;
    if (!both && (flags & VK_QUEUE_GRAPHICS_BIT) && (flags & VK_QUEUE_COMPUTE_BIT)) both = i;
    if (!compute && (flags & VK_QUEUE_COMPUTE_BIT) && !(flags & VK_QUEUE_GRAPHICS_BIT)) compute = i;
  }
  if (!both) throw std::runtime_error(name_ + " has no queue family with graphics and compute");

  const float priority = 1.0f;
  std::vector<VkDeviceQueueCreateInfo> queues;
  for (const std::optional<uint32_t>& family : {both, compute}) {
    if (!family) continue;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = *family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    queues.push_back(queue);
  }
  FeatureChain chain;
  chooseFeatures(vki_, physicalDevice_, options.features, chain);
  features_ = chain.enabled;
  if (debugUtils_ && (options.features & GPGP_FEATURE_DEBUG_UTILS)) features_ |= GPGP_FEATURE_DEBUG_UTILS;

  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  info.pNext = &chain.features;
  info.queueCreateInfoCount = static_cast<uint32_t>(queues.size());
  info.pQueueCreateInfos = queues.data();
  info.enabledExtensionCount = static_cast<uint32_t>(chain.extensions.size());
  info.ppEnabledExtensionNames = chain.extensions.data();
  check(vki_.createDevice(physicalDevice_, &info, nullptr, &device_), "vkCreateDevice");
  {
    const std::lock_guard lock(volkMutex());
    volkLoadDeviceTable(&vk_, device_);
  }
  const auto queueOf = [&](uint32_t family) {
    Queue queue;
    queue.family = family;
    queue.flags = families[family].queueFlags;
    vk_.vkGetDeviceQueue(device_, family, 0, &queue.queue);
    return queue;
  };
  graphics_ = queueOf(*both);
  if (compute) computeOnly_ = queueOf(*compute);
}

GpgpContextCreateInfo HeadlessDevice::contextCreateInfo() const {
  GpgpContextCreateInfo info = GPGP_CONTEXT_CREATE_INFO_INIT;
  info.instance = instance_;
  info.physicalDevice = physicalDevice_;
  info.device = device_;
  info.getInstanceProcAddr = vkGetInstanceProcAddr;
  info.apiVersion = apiVersion_;
  info.features = features_;
  return info;
}

void HeadlessDevice::submitAndWait(const Queue& queue, const std::function<void(VkCommandBuffer)>& record) {
  // Whatever fails on the way, the pool (and the command buffer with it) and the fence are given back.
  struct Scope {
    const HeadlessDevice& device;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    ~Scope() {
      device.vk_.vkDestroyFence(device.device_, fence, nullptr);
      device.vk_.vkDestroyCommandPool(device.device_, pool, nullptr);
    }
  } scope{*this};
  VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  poolInfo.queueFamilyIndex = queue.family;
  check(vk_.vkCreateCommandPool(device_, &poolInfo, nullptr, &scope.pool), "vkCreateCommandPool");
  VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  check(vk_.vkCreateFence(device_, &fenceInfo, nullptr, &scope.fence), "vkCreateFence");
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = scope.pool;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vk_.vkAllocateCommandBuffers(device_, &allocate, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vk_.vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  record(commands);
  check(vk_.vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  check(vk_.vkQueueSubmit(queue.queue, 1, &submit, scope.fence), "vkQueueSubmit");
  check(vk_.vkWaitForFences(device_, 1, &scope.fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
}

void HeadlessDevice::waitIdle() { check(vk_.vkDeviceWaitIdle(device_), "vkDeviceWaitIdle"); }

std::vector<std::string> HeadlessDevice::validationMessages() const {
  const std::lock_guard lock(log_.mutex);
  return log_.messages;
}

std::vector<std::string> HeadlessDevice::takeValidationMessages() {
  const std::lock_guard lock(log_.mutex);
  return std::exchange(log_.messages, {});
}

void HeadlessDevice::setName(VkObjectType type, uint64_t handle, const std::string& name) const {
  if (!vki_.setDebugUtilsObjectName) return;
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  info.objectType = type;
  info.objectHandle = handle;
  info.pObjectName = name.c_str();
  vki_.setDebugUtilsObjectName(device_, &info);
}

uint32_t HeadlessDevice::memoryType(uint32_t typeBits, VkMemoryPropertyFlags required,
                                    VkMemoryPropertyFlags preferred) const {
  for (const VkMemoryPropertyFlags flags : {required | preferred, required})
    for (uint32_t i = 0; i < memoryProperties_.memoryTypeCount; ++i)
      if ((typeBits >> i & 1u) && (memoryProperties_.memoryTypes[i].propertyFlags & flags) == flags) return i;
  throw std::runtime_error(name_ + " has no memory type for this use");
}

} // namespace gpgp::host
