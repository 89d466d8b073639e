// Pictures without a window, written as PNG.
#include "target.h"

namespace mini {

Offscreen::Offscreen(Device& device, VkExtent2D extent) : device_(device), extent_(extent) {
  for (Image& image : images_)
    image = Image(device, format(), extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                  VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
}

Offscreen::~Offscreen() { destroyFramebuffers(); }

void Offscreen::destroyFramebuffers() {
  for (VkFramebuffer& framebuffer : framebuffers_) vkDestroyFramebuffer(device_.device, framebuffer, nullptr);
}

void Offscreen::attach(Forward& forward) {
  destroyFramebuffers();
  forward.resize(extent_);
  for (size_t i = 0; i < 2; ++i) framebuffers_[i] = forward.makeFramebuffer(images_[i].view);
}

std::optional<Acquired> Offscreen::acquire(uint32_t) {
  return Acquired{0, framebuffers_[0], VK_NULL_HANDLE, VK_NULL_HANDLE};
}

void Offscreen::writeImage(uint32_t image, const std::string& file) {
  const VkDeviceSize bytes = VkDeviceSize{extent_.width} * extent_.height * 4;
  const Buffer pixels(device_, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, true);
  device_.runOnce([&](VkCommandBuffer commands) {
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {extent_.width, extent_.height, 1};
    vkCmdCopyImageToBuffer(commands, images_[image].handle, finalLayout(), pixels.handle, 1, &copy);
    VkMemoryBarrier toHost{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    toHost.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    toHost.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &toHost, 0,
                         nullptr, 0, nullptr);
  });
  writePng(file, extent_, pixels.mapped);
}

} // namespace mini
