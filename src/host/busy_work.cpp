#include "host/busy_work.h"

namespace gpgp::host {

BusyWork::BusyWork(HeadlessDevice& device) : device_(device) {
  if (!device.isSoftware()) target_ = Buffer(device, 4u << 20, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

void BusyWork::warmUp() {
  const auto begin = std::chrono::steady_clock::now();
  if (!target_.handle() || begin - last_ < std::chrono::milliseconds(100)) return;
  while (std::chrono::steady_clock::now() - begin < std::chrono::seconds(1)) pass();
}

void BusyWork::pass() {
  if (!target_.handle()) return;
  device_.submitAndWait([&](VkCommandBuffer commands) {
    for (int i = 0; i < 10; ++i) record(commands);
  });
}

void BusyWork::record(VkCommandBuffer commands) {
  last_ = std::chrono::steady_clock::now();
  for (int i = 0; i < 300 && target_.handle(); ++i) {
    device_.vk().vkCmdFillBuffer(commands, target_.handle(), 0, VK_WHOLE_SIZE, 0);
    fullBarrier(device_, commands);
  }
}

} // namespace gpgp::host
