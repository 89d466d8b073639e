#include "frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace mini {
namespace {

using Texel = std::array<uint8_t, 4>;

/// Brass around dark steel: rivets in the corners, studs along the sides, a weave in the middle.
Texel texelAt(uint32_t x, uint32_t y) {
  constexpr float kSide = FramePicture::kSide, kBorder = FramePicture::kBorder;
  const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
  const float fromEdge = std::min(std::min(px, kSide - px), std::min(py, kSide - py));
  const auto texel = [](float red, float green, float blue, float light) {
    const auto byte = [&](float value) { return static_cast<uint8_t>(std::clamp(value * light, 0.0f, 255.0f)); };
    return Texel{byte(red), byte(green), byte(blue), 250};
  };
  if (fromEdge > kBorder) return texel(18, 38, 52, (x / 2 + y / 2) % 2 ? 1.0f : 0.86f);
  // The nearest rivet or stud: on the middle line of the border, lit from the upper left.
  const auto centre = [&](float p) {
    return p < kBorder ? kBorder / 2 : p > kSide - kBorder ? kSide - kBorder / 2 : kSide / 2;
  };
  const float dx = px - centre(px), dy = py - centre(py), distance = std::hypot(dx, dy);
  const bool corner = centre(px) != kSide / 2 && centre(py) != kSide / 2;
  const float radius = corner ? 3.6f : 2.1f;
  if (distance < radius) return texel(255, 214, 138, 1.0f - 0.25f * (dx + dy) / radius);
  if (distance < radius + 1) return texel(70, 46, 16, 1.0f);
  if (fromEdge < 1 || fromEdge > kBorder - 1) return texel(52, 34, 12, 1.0f);
  return texel(196, 142, 62, 1.15f - 0.45f * std::abs(fromEdge - kBorder / 2) / (kBorder / 2));
}

} // namespace

FramePicture::FramePicture(Device& device)
    : device_(device), image_(device, VK_FORMAT_R8G8B8A8_SRGB, {kSide, kSide},
                              VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_SAMPLE_COUNT_1_BIT,
                              VK_IMAGE_ASPECT_COLOR_BIT) {
  const Buffer staging(device, VkDeviceSize{kSide} * kSide * sizeof(Texel), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, true);
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x) {
      const Texel texel = texelAt(x, y);
      std::memcpy(static_cast<uint8_t*>(staging.mapped) + (size_t{y} * kSide + x) * sizeof texel, texel.data(),
                  sizeof texel);
    }
  device.runOnce([&](VkCommandBuffer commands) {
    VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image_.handle;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0,
                         nullptr, 1, &barrier);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {kSide, kSide, 1};
    vkCmdCopyBufferToImage(commands, staging.handle, image_.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 0, nullptr,
                         0, nullptr, 1, &barrier);
  });
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  check(vkCreateSampler(device.device, &info, nullptr, &recorder_), "vkCreateSampler");
}

FramePicture::~FramePicture() { vkDestroySampler(device_.device, recorder_, nullptr); }

} // namespace mini
