// The image that a canvas is drawn into and Qt samples.
#pragma once
#include <gpgp/core.h>

#include <QtCore/QSize>
#include <QtGui/QVulkanFunctions>
#include <QtGui/QVulkanInstance>

namespace gpgp::qt {

/// RGBA8, transparent once recordClear was executed. The owner sees to it that no frame in flight uses what is
/// destroyed.
class Picture {
public:
  Picture() = default;
  /// VK_SUCCESS, or what failed; then nothing is there.
  VkResult create(QVulkanInstance& instance, VkPhysicalDevice physicalDevice, VkDevice device, QSize size);
  void destroy();

  VkImage image() const { return image_; }
  QSize size() const { return size_; }
  /// First use: clears it and makes it ready to be sampled. Later: nothing. @pass outside
  void recordClear(VkCommandBuffer commands);
  bool cleared() const { return cleared_; }
  /// For GpgpCanvasInfo::target: sampled by Qt before and after.
  GpgpImage target() const;

private:
  QVulkanDeviceFunctions* functions_ = nullptr;
  VkDevice device_ = VK_NULL_HANDLE;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  QSize size_;
  bool cleared_ = false;
};

} // namespace gpgp::qt
