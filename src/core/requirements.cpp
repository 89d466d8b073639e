#include "core/requirements.h"

#include <cstring>
#include <iterator>
#include <utility>

namespace gpgp::core {
namespace {

// The limits that shaders and descriptors are written for. All are met by every desktop and current mobile device.
struct Limit {
  uint32_t VkPhysicalDeviceLimits::*value;
  uint32_t needed;
  const char* text;
};
constexpr Limit kLimits[] = {
    {&VkPhysicalDeviceLimits::maxPushConstantsSize, 128, "maxPushConstantsSize >= 128"},
    {&VkPhysicalDeviceLimits::maxComputeWorkGroupInvocations, 256, "maxComputeWorkGroupInvocations >= 256"},
    {&VkPhysicalDeviceLimits::maxComputeSharedMemorySize, 16384, "maxComputeSharedMemorySize >= 16384"},
    {&VkPhysicalDeviceLimits::maxPerStageDescriptorStorageBuffers, 16, "maxPerStageDescriptorStorageBuffers >= 16"},
    {&VkPhysicalDeviceLimits::maxPerStageDescriptorStorageImages, 4, "maxPerStageDescriptorStorageImages >= 4"},
    {&VkPhysicalDeviceLimits::maxStorageBufferRange, 1u << 27, "maxStorageBufferRange >= 134217728"},
};

bool hasExtension(const InstanceTable& vki, VkPhysicalDevice device, const char* name) {
  // Read in pieces of a fixed size: this runs before any allocator is known.
  VkExtensionProperties piece[512];
  uint32_t count = sizeof piece / sizeof piece[0];
  const VkResult result = vki.EnumerateDeviceExtensionProperties(device, nullptr, &count, piece);
  if (result != VK_SUCCESS && result != VK_INCOMPLETE) return false;
  for (uint32_t i = 0; i < count; ++i)
    if (std::strcmp(piece[i].extensionName, name) == 0) return true;
  return false;
}

constexpr const char* kAllExtensions[] = {VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME};

/// What a device offers of the features that gpgp can use. `device` has Vulkan 1.2.
GpgpFeatures offeredFeatures(const InstanceTable& vki, VkPhysicalDevice device) {
  VkPhysicalDeviceFeatures2 have{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan11Features have11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  VkPhysicalDeviceVulkan12Features have12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceDynamicRenderingFeatures haveDynamic{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES};
  have.pNext = &have11;
  have11.pNext = &have12;
  // Core since 1.3, but an engine's instance may be older than its device: so always as an extension.
  if (hasExtension(vki, device, VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME)) have12.pNext = &haveDynamic;
  vki.GetPhysicalDeviceFeatures2(device, &have);
  GpgpFeatures offered = 0;
  if (haveDynamic.dynamicRendering) offered |= GPGP_FEATURE_DYNAMIC_RENDERING;
  if (have12.shaderBufferInt64Atomics && have.features.shaderInt64) offered |= GPGP_FEATURE_BUFFER_INT64_ATOMICS;
  if (have11.multiview) offered |= GPGP_FEATURE_MULTIVIEW;
  return offered;
}

} // namespace

Result<void> fillRequirements(const GpgpRequirementsInfo& info, GpgpRequirements& out) {
  const auto vki = loadInstanceTable(info.instance, info.getInstanceProcAddr);
  if (!vki) return vki.error();
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
  vki->GetPhysicalDeviceProperties2(info.physicalDevice, &properties);
  const VkPhysicalDeviceProperties& device = properties.properties;

  out.apiVersion = VK_API_VERSION_1_2;
  out.requiredFeatures = 0;
  out.optionalFeatures = 0;
  out.queueFlags = VK_QUEUE_COMPUTE_BIT;
  out.extensions = nullptr;
  out.extensionCount = 0;
  out.missingCount = 0;
  const auto missing = [&](const char* text) {
    if (out.missingCount < sizeof out.missing / sizeof out.missing[0]) out.missing[out.missingCount++] = text;
  };
  if (device.apiVersion < VK_API_VERSION_1_2) missing("Vulkan >= 1.2");
  for (const Limit& limit : kLimits)
    if (device.limits.*limit.value < limit.needed) missing(limit.text);

  out.features = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  out.features11 = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  out.features12 = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  out.dynamicRendering = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES};
  if (device.apiVersion < VK_API_VERSION_1_2) {
    out.features.pNext = nullptr;
    return {};
  }

  // What to enable: exactly what gpgp would use and the device offers.
  out.features.pNext = &out.features11;
  out.features11.pNext = &out.features12;
  out.features12.pNext = nullptr;
  out.optionalFeatures = offeredFeatures(*vki, info.physicalDevice);
  if (out.optionalFeatures & GPGP_FEATURE_BUFFER_INT64_ATOMICS)
    out.features12.shaderBufferInt64Atomics = out.features.features.shaderInt64 = VK_TRUE;
  if (out.optionalFeatures & GPGP_FEATURE_MULTIVIEW) out.features11.multiview = VK_TRUE;
  if (out.optionalFeatures & GPGP_FEATURE_DYNAMIC_RENDERING) {
    out.dynamicRendering.dynamicRendering = VK_TRUE;
    out.features12.pNext = &out.dynamicRendering;
    out.extensions = kAllExtensions;
    out.extensionCount = static_cast<uint32_t>(std::size(kAllExtensions));
  }
  return {};
}

Result<void> checkFeatures(const InstanceTable& vki, VkPhysicalDevice device, GpgpFeatures declared) {
  static constexpr std::pair<GpgpFeatures, const char*> kNames[] = {
      {GPGP_FEATURE_DYNAMIC_RENDERING, "GPGP_FEATURE_DYNAMIC_RENDERING"},
      {GPGP_FEATURE_BUFFER_INT64_ATOMICS, "GPGP_FEATURE_BUFFER_INT64_ATOMICS"},
      {GPGP_FEATURE_MULTIVIEW, "GPGP_FEATURE_MULTIVIEW"},
  };
  const GpgpFeatures offered = offeredFeatures(vki, device);
  for (const auto& [feature, name] : kNames)
    if (declared & ~offered & feature)
      return makeError(GPGP_ERROR_MISSING_FEATURE, "features has %s, which the physical device does not offer", name);
  return {};
}

} // namespace gpgp::core
