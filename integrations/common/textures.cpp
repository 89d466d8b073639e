#include "gpgp_textures.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace gpgp::integration {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkImageSubresourceRange kColor{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
constexpr VkImageSubresourceLayers kColorLayer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

void barrier(VkCommandBuffer commands, VkImage image, bool filled) {
  VkImageMemoryBarrier change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  change.srcAccessMask = filled ? VK_ACCESS_TRANSFER_WRITE_BIT : 0;
  change.dstAccessMask = filled ? VK_ACCESS_SHADER_READ_BIT : VK_ACCESS_TRANSFER_WRITE_BIT;
  change.oldLayout = filled ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED;
  change.newLayout = filled ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  change.image = image;
  change.subresourceRange = kColor;
  vkCmdPipelineBarrier(commands, filled ? VK_PIPELINE_STAGE_TRANSFER_BIT : VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                       filled ? VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT : VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0,
                       nullptr, 1, &change);
}

} // namespace

Textures::Textures(VkPhysicalDevice physical, VkDevice device) : device_(device) {
  vkGetPhysicalDeviceMemoryProperties(physical, &memory_);
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  maxSide_ = properties.limits.maxImageDimension2D;
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = VK_SAMPLER_ADDRESS_MODE_REPEAT; // as toolkits want it
  if (vkCreateSampler(device, &info, nullptr, &sampler_) < 0) throw std::runtime_error("vkCreateSampler failed");
}

Textures::~Textures() {
  for (const Dead<Target>& dead : images_) destroy(dead.what);
  for (const Dead<Staging>& dead : stagings_) destroy(dead.what);
  vkDestroySampler(device_, sampler_, nullptr);
}

TexturePointer Textures::make(uint32_t width, uint32_t height, std::vector<uint8_t> pixels) {
  const TexturePointer made(new Texture, [this](Texture* texture) {
    if (texture->image) images_.push_back({{texture->image, texture->memory, texture->view}, frame_});
    delete texture;
  });
  made->width = width;
  made->height = height;
  made->pixels = std::move(pixels);
  if (!made->pixels.empty()) waiting_.push_back(made);
  return made;
}

void Textures::advance(const GpgpFrame& frame) {
  frame_ = frame.current;
  const auto sweep = [&](auto& all) {
    std::erase_if(all, [&](const auto& dead) {
      if (dead.frame > frame.safe) return false;
      destroy(dead.what);
      return true;
    });
  };
  sweep(images_);
  sweep(stagings_);
}

bool Textures::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags, VkDeviceMemory& memory) const {
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = needs.size;
  for (uint32_t type = 0; type < memory_.memoryTypeCount; ++type) {
    if (!(needs.memoryTypeBits >> type & 1u) || (memory_.memoryTypes[type].propertyFlags & flags) != flags) continue;
    info.memoryTypeIndex = type;
    return vkAllocateMemory(device_, &info, nullptr, &memory) == VK_SUCCESS;
  }
  return false;
}

bool Textures::makeImage(uint32_t width, uint32_t height, VkImageUsageFlags usage, Target& target) const {
  if (width > maxSide_ || height > maxSide_) return false;
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = kFormat;
  info.extent = {width, height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage;
  if (vkCreateImage(device_, &info, nullptr, &target.image) < 0) return false;
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device_, target.image, &needs);
  if (!allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, target.memory)) return false;
  if (vkBindImageMemory(device_, target.image, target.memory, 0) < 0) return false;
  VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  viewInfo.image = target.image;
  viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
  viewInfo.format = kFormat;
  viewInfo.subresourceRange = kColor;
  return vkCreateImageView(device_, &viewInfo, nullptr, &target.view) == VK_SUCCESS;
}

bool Textures::makeTarget(uint32_t width, uint32_t height, Target& target) const {
  if (makeImage(width, height, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, target)) return true;
  destroy(target);
  target = {};
  return false;
}

void Textures::destroy(const Target& target) const {
  vkDestroyImageView(device_, target.view, nullptr);
  vkDestroyImage(device_, target.image, nullptr);
  vkFreeMemory(device_, target.memory, nullptr);
}

void Textures::destroy(const Staging& staging) const {
  vkDestroyBuffer(device_, staging.buffer, nullptr);
  vkFreeMemory(device_, staging.memory, nullptr);
}

bool Textures::recordUpload(VkCommandBuffer commands, uint32_t& count) {
  count = 0;
  std::vector<TexturePointer> now;
  VkDeviceSize bytes = 0;
  bool well = true;
  for (const std::weak_ptr<Texture>& weak : waiting_) {
    TexturePointer texture = weak.lock();
    if (!texture) continue;
    Target made;
    if (!makeImage(texture->width, texture->height, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                   made)) {
      destroy(made);
      texture->broken = true;
      texture->pixels = {};
      well = false;
      continue;
    }
    texture->image = made.image;
    texture->memory = made.memory;
    texture->view = made.view;
    bytes += texture->pixels.size();
    now.push_back(std::move(texture));
  }
  waiting_.clear();
  if (now.empty()) return well;

  Staging staging;
  void* mapped = nullptr;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  VkMemoryRequirements needs{};
  bool staged = vkCreateBuffer(device_, &info, nullptr, &staging.buffer) == VK_SUCCESS;
  if (staged) {
    vkGetBufferMemoryRequirements(device_, staging.buffer, &needs);
    staged =
        allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, staging.memory) &&
        vkBindBufferMemory(device_, staging.buffer, staging.memory, 0) == VK_SUCCESS &&
        vkMapMemory(device_, staging.memory, 0, VK_WHOLE_SIZE, 0, &mapped) == VK_SUCCESS;
  }
  stagings_.push_back({staging, frame_});
  VkDeviceSize offset = 0;
  for (const TexturePointer& texture : now) {
    texture->broken = !staged;
    if (staged) {
      std::memcpy(static_cast<uint8_t*>(mapped) + offset, texture->pixels.data(), texture->pixels.size());
      barrier(commands, texture->image, false);
      VkBufferImageCopy copy{};
      copy.bufferOffset = offset;
      copy.imageSubresource = kColorLayer;
      copy.imageExtent = {texture->width, texture->height, 1};
      vkCmdCopyBufferToImage(commands, staging.buffer, texture->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
      barrier(commands, texture->image, true);
      offset += texture->pixels.size();
      texture->filled = true;
      ++count;
    }
    texture->pixels = {};
  }
  return well && staged;
}

bool Textures::recordCopy(VkCommandBuffer commands, VkImage from, uint32_t x, uint32_t y, Texture& texture) {
  Target made;
  if (!makeImage(texture.width, texture.height, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, made)) {
    destroy(made);
    texture.broken = true;
    return false;
  }
  texture.image = made.image;
  texture.memory = made.memory;
  texture.view = made.view;
  barrier(commands, texture.image, false);
  VkImageCopy copy{};
  copy.srcSubresource = copy.dstSubresource = kColorLayer;
  copy.srcOffset = {static_cast<int32_t>(x), static_cast<int32_t>(y), 0};
  copy.extent = {texture.width, texture.height, 1};
  vkCmdCopyImage(commands, from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, texture.image,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
  barrier(commands, texture.image, true);
  texture.filled = true;
  return true;
}

GpgpCanvasImage Textures::image(const Texture& texture, GpgpImageEncoding encoding) const {
  return {texture.view, sampler_, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
          VK_TRUE,      encoding, GPGP_IMAGE_FILTER_LINEAR};
}

} // namespace gpgp::integration
