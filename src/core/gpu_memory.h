// Device memory of a context: the engine's callbacks, or blocks of our own with first-fit sub-allocation.
//
// Only buffers are allocated, so bufferImageGranularity does not matter. Any thread may use it, but never while it
// records; calls wait for each other, the engine's callbacks included. Buffer is the only owner of an allocation.
#pragma once
#include "core/host_memory.h"
#include "core/vulkan_table.h"

#include <mutex>
#include <vector>

namespace gpgp::core {

struct Device;

class GpuMemory {
public:
  GpuMemory(const Device& device, HostMemory& host, const GpgpGpuAllocator* callbacks);
  virtual ~GpuMemory();
  GpuMemory(const GpuMemory&) = delete;
  GpuMemory& operator=(const GpuMemory&) = delete;

  Result<GpgpGpuAllocation> allocate(const GpgpGpuAllocationRequest& request);
  void free(const GpgpGpuAllocation& allocation);

  /// Adds to a counter of a service. A negated size takes away.
  void count(GpgpService service, VkDeviceSize GpgpServiceMemory::*counter, VkDeviceSize bytes);
  /// Fills the counters of all services and the bytes of the blocks.
  void report(GpgpMemoryReport& report) const;

private:
  struct Range {
    VkDeviceSize offset, size;
  };
  struct Block {
    VkDeviceMemory memory;
    VkDeviceSize size;
    uint32_t type;
    char* mapped;
    std::pmr::vector<Range> used; // sorted by offset
  };
  Result<uint32_t> chooseType(const GpgpGpuAllocationRequest& request) const;

  const Device& device_;
  HostMemory& host_;
  mutable std::mutex mutex_; // guards what is below
  GpgpGpuAllocator callbacks_{};
  VkPhysicalDeviceMemoryProperties properties_{};
  std::pmr::vector<Block> blocks_;
  GpgpServiceMemory services_[GPGP_SERVICE_COUNT] = {};
};

/// constants: small and written by the host for each recording; on the device where the host sees that, as shaders
/// would else wait for the bus.
enum class MemoryPlace { device, upload, constants, readBack };

/// A buffer with its memory. Movable, frees itself.
class Buffer {
public:
  Buffer() = default;
  ~Buffer() { reset(); }
  Buffer(Buffer&& other) noexcept { *this = static_cast<Buffer&&>(other); }
  Buffer& operator=(Buffer&& other) noexcept;
  static Result<Buffer> create(const Device& device, GpuMemory& memory, GpgpService service, const char* label,
                               VkDeviceSize size, VkBufferUsageFlags usage, MemoryPlace place);
  void reset();
  explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }
  VkBuffer handle() const { return buffer_; }
  VkDeviceSize size() const { return size_; }
  char* mapped() const { return static_cast<char*>(allocation_.mapped); }
  /// Counts this buffer's bytes as waiting for frames to be safe.
  void markPending();

private:
  VkDeviceSize GpgpServiceMemory::*counter() const {
    return hostVisible_ ? &GpgpServiceMemory::hostVisibleBytes : &GpgpServiceMemory::deviceBytes;
  }

  const Device* device_ = nullptr;
  GpuMemory* memory_ = nullptr;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  GpgpGpuAllocation allocation_{};
  VkDeviceSize size_ = 0;
  GpgpService service_ = GPGP_SERVICE_CORE;
  bool hostVisible_ = false, pending_ = false;
};

} // namespace gpgp::core
