// What of Unity's native plugin interface this plugin uses.
//
// Unity's own headers (PluginAPI in an editor's installation) are taken where CMake was given UNITY_PLUGIN_API. Otherwise
// the declarations here stand in for them: names, order and layout are those of the documented binary interface, on which
// compiled plugins depend, so they do not change. tests/integrations/unity_test.cpp checks sizes and offsets.
#pragma once
#ifdef GPGP_UNITY_HEADERS
#define VK_NO_PROTOTYPES
#include <IUnityGraphics.h>
#include <IUnityGraphicsVulkan.h>
#include <IUnityInterface.h>
#else

#include <cstddef>
#include <cstdint>
#include <vulkan/vulkan_core.h>

#if defined(_WIN32)
#define UNITY_INTERFACE_API __stdcall
#define UNITY_INTERFACE_EXPORT __declspec(dllexport)
#else
#define UNITY_INTERFACE_API
#define UNITY_INTERFACE_EXPORT __attribute__((visibility("default")))
#endif

struct UnityInterfaceGUID {
  unsigned long long m_GUIDHigh, m_GUIDLow;
};

struct IUnityInterface {};

/// The registry that a plugin is loaded with.
struct IUnityInterfaces {
  IUnityInterface*(UNITY_INTERFACE_API* GetInterface)(UnityInterfaceGUID guid);
  void(UNITY_INTERFACE_API* RegisterInterface)(UnityInterfaceGUID guid, IUnityInterface* ptr);
  IUnityInterface*(UNITY_INTERFACE_API* GetInterfaceSplit)(unsigned long long high, unsigned long long low);
  void(UNITY_INTERFACE_API* RegisterInterfaceSplit)(unsigned long long high, unsigned long long low,
                                                    IUnityInterface* ptr);
};

struct RenderSurfaceBase;
using UnityRenderBuffer = RenderSurfaceBase*;
using UnityTextureID = unsigned int;

// ---------------------------------------------------------------- IUnityGraphics

enum UnityGfxRenderer { kUnityGfxRendererNull = 4, kUnityGfxRendererOpenGLCore = 17, kUnityGfxRendererVulkan = 21 };
enum UnityGfxDeviceEventType {
  kUnityGfxDeviceEventInitialize = 0,
  kUnityGfxDeviceEventShutdown = 1,
  kUnityGfxDeviceEventBeforeReset = 2,
  kUnityGfxDeviceEventAfterReset = 3
};
using IUnityGraphicsDeviceEventCallback = void(UNITY_INTERFACE_API*)(UnityGfxDeviceEventType eventType);
using UnityRenderingEventAndData = void(UNITY_INTERFACE_API*)(int eventId, void* data);

struct IUnityGraphics : IUnityInterface {
  UnityGfxRenderer(UNITY_INTERFACE_API* GetRenderer)();
  void(UNITY_INTERFACE_API* RegisterDeviceEventCallback)(IUnityGraphicsDeviceEventCallback callback);
  void(UNITY_INTERFACE_API* UnregisterDeviceEventCallback)(IUnityGraphicsDeviceEventCallback callback);
  int(UNITY_INTERFACE_API* ReserveEventIDRange)(int count);
};

// ---------------------------------------------------------------- IUnityGraphicsVulkan

struct UnityVulkanInstance {
  VkPipelineCache pipelineCache;
  VkInstance instance;
  VkPhysicalDevice physicalDevice;
  VkDevice device;
  VkQueue graphicsQueue;
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  unsigned int queueFamilyIndex;
  void* reserved[8];
};

struct UnityVulkanMemory {
  VkDeviceMemory memory;
  VkDeviceSize offset, size;
  void* mapped;
  VkMemoryPropertyFlags flags;
  unsigned int memoryTypeIndex;
  void* reserved[4];
};

enum UnityVulkanResourceAccessMode {
  kUnityVulkanResourceAccess_ObserveOnly,     // no barrier
  kUnityVulkanResourceAccess_PipelineBarrier, // Unity brings the resource into the state that is asked for
  kUnityVulkanResourceAccess_Recreate
};

struct UnityVulkanImage {
  UnityVulkanMemory memory;
  VkImage image;
  VkImageLayout layout;
  VkImageAspectFlags aspect;
  VkImageUsageFlags usage;
  VkFormat format;
  VkExtent3D extent;
  VkImageTiling tiling;
  VkImageType type;
  VkSampleCountFlagBits samples;
  int layers, mipCount;
  void* reserved[4];
};

struct UnityVulkanBuffer {
  UnityVulkanMemory memory;
  VkBuffer buffer;
  size_t sizeInBytes;
  VkBufferUsageFlags usage;
  void* reserved[4];
};

struct UnityVulkanRecordingState {
  VkCommandBuffer commandBuffer;
  VkCommandBufferLevel commandBufferLevel;
  VkRenderPass renderPass;
  VkFramebuffer framebuffer;
  int subPassIndex;                                  // -1 outside of a render pass
  unsigned long long currentFrameNumber;             // of what is recorded now
  unsigned long long safeFrameNumber;                // up to here everything has finished
  void* reserved[4];
};

