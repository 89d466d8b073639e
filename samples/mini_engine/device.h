// The engine's Vulkan device: instance, GPU, one queue, and its memory. It links libvulkan; gpgp finds its own
// functions through vkGetInstanceProcAddr. What gpgp can use is asked with gpgpGetRequirements before the device is
// made.
#pragma once
#include <gpgp/gpgp.h>
#include <vulkan/vulkan.h>

#include <atomic>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace mini {

/// Throws std::runtime_error with the call's name where result is an error.
void check(VkResult result, const char* what);

struct DeviceOptions {
  std::string name; // part of a name or an index; empty: $GPGP_DEVICE, else software, else 0
  bool validate = false;
  std::vector<const char*> instanceExtensions; // of the window system
  bool swapchain = false;
};

class Device {
public:
  explicit Device(const DeviceOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t family = 0;
  VkQueueFlags queueFlags = 0;
  VkPhysicalDeviceProperties properties{};
  GpgpFeatures gpgpFeatures = 0; // what was enabled, to be declared to gpgp

  uint32_t validationMessages() const { return validationMessages_; }
  uint32_t memoryType(uint32_t typeBits, VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred = 0) const;
  /// For loading: records, submits, waits.
  void runOnce(const std::function<void(VkCommandBuffer)>& record);

private:
  void createInstance(const DeviceOptions& options);
  void choosePhysical(std::string name);
  void createDevice(const DeviceOptions& options);
  static VKAPI_ATTR VkBool32 VKAPI_CALL onValidation(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                     VkDebugUtilsMessageTypeFlagsEXT types,
                                                     const VkDebugUtilsMessengerCallbackDataEXT* data, void* user);
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDeviceMemoryProperties memory_{};
  std::atomic<uint32_t> validationMessages_{0};
};

/// The engine's buffer with memory of its own.
class Buffer {
public:
  Buffer() = default;
  Buffer(Device& device, VkDeviceSize size, VkBufferUsageFlags usage, bool hostVisible = false);
  /// Device-local, filled with bytes through a staging buffer.
  Buffer(Device& device, const void* bytes, VkDeviceSize size, VkBufferUsageFlags usage);
  Buffer(Buffer&& other) noexcept { *this = std::move(other); }
  Buffer& operator=(Buffer&& other) noexcept;
  ~Buffer();
  /// As gpgp wants it: the whole buffer with the engine's uses before and after.
  GpgpBuffer forGpgp(const GpgpAccess& before, const GpgpAccess& after) const;

  VkBuffer handle = VK_NULL_HANDLE;
  VkDeviceSize size = 0;
  void* mapped = nullptr;

private:
  Device* device_ = nullptr;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
};

class Image {
public:
  Image() = default;
  Image(Device& device, VkFormat format, VkExtent2D extent, VkImageUsageFlags usage, VkSampleCountFlagBits samples,
        VkImageAspectFlags aspect);
  Image(Image&& other) noexcept { *this = std::move(other); }
  Image& operator=(Image&& other) noexcept;
  ~Image();

  VkImage handle = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;

private:
  Device* device_ = nullptr;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
};

template <class T> Buffer makeBuffer(Device& device, const std::vector<T>& data, VkBufferUsageFlags usage) {
  return Buffer(device, data.data(), data.size() * sizeof(T), usage);
}

} // namespace mini
