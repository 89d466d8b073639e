#include "spawn/schedule/fits.h"

namespace gpgp::spawn {
namespace {
constexpr Limits kHardware{{32, 2048, 256, 2048}, {128, 1024, 512, 4096, 0, 1}, 2048},
    kSoftware{{64, 256, 1024, 512}, {64, 256, 1024, 512}, 65535};
/// Batches of one group are small, so that workgroups take many: short batches, of what a small stack has room for,
/// leave more of the device's turns to them.
constexpr Fit kSoftwareQueues{64, 256, 384, 512};
/// A stack holds what some steps of a workgroup leave: below that, shapes go through the queue all the time.
constexpr bool hasRoom(const Fit& fit) { return fit.stackShapes >= 4 * fit.groupSize; }
static_assert(hasRoom(kHardware.fit) && hasRoom(kHardware.uneven) && hasRoom(kSoftware.fit) &&
              hasRoom(kSoftware.uneven) && hasRoom(kSoftwareQueues));
} // namespace

const Limits& limitsOf(const core::Device& device) { return device.software ? kSoftware : kHardware; }

bool takesBatches(const core::Device& device) {
  return device.software && device.subgroupArithmetic && device.subgroupSize;
}
bool canRun(const core::Device& device, KernelTarget target) {
  return target == KernelTarget::any ||
         (target == KernelTarget::software ? takesBatches(device) : device.subgroupArithmetic);
}
Fit fitOf(const core::Device& device, const KernelInfo& info, bool uneven) {
  if (info.fit.groupSize) return info.fit;
  Fit fit = uneven ? limitsOf(device).uneven : limitsOf(device).fit;
  if (info.target == KernelTarget::software) fit = {device.subgroupSize, 256, 1024, 512};
  if (info.queues == Queues::groups && device.software) fit = kSoftwareQueues;
  fit.rounds = info.fit.rounds;
  return fit;
}
KernelInfo interpreterFor(const core::Device& device, bool colliders) {
  KernelInfo info;
  info.target = takesBatches(device) && !colliders ? KernelTarget::software
                : device.subgroupArithmetic        ? KernelTarget::subgroups
                                                   : KernelTarget::any;
  return info;
}
bool isOneSubgroup(const core::Device& device, KernelTarget target, const Fit& fit) {
  return target != KernelTarget::any && fit.groupSize == device.subgroupSize;
}
std::array<uint32_t, core::kMaxSpecialization> specialization(const core::Device& device, const Fit& fit,
                                                              uint32_t table) {
  return {fit.groupSize, fit.stackShapes, table, fit.groupSize == device.subgroupSize, device.software};
}

} // namespace gpgp::spawn