enum UnityVulkanEventRenderPassPreCondition {
  kUnityVulkanRenderPass_DontCare,
  kUnityVulkanRenderPass_EnsureInside,
  kUnityVulkanRenderPass_EnsureOutside
};
enum UnityVulkanGraphicsQueueAccess {
  kUnityVulkanGraphicsQueueAccess_DontCare,
  kUnityVulkanGraphicsQueueAccess_Allow
};
enum UnityVulkanEventConfigFlagBits {
  kUnityVulkanEventConfigFlag_EnsurePreviousFrameSubmission = 1 << 0,
  kUnityVulkanEventConfigFlag_FlushCommandBuffers = 1 << 1,
  kUnityVulkanEventConfigFlag_SyncWorkerThreads = 1 << 2,
  kUnityVulkanEventConfigFlag_ModifiesCommandBuffersState = 1 << 3
};
struct UnityVulkanPluginEventConfig {
  UnityVulkanEventRenderPassPreCondition renderPassPrecondition;
  UnityVulkanGraphicsQueueAccess graphicsQueueAccess;
  uint32_t flags;
};

const VkImageSubresource* const UnityVulkanWholeImage = nullptr;
using UnityVulkanInitCallback = PFN_vkGetInstanceProcAddr(UNITY_INTERFACE_API*)(PFN_vkGetInstanceProcAddr loader,
                                                                                void* userdata);
enum UnityVulkanSwapchainMode { kUnityVulkanSwapchainMode_Default, kUnityVulkanSwapchainMode_Offscreen };
struct UnityVulkanSwapchainConfiguration {
  UnityVulkanSwapchainMode mode;
};

struct IUnityGraphicsVulkan : IUnityInterface {
  bool(UNITY_INTERFACE_API* InterceptInitialization)(UnityVulkanInitCallback func, void* userdata);
  PFN_vkVoidFunction(UNITY_INTERFACE_API* InterceptVulkanAPI)(const char* name, PFN_vkVoidFunction func);
  void(UNITY_INTERFACE_API* ConfigureEvent)(int eventID, const UnityVulkanPluginEventConfig* config);
  UnityVulkanInstance(UNITY_INTERFACE_API* Instance)();
  bool(UNITY_INTERFACE_API* CommandRecordingState)(UnityVulkanRecordingState* state,
                                                   UnityVulkanGraphicsQueueAccess queueAccess);
  bool(UNITY_INTERFACE_API* AccessTexture)(void* nativeTexture, const VkImageSubresource* subResource,
                                           VkImageLayout layout, VkPipelineStageFlags stages, VkAccessFlags access,
                                           UnityVulkanResourceAccessMode mode, UnityVulkanImage* image);
  bool(UNITY_INTERFACE_API* AccessRenderBufferTexture)(UnityRenderBuffer renderBuffer,
                                                       const VkImageSubresource* subResource, VkImageLayout layout,
                                                       VkPipelineStageFlags stages, VkAccessFlags access,
                                                       UnityVulkanResourceAccessMode mode, UnityVulkanImage* image);
  bool(UNITY_INTERFACE_API* AccessRenderBufferResolveTexture)(UnityRenderBuffer renderBuffer,
                                                              const VkImageSubresource* subResource,
                                                              VkImageLayout layout, VkPipelineStageFlags stages,
                                                              VkAccessFlags access, UnityVulkanResourceAccessMode mode,
                                                              UnityVulkanImage* image);
  bool(UNITY_INTERFACE_API* AccessBuffer)(void* nativeBuffer, VkPipelineStageFlags stages, VkAccessFlags access,
                                          UnityVulkanResourceAccessMode mode, UnityVulkanBuffer* buffer);
  void(UNITY_INTERFACE_API* EnsureOutsideRenderPass)();
  void(UNITY_INTERFACE_API* EnsureInsideRenderPass)();
  void(UNITY_INTERFACE_API* AccessQueue)(UnityRenderingEventAndData callback, int eventId, void* userData, bool flush);
  bool(UNITY_INTERFACE_API* ConfigureSwapchain)(const UnityVulkanSwapchainConfiguration* config);
  bool(UNITY_INTERFACE_API* AccessTextureByID)(UnityTextureID textureID, const VkImageSubresource* subResource,
                                               VkImageLayout layout, VkPipelineStageFlags stages, VkAccessFlags access,
                                               UnityVulkanResourceAccessMode mode, UnityVulkanImage* image);
};

/// The same, and at its end hooks that several plugins may have side by side.
struct IUnityGraphicsVulkanV2 : IUnityGraphicsVulkan {
  bool(UNITY_INTERFACE_API* AddInterceptInitialization)(UnityVulkanInitCallback func, void* userdata, int32_t priority);
  bool(UNITY_INTERFACE_API* RemoveInterceptInitialization)(UnityVulkanInitCallback func);
};

#endif

/// The registry's keys.
constexpr unsigned long long kUnityGraphicsGuid[2] = {0x7CBA0A9CA4DDB544ULL, 0x8C5AD4926EB17B11ULL};
constexpr unsigned long long kUnityGraphicsVulkanGuid[2] = {0x95355348D4EF4E11ULL, 0x9789313DFCFFCC87ULL};
constexpr unsigned long long kUnityGraphicsVulkanV2Guid[2] = {0x329334C09DCA4787ULL, 0xB347DD92A0097FFCULL};
