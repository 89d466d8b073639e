// A host that loads a native rendering plugin as Unity documents that it does: the registry of interfaces, the hooks
// around its Vulkan instance and device, device events, events with a command buffer that is being recorded, frame
// numbers with a safe one some frames behind, textures whose state it tracks. What a plugin must not do is a violation.
#pragma once
#include "unity_api.h"

#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace gpgp::test {

struct FakeUnityOptions {
  bool v2 = true;      ///< IUnityGraphicsVulkanV2 is there, too
  bool preload = true; ///< the plugin is loaded before the device is made
  bool begin = true;   ///< and is told that the device is there
  UnityGfxRenderer renderer = kUnityGfxRendererVulkan;
};

/// A RenderTexture: its address is the native pointer.
struct FakeTexture {
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  VkExtent2D extent{};
  VkImageUsageFlags usage = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED; ///< and how it was used last
  VkPipelineStageFlags stages = VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT;
  VkAccessFlags access = 0;
};

/// One at a time: callbacks have no user data.
class FakeUnity {
public:
  static constexpr uint32_t kLag = 3; ///< frames in flight
  FakeUnity(const std::string& library, const FakeUnityOptions& options);
  ~FakeUnity(); ///< device event, device, plugin, in that order; then validation has its say
  FakeUnity(const FakeUnity&) = delete;
  FakeUnity& operator=(const FakeUnity&) = delete;

  /// A function that the plugin exports.
  template <class Function> Function symbol(const char* name) const {
    return reinterpret_cast<Function>(symbolOf(name));
  }
  FakeTexture* makeTexture(uint32_t width, uint32_t height, VkFormat format = VK_FORMAT_R8G8B8A8_UNORM,
                           VkImageUsageFlags usage = VK_IMAGE_USAGE_STORAGE_BIT);
  void destroyTexture(FakeTexture* texture); ///< once the frames that use it are over
  /// A frame with a camera's render pass, in which these events are issued: id, data.
  void frame(UnityRenderingEventAndData event, const std::vector<std::pair<int, void*>>& issued);
  /// As frames pass by: nothing is safe until it is released.
  void holdSafe(bool hold) { held_ = hold; }
  void shutdown();   ///< the device event, when the renderer goes
  void initialize(); ///< and when it comes
  /// A device event as it is, whether it makes sense or not.
  void send(UnityGfxDeviceEventType type);
  /// From here on waiting for the device says that it is lost, at once.
  void loseDevice();
  /// The renderer goes, its device, too, and comes back with another. Textures are gone.
  void replaceDevice();
  void loadAgain(); ///< UnityPluginLoad, though it is loaded
  void unload();    ///< UnityPluginUnload; the library stays in memory
  std::vector<uint8_t> read(FakeTexture& texture);
  /// Work of the test's own, submitted and waited for.
  void submit(const std::function<void(VkCommandBuffer)>& record);

  VkInstance instance() const { return instance_; }
  VkPhysicalDevice physicalDevice() const { return physical_; }
  VkDevice device() const { return device_; }
  uint32_t family() const { return family_; }
  uint64_t currentFrame() const { return current_; }
  const UnityVulkanPluginEventConfig* config(int eventId) const;
  uint32_t hooksTaken() const { return hooksTaken_; }
  const std::vector<std::string>& violations() const { return violations_; }
  static std::vector<std::string>& validation();

private:
  struct Slot {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
  };
  struct Interfaces; // the callbacks
  void* symbolOf(const char* name) const;
  void makeDevice();
  void destroyDevice();
  void makeCamera();
  VkCommandBuffer nextCommands();
  void beginPass();
  void violate(const std::string& what) { violations_.push_back(what); }
  bool hook(UnityVulkanInitCallback callback, void* data, bool right);
  UnityVulkanInstance unityInstance() const;
  void transition(FakeTexture& texture, VkImageLayout layout, VkPipelineStageFlags stages, VkAccessFlags access);

  FakeUnityOptions options_;
  void* library_ = nullptr;
  UnityVulkanInitCallback hook_ = nullptr;
  void* hookData_ = nullptr;
  uint32_t hooksTaken_ = 0;
  bool deviceMade_ = false, initialized_ = false, held_ = false, lost_ = false;
  std::vector<IUnityGraphicsDeviceEventCallback> deviceEvents_;
  std::map<int, UnityVulkanPluginEventConfig> configs_;
  std::vector<std::string> violations_;

  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  uint32_t family_ = 0;
  std::map<FakeTexture*, std::unique_ptr<FakeTexture>> textures_;
  FakeTexture* camera_ = nullptr;
  VkImageView cameraHistory_ = VK_NULL_HANDLE;
  VkRenderPass pass_ = VK_NULL_HANDLE;
  VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
  Slot slots_[kLag];
  uint64_t current_ = 100, safe_ = 0; // numbers begin somewhere
  std::vector<VkCommandBuffer> recorded_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  bool insidePass_ = false, insideEvent_ = false;
};

} // namespace gpgp::test
