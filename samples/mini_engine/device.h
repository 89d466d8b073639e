// The engine's Vulkan device and its memory. Instance, GPU and queue are those of gpgp::sdl2, which asks
// gpgpGetRequirements what gpgp could use before the device is made.
#pragma once
#include <gpgp/gpgp.h>
#include <gpgp_sdl2.hpp>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace mini {

using gpgp::sdl2::check;

struct DeviceOptions {
  std::string name; // part of a name or an index; empty: $GPGP_DEVICE, else software, else 0
  bool validate = false;
  std::vector<const char*> instanceExtensions; // of the window system
  bool swapchain = false;
};

class Device : public gpgp::sdl2::Device {
public:
  explicit Device(const DeviceOptions& options);
  /// For loading: records, submits, waits.
  void runOnce(const std::function<void(VkCommandBuffer)>& record);
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
