// One compute shader over a few storage buffers, waited for.
#include "host/kernel.h"

#include <algorithm>

namespace gpgp::host {

ComputeKernel::ComputeKernel(HeadlessDevice& device, std::span<const uint32_t> spirv, uint32_t bufferCount,
                             uint32_t pushBytes)
    : device_(device), bufferCount_(bufferCount), pushBytes_(pushBytes) {
  const VolkDeviceTable& vk = device.vk();
  VkShaderModule module = VK_NULL_HANDLE;
  try {
    std::vector<VkDescriptorSetLayoutBinding> bindings(bufferCount);
    for (uint32_t i = 0; i < bufferCount; ++i)
      bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    setInfo.bindingCount = bufferCount;
    setInfo.pBindings = bindings.data();
    check(vk.vkCreateDescriptorSetLayout(device.device(), &setInfo, nullptr, &setLayout_), "descriptor set layout");
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes};
    VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &setLayout_;
    layoutInfo.pushConstantRangeCount = pushBytes > 0 ? 1 : 0;
    layoutInfo.pPushConstantRanges = &range;
    check(vk.vkCreatePipelineLayout(device.device(), &layoutInfo, nullptr, &layout_), "vkCreatePipelineLayout");
    VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    moduleInfo.codeSize = spirv.size_bytes();
    moduleInfo.pCode = spirv.data();
    check(vk.vkCreateShaderModule(device.device(), &moduleInfo, nullptr, &module), "vkCreateShaderModule");
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = layout_;
    check(vk.vkCreateComputePipelines(device.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_),
          "vkCreateComputePipelines");
    vk.vkDestroyShaderModule(device.device(), module, nullptr);
    module = VK_NULL_HANDLE;
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, std::max(bufferCount, 1u)};
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    check(vk.vkCreateDescriptorPool(device.device(), &poolInfo, nullptr, &pool_), "vkCreateDescriptorPool");
    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &setLayout_;
    check(vk.vkAllocateDescriptorSets(device.device(), &allocate, &set_), "vkAllocateDescriptorSets");
  } catch (...) {
    vk.vkDestroyShaderModule(device.device(), module, nullptr);
    destroy();
    throw;
  }
}

ComputeKernel::~ComputeKernel() { destroy(); }

void ComputeKernel::destroy() noexcept {
  const VolkDeviceTable& vk = device_.vk();
  vk.vkDestroyDescriptorPool(device_.device(), pool_, nullptr);
  vk.vkDestroyPipeline(device_.device(), pipeline_, nullptr);
  vk.vkDestroyPipelineLayout(device_.device(), layout_, nullptr);
  vk.vkDestroyDescriptorSetLayout(device_.device(), setLayout_, nullptr);
}

void ComputeKernel::run(const std::vector<const Buffer*>& buffers, const void* push, uint32_t x, uint32_t y,
                        uint32_t z) {
  const VolkDeviceTable& vk = device_.vk();
  if (buffers.size() != bufferCount_) throw std::runtime_error("a kernel was given the wrong number of buffers");
  std::vector<VkDescriptorBufferInfo> infos(bufferCount_);
  std::vector<VkWriteDescriptorSet> writes(bufferCount_);
  for (uint32_t i = 0; i < bufferCount_; ++i) {
    infos[i] = {buffers[i]->handle(), 0, VK_WHOLE_SIZE};
    writes[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstSet = set_;
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    writes[i].pBufferInfo = &infos[i];
  }
  vk.vkUpdateDescriptorSets(device_.device(), bufferCount_, writes.data(), 0, nullptr);
  device_.submitAndWait([&](VkCommandBuffer commands) {
    fullBarrier(device_, commands);
    vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
    vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set_, 0, nullptr);
    if (pushBytes_ > 0) vk.vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes_, push);
    vk.vkCmdDispatch(commands, x, y, z);
    fullBarrier(device_, commands);
  });
}

} // namespace gpgp::host
