// The images of a window, and what draws into them and reads them back.
#include "gpgp_device.hpp"

#include <algorithm>
#include <fstream>
#include <utility>

namespace gpgp::integration {

Window::~Window() = default;

Swapchain::Swapchain(Device& device, const Window& window, const SwapchainInfo& info)
    : device_(device), window_(window), info_(info), surface_(window.createSurface(device.instance)) {
  VkBool32 canPresent = VK_FALSE;
  check(vkGetPhysicalDeviceSurfaceSupportKHR(device.physical, device.family, surface_, &canPresent), "surface support");
  if (!canPresent) throw std::runtime_error("the device cannot present to this window");
  uint32_t count = 0;
  check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface_, &count, nullptr), "surface formats");
  std::vector<VkSurfaceFormatKHR> formats(count);
  check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface_, &count, formats.data()), "surface formats");
  const VkFormat bgra = info.srgb ? VK_FORMAT_B8G8R8A8_SRGB : VK_FORMAT_B8G8R8A8_UNORM;
  const VkFormat rgba = info.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  const auto wanted = std::find_if(formats.begin(), formats.end(),
                                   [&](const VkSurfaceFormatKHR& f) { return f.format == bgra || f.format == rgba; });
  if (wanted == formats.end())
    throw std::runtime_error(info.srgb ? "the window offers no sRGB format" : "the window offers no 8-bit format");
  format_ = *wanted;
  window.limitSize(info_.maxExtent); // a surface that is larger than its swapchain is an error in most window systems
  resize();
}

Swapchain::~Swapchain() {
  vkDeviceWaitIdle(device_.device);
  destroyImages();
  for (VkSemaphore semaphore : available_) vkDestroySemaphore(device_.device, semaphore, nullptr);
  vkDestroySwapchainKHR(device_.device, swapchain_, nullptr);
  vkDestroySurfaceKHR(device_.instance, surface_, nullptr);
}

void Swapchain::destroyImages() noexcept {
  for (const Image& image : images_) {
    vkDestroySemaphore(device_.device, image.rendered, nullptr);
    vkDestroyImageView(device_.device, image.view, nullptr);
  }
  images_.clear();
}

void Swapchain::resize() {
  check(vkDeviceWaitIdle(device_.device), "vkDeviceWaitIdle");
  VkSurfaceCapabilitiesKHR can{};
  check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical, surface_, &can), "surface capabilities");
  extent_ = can.currentExtent;
  if (extent_.width == UINT32_MAX) extent_ = window_.drawableSize(); // the surface follows the swapchain
  extent_ = {std::clamp(extent_.width, 1u, info_.maxExtent.width),
             std::clamp(extent_.height, 1u, info_.maxExtent.height)};
  canBeRead_ = (can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0;
  VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
  info.surface = surface_;
  info.minImageCount = can.maxImageCount ? std::min(can.minImageCount + 1, can.maxImageCount) : can.minImageCount + 1;
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent_;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (canBeRead_) info.imageUsage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  info.preTransform = can.currentTransform;
  info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain_;
  VkSwapchainKHR old = swapchain_;
  check(vkCreateSwapchainKHR(device_.device, &info, nullptr, &swapchain_), "vkCreateSwapchainKHR");
  destroyImages();
  vkDestroySwapchainKHR(device_.device, old, nullptr);
  uint32_t count = 0;
  check(vkGetSwapchainImagesKHR(device_.device, swapchain_, &count, nullptr), "vkGetSwapchainImagesKHR");
  std::vector<VkImage> all(count);
  check(vkGetSwapchainImagesKHR(device_.device, swapchain_, &count, all.data()), "vkGetSwapchainImagesKHR");
  for (VkImage handle : all) {
    Image& image = images_.emplace_back();
    image.image = handle;
    VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    viewInfo.image = handle;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = format_.format;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    check(vkCreateImageView(device_.device, &viewInfo, nullptr, &image.view), "vkCreateImageView");
    VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    check(vkCreateSemaphore(device_.device, &semaphore, nullptr, &image.rendered), "vkCreateSemaphore");
  }
}

std::optional<Swapchain::Acquired> Swapchain::acquire(uint32_t slot) {
  while (available_.size() <= slot) {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore made = VK_NULL_HANDLE;
    check(vkCreateSemaphore(device_.device, &info, nullptr, &made), "vkCreateSemaphore");
    available_.push_back(made);
  }
  Acquired acquired;
  acquired.available = available_[slot];
  const VkResult result = vkAcquireNextImageKHR(device_.device, swapchain_, UINT64_MAX, acquired.available,
                                                VK_NULL_HANDLE, &acquired.index);
  if (result == VK_ERROR_OUT_OF_DATE_KHR) return std::nullopt;
  check(result, "vkAcquireNextImageKHR");
  return acquired;
}

void Swapchain::present(const Acquired& acquired) {
  VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &images_[acquired.index].rendered;
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain_;
  info.pImageIndices = &acquired.index;
  const VkResult result = vkQueuePresentKHR(device_.queue, &info);
  if (result != VK_ERROR_OUT_OF_DATE_KHR) check(result, "vkQueuePresentKHR"); // the next acquire says so again
}

ColorPass::ColorPass(Device& device, const Swapchain& swapchain) : device_(device), swapchain_(swapchain) {
  VkAttachmentDescription attachment{};
  attachment.format = swapchain.format();
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  attachment.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &color;
  VkSubpassDependency dependencies[2]{};
  dependencies[0].srcSubpass = VK_SUBPASS_EXTERNAL; // after the semaphore that says the image is available
  dependencies[0].srcStageMask = dependencies[0].dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  dependencies[0].dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
  dependencies[1].dstSubpass = VK_SUBPASS_EXTERNAL; // before a screenshot
  dependencies[1].srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  dependencies[1].srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
  dependencies[1].dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
  dependencies[1].dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = 1;
  info.pAttachments = &attachment;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 2;
  info.pDependencies = dependencies;
  check(vkCreateRenderPass(device.device, &info, nullptr, &renderPass_), "vkCreateRenderPass");
  attach();
}

