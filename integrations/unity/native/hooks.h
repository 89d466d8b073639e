// What the plugin changes of Unity's Vulkan instance and device, while Unity makes them.
#pragma once
#include <gpgp/core.h>

namespace gpgp::unity {

/// Results of the hooks. One Unity, one device: hooks have no user data, so this is the process's.
struct HookedDevice {
  PFN_vkGetInstanceProcAddr loader = nullptr;
  VkInstance instance = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE; ///< the last one made
  uint32_t apiVersion = 0;          ///< of the instance
};
HookedDevice& hookedDevice();

/// What Unity gets in place of the loader's. Raises the instance to Vulkan 1.2. All else passes through.
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL hookedGetInstanceProcAddr(VkInstance instance, const char* name);

} // namespace gpgp::unity
