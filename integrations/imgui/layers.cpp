#include "layers.h"

#include "shaders/gpgp_imgui_piece_frag.spv.h"
#include "shaders/gpgp_imgui_piece_vert.spv.h"

#include <stdexcept>
#include <string>

namespace gpgp::imgui {
namespace {

void check(VkResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + " failed with VkResult " + std::to_string(result));
}

struct PushConstants {
  int32_t rect[4];
  float scale[2];
  int32_t down;
};

constexpr GpgpAccess kSampled{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT,
                              VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
constexpr GpgpAccess kSampledBefore{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED};

} // namespace

Layers::Layers(const RendererInfo& info) : info_(info) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(info.physicalDevice, &properties);
  const uint32_t limit = properties.limits.maxImageDimension2D;
  if (info.maxWidth > limit || info.maxHeight > limit || info.maxLayers > limit / info.maxHeight)
    throw std::runtime_error("maxHeight times maxLayers is beyond the device's images of " + std::to_string(limit) +
                             " pixels");
  try {
    makeImage();
    makeSet();
    makePipeline();
  } catch (...) {
    destroy();
    throw;
  }
}

Layers::~Layers() { destroy(); }

void Layers::destroy() noexcept {
  vkDestroyPipeline(info_.device, pipeline_, nullptr);
  vkDestroyPipelineLayout(info_.device, layout_, nullptr);
  vkDestroyDescriptorPool(info_.device, pool_, nullptr);
  vkDestroyDescriptorSetLayout(info_.device, setLayout_, nullptr);
  vkDestroySampler(info_.device, sampler_, nullptr);
  vkDestroyImageView(info_.device, view_, nullptr);
  vkDestroyImage(info_.device, image_, nullptr);
  vkFreeMemory(info_.device, memory_, nullptr);
}

