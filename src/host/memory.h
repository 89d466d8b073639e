// Buffers and images with memory of their own, and the simple transfers that programs around the library need.
// One allocation each: meant for tens of resources, not thousands.
#pragma once
#include "host/device.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <type_traits>

namespace gpgp::host {

enum class Memory {
  device,  ///< fast for the GPU
  host,    ///< mapped, coherent; written by the CPU
  readback ///< mapped, coherent, cached where there is such a type; read by the CPU
};

class Buffer {
public:
  Buffer() = default;
  /// usage is extended by both transfer usages. Contents are undefined.
  Buffer(HeadlessDevice& device, VkDeviceSize size, VkBufferUsageFlags usage, Memory memory = Memory::device,
         const std::string& name = {});
  ~Buffer() { destroy(); }
  Buffer(Buffer&& other) noexcept { *this = std::move(other); }
  Buffer& operator=(Buffer&& other) noexcept;

  VkBuffer handle() const { return handle_; }
  VkDeviceSize size() const { return size_; }
  /// Null for Memory::device.
  void* mapped() const { return mapped_; }
  template <class T> T* as() const { return static_cast<T*>(mapped_); }
  /// The whole buffer, or a range, for a recording; before and after as given.
  GpgpBuffer range(const GpgpAccess& before = {}, const GpgpAccess& after = {}, VkDeviceSize offset = 0,
                   VkDeviceSize size = VK_WHOLE_SIZE) const;

private:
  void destroy() noexcept;
  HeadlessDevice* device_ = nullptr;
  VkBuffer handle_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkDeviceSize size_ = 0;
  void* mapped_ = nullptr;
};

struct ImageInfo {
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  uint32_t width = 1, height = 1;
  VkImageUsageFlags usage = VK_IMAGE_USAGE_STORAGE_BIT; ///< both transfer usages are added
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  uint32_t layers = 1; ///< more: the view is one of an array
  uint32_t levels = 1; ///< each half as large as the one before
};

/// A 2D image with one level, and a view of all of it. Layout UNDEFINED at first.
class Image {
public:
  Image() = default;
  Image(HeadlessDevice& device, const ImageInfo& info, const std::string& name = {});
  ~Image() { destroy(); }
  Image(Image&& other) noexcept { *this = std::move(other); }
  Image& operator=(Image&& other) noexcept;

  VkImage handle() const { return handle_; }
  VkImageView view() const { return view_; }
  const ImageInfo& info() const { return info_; }
  VkImageAspectFlags aspect() const;
  GpgpImage target(const GpgpAccess& before = {}, const GpgpAccess& after = {}) const;

private:
  void destroy() noexcept;
  HeadlessDevice* device_ = nullptr;
  VkImage handle_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  ImageInfo info_;
};

/// Bytes of one pixel of the colour and depth formats used here; throws for others.
uint32_t bytesPerPixel(VkFormat format);

/// A full memory barrier, all stages to all stages: for programs where clarity counts more than speed.
void fullBarrier(const HeadlessDevice& device, VkCommandBuffer commands);
/// The same with a layout change of one image.
void imageBarrier(const HeadlessDevice& device, VkCommandBuffer commands, const Image& image, VkImageLayout from,
                  VkImageLayout to);

/// Writes bytes into any buffer and waits.
void uploadBytes(HeadlessDevice& device, const Buffer& buffer, const void* data, size_t size, VkDeviceSize offset = 0);
/// Reads bytes of any buffer, after everything submitted before, and waits.
void downloadBytes(HeadlessDevice& device, const Buffer& buffer, void* data, size_t size, VkDeviceSize offset = 0);
/// Fills the whole buffer with a word and waits: for poisoning and clearing.
void fill(HeadlessDevice& device, const Buffer& buffer, uint32_t word);
/// Writes all pixels, level by level, rows tightly packed, and waits; the image is in `layout` afterwards.
void uploadImage(HeadlessDevice& device, const Image& image, std::span<const uint8_t> pixels, VkImageLayout layout);
/// All pixels, layer by layer, rows tightly packed; the image is in `layout` before and after.
std::vector<uint8_t> downloadImage(HeadlessDevice& device, const Image& image, VkImageLayout layout);

template <class T>
void upload(HeadlessDevice& device, const Buffer& buffer, std::span<const T> data, VkDeviceSize offset = 0) {
  static_assert(std::is_trivially_copyable_v<T>);
  uploadBytes(device, buffer, data.data(), data.size_bytes(), offset);
}

template <class T>
std::vector<T> download(HeadlessDevice& device, const Buffer& buffer, size_t count, VkDeviceSize offset = 0) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> data(count);
  downloadBytes(device, buffer, data.data(), count * sizeof(T), offset);
  return data;
}

/// A buffer in device memory that holds a copy of data.
template <class T>
Buffer makeBuffer(HeadlessDevice& device, const std::vector<T>& data, VkBufferUsageFlags usage,
                  const std::string& name = {}) {
  Buffer buffer(device, std::max<VkDeviceSize>(data.size() * sizeof(T), 4), usage, Memory::device, name);
  if (!data.empty()) upload(device, buffer, std::span<const T>(data));
  return buffer;
}

} // namespace gpgp::host
