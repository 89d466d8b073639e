#include "hooks.h"

#include <algorithm>
#include <cstring>

namespace gpgp::unity {

HookedDevice& hookedDevice() {
  static HookedDevice hooked;
  return hooked;
}

namespace {

template <class Function> Function load(VkInstance instance, const char* name) {
  return reinterpret_cast<Function>(hookedDevice().loader(instance, name));
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
  HookedDevice& hooked = hookedDevice();
  const auto create = load<PFN_vkCreateInstance>(nullptr, "vkCreateInstance");
  const auto version = load<PFN_vkEnumerateInstanceVersion>(nullptr, "vkEnumerateInstanceVersion");
  uint32_t offered = VK_API_VERSION_1_0;
  if (version) version(&offered);
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  if (info->pApplicationInfo) application = *info->pApplicationInfo;
  if (offered >= VK_API_VERSION_1_2) application.apiVersion = std::max(application.apiVersion, VK_API_VERSION_1_2);
  VkInstanceCreateInfo raised = *info;
  raised.pApplicationInfo = &application;
  const VkResult result = create(&raised, allocator, instance);
  if (result != VK_SUCCESS) return result;
  hooked.instance = *instance;
  hooked.apiVersion = application.apiVersion;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physicalDevice, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkDevice* device) {
  HookedDevice& hooked = hookedDevice();
  const auto create = load<PFN_vkCreateDevice>(hooked.instance, "vkCreateDevice");
  const VkResult result = create(physicalDevice, info, allocator, device);
  if (result != VK_SUCCESS) return result;
  hooked.device = *device;
  return result;
}

} // namespace

PFN_vkVoidFunction hookedGetInstanceProcAddr(VkInstance instance, const char* name) {
  if (!name) return nullptr;
  if (std::strcmp(name, "vkCreateInstance") == 0) return reinterpret_cast<PFN_vkVoidFunction>(createInstance);
  if (std::strcmp(name, "vkCreateDevice") == 0) return reinterpret_cast<PFN_vkVoidFunction>(createDevice);
  if (std::strcmp(name, "vkGetInstanceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(hookedGetInstanceProcAddr);
  return hookedDevice().loader(instance, name);
}

} // namespace gpgp::unity
