// Instance, GPU, device, frames in flight. What gpgp could use is asked for with gpgpGetRequirements before the device
// is made, and enabled; no line of this needs a window.
#include "gpgp_device.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>

namespace gpgp::integration {

void check(VkResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + " failed with VkResult " + std::to_string(result));
}

Device::Device(const DeviceInfo& info) {
  try {
    createInstance(info);
    const char* fromEnvironment = std::getenv("GPGP_DEVICE");
    choosePhysical(!info.device.empty() ? info.device : fromEnvironment ? fromEnvironment : "");
    createDevice(info);
  } catch (...) {
    destroy();
    throw;
  }
}

Device::~Device() { destroy(); }

void Device::destroy() noexcept {
  if (device) vkDeviceWaitIdle(device);
  if (device) vkDestroyDevice(device, nullptr);
  if (messenger_) {
    const auto destroyMessenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
    destroyMessenger(instance, messenger_, nullptr);
  }
  if (instance) vkDestroyInstance(instance, nullptr);
}

VkBool32 Device::onValidation(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT types,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  if (!(types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT)) return VK_FALSE; // the loader's remarks on drivers
  std::fprintf(stderr, "validation: %s\n", data->pMessage);
  ++static_cast<Device*>(user)->validationMessages_;
  return VK_FALSE;
}

