// Device memory of a context: the engine's callbacks, or blocks of our own with first-fit sub-allocation.
//
// Only buffers are allocated, so bufferImageGranularity does not matter. Any thread may use it, but never while it
// records. One thread at a time asks the device or the engine for memory. Others wait for that only where they need
// more than there is: the frame's thread, which frees and counts, never does. Buffer is the only owner of an
// allocation.
#pragma once
#include "core/host_memory.h"
#include "core/vulkan_table.h"

#include <mutex>
#include <optional>
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
  Result<GpgpGpuAllocation> allocateFromEngine(const GpgpGpuAllocationRequest& request);
  std::optional<GpgpGpuAllocation> place(uint32_t type, const VkMemoryRequirements& requirements);
  Result<Block> makeBlock(uint32_t type, VkDeviceSize size);
  void freeGivenBack();

  const Device& device_;
  HostMemory& host_;
  std::mutex growing_;       // held during calls of the engine's callbacks, and while a block is made; taken first
  mutable std::mutex mutex_; // guards what is below, and is held briefly
  GpgpGpuAllocator callbacks_{};
  VkPhysicalDeviceMemoryProperties properties_{};
  std::pmr::vector<Block> blocks_;
  size_t engineAllocations_ = 0;                  // that live; room for all of them is reserved in the next
  std::pmr::vector<GpgpGpuAllocation> givenBack_; // of the engine's: to be freed by who holds growing_
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
