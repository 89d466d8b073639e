// Frames in flight as an engine has them: a command buffer and a fence each, and the numbers gpgp wants to be told.
#pragma once
#include "host/device.h"

namespace gpgp::host {

/// begin() ... record ... submit() or drop(), over and over. Frame numbers start at 1 and only grow.
class FrameRing {
public:
  FrameRing(HeadlessDevice& device, uint32_t framesInFlight = 3)
      : FrameRing(device, device.graphics(), framesInFlight) {}
  FrameRing(HeadlessDevice& device, const Queue& queue, uint32_t framesInFlight = 3);
  ~FrameRing(); ///< waits for all frames
  FrameRing(const FrameRing&) = delete;
  FrameRing& operator=(const FrameRing&) = delete;

  /// Waits until a slot is free and begins its command buffer. frame() is this frame's from here on.
  VkCommandBuffer begin();
  const GpgpFrame& frame() const { return frame_; }
  /// Ends and submits what was recorded.
  void submit();
  /// Throws away what was recorded, as an engine does when its window is resized.
  void drop();
  /// Waits for all submitted frames; frame().safe is then the last number.
  void waitAll();
  const Queue& queue() const { return queue_; }

private:
  struct Slot {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    uint64_t number = 0; // 0: never used
    bool pending = false;
  };
  void wait(Slot& slot);
  void destroy() noexcept;
  HeadlessDevice& device_;
  Queue queue_;
  std::vector<Slot> slots_;
  GpgpFrame frame_{};
};

} // namespace gpgp::host
