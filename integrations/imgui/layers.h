// The image that a frame's canvas is rasterised into, layer below layer, and the pipeline that draws rectangles of it.
#pragma once
#include "gpgp_imgui.hpp"
#include "pieces.h"

namespace gpgp::imgui {

class Layers {
public:
  /// Throws std::runtime_error with what failed.
  explicit Layers(const RendererInfo& info);
  ~Layers();
  Layers(const Layers&) = delete;
  Layers& operator=(const Layers&) = delete;

  uint32_t height() const { return info_.maxHeight * info_.maxLayers; }
  /// For GpgpCanvasInfo::target: readable for fragment shaders before and after.
  GpgpImage target() const;
  void bind(VkCommandBuffer commands, VkExtent2D screen) const;
  /// A rectangle of a layer, at its place on the screen; bound before.
  void draw(VkCommandBuffer commands, VkExtent2D screen, const Rect& shown, int layer) const;

private:
  void makeImage();
  void makeSet();
  void makePipeline();
  void destroy() noexcept;
  VkFormat format() const { return info_.srgbTarget ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R8G8B8A8_UNORM; }

  const RendererInfo info_;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
};

} // namespace gpgp::imgui
