// A graphics pipeline of the forward pass, and compute pipelines beside it.
#include "forward.h"

#include <utility>

namespace mini {
namespace {

VkShaderModule makeModule(Device& device, const std::vector<uint32_t>& words) {
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = words.size() * sizeof(uint32_t);
  info.pCode = words.data();
  VkShaderModule module = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device.device, &info, nullptr, &module), "vkCreateShaderModule");
  return module;
}

} // namespace

Pipeline::Pipeline(Device& device, VkRenderPass renderPass, VkSampleCountFlagBits samples, const PipelineInfo& info)
    : device_(&device) {
  const VkPushConstantRange push{kStages, 0, info.pushBytes};
  VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layoutInfo.setLayoutCount = info.setLayout ? 1 : 0;
  layoutInfo.pSetLayouts = &info.setLayout;
  layoutInfo.pushConstantRangeCount = 1;
  layoutInfo.pPushConstantRanges = &push;
  check(vkCreatePipelineLayout(device.device, &layoutInfo, nullptr, &layout), "vkCreatePipelineLayout");

  VkPipelineShaderStageCreateInfo stages[2] = {{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO},
                                               {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO}};
  stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  stages[0].module = makeModule(device, info.vertex);
  stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  stages[1].module = makeModule(device, info.fragment);
  stages[0].pName = stages[1].pName = "main";
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  input.vertexBindingDescriptionCount = static_cast<uint32_t>(info.bindings.size());
  input.pVertexBindingDescriptions = info.bindings.data();
  input.vertexAttributeDescriptionCount = static_cast<uint32_t>(info.attributes.size());
  input.pVertexAttributeDescriptions = info.attributes.data();
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.polygonMode = VK_POLYGON_MODE_FILL;
  raster.cullMode = VK_CULL_MODE_NONE;
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.lineWidth = 1.0f;
  VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  multisample.rasterizationSamples = samples;
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  depth.depthTestEnable = depth.depthWriteEnable = info.depth ? VK_TRUE : VK_FALSE;
  depth.depthCompareOp = VK_COMPARE_OP_LESS;
  VkPipelineColorBlendAttachmentState opaque{};
  opaque.colorWriteMask = 0xf;
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = 1;
  blend.pAttachments = &opaque;
  const VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = 2;
  dynamic.pDynamicStates = dynamicStates;

  VkGraphicsPipelineCreateInfo create{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  create.stageCount = 2;
  create.pStages = stages;
  create.pVertexInputState = &input;
  create.pInputAssemblyState = &assembly;
  create.pViewportState = &viewport;
  create.pRasterizationState = &raster;
  create.pMultisampleState = &multisample;
  create.pDepthStencilState = &depth;
  create.pColorBlendState = &blend;
  create.pDynamicState = &dynamic;
  create.layout = layout;
  create.renderPass = renderPass;
  const VkResult result = vkCreateGraphicsPipelines(device.device, VK_NULL_HANDLE, 1, &create, nullptr, &handle);
  for (const VkPipelineShaderStageCreateInfo& stage : stages)
    vkDestroyShaderModule(device.device, stage.module, nullptr);
  check(result, "vkCreateGraphicsPipelines");
}

Pipeline& Pipeline::operator=(Pipeline&& other) noexcept {
  std::swap(handle, other.handle);
  std::swap(layout, other.layout);
  std::swap(device_, other.device_);
  return *this;
}

Pipeline::~Pipeline() {
  if (!device_) return;
  vkDestroyPipeline(device_->device, handle, nullptr);
  vkDestroyPipelineLayout(device_->device, layout, nullptr);
}

ComputePipeline::ComputePipeline(Device& device, const std::vector<uint32_t>& code, VkDescriptorSetLayout setLayout,
                                 uint32_t pushBytes)
    : device_(device) {
  const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes};
  VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layoutInfo.setLayoutCount = 1;
  layoutInfo.pSetLayouts = &setLayout;
  layoutInfo.pushConstantRangeCount = 1;
  layoutInfo.pPushConstantRanges = &push;
  check(vkCreatePipelineLayout(device.device, &layoutInfo, nullptr, &layout), "vkCreatePipelineLayout");
  VkComputePipelineCreateInfo create{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  create.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  create.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  create.stage.module = makeModule(device, code);
  create.stage.pName = "main";
  create.layout = layout;
  const VkResult result = vkCreateComputePipelines(device.device, VK_NULL_HANDLE, 1, &create, nullptr, &handle);
  vkDestroyShaderModule(device.device, create.stage.module, nullptr);
  check(result, "vkCreateComputePipelines");
}

ComputePipeline::~ComputePipeline() {
  vkDestroyPipeline(device_.device, handle, nullptr);
  vkDestroyPipelineLayout(device_.device, layout, nullptr);
}

} // namespace mini
