// What gpgp asks of a device, and what it could use.
#pragma once
#include "core/vulkan_table.h"

namespace gpgp::core {
/// Fills `requirements` (all but sType and pNext). The feature chain points into it.
Result<void> fillRequirements(const GpgpRequirementsInfo& info, GpgpRequirements& requirements);
/// MISSING_FEATURE, with the feature's name, where the device does not offer what was declared. Debug names aside,
/// which are the instance's.
Result<void> checkFeatures(const InstanceTable& vki, VkPhysicalDevice device, GpgpFeatures declared);
} // namespace gpgp::core
