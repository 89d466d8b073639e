// Buffers and images, one allocation each; transfers go through a staging buffer and wait.
#include "host/memory.h"

#include <algorithm>
#include <utility>

namespace gpgp::host {
namespace {

VkDeviceMemory allocate(const HeadlessDevice& device, const VkMemoryRequirements& needs, Memory memory,
                        bool deviceAddress) {
  VkMemoryPropertyFlags required = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  VkMemoryPropertyFlags preferred = 0;
  if (memory == Memory::device) required = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  if (memory == Memory::readback) preferred = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  if (deviceAddress) info.pNext = &flags;
  info.allocationSize = needs.size;
  info.memoryTypeIndex = device.memoryType(needs.memoryTypeBits, required, preferred);
  VkDeviceMemory result = VK_NULL_HANDLE;
  check(device.vk().vkAllocateMemory(device.device(), &info, nullptr, &result), "vkAllocateMemory");
  return result;
}

} // namespace

Buffer::Buffer(HeadlessDevice& device, VkDeviceSize size, VkBufferUsageFlags usage, Memory memory,
               const std::string& name)
    : device_(&device), size_(size) {
  const VolkDeviceTable& vk = device.vk();
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = size;
  info.usage = usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  try {
    check(vk.vkCreateBuffer(device.device(), &info, nullptr, &handle_), "vkCreateBuffer");
    VkMemoryRequirements needs{};
    vk.vkGetBufferMemoryRequirements(device.device(), handle_, &needs);
    memory_ = allocate(device, needs, memory, (usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0);
    check(vk.vkBindBufferMemory(device.device(), handle_, memory_, 0), "vkBindBufferMemory");
    if (memory != Memory::device)
      check(vk.vkMapMemory(device.device(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory");
  } catch (...) {
    destroy();
    throw;
  }
  if (!name.empty()) device.setName(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(handle_), name);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  if (this == &other) return *this;
  destroy();
  device_ = std::exchange(other.device_, nullptr);
  handle_ = std::exchange(other.handle_, VK_NULL_HANDLE);
  memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
  size_ = std::exchange(other.size_, 0);
  mapped_ = std::exchange(other.mapped_, nullptr);
  return *this;
}

void Buffer::destroy() noexcept {
  if (!device_) return;
  device_->vk().vkDestroyBuffer(device_->device(), handle_, nullptr);
  device_->vk().vkFreeMemory(device_->device(), memory_, nullptr);
  device_ = nullptr;
}

GpgpBuffer Buffer::range(const GpgpAccess& before, const GpgpAccess& after, VkDeviceSize offset,
                         VkDeviceSize size) const {
  GpgpBuffer result{};
  result.buffer = handle_;
  result.offset = offset;
  result.size = size == VK_WHOLE_SIZE ? size_ - offset : size;
  result.before = before;
  result.after = after;
  return result;
}

Image::Image(HeadlessDevice& device, const ImageInfo& info, const std::string& name) : device_(&device), info_(info) {
  const VolkDeviceTable& vk = device.vk();
  VkImageCreateInfo create{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  create.imageType = VK_IMAGE_TYPE_2D;
  create.format = info.format;
  create.extent = {info.width, info.height, 1};
  create.mipLevels = info.levels;
  create.arrayLayers = info.layers;
  create.samples = info.samples;
  create.usage = info.usage;
  if (info.samples == VK_SAMPLE_COUNT_1_BIT)
    create.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  try {
    check(vk.vkCreateImage(device.device(), &create, nullptr, &handle_), "vkCreateImage");
    VkMemoryRequirements needs{};
    vk.vkGetImageMemoryRequirements(device.device(), handle_, &needs);
    memory_ = allocate(device, needs, Memory::device, false);
    check(vk.vkBindImageMemory(device.device(), handle_, memory_, 0), "vkBindImageMemory");
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = handle_;
    view.viewType = info.layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    view.format = info.format;
    view.subresourceRange = {aspect(), 0, info.levels, 0, info.layers};
    check(vk.vkCreateImageView(device.device(), &view, nullptr, &view_), "vkCreateImageView");
  } catch (...) {
    destroy();
    throw;
  }
  if (!name.empty()) device.setName(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(handle_), name);
}

Image& Image::operator=(Image&& other) noexcept {
  if (this == &other) return *this;
  destroy();
  device_ = std::exchange(other.device_, nullptr);
  handle_ = std::exchange(other.handle_, VK_NULL_HANDLE);
  view_ = std::exchange(other.view_, VK_NULL_HANDLE);
  memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
  info_ = other.info_;
  return *this;
}

void Image::destroy() noexcept {
  if (!device_) return;
  device_->vk().vkDestroyImageView(device_->device(), view_, nullptr);
  device_->vk().vkDestroyImage(device_->device(), handle_, nullptr);
  device_->vk().vkFreeMemory(device_->device(), memory_, nullptr);
  device_ = nullptr;
}

VkImageAspectFlags Image::aspect() const {
  switch (info_.format) {
  case VK_FORMAT_D32_SFLOAT:
  case VK_FORMAT_D16_UNORM: return VK_IMAGE_ASPECT_DEPTH_BIT;
  default: return VK_IMAGE_ASPECT_COLOR_BIT;
  }
}

GpgpImage Image::target(const GpgpAccess& before, const GpgpAccess& after) const {
  GpgpImage result{};
  result.image = handle_;
  result.view = view_;
  result.format = info_.format;
  result.width = info_.width;
  result.height = info_.height;
  result.before = before;
  result.after = after;
  return result;
}

uint32_t bytesPerPixel(VkFormat format) {
  switch (format) {
  case VK_FORMAT_R8_UNORM: return 1;
  case VK_FORMAT_D16_UNORM: return 2;
  case VK_FORMAT_R8G8B8A8_UNORM:
  case VK_FORMAT_R8G8B8A8_SRGB:
  case VK_FORMAT_B8G8R8A8_UNORM:
  case VK_FORMAT_B8G8R8A8_SRGB:
  case VK_FORMAT_R32_UINT:
  case VK_FORMAT_R32_SFLOAT:
  case VK_FORMAT_D32_SFLOAT: return 4;
  case VK_FORMAT_R16G16B16A16_SFLOAT:
  case VK_FORMAT_R32G32_UINT: return 8;
  case VK_FORMAT_R32G32B32A32_SFLOAT:
  case VK_FORMAT_R32G32B32A32_UINT: return 16;
  default: throw std::runtime_error("no pixel size known for format " + std::to_string(static_cast<int>(format)));
  }
}

void fullBarrier(const HeadlessDevice& device, VkCommandBuffer commands) {
  VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  // HOST is not part of ALL_COMMANDS; with it mapped memory can be read after the fence.
  device.vk().vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT,
                                   VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                                   nullptr, 0, nullptr);
}

void imageBarrier(const HeadlessDevice& device, VkCommandBuffer commands, const Image& image, VkImageLayout from,
                  VkImageLayout to) {
  VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image.handle();
  barrier.subresourceRange = {image.aspect(), 0, image.info().levels, 0, image.info().layers};
  device.vk().vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0,
                                   0, nullptr, 0, nullptr, 1, &barrier);
}

void uploadBytes(HeadlessDevice& device, const Buffer& buffer, const void* data, size_t size, VkDeviceSize offset) {
  if (size == 0) return;
  if (offset + size > buffer.size()) throw std::runtime_error("upload past the end of a buffer");
  if (buffer.mapped()) {
    std::memcpy(buffer.as<std::byte>() + offset, data, size);
    return;
  }
  const Buffer staging(device, size, 0, Memory::host);
  std::memcpy(staging.mapped(), data, size);
  device.submitAndWait([&](VkCommandBuffer commands) {
    fullBarrier(device, commands);
    const VkBufferCopy copy{0, offset, size};
    device.vk().vkCmdCopyBuffer(commands, staging.handle(), buffer.handle(), 1, &copy);
    fullBarrier(device, commands);
  });
}

void downloadBytes(HeadlessDevice& device, const Buffer& buffer, void* data, size_t size, VkDeviceSize offset) {
  if (size == 0) return;
  if (offset + size > buffer.size()) throw std::runtime_error("download past the end of a buffer");
  const Buffer staging(device, size, 0, Memory::readback);
  device.submitAndWait([&](VkCommandBuffer commands) {
    fullBarrier(device, commands);
    const VkBufferCopy copy{offset, 0, size};
    device.vk().vkCmdCopyBuffer(commands, buffer.handle(), staging.handle(), 1, &copy);
    fullBarrier(device, commands);
  });
  std::memcpy(data, staging.mapped(), size);
}

void fill(HeadlessDevice& device, const Buffer& buffer, uint32_t word) {
  device.submitAndWait([&](VkCommandBuffer commands) {
    fullBarrier(device, commands);
    device.vk().vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, word);
    fullBarrier(device, commands);
  });
}

void uploadImage(HeadlessDevice& device, const Image& image, std::span<const uint8_t> pixels, VkImageLayout layout) {
  const Buffer staging(device, pixels.size(), 0, Memory::host);
  std::memcpy(staging.mapped(), pixels.data(), pixels.size());
  device.submitAndWait([&](VkCommandBuffer commands) {
    imageBarrier(device, commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const ImageInfo& info = image.info();
    VkBufferImageCopy copy{};
    for (uint32_t level = 0; level < info.levels; ++level) {
      copy.imageSubresource = {image.aspect(), level, 0, 1};
      copy.imageExtent = {std::max(info.width >> level, 1u), std::max(info.height >> level, 1u), 1};
      device.vk().vkCmdCopyBufferToImage(commands, staging.handle(), image.handle(),
                                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
      copy.bufferOffset += VkDeviceSize{copy.imageExtent.width} * copy.imageExtent.height * bytesPerPixel(info.format);
    }
    imageBarrier(device, commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout);
  });
}

std::vector<uint8_t> downloadImage(HeadlessDevice& device, const Image& image, VkImageLayout layout) {
  const ImageInfo& info = image.info();
  const size_t size = size_t{info.width} * info.height * info.layers * bytesPerPixel(info.format);
  const Buffer staging(device, size, 0, Memory::readback);
  device.submitAndWait([&](VkCommandBuffer commands) {
    imageBarrier(device, commands, image, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {image.aspect(), 0, 0, info.layers};
    copy.imageExtent = {info.width, info.height, 1};
    device.vk().vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.handle(),
                                       1, &copy);
    const VkImageLayout back = layout == VK_IMAGE_LAYOUT_UNDEFINED ? VK_IMAGE_LAYOUT_GENERAL : layout;
    imageBarrier(device, commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, back);
    fullBarrier(device, commands);
  });
  const auto* bytes = staging.as<uint8_t>();
  return {bytes, bytes + size};
}

} // namespace gpgp::host
