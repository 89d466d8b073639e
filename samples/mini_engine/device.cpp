// What the engine wants of a device beyond what gpgp could use.
#include "device.h"

namespace mini {
namespace {

gpgp::sdl2::DeviceInfo wanted(const DeviceOptions& options) {
  gpgp::sdl2::DeviceInfo info;
  info.application = "mini engine";
  info.device = options.name;
  info.validate = options.validate;
  info.instanceExtensions = options.instanceExtensions;
  if (options.swapchain) info.deviceExtensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  info.chooseFeatures = [](const VkPhysicalDeviceFeatures& offered, VkPhysicalDeviceFeatures& enabled) {
    // Indirect draws that begin at any instance.
    if (!offered.drawIndirectFirstInstance) throw std::runtime_error("the device lacks drawIndirectFirstInstance");
    enabled.drawIndirectFirstInstance = VK_TRUE;
  };
  return info;
}

} // namespace

Device::Device(const DeviceOptions& options) : gpgp::sdl2::Device(wanted(options)) {}

void Device::runOnce(const std::function<void(VkCommandBuffer)>& record) {
  VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  poolInfo.queueFamilyIndex = family;
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device, &poolInfo, nullptr, &pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = pool;
  allocate.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device, &allocate, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  record(commands);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  check(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
  vkDestroyCommandPool(device, pool, nullptr);
}

} // namespace mini
