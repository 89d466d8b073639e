// A ring of frames. `safe` is the number before the oldest frame that may still run: exact, never guessed.
#include "host/frames.h"

#include <algorithm>

namespace gpgp::host {

FrameRing::FrameRing(HeadlessDevice& device, const Queue& queue, uint32_t framesInFlight)
    : device_(device), queue_(queue), slots_(std::max(framesInFlight, 1u)) {
  const VolkDeviceTable& vk = device.vk();
  try {
    for (Slot& slot : slots_) {
      VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
      pool.queueFamilyIndex = queue.family;
      check(vk.vkCreateCommandPool(device.device(), &pool, nullptr, &slot.pool), "vkCreateCommandPool");
      VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
      allocate.commandPool = slot.pool;
      allocate.commandBufferCount = 1;
      check(vk.vkAllocateCommandBuffers(device.device(), &allocate, &slot.commands), "vkAllocateCommandBuffers");
      VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
      check(vk.vkCreateFence(device.device(), &fence, nullptr, &slot.fence), "vkCreateFence");
    }
  } catch (...) {
    destroy();
    throw;
  }
}

FrameRing::~FrameRing() { destroy(); }

void FrameRing::destroy() noexcept {
  const VolkDeviceTable& vk = device_.vk();
  for (Slot& slot : slots_) {
    if (slot.pending) vk.vkWaitForFences(device_.device(), 1, &slot.fence, VK_TRUE, UINT64_MAX);
    vk.vkDestroyFence(device_.device(), slot.fence, nullptr);
    vk.vkDestroyCommandPool(device_.device(), slot.pool, nullptr);
  }
}

void FrameRing::wait(Slot& slot) {
  if (!slot.pending) return;
  check(device_.vk().vkWaitForFences(device_.device(), 1, &slot.fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  check(device_.vk().vkResetFences(device_.device(), 1, &slot.fence), "vkResetFences");
  slot.pending = false;
}

VkCommandBuffer FrameRing::begin() {
  const VolkDeviceTable& vk = device_.vk();
  ++frame_.current;
  Slot& slot = slots_[frame_.current % slots_.size()];
  wait(slot);
  uint64_t oldestPending = frame_.current;
  for (const Slot& other : slots_)
    if (other.pending) oldestPending = std::min(oldestPending, other.number);
  frame_.safe = oldestPending - 1;
  slot.number = frame_.current;
  check(vk.vkResetCommandPool(device_.device(), slot.pool, 0), "vkResetCommandPool");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vk.vkBeginCommandBuffer(slot.commands, &begin), "vkBeginCommandBuffer");
  return slot.commands;
}

void FrameRing::submit() {
  const VolkDeviceTable& vk = device_.vk();
  Slot& slot = slots_[frame_.current % slots_.size()];
  check(vk.vkEndCommandBuffer(slot.commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &slot.commands;
  check(vk.vkQueueSubmit(queue_.queue, 1, &submit, slot.fence), "vkQueueSubmit");
  slot.pending = true;
}

void FrameRing::drop() {
  Slot& slot = slots_[frame_.current % slots_.size()];
  check(device_.vk().vkEndCommandBuffer(slot.commands), "vkEndCommandBuffer");
}

void FrameRing::waitAll() {
  for (Slot& slot : slots_) wait(slot);
  frame_.safe = frame_.current;
}

} // namespace gpgp::host
