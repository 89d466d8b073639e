#include "core/vulkan_table.h"

namespace gpgp::core {

Result<InstanceTable> loadInstanceTable(VkInstance instance, PFN_vkGetInstanceProcAddr getInstanceProcAddr) {
  InstanceTable table;
#define X(name)                                                                                                        \
  table.name = reinterpret_cast<PFN_vk##name>(getInstanceProcAddr(instance, "vk" #name));                              \
  if (!table.name)                                                                                                     \
    return makeError(GPGP_ERROR_MISSING_FEATURE,                                                                       \
                     "getInstanceProcAddr does not know vk" #name "; the instance must be of Vulkan 1.2 or later");
  GPGP_INSTANCE_FUNCTIONS(X)
#undef X
  return table;
}

Result<DeviceTable> loadDeviceTable(const InstanceTable& instanceTable, VkDevice device, bool debugUtils) {
  DeviceTable table;
#define X(name)                                                                                                        \
  table.name = reinterpret_cast<PFN_vk##name>(instanceTable.GetDeviceProcAddr(device, "vk" #name));                    \
  if (!table.name) return makeError(GPGP_ERROR_MISSING_FEATURE, "vkGetDeviceProcAddr does not know vk" #name);
  GPGP_DEVICE_FUNCTIONS(X)
#undef X
  if (debugUtils) {
#define X(name) table.name = reinterpret_cast<PFN_vk##name>(instanceTable.GetDeviceProcAddr(device, "vk" #name));
    GPGP_OPTIONAL_FUNCTIONS(X)
#undef X
    if (!table.CmdBeginDebugUtilsLabelEXT || !table.CmdEndDebugUtilsLabelEXT || !table.SetDebugUtilsObjectNameEXT)
      return makeError(GPGP_ERROR_MISSING_FEATURE, "GPGP_FEATURE_DEBUG_UTILS is declared, but the instance was made "
                                                   "without VK_EXT_debug_utils");
  }
  return table;
}

Error vulkanError(VkResult result, const char* function) {
  const char* name = "VkResult";
  GpgpResult code = GPGP_ERROR_VULKAN;
  switch (result) {
  case VK_ERROR_OUT_OF_HOST_MEMORY: name = "VK_ERROR_OUT_OF_HOST_MEMORY", code = GPGP_ERROR_OUT_OF_HOST_MEMORY; break;
  case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    name = "VK_ERROR_OUT_OF_DEVICE_MEMORY", code = GPGP_ERROR_OUT_OF_DEVICE_MEMORY;
    break;
  case VK_ERROR_DEVICE_LOST: name = "VK_ERROR_DEVICE_LOST", code = GPGP_ERROR_DEVICE_LOST; break;
  default: break;
  }
  return makeError(code, "%s (%d) from %s", name, static_cast<int>(result), function);
}

} // namespace gpgp::core
