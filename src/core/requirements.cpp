#include "core/requirements.h"

#include <cstring>

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
    {&VkPhysicalDeviceLimits::maxPerStageDescriptorStorageBuffers, 24, "maxPerStageDescriptorStorageBuffers >= 24"},
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

constexpr const char* kAllExtensions[] = {
    VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME,
    VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME,
};

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
  out.synchronization2 = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES};
  out.dynamicRendering = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES};
  if (device.apiVersion < VK_API_VERSION_1_2) {
    out.features.pNext = nullptr;
    return {};
  }

  // Both are core since 1.3, but an engine's instance may be older than its device: so always as extensions.
  const bool hasSync2 = hasExtension(*vki, info.physicalDevice, VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME);
  const bool hasDynamic = hasExtension(*vki, info.physicalDevice, VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME);
  VkPhysicalDeviceFeatures2 have{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan11Features have11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  VkPhysicalDeviceVulkan12Features have12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceSynchronization2Features haveSync2{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES};
  VkPhysicalDeviceDynamicRenderingFeatures haveDynamic{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES};
  have.pNext = &have11;
  have11.pNext = &have12;
  void** last = &have12.pNext;
  if (hasSync2) *last = &haveSync2, last = &haveSync2.pNext;
  if (hasDynamic) *last = &haveDynamic, last = &haveDynamic.pNext;
  vki->GetPhysicalDeviceFeatures2(info.physicalDevice, &have);

  // What to enable: exactly what gpgp would use and the device offers.
  out.features.pNext = &out.features11;
  out.features11.pNext = &out.features12;
  last = &out.features12.pNext;
  const auto offer = [&](bool there, GpgpFeatures feature, std::initializer_list<VkBool32*> enable) {
    if (!there) return;
    out.optionalFeatures |= feature;
    for (VkBool32* field : enable) *field = VK_TRUE;
  };
  offer(have12.bufferDeviceAddress, GPGP_FEATURE_BUFFER_DEVICE_ADDRESS, {&out.features12.bufferDeviceAddress});
  offer(have.features.geometryShader, GPGP_FEATURE_GEOMETRY_SHADER, {&out.features.features.geometryShader});
  offer(have12.shaderBufferInt64Atomics && have.features.shaderInt64, GPGP_FEATURE_BUFFER_INT64_ATOMICS,
        {&out.features12.shaderBufferInt64Atomics, &out.features.features.shaderInt64});
  offer(have11.multiview, GPGP_FEATURE_MULTIVIEW, {&out.features11.multiview});
  offer(have.features.fragmentStoresAndAtomics, GPGP_FEATURE_FRAGMENT_STORES,
        {&out.features.features.fragmentStoresAndAtomics});
  if (haveSync2.synchronization2) {
    offer(true, GPGP_FEATURE_SYNCHRONIZATION_2, {&out.synchronization2.synchronization2});
    *last = &out.synchronization2, last = &out.synchronization2.pNext;
  }
  if (haveDynamic.dynamicRendering) {
    offer(true, GPGP_FEATURE_DYNAMIC_RENDERING, {&out.dynamicRendering.dynamicRendering});
    *last = &out.dynamicRendering, last = &out.dynamicRendering.pNext;
  }
  *last = nullptr;
  if (hasSync2 || hasDynamic) { // neighbours in kAllExtensions

    out.extensions = hasSync2 ? kAllExtensions : kAllExtensions + 1;
    out.extensionCount = static_cast<uint32_t>(hasSync2) + static_cast<uint32_t>(hasDynamic);
  }
  return {};
}

} // namespace gpgp::core
