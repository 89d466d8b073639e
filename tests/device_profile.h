// Vulkan as devices of other classes would show it: a vkGetInstanceProcAddr between the library and the real one, which
// lowers limits and hides features. The device below is still the real one; that nothing beyond the profile is used is
// what the library says of itself at creation, and the validation layer of what it was told to enable.
#pragma once
#include <gpgp/core.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace gpgp::test {

struct DeviceProfile {
  const char* name;
  VkPhysicalDeviceType type;              ///< what the library chooses passes by
  uint32_t storageBuffers, storageImages; ///< a stage
  uint32_t storageRange;                  ///< bytes
  bool dynamicRendering, int64Atomics, multiview;
};

/// One at a time; tests run one after the other.
class ProfiledVulkan {
public:
  ProfiledVulkan(const DeviceProfile& profile, PFN_vkGetInstanceProcAddr realOne) {
    current = profile;
    real = realOne;
  }
  static PFN_vkGetInstanceProcAddr getInstanceProcAddr() { return &lookUp; }
  /// Of those that the engine enabled.
  static GpgpFeatures featuresOf(const DeviceProfile& profile, GpgpFeatures enabled) {
    if (!profile.dynamicRendering) enabled &= ~GPGP_FEATURE_DYNAMIC_RENDERING;
    if (!profile.int64Atomics) enabled &= ~GPGP_FEATURE_BUFFER_INT64_ATOMICS;
    if (!profile.multiview) enabled &= ~GPGP_FEATURE_MULTIVIEW;
    return enabled;
  }

private:
  static inline DeviceProfile current{};
  static inline PFN_vkGetInstanceProcAddr real = nullptr;
  static inline PFN_vkGetPhysicalDeviceProperties2 realProperties = nullptr;
  static inline PFN_vkGetPhysicalDeviceFeatures2 realFeatures = nullptr;

  static VKAPI_ATTR void VKAPI_CALL properties(VkPhysicalDevice device, VkPhysicalDeviceProperties2* found) {
    realProperties(device, found);
    VkPhysicalDeviceLimits& limits = found->properties.limits;
    found->properties.deviceType = current.type;
    const auto lower = [](uint32_t& limit, uint32_t to) { limit = std::min(limit, to); };
    lower(limits.maxPerStageDescriptorStorageBuffers, current.storageBuffers);
    lower(limits.maxPerStageDescriptorStorageImages, current.storageImages);
    lower(limits.maxStorageBufferRange, current.storageRange);
    lower(limits.maxComputeSharedMemorySize, 16384); // what Vulkan guarantees, and our shaders ask for
    lower(limits.maxComputeWorkGroupInvocations, 256);
    lower(limits.maxPushConstantsSize, 128);
    for (uint32_t& count : limits.maxComputeWorkGroupCount) lower(count, 65535);
  }
  static VKAPI_ATTR void VKAPI_CALL features(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* found) {
    realFeatures(device, found);
    found->features.shaderInt64 = found->features.shaderInt64 && current.int64Atomics;
    for (auto* next = static_cast<VkBaseOutStructure*>(found->pNext); next; next = next->pNext) {
      if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES && !current.multiview)
        reinterpret_cast<VkPhysicalDeviceVulkan11Features*>(next)->multiview = VK_FALSE;
      if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES && !current.int64Atomics)
        reinterpret_cast<VkPhysicalDeviceVulkan12Features*>(next)->shaderBufferInt64Atomics = VK_FALSE;
      if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES && !current.dynamicRendering)
        reinterpret_cast<VkPhysicalDeviceDynamicRenderingFeatures*>(next)->dynamicRendering = VK_FALSE;
    }
  }
  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL lookUp(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction found = real(instance, name);
    if (std::strcmp(name, "vkGetPhysicalDeviceProperties2") == 0) {
      realProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(found);
      return reinterpret_cast<PFN_vkVoidFunction>(&properties);
    }
    if (std::strcmp(name, "vkGetPhysicalDeviceFeatures2") == 0) {
      realFeatures = reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2>(found);
      return reinterpret_cast<PFN_vkVoidFunction>(&features);
    }
    return found;
  }
};

} // namespace gpgp::test
