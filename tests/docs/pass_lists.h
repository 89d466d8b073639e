// The pass lists of recorders with everything that a recorder can have, without a device. Each service has a source of
// its own, as the layouts of two do not go into one.
#pragma once
#include "core/device.h"
#include "core/passes.h"

namespace gpgp::test {

core::PassList canvasPasses(bool software, bool patches = false);
core::PassList visibilityPasses();
core::PassList atlasPasses();
core::PassList spawnPasses(bool vertices);
/// The shader of the pass `derive` with colliders or without. subgroups: the device has subgroup arithmetic.
core::ShaderDesc interpreterOf(bool software, bool subgroups, bool colliders);

/// With all features, and limits as devices have them.
inline core::Device deviceOf(bool software) {
  core::Device device;
  device.software = software;
  device.subgroupArithmetic = true;
  device.subgroupSize = software ? 8 : 32;
  device.features = GPGP_FEATURE_BUFFER_INT64_ATOMICS;
  device.limits.maxStorageBufferRange = 1u << 27;
  device.limits.maxComputeSharedMemorySize = 32768;
  return device;
}

} // namespace gpgp::test
