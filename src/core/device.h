// The engine's device as the library sees it: handles, tables, declared features, limits. A plain value.
#pragma once
#include "core/vulkan_table.h"

namespace gpgp::core {

struct Device {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  InstanceTable vki;
  DeviceTable vk;
  GpgpFeatures features = 0;
  VkPhysicalDeviceLimits limits{};
  uint32_t vendor = 0, model = 0;  ///< vendorID and deviceID
  bool software = false;           ///< runs on the CPU
  bool subgroupArithmetic = false; ///< and ballots and shuffles, in compute shaders
  uint32_t subgroupSize = 0;       ///< 0: not the same for all shaders

  bool has(GpgpFeatures wanted) const { return (features & wanted) == wanted; }
  template <class Handle> void setName(VkObjectType type, Handle handle, const char* label, const char* part) const;
};

/// Names an object "label part" for debuggers where debug utils are there.
template <class Handle>
void Device::setName(VkObjectType type, Handle handle, const char* label, const char* part) const {
  if (!vk.SetDebugUtilsObjectNameEXT) return;
  char name[128];
  std::snprintf(name, sizeof name, "gpgp %s %s", label, part);
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, type,
                                     reinterpret_cast<uint64_t>(handle), name};
  vk.SetDebugUtilsObjectNameEXT(device, &info);
}

} // namespace gpgp::core