ColorPass::~ColorPass() {
  vkDeviceWaitIdle(device_.device);
  destroyFramebuffers();
  vkDestroyRenderPass(device_.device, renderPass_, nullptr);
}

void ColorPass::destroyFramebuffers() noexcept {
  for (VkFramebuffer framebuffer : framebuffers_) vkDestroyFramebuffer(device_.device, framebuffer, nullptr);
  framebuffers_.clear();
}

void ColorPass::attach() {
  destroyFramebuffers();
  for (const Swapchain::Image& image : swapchain_.images()) {
    VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    info.renderPass = renderPass_;
    info.attachmentCount = 1;
    info.pAttachments = &image.view;
    info.width = swapchain_.extent().width;
    info.height = swapchain_.extent().height;
    info.layers = 1;
    check(vkCreateFramebuffer(device_.device, &info, nullptr, &framebuffers_.emplace_back()), "vkCreateFramebuffer");
  }
}

void ColorPass::begin(VkCommandBuffer commands, uint32_t image, const float (&clear)[4]) const {
  VkClearValue value{};
  std::copy(std::begin(clear), std::end(clear), value.color.float32);
  VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  info.renderPass = renderPass_;
  info.framebuffer = framebuffers_[image];
  info.renderArea.extent = swapchain_.extent();
  info.clearValueCount = 1;
  info.pClearValues = &value;
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  const VkViewport viewport{
      0, 0, static_cast<float>(swapchain_.extent().width), static_cast<float>(swapchain_.extent().height), 0, 1};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &info.renderArea);
}

Screenshot::Screenshot(Device& device, const Swapchain& swapchain)
    : device_(device), swapchain_(swapchain), extent_(swapchain.extent()) {
  if (!swapchain.canBeRead()) throw std::runtime_error("this window's images cannot be read");
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = VkDeviceSize{extent_.width} * extent_.height * 4;
  info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  check(vkCreateBuffer(device.device, &info, nullptr, &buffer_), "vkCreateBuffer");
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device.device, buffer_, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = device.memoryType(
      needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
      VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
  check(vkAllocateMemory(device.device, &allocate, nullptr, &memory_), "vkAllocateMemory");
  check(vkBindBufferMemory(device.device, buffer_, memory_, 0), "vkBindBufferMemory");
  check(vkMapMemory(device.device, memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory");
}

Screenshot::~Screenshot() {
  vkDestroyBuffer(device_.device, buffer_, nullptr);
  vkFreeMemory(device_.device, memory_, nullptr);
}

void Screenshot::record(VkCommandBuffer commands, uint32_t image) {
  if (extent_.width != swapchain_.extent().width || extent_.height != swapchain_.extent().height)
    throw std::runtime_error("the window's size has changed since the screenshot was made ready");
  VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  barrier.oldLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = swapchain_.images()[image].image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {extent_.width, extent_.height, 1};
  vkCmdCopyImageToBuffer(commands, barrier.image, barrier.newLayout, buffer_, 1, &copy);
  std::swap(barrier.oldLayout, barrier.newLayout);
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  barrier.dstAccessMask = 0; // presenting waits for the semaphore
  VkMemoryBarrier toHost{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  toHost.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  toHost.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &toHost, 0, nullptr,
                       1, &barrier);
}

std::vector<uint8_t> Screenshot::rgba() const {
  const auto* from = static_cast<const uint8_t*>(mapped_);
  std::vector<uint8_t> pixels(from, from + size_t{extent_.width} * extent_.height * 4);
  const bool bgra = swapchain_.format() == VK_FORMAT_B8G8R8A8_SRGB || swapchain_.format() == VK_FORMAT_B8G8R8A8_UNORM;
  for (size_t i = 0; i < pixels.size(); i += 4) {
    if (bgra) std::swap(pixels[i], pixels[i + 2]);
    pixels[i + 3] = 255; // a window is opaque, whatever alpha says
  }
  return pixels;
}

void Screenshot::save(const std::string& file) const {
  const std::vector<uint8_t> pixels = rgba();
  std::vector<uint8_t> bytes; // BMP: file header, BITMAPINFOHEADER, then rows from the top as the height is negative
  const auto put = [&](uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<uint8_t>(value >> 8 * i));
  };
  constexpr uint32_t kHeaders = 14 + 40;
  const auto size = static_cast<uint32_t>(pixels.size());
  bytes.reserve(kHeaders + size);
  for (const auto& [value, count] : {std::pair{0x4D42u, 2},
                                     {kHeaders + size, 4},
                                     {0u, 4},
                                     {kHeaders, 4}, // file
                                     {40u, 4},
                                     {extent_.width, 4},
                                     {0u - extent_.height, 4},
                                     {1u, 2},
                                     {32u, 2},
                                     {0u, 4},
                                     {size, 4},
                                     {2835u, 4},
                                     {2835u, 4},
                                     {0u, 4},
                                     {0u, 4}})
    put(value, count);
  for (size_t i = 0; i < pixels.size(); i += 4)
    for (const size_t channel : {2, 1, 0, 3}) bytes.push_back(pixels[i + channel]);
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream.flush()) throw std::runtime_error("cannot write " + file);
}

} // namespace gpgp::integration
