// Buffers and images: created, bound to memory, freed.
#include "device.h"

#include <cstring>
#include <utility>

namespace mini {
namespace {

VkDeviceMemory allocate(Device& device, const VkMemoryRequirements& needs, bool hostVisible) {
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = needs.size;
  info.memoryTypeIndex =
      hostVisible ? device.memoryType(needs.memoryTypeBits,
                                      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                                      VK_MEMORY_PROPERTY_HOST_CACHED_BIT)
                  : device.memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  check(vkAllocateMemory(device.device, &info, nullptr, &memory), "vkAllocateMemory");
  return memory;
}

} // namespace

Buffer::Buffer(Device& device, VkDeviceSize bytes, VkBufferUsageFlags usage, bool hostVisible)
    : size(bytes), device_(&device) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = usage;
  check(vkCreateBuffer(device.device, &info, nullptr, &handle), "vkCreateBuffer");
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device.device, handle, &needs);
  memory_ = allocate(device, needs, hostVisible);
  check(vkBindBufferMemory(device.device, handle, memory_, 0), "vkBindBufferMemory");
  if (hostVisible) check(vkMapMemory(device.device, memory_, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
}

Buffer::Buffer(Device& device, const void* bytes, VkDeviceSize count, VkBufferUsageFlags usage)
    : Buffer(device, count, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  const Buffer staging(device, count, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, true);
  std::memcpy(staging.mapped, bytes, count);
  device.runOnce([&](VkCommandBuffer commands) {
    const VkBufferCopy copy{0, 0, count};
    vkCmdCopyBuffer(commands, staging.handle, handle, 1, &copy);
  }); // the wait in there makes the bytes visible to everything submitted later
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(handle, other.handle);
  std::swap(size, other.size);
  std::swap(mapped, other.mapped);
  std::swap(device_, other.device_);
  std::swap(memory_, other.memory_);
  return *this;
}

Buffer::~Buffer() {
  if (!device_) return;
  vkDestroyBuffer(device_->device, handle, nullptr);
  vkFreeMemory(device_->device, memory_, nullptr);
}

GpgpBuffer Buffer::forGpgp(const GpgpAccess& before, const GpgpAccess& after) const {
  GpgpBuffer result{};
  result.buffer = handle;
  result.size = size;
  result.before = before;
  result.after = after;
  return result;
}

Image::Image(Device& device, VkFormat format, VkExtent2D extent, VkImageUsageFlags usage, VkSampleCountFlagBits samples,
             VkImageAspectFlags aspect)
    : device_(&device) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {extent.width, extent.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = 1;
  info.samples = samples;
  info.usage = usage;
  check(vkCreateImage(device.device, &info, nullptr, &handle), "vkCreateImage");
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device.device, handle, &needs);
  memory_ = allocate(device, needs, false);
  check(vkBindImageMemory(device.device, handle, memory_, 0), "vkBindImageMemory");
  VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  viewInfo.image = handle;
  viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
  viewInfo.format = format;
  viewInfo.subresourceRange = {aspect, 0, 1, 0, 1};
  check(vkCreateImageView(device.device, &viewInfo, nullptr, &view), "vkCreateImageView");
}

Image& Image::operator=(Image&& other) noexcept {
  std::swap(handle, other.handle);
  std::swap(view, other.view);
  std::swap(device_, other.device_);
  std::swap(memory_, other.memory_);
  return *this;
}

Image::~Image() {
  if (!device_) return;
  vkDestroyImageView(device_->device, view, nullptr);
  vkDestroyImage(device_->device, handle, nullptr);
  vkFreeMemory(device_->device, memory_, nullptr);
}

} // namespace mini
