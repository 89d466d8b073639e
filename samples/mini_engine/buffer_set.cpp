// Layout, pool and the one set in it.
#include "buffer_set.h"

namespace mini {

BufferSet::BufferSet(Device& device, const std::vector<const Buffer*>& buffers, VkShaderStageFlags stages)
    : device_(device) {
  const auto count = static_cast<uint32_t>(buffers.size());
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (uint32_t i = 0; i < count; ++i) bindings.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, stages, nullptr});
  VkDescriptorSetLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  layoutInfo.bindingCount = count;
  layoutInfo.pBindings = bindings.data();
  check(vkCreateDescriptorSetLayout(device.device, &layoutInfo, nullptr, &layout), "vkCreateDescriptorSetLayout");
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count};
  VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  poolInfo.maxSets = 1;
  poolInfo.poolSizeCount = 1;
  poolInfo.pPoolSizes = &size;
  check(vkCreateDescriptorPool(device.device, &poolInfo, nullptr, &pool_), "vkCreateDescriptorPool");
  VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocate.descriptorPool = pool_;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &layout;
  check(vkAllocateDescriptorSets(device.device, &allocate, &handle), "vkAllocateDescriptorSets");
  std::vector<VkDescriptorBufferInfo> infos;
  for (const Buffer* buffer : buffers) infos.push_back({buffer->handle, 0, VK_WHOLE_SIZE});
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = handle;
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.descriptorCount = 1;
  for (uint32_t i = 0; i < count; ++i) {
    write.dstBinding = i;
    write.pBufferInfo = &infos[i];
    vkUpdateDescriptorSets(device.device, 1, &write, 0, nullptr);
  }
}

BufferSet::~BufferSet() {
  vkDestroyDescriptorPool(device_.device, pool_, nullptr);
  vkDestroyDescriptorSetLayout(device_.device, layout, nullptr);
}

} // namespace mini
