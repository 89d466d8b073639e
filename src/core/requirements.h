// What gpgp asks of a device, and what it could use.
#pragma once
#include "core/vulkan_table.h"

namespace gpgp::core {
/// Fills `requirements` (all but sType and pNext). The feature chain points into it.
Result<void> fillRequirements(const GpgpRequirementsInfo& info, GpgpRequirements& requirements);
} // namespace gpgp::core
