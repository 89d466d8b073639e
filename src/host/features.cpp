// Chooses features: each optional one of gpgp where the device has it, and what our own programs draw with (indirect
// draws with a first instance). Extensions are used instead of Vulkan 1.3 so that a 1.2 device shows what it can.
#include "host/features.h"

#include <cstring>
#include <set>

namespace gpgp::host {

void chooseFeatures(const InstanceTable& vki, VkPhysicalDevice device, GpgpFeatures wanted, FeatureChain& chain) {
  uint32_t count = 0;
  check(vki.enumerateDeviceExtensionProperties(device, nullptr, &count, nullptr), "device extensions");
  std::vector<VkExtensionProperties> properties(count);
  check(vki.enumerateDeviceExtensionProperties(device, nullptr, &count, properties.data()), "device extensions");
  std::set<std::string> available;
  for (const VkExtensionProperties& extension : properties) available.insert(extension.extensionName);

  FeatureChain offered;
  void** tail = &offered.features.pNext;
  const auto link = [&tail](auto& feature) {
    *tail = &feature;
    tail = &feature.pNext;
  };
  const bool hasDynamic = available.count(VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME) > 0;
  link(offered.features11);
  link(offered.features12);
  if (hasDynamic) link(offered.dynamicRendering);
  vki.getPhysicalDeviceFeatures2(device, &offered.features);

  tail = &chain.features.pNext;
  link(chain.features11);
  link(chain.features12);
  const auto take = [&](GpgpFeatures bit, bool available_) {
    if (!(wanted & bit) || !available_) return false;
    chain.enabled |= bit;
    return true;
  };
  const VkPhysicalDeviceFeatures& core = offered.features.features;
  VkPhysicalDeviceFeatures& enable = chain.features.features;
  enable.multiDrawIndirect = core.multiDrawIndirect;
  enable.drawIndirectFirstInstance = core.drawIndirectFirstInstance;
  if (take(GPGP_FEATURE_BUFFER_INT64_ATOMICS, core.shaderInt64 && offered.features12.shaderBufferInt64Atomics)) {
    enable.shaderInt64 = VK_TRUE;
    chain.features12.shaderBufferInt64Atomics = VK_TRUE;
  }
  if (take(GPGP_FEATURE_MULTIVIEW, offered.features11.multiview)) chain.features11.multiview = VK_TRUE;
  if (take(GPGP_FEATURE_DYNAMIC_RENDERING, offered.dynamicRendering.dynamicRendering)) {
    link(chain.dynamicRendering);
    chain.dynamicRendering.dynamicRendering = VK_TRUE;
    chain.extensions.push_back(VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME);
  }
}

} // namespace gpgp::host
