// Device memory of a context: the engine's callbacks, or blocks of our own with first-fit sub-allocation.
//
// Only buffers are allocated, so bufferImageGranularity does not matter. Used by one thread at a time per context and
// never while recording. Buffer is the only owner of an allocation.
#pragma once
#include "core/host_memory.h"
#include "core/vulkan_table.h"

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

  VkDeviceSize blockBytes() const;
  GpgpServiceMemory services[GPGP_SERVICE_COUNT] = {};

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
  GpgpGpuAllocator callbacks_{};
  VkPhysicalDeviceMemoryProperties properties_{};
  std::pmr::vector<Block> blocks_;
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
  const Device* device_ = nullptr;
  GpuMemory* memory_ = nullptr;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  GpgpGpuAllocation allocation_{};
  VkDeviceSize size_ = 0;
  GpgpService service_ = GPGP_SERVICE_CORE;
  bool hostVisible_ = false, pending_ = false;
};

} // namespace gpgp::core
