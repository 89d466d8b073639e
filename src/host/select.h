// Which physical device a person means: by index, by part of a name, or by default.
#pragma once
#include "host/device.h"

namespace gpgp::host {

/// Loads the instance functions. Throws where a core function is missing.
InstanceTable loadInstanceTable(VkInstance instance);
/// Summaries in the loader's order; index i belongs to handle i.
std::vector<DeviceSummary> summarise(const InstanceTable& vki, const std::vector<VkPhysicalDevice>& handles);
std::vector<VkPhysicalDevice> physicalDevices(const InstanceTable& vki, VkInstance instance);
/// wanted: an index, part of a name in any case, or empty for the default (the software device, else the first).
/// Throws with the list of what there is where nothing fits.
uint32_t selectDevice(const std::vector<DeviceSummary>& devices, std::string_view wanted);
/// Loads the Vulkan loader once; throws with the package to install where there is none.
void loadVulkan();

} // namespace gpgp::host
