// One compute shader over a few storage buffers: for tests that run a shader's functions beside their CPU CPU
// references.
#pragma once
#include "host/memory.h"

namespace gpgp::host {

/// Set 0, bindings 0..bufferCount-1 are storage buffers; push constants start at 0. Entry point "main".
class ComputeKernel {
public:
  ComputeKernel(HeadlessDevice& device, std::span<const uint32_t> spirv, uint32_t bufferCount, uint32_t pushBytes = 0);
  ~ComputeKernel();
  ComputeKernel(const ComputeKernel&) = delete;
  ComputeKernel& operator=(const ComputeKernel&) = delete;

  /// Runs groups x, y, z over the buffers and waits.
  void run(const std::vector<const Buffer*>& buffers, const void* push, uint32_t x, uint32_t y = 1, uint32_t z = 1);

private:
  void destroy() noexcept;
  HeadlessDevice& device_;
  uint32_t bufferCount_, pushBytes_;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

} // namespace gpgp::host
