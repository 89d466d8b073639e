// The library's own Vulkan dispatch table, loaded from the engine's vkGetInstanceProcAddr.
//
// Nothing in the library calls a vk* symbol directly: an engine may link libvulkan, have volk, or load Vulkan by hand.
#pragma once
#include "core/result.h"

// Needed before a device exists. X(name without vk)
#define GPGP_INSTANCE_FUNCTIONS(X)                                                                                     \
  X(GetDeviceProcAddr)                                                                                                 \
  X(EnumerateDeviceExtensionProperties)                                                                                \
  X(GetPhysicalDeviceFeatures2)                                                                                        \
  X(GetPhysicalDeviceMemoryProperties)                                                                                 \
  X(GetPhysicalDeviceProperties2)                                                                                      \
  X(GetPhysicalDeviceQueueFamilyProperties)

#define GPGP_DEVICE_FUNCTIONS(X)                                                                                       \
  X(AllocateDescriptorSets)                                                                                            \
  X(AllocateMemory)                                                                                                    \
  X(BindBufferMemory)                                                                                                  \
  X(CmdBindDescriptorSets)                                                                                             \
  X(CmdBindPipeline)                                                                                                   \
  X(CmdCopyBuffer)                                                                                                     \
  X(CmdDispatch)                                                                                                       \
  X(CmdDispatchIndirect)                                                                                               \
  X(CmdDraw)                                                                                                           \
  X(CmdFillBuffer)                                                                                                     \
  X(CmdPipelineBarrier)                                                                                                \
  X(CmdPushConstants)                                                                                                  \
  X(CmdWriteTimestamp)                                                                                                 \
  X(CreateBuffer)                                                                                                      \
  X(CreateComputePipelines)                                                                                            \
  X(CreateDescriptorPool)                                                                                              \
  X(CreateDescriptorSetLayout)                                                                                         \
  X(CreateGraphicsPipelines)                                                                                           \
  X(CreatePipelineCache)                                                                                               \
  X(CreatePipelineLayout)                                                                                              \
  X(CreateShaderModule)                                                                                                \
  X(DestroyBuffer)                                                                                                     \
  X(DestroyDescriptorPool)                                                                                             \
  X(DestroyDescriptorSetLayout)                                                                                        \
  X(DestroyPipeline)                                                                                                   \
  X(DestroyPipelineCache)                                                                                              \
  X(DestroyPipelineLayout)                                                                                             \
  X(DestroyShaderModule)                                                                                               \
  X(FreeMemory)                                                                                                        \
  X(GetBufferMemoryRequirements)                                                                                       \
  X(GetPipelineCacheData)                                                                                              \
  X(MapMemory)                                                                                                         \
  X(UpdateDescriptorSets)

// Absent unless VK_EXT_debug_utils is enabled.
#define GPGP_OPTIONAL_FUNCTIONS(X)                                                                                     \
  X(CmdBeginDebugUtilsLabelEXT)                                                                                        \
  X(CmdEndDebugUtilsLabelEXT)                                                                                          \
  X(SetDebugUtilsObjectNameEXT)

namespace gpgp::core {

struct InstanceTable {
#define X(name) PFN_vk##name name = nullptr;
  GPGP_INSTANCE_FUNCTIONS(X)
#undef X
};

struct DeviceTable {
#define X(name) PFN_vk##name name = nullptr;
  GPGP_DEVICE_FUNCTIONS(X)
  GPGP_OPTIONAL_FUNCTIONS(X)
#undef X
};

/// MISSING_FEATURE with the function's name where one is absent.
Result<InstanceTable> loadInstanceTable(VkInstance instance, PFN_vkGetInstanceProcAddr getInstanceProcAddr);
Result<DeviceTable> loadDeviceTable(const InstanceTable& instanceTable, VkDevice device, bool debugUtils);

/// "VK_ERROR_OUT_OF_DEVICE_MEMORY (-2) from vkCreateBuffer" as the Error that fits.
Error vulkanError(VkResult result, const char* function);

} // namespace gpgp::core
