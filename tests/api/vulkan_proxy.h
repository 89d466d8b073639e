// A vkGetInstanceProcAddr that stands between the library and Vulkan: logs every call the library makes, and can make
// the n-th creating call fail. One at a time per process; tests run one after the other.
#pragma once
#include "host/device.h"

#include <array>
#include <functional>
#include <string_view>
#include <vector>

namespace gpgp::test {

struct LoggedCall {
  std::string_view name;                                           ///< "vkCmdDispatch"
  VkPipelineBindPoint bindPoint = VK_PIPELINE_BIND_POINT_MAX_ENUM; ///< binding calls
  uint32_t firstSet = 0, setCount = 0;                             ///< vkCmdBindDescriptorSets
  VkPipelineStageFlags sourceStages = 0, targetStages = 0;         ///< vkCmdPipelineBarrier
  VkAccessFlags sourceAccess = 0, targetAccess = 0;                ///< of its memory barriers, united
  std::array<VkImageMemoryBarrier, 4> images = {};                 ///< of vkCmdPipelineBarrier
  uint32_t imageCount = 0;
};

class VulkanProxy {
public:
  explicit VulkanProxy(const host::HeadlessDevice& device);
  ~VulkanProxy();
  VulkanProxy(const VulkanProxy&) = delete;
  VulkanProxy& operator=(const VulkanProxy&) = delete;

  /// What to give to gpgp in place of the real one.
  static PFN_vkGetInstanceProcAddr getInstanceProcAddr();

  void clear() { calls.clear(); }
  /// Lets the n-th call (from 1) from now on that creates, allocates or can otherwise fail, and all after it, fail with
  /// the result; 0: none.
  void failCreation(uint32_t nth, VkResult with) { failAt = nth, failWith = with, creations = 0; }

  std::vector<LoggedCall> calls;
  std::function<void()> inNextCall; ///< called once, on the calling thread, inside the next call
  uint32_t failAt = 0, creations = 0;
  VkResult failWith = VK_ERROR_OUT_OF_DEVICE_MEMORY;

  PFN_vkGetInstanceProcAddr real = nullptr;
  PFN_vkGetDeviceProcAddr realDevice = nullptr;
};

} // namespace gpgp::test
