// What tests of integrations draw on: a device under the validation layer, a context whose messages are kept, and an
// image with memory that its pixels are copied to.
#pragma once
#include "gpgp_sdl2.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gpgp::test {

struct Stage {
  const VkFormat format;
  const uint32_t width, height;
  sdl2::Device device;
  sdl2::Frames frames{device, 2};
  Context context;
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  void* mapped = nullptr; ///< the buffer's memory
  std::vector<std::string> messages;

  Stage(VkFormat f, uint32_t w, uint32_t h, VkImageUsageFlags usage)
      : format(f), width(w), height(h), device(validated()) {
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.label = "integration test";
    info.maxFramesInFlight = 2;
    info.messageUserData = &messages;
    info.messageFn = [](void* user, const GpgpMessage* m) {
      static_cast<std::vector<std::string>*>(user)->push_back(std::string(m->function) + ": " + m->text);
    };
    context = *Context::create(info);
    makeImage(usage);
    makeBuffer();
  }
  ~Stage() {
    vkDeviceWaitIdle(device.device);
    context.reset();
    vkDestroyImageView(device.device, view, nullptr);
    vkDestroyImage(device.device, image, nullptr);
    vkDestroyBuffer(device.device, buffer, nullptr);
    vkFreeMemory(device.device, imageMemory_, nullptr);
    vkFreeMemory(device.device, bufferMemory_, nullptr);
    EXPECT_EQ(device.validationMessages(), 0u);
  }
  Stage(const Stage&) = delete;

private:
  static sdl2::DeviceInfo validated() {
    sdl2::DeviceInfo info;
    info.validate = true;
    return info;
  }
  VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags) const {
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = needs.size;
    info.memoryTypeIndex = device.memoryType(needs.memoryTypeBits, flags);
    VkDeviceMemory made = VK_NULL_HANDLE;
    sdl2::check(vkAllocateMemory(device.device, &info, nullptr, &made), "memory");
    return made;
  }
  void makeImage(VkImageUsageFlags usage) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {width, height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    sdl2::check(vkCreateImage(device.device, &info, nullptr, &image), "image");
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device.device, image, &needs);
    imageMemory_ = allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    vkBindImageMemory(device.device, image, imageMemory_, 0);
    VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    viewInfo.image = image;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = format;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    sdl2::check(vkCreateImageView(device.device, &viewInfo, nullptr, &view), "view");
  }
  void makeBuffer() {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = VkDeviceSize{width} * height * 4;
    info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    sdl2::check(vkCreateBuffer(device.device, &info, nullptr, &buffer), "buffer");
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device.device, buffer, &needs);
    bufferMemory_ = allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    vkBindBufferMemory(device.device, buffer, bufferMemory_, 0);
    sdl2::check(vkMapMemory(device.device, bufferMemory_, 0, VK_WHOLE_SIZE, 0, &mapped), "map");
  }
  VkDeviceMemory imageMemory_ = VK_NULL_HANDLE, bufferMemory_ = VK_NULL_HANDLE;
};

/// With a pass that clears the image and draws into it.
struct PassStage : Stage {
  VkRenderPass pass = VK_NULL_HANDLE;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;

  PassStage(VkFormat f, uint32_t w, uint32_t h, VkImageUsageFlags usage) : Stage(f, w, h, usage) {
    makePass();
    makeFramebuffer();
  }
  ~PassStage() {
    vkDeviceWaitIdle(device.device);
    vkDestroyFramebuffer(device.device, framebuffer, nullptr);
    vkDestroyRenderPass(device.device, pass, nullptr);
  }

private:
  void makePass() {
    VkAttachmentDescription attachment{};
    attachment.format = format;
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    VkSubpassDependency dependencies[2]{};
    dependencies[0].srcSubpass = dependencies[1].dstSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[0].srcStageMask = dependencies[1].dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
    dependencies[0].dstStageMask = dependencies[1].srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    dependencies[0].dstAccessMask = dependencies[1].srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[1].dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    info.attachmentCount = info.subpassCount = 1;
    info.pAttachments = &attachment;
    info.pSubpasses = &subpass;
    info.dependencyCount = 2;
    info.pDependencies = dependencies;
    sdl2::check(vkCreateRenderPass(device.device, &info, nullptr, &pass), "render pass");
  }
  void makeFramebuffer() {
    VkFramebufferCreateInfo framebufferInfo{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    framebufferInfo.renderPass = pass;
    framebufferInfo.attachmentCount = 1;
    framebufferInfo.pAttachments = &view;
    framebufferInfo.width = width;
    framebufferInfo.height = height;
    framebufferInfo.layers = 1;
    sdl2::check(vkCreateFramebuffer(device.device, &framebufferInfo, nullptr, &framebuffer), "framebuffer");
  }
};

} // namespace gpgp::test
