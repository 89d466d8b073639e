// Instance, GPU, device. The engine decides what to enable: gpgp only says what it could use.
#include "device.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace mini {

void check(VkResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + " failed with VkResult " + std::to_string(result));
}

Device::Device(const DeviceOptions& options) {
  createInstance(options);
  const char* fromEnvironment = std::getenv("GPGP_DEVICE");
  choosePhysical(!options.name.empty() ? options.name : fromEnvironment ? fromEnvironment : "");
  createDevice(options);
}

Device::~Device() {
  if (device) vkDeviceWaitIdle(device);
  if (device) vkDestroyDevice(device, nullptr);
  if (messenger_) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance, messenger_, nullptr);
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

void Device::createInstance(const DeviceOptions& options) {
  std::vector<const char*> extensions = options.instanceExtensions;
  std::vector<const char*> layers;
  if (options.validate) {
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
  application.pApplicationName = "mini engine";
  application.apiVersion = VK_API_VERSION_1_2;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  if (options.validate) info.pNext = &validation;
  info.pApplicationInfo = &application;
  info.enabledLayerCount = static_cast<uint32_t>(layers.size());
  info.ppEnabledLayerNames = layers.data();
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
  if (!options.validate) return;
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
  vkGetPhysicalDeviceMemoryProperties(physical, &memory_);
}

void Device::createDevice(const DeviceOptions& options) {
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

  // The engine's own need on top of what gpgp could use: indirect draws that begin at any instance.
  VkPhysicalDeviceFeatures offered{};
  vkGetPhysicalDeviceFeatures(physical, &offered);
  if (!offered.drawIndirectFirstInstance) throw std::runtime_error("the device lacks drawIndirectFirstInstance");
  requirements.features.features.drawIndirectFirstInstance = VK_TRUE;
  std::vector<const char*> extensions(requirements.extensions, requirements.extensions + requirements.extensionCount);
  if (options.swapchain) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);

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

uint32_t Device::memoryType(uint32_t typeBits, VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred) const {
  for (const VkMemoryPropertyFlags flags : {required | preferred, required})
    for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
      if ((typeBits >> i & 1u) && (memory_.memoryTypes[i].propertyFlags & flags) == flags) return i;
  throw std::runtime_error("no memory type for this use");
}

void Device::runOnce(const std::function<void(VkCommandBuffer)>& record) {
  VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  poolInfo.queueFamilyIndex = family;
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device, &poolInfo, nullptr, &pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = pool;
  allocate.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device, &allocate, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  record(commands);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  check(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
  vkDestroyCommandPool(device, pool, nullptr);
}

} // namespace mini
