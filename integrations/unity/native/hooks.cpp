#include "hooks.h"

#include <algorithm>
#include <cstring>
#include <vector>

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

/// A struct of a chain, by its type.
template <class Struct> const Struct* find(const void* chain, VkStructureType type) {
  for (const auto* at = static_cast<const VkBaseInStructure*>(chain); at; at = at->pNext)
    if (at->sType == type) return reinterpret_cast<const Struct*>(at);
  return nullptr;
}

bool names(const VkDeviceCreateInfo& info, const char* extension) {
  const auto is = [extension](const char* name) { return std::strcmp(name, extension) == 0; };
  return std::any_of(info.ppEnabledExtensionNames, info.ppEnabledExtensionNames + info.enabledExtensionCount, is);
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physicalDevice, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkDevice* device) {
  HookedDevice& hooked = hookedDevice();
  const auto create = load<PFN_vkCreateDevice>(hooked.instance, "vkCreateDevice");
  hooked.features = 0;
  const auto* theirs = find<VkPhysicalDeviceSynchronization2Features>(
      info->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES);
  const auto* core = find<VkPhysicalDeviceVulkan13Features>(info->pNext,
                                                            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  const bool enabled = (theirs && theirs->synchronization2) || (core && core->synchronization2);

  GpgpRequirementsInfo query = GPGP_REQUIREMENTS_INFO_INIT;
  query.instance = hooked.instance;
  query.physicalDevice = physicalDevice;
  query.getInstanceProcAddr = hooked.loader;
  GpgpRequirements requirements = GPGP_REQUIREMENTS_INIT;
  const bool fits = hooked.apiVersion >= VK_API_VERSION_1_2 && gpgpGetRequirements(&query, &requirements) == GPGP_SUCCESS;
  // Unity's own structs are Unity's: where it names the feature, that is how it is.
  if (fits && !theirs && !core && (requirements.optionalFeatures & GPGP_FEATURE_SYNCHRONIZATION_2)) {
    VkPhysicalDeviceSynchronization2Features feature{};
    feature.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES;
    feature.pNext = const_cast<void*>(info->pNext);
    feature.synchronization2 = VK_TRUE;
    std::vector<const char*> extensions(info->ppEnabledExtensionNames,
                                        info->ppEnabledExtensionNames + info->enabledExtensionCount);
    if (!names(*info, VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME))
      extensions.push_back(VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME);
    VkDeviceCreateInfo more = *info;
    more.pNext = &feature;
    more.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    more.ppEnabledExtensionNames = extensions.data();
    if (create(physicalDevice, &more, allocator, device) == VK_SUCCESS) {
      hooked.features = GPGP_FEATURE_SYNCHRONIZATION_2;
      hooked.device = *device;
      return VK_SUCCESS;
    } // else as Unity wanted it
  }
  const VkResult result = create(physicalDevice, info, allocator, device);
  if (result != VK_SUCCESS) return result;
  if (fits && enabled) hooked.features = GPGP_FEATURE_SYNCHRONIZATION_2;
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
