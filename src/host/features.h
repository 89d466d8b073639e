// What of a device's optional features our own programs enable, as an engine would with gpgpGetRequirements.
#pragma once
#include "host/device.h"

namespace gpgp::host {

/// A chain for VkDeviceCreateInfo::pNext. The structs point at each other, so it does not move.
struct FeatureChain {
  FeatureChain() = default;
  FeatureChain(const FeatureChain&) = delete;
  FeatureChain& operator=(const FeatureChain&) = delete;

  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan11Features features11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  VkPhysicalDeviceVulkan12Features features12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceDynamicRenderingFeatures dynamicRendering{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES};
  std::vector<const char*> extensions;
  GpgpFeatures enabled = 0;
};

/// Fills the chain with what is both wanted and offered, and with the plain features that our programs draw with.
void chooseFeatures(const InstanceTable& vki, VkPhysicalDevice device, GpgpFeatures wanted, FeatureChain& chain);

} // namespace gpgp::host
