#include "picture.h"

namespace gpgp::qt {

VkResult Picture::create(QVulkanInstance& instance, VkPhysicalDevice physicalDevice, VkDevice device, QSize size) {
  functions_ = instance.deviceFunctions(device);
  device_ = device;
  size_ = size;
  cleared_ = false;
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R8G8B8A8_UNORM; // which Qt takes a native texture for
  info.extent = {static_cast<uint32_t>(size.width()), static_cast<uint32_t>(size.height()), 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
               VK_IMAGE_USAGE_TRANSFER_SRC_BIT; // read back by QQuickItem::grabToImage and effects
  VkResult result = functions_->vkCreateImage(device, &info, nullptr, &image_);
  if (result == VK_SUCCESS) {
    VkMemoryRequirements needs{};
    functions_->vkGetImageMemoryRequirements(device, image_, &needs);
    VkPhysicalDeviceMemoryProperties memory{};
    instance.functions()->vkGetPhysicalDeviceMemoryProperties(physicalDevice, &memory);
    VkMemoryAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.allocationSize = needs.size;
    result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    for (uint32_t i = memory.memoryTypeCount; i-- > 0;) // the first type of the device's own, else the first at all
      if ((needs.memoryTypeBits >> i & 1u) &&
          (result != VK_SUCCESS || (memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT))) {
        allocate.memoryTypeIndex = i;
        result = VK_SUCCESS;
      }
    if (result == VK_SUCCESS) result = functions_->vkAllocateMemory(device, &allocate, nullptr, &memory_);
  }
  if (result == VK_SUCCESS) result = functions_->vkBindImageMemory(device, image_, memory_, 0);
  if (result == VK_SUCCESS) {
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = info.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    result = functions_->vkCreateImageView(device, &view, nullptr, &view_);
  }
  if (result != VK_SUCCESS) destroy();
  return result;
}

void Picture::destroy() {
  if (!functions_) return;
  functions_->vkDestroyImageView(device_, view_, nullptr);
  functions_->vkDestroyImage(device_, image_, nullptr);
  functions_->vkFreeMemory(device_, memory_, nullptr);
  *this = {};
}

void Picture::recordClear(VkCommandBuffer commands) {
  if (cleared_ || !image_) return;
  cleared_ = true;
  VkImageMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image_;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  functions_->vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0,
                                   nullptr, 0, nullptr, 1, &barrier);
  const VkClearColorValue transparent{};
  functions_->vkCmdClearColorImage(commands, image_, barrier.newLayout, &transparent, 1, &barrier.subresourceRange);
  barrier.oldLayout = barrier.newLayout;
  barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  barrier.srcAccessMask = barrier.dstAccessMask;
  barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
  functions_->vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0,
                                   0, nullptr, 0, nullptr, 1, &barrier);
}

GpgpImage Picture::target() const {
  GpgpImage target{};
  target.image = image_;
  target.view = view_;
  target.format = VK_FORMAT_R8G8B8A8_UNORM;
  target.width = static_cast<uint32_t>(size_.width());
  target.height = static_cast<uint32_t>(size_.height());
  target.before = target.after = {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  return target;
}

} // namespace gpgp::qt