void Layers::makeImage() {
  VkImageCreateInfo imageInfo{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  imageInfo.imageType = VK_IMAGE_TYPE_2D;
  imageInfo.format = format();
  imageInfo.extent = {info_.maxWidth, height(), 1};
  imageInfo.mipLevels = imageInfo.arrayLayers = 1;
  imageInfo.samples = VK_SAMPLE_COUNT_1_BIT;
  imageInfo.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  check(vkCreateImage(info_.device, &imageInfo, nullptr, &image_), "vkCreateImage");
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(info_.device, image_, &needs);
  VkPhysicalDeviceMemoryProperties types{};
  vkGetPhysicalDeviceMemoryProperties(info_.physicalDevice, &types);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  for (const VkMemoryPropertyFlags flags : {VkMemoryPropertyFlags{VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT}, 0u}) {
    uint32_t type = 0;
    while (type < types.memoryTypeCount &&
           (!(needs.memoryTypeBits >> type & 1u) || (types.memoryTypes[type].propertyFlags & flags) != flags))
      ++type;
    if (type == types.memoryTypeCount) continue;
    allocate.memoryTypeIndex = type;
    check(vkAllocateMemory(info_.device, &allocate, nullptr, &memory_), "vkAllocateMemory");
    break;
  }
  if (!memory_) throw std::runtime_error("no memory type for the canvas's image");
  check(vkBindImageMemory(info_.device, image_, memory_, 0), "vkBindImageMemory");
  VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  viewInfo.image = image_;
  viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
  viewInfo.format = format();
  viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  check(vkCreateImageView(info_.device, &viewInfo, nullptr, &view_), "vkCreateImageView");
  const VkSamplerCreateInfo samplerInfo{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO}; // texels are fetched
  check(vkCreateSampler(info_.device, &samplerInfo, nullptr, &sampler_), "vkCreateSampler");
}

void Layers::makeSet() {
  VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT,
                                       &sampler_};
  VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  setInfo.bindingCount = 1;
  setInfo.pBindings = &binding;
  check(vkCreateDescriptorSetLayout(info_.device, &setInfo, nullptr, &setLayout_), "vkCreateDescriptorSetLayout");
  const VkDescriptorPoolSize poolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
  VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  poolInfo.maxSets = poolInfo.poolSizeCount = 1;
  poolInfo.pPoolSizes = &poolSize;
  check(vkCreateDescriptorPool(info_.device, &poolInfo, nullptr, &pool_), "vkCreateDescriptorPool");
  VkDescriptorSetAllocateInfo setAllocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  setAllocate.descriptorPool = pool_;
  setAllocate.descriptorSetCount = 1;
  setAllocate.pSetLayouts = &setLayout_;
  check(vkAllocateDescriptorSets(info_.device, &setAllocate, &set_), "vkAllocateDescriptorSets");
  const VkDescriptorImageInfo texture{VK_NULL_HANDLE, view_, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = set_;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  write.pImageInfo = &texture;
  vkUpdateDescriptorSets(info_.device, 1, &write, 0, nullptr);
}

void Layers::makePipeline() {
  const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(PushConstants)};
  VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layoutInfo.setLayoutCount = layoutInfo.pushConstantRangeCount = 1;
  layoutInfo.pSetLayouts = &setLayout_;
  layoutInfo.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(info_.device, &layoutInfo, nullptr, &layout_), "vkCreatePipelineLayout");

  VkShaderModule modules[2] = {};
  VkPipelineShaderStageCreateInfo stages[2] = {};
  const auto stage = [&](int i, VkShaderStageFlagBits flag, const uint32_t* code, size_t bytes) {
    VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    moduleInfo.codeSize = bytes;
    moduleInfo.pCode = code;
    const VkResult result = vkCreateShaderModule(info_.device, &moduleInfo, nullptr, &modules[i]);
    stages[i] = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    stages[i].stage = flag;
    stages[i].module = modules[i];
    stages[i].pName = "main";
    return result;
  };
  VkResult result = stage(0, VK_SHADER_STAGE_VERTEX_BIT, gpgp_imgui_piece_vert, sizeof gpgp_imgui_piece_vert);
  if (result == VK_SUCCESS)
    result = stage(1, VK_SHADER_STAGE_FRAGMENT_BIT, gpgp_imgui_piece_frag, sizeof gpgp_imgui_piece_frag);
  VkPipelineVertexInputStateCreateInfo vertexInput{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  multisample.rasterizationSamples = info_.samples;
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  VkPipelineColorBlendAttachmentState blend{}; // premultiplied over
  blend.blendEnable = VK_TRUE;
  blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  blend.colorWriteMask = 0xf;
  VkPipelineColorBlendStateCreateInfo blending{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blending.attachmentCount = 1;
  blending.pAttachments = &blend;
  const VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = 2;
  dynamic.pDynamicStates = dynamicStates;
  VkGraphicsPipelineCreateInfo pipelineInfo{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  pipelineInfo.stageCount = 2;
  pipelineInfo.pStages = stages;
  pipelineInfo.pVertexInputState = &vertexInput;
  pipelineInfo.pInputAssemblyState = &assembly;
  pipelineInfo.pViewportState = &viewport;
  pipelineInfo.pRasterizationState = &raster;
  pipelineInfo.pMultisampleState = &multisample;
  pipelineInfo.pDepthStencilState = &depth;
  pipelineInfo.pColorBlendState = &blending;
  pipelineInfo.pDynamicState = &dynamic;
  pipelineInfo.layout = layout_;
  pipelineInfo.renderPass = info_.renderPass;
  pipelineInfo.subpass = info_.subpass;
  if (result == VK_SUCCESS)
    result = vkCreateGraphicsPipelines(info_.device, VK_NULL_HANDLE, 1, &pipelineInfo, nullptr, &pipeline_);
  for (VkShaderModule module : modules) vkDestroyShaderModule(info_.device, module, nullptr);
  check(result, "vkCreateGraphicsPipelines");
}

GpgpImage Layers::target() const {
  return {image_, view_, format(), 0, 0, info_.maxWidth, height(), kSampledBefore, kSampled};
}

void Layers::bind(VkCommandBuffer commands, VkExtent2D screen) const {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set_, 0, nullptr);
  const VkRect2D all{{0, 0}, screen};
  vkCmdSetScissor(commands, 0, 1, &all); // what is drawn are rectangles
}

void Layers::draw(VkCommandBuffer commands, VkExtent2D screen, const Rect& shown, int layer) const {
  const PushConstants constants{{shown.left, shown.top, shown.right, shown.bottom},
                                {2.0f / static_cast<float>(screen.width), 2.0f / static_cast<float>(screen.height)},
                                layer * static_cast<int32_t>(screen.height)};
  vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof constants,
                     &constants);
  vkCmdDraw(commands, 4, 1, 0, 0);
}

} // namespace gpgp::imgui
