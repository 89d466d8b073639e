// A descriptor set of storage buffers, numbered in their order, that never changes.
#pragma once
#include "device.h"

namespace mini {

class BufferSet {
public:
  BufferSet(Device& device, const std::vector<const Buffer*>& buffers, VkShaderStageFlags stages);
  ~BufferSet();
  BufferSet(const BufferSet&) = delete;
  BufferSet& operator=(const BufferSet&) = delete;

  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  VkDescriptorSet handle = VK_NULL_HANDLE;

private:
  Device& device_;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
};

} // namespace mini