void Device::createInstance(const DeviceInfo& wanted) {
  std::vector<const char*> extensions = wanted.instanceExtensions;
  std::vector<const char*> layers;
  if (wanted.validate) {
    layers.push_back("VK_LAYER_KHRONOS_validation");
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    gpgpFeatures |= GPGP_FEATURE_DEBUG_UTILS; // gpgp names its objects and passes
  }
  const VkValidationFeatureEnableEXT synchronisation = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  VkValidationFeaturesEXT validation{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  validation.enabledValidationFeatureCount = 1;
  validation.pEnabledValidationFeatures = &synchronisation;
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = wanted.application;
  application.apiVersion = VK_API_VERSION_1_2;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  if (wanted.validate) info.pNext = &validation;
  info.pApplicationInfo = &application;
  info.enabledLayerCount = static_cast<uint32_t>(layers.size());
  info.ppEnabledLayerNames = layers.data();
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
  if (!wanted.validate) return;
  VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  messenger.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  messenger.pfnUserCallback = onValidation;
  messenger.pUserData = this;
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
  check(create(instance, &messenger, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
}

void Device::choosePhysical(std::string name) {
  uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> all(count);
  if (count) check(vkEnumeratePhysicalDevices(instance, &count, all.data()), "vkEnumeratePhysicalDevices");
  if (all.empty()) throw std::runtime_error("no Vulkan device (Debian: apt-get install mesa-vulkan-drivers)");
  const auto lower = [](std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
  };
  name = lower(name);
  for (uint32_t i = 0; i < count && !physical; ++i) {
    VkPhysicalDeviceProperties candidate{};
    vkGetPhysicalDeviceProperties(all[i], &candidate);
    const bool wanted = name.empty()
                            ? candidate.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU
                            : name == std::to_string(i) || lower(candidate.deviceName).find(name) != std::string::npos;
    if (wanted) physical = all[i];
  }
  if (!physical && !name.empty()) throw std::runtime_error("no device is called \"" + name + "\"");
  if (!physical) physical = all[0];
  vkGetPhysicalDeviceProperties(physical, &properties);
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
}

void Device::createDevice(const DeviceInfo& wanted) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  const auto found = std::find_if(families.begin(), families.end(), [](const VkQueueFamilyProperties& candidate) {
    return (candidate.queueFlags & VK_QUEUE_GRAPHICS_BIT) && (candidate.queueFlags & VK_QUEUE_COMPUTE_BIT);
  });
  if (found == families.end()) throw std::runtime_error("no queue family with graphics and compute");
  family = static_cast<uint32_t>(found - families.begin());
  queueFlags = found->queueFlags;

  GpgpRequirementsInfo query = GPGP_REQUIREMENTS_INFO_INIT;
  query.instance = instance;
  query.physicalDevice = physical;
  query.getInstanceProcAddr = vkGetInstanceProcAddr;
  GpgpRequirements requirements = GPGP_REQUIREMENTS_INIT;
  if (const GpgpResult result = gpgpGetRequirements(&query, &requirements); result != GPGP_SUCCESS)
    throw std::runtime_error(std::string("this device cannot run gpgp; it lacks ") +
                             (requirements.missingCount ? requirements.missing[0] : gpgpResultString(result)));
  gpgpFeatures |= requirements.optionalFeatures;
  if (wanted.chooseFeatures) { // beside what gpgp could use
    VkPhysicalDeviceFeatures offered{};
    vkGetPhysicalDeviceFeatures(physical, &offered);
    wanted.chooseFeatures(offered, requirements.features.features);
  }
  std::vector<const char*> extensions(requirements.extensions, requirements.extensions + requirements.extensionCount);
  extensions.insert(extensions.end(), wanted.deviceExtensions.begin(), wanted.deviceExtensions.end());

  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queueInfo{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queueInfo.queueFamilyIndex = family;
  queueInfo.queueCount = 1;
  queueInfo.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  info.pNext = &requirements.features;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queueInfo;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  check(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
  vkGetDeviceQueue(device, family, 0, &queue);
}

GpgpContextCreateInfo Device::contextCreateInfo() const {
  GpgpContextCreateInfo info = GPGP_CONTEXT_CREATE_INFO_INIT;
  info.instance = instance;
  info.physicalDevice = physical;
  info.device = device;
  info.getInstanceProcAddr = vkGetInstanceProcAddr;
  info.apiVersion = VK_API_VERSION_1_2;
  info.features = gpgpFeatures;
  return info;
}

uint32_t Device::memoryType(uint32_t typeBits, VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred) const {
  for (const VkMemoryPropertyFlags flags : {required | preferred, required})
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
      if ((typeBits >> i & 1u) && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
  throw std::runtime_error("no memory type for this use");
}

Frames::Frames(Device& device, uint32_t inFlight) : device_(device), slots_(inFlight) {
  for (Slot& slot : slots_) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = device.family;
    check(vkCreateCommandPool(device.device, &pool, nullptr, &slot.pool), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = slot.pool;
    allocate.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device.device, &allocate, &slot.commands), "vkAllocateCommandBuffers");
    VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    check(vkCreateFence(device.device, &fence, nullptr, &slot.finished), "vkCreateFence");
  }
}

Frames::~Frames() {
  vkDeviceWaitIdle(device_.device);
  for (const Slot& slot : slots_) {
    vkDestroyFence(device_.device, slot.finished, nullptr);
    vkDestroyCommandPool(device_.device, slot.pool, nullptr);
  }
}

VkCommandBuffer Frames::begin() {
  // The slot was used inFlight() frames ago: once its fence is signalled, everything up to that frame is safe.
  ++number_.current;
  const Slot& now = slots_[slot()];
  check(vkWaitForFences(device_.device, 1, &now.finished, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  if (number_.current > inFlight()) number_.safe = std::max(number_.safe, number_.current - inFlight());
  check(vkResetCommandPool(device_.device, now.pool, 0), "vkResetCommandPool");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(now.commands, &begin), "vkBeginCommandBuffer");
  return now.commands;
}

void Frames::submit(VkSemaphore wait, VkSemaphore signal) {
  const Slot& now = slots_[slot()];
  check(vkEndCommandBuffer(now.commands), "vkEndCommandBuffer");
  const VkPipelineStageFlags waitStage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.waitSemaphoreCount = wait ? 1 : 0;
  submit.pWaitSemaphores = &wait;
  submit.pWaitDstStageMask = &waitStage;
  submit.signalSemaphoreCount = signal ? 1 : 0;
  submit.pSignalSemaphores = &signal;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &now.commands;
  check(vkResetFences(device_.device, 1, &now.finished), "vkResetFences"); // a frame that throws before leaves it
  check(vkQueueSubmit(device_.queue, 1, &submit, now.finished), "vkQueueSubmit");
}

void Frames::finish() {
  check(vkDeviceWaitIdle(device_.device), "vkDeviceWaitIdle");
  number_ = {number_.current + 1, number_.current};
}

} // namespace gpgp::integration
