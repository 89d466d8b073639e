// The forward pass: one render pass with depth and four samples a pixel, and the pipelines that draw in it.
#pragma once
#include "camera.h"
#include "device.h"

namespace mini {

/// A vertex and a fragment shader with fixed state: depth test, counter-clockwise front faces, no culling (a grammar's
/// mirrored parts turn their corners around).
struct PipelineInfo {
  std::vector<uint32_t> vertex, fragment;
  std::vector<VkVertexInputBindingDescription> bindings;
  std::vector<VkVertexInputAttributeDescription> attributes;
  VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
  uint32_t pushBytes = 0;
  bool depth = true;
};

class Pipeline {
public:
  Pipeline() = default;
  Pipeline(Device& device, VkRenderPass renderPass, VkSampleCountFlagBits samples, const PipelineInfo& info);
  Pipeline(Pipeline&& other) noexcept { *this = std::move(other); }
  Pipeline& operator=(Pipeline&& other) noexcept;
  ~Pipeline();
  VkPipeline handle = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  static constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

private:
  Device* device_ = nullptr;
};

class ComputePipeline {
public:
  ComputePipeline(Device& device, const std::vector<uint32_t>& code, VkDescriptorSetLayout setLayout,
                  uint32_t pushBytes);
  ~ComputePipeline();
  ComputePipeline(const ComputePipeline&) = delete;
  ComputePipeline& operator=(const ComputePipeline&) = delete;
  VkPipeline handle = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;

private:
  Device& device_;
};

class Forward {
public:
  /// Colour is resolved into images of this format, left in this layout.
  Forward(Device& device, VkFormat format, VkImageLayout finalLayout);
  ~Forward();
  Forward(const Forward&) = delete;
  Forward& operator=(const Forward&) = delete;

  /// New multisampled images; the device must be idle. Framebuffers made before are invalid.
  void resize(VkExtent2D extent);
  VkFramebuffer makeFramebuffer(VkImageView resolved);
  void begin(VkCommandBuffer commands, VkFramebuffer framebuffer);
  /// Viewport and scissor of a part of the picture; depth there is cleared where `clear` is set.
  void setArea(VkCommandBuffer commands, const VkRect2D& area, bool clear = false);
  void drawBackdrop(VkCommandBuffer commands, const Camera& camera);
  VkExtent2D extent() const { return extent_; }
  VkRenderPass renderPass() const { return renderPass_; }
  static constexpr VkSampleCountFlagBits kSamples = VK_SAMPLE_COUNT_4_BIT; // every Vulkan device has 4
  static constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

private:
  Device& device_;
  VkFormat format_;
  VkRenderPass renderPass_ = VK_NULL_HANDLE;
  VkExtent2D extent_{};
  Image colour_, depth_;
  Pipeline backdrop_;
};

} // namespace mini
