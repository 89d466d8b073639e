// Buffers that assets share: a recording binds a few buffers, whatever number of assets it shows.
#pragma once
#include "core/gpu_memory.h"

namespace gpgp::core {

/// Any thread may use it, but never while it records. Only a thread that needs a new buffer waits while one is made.
class AssetPool {
public:
  struct Place {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceSize bufferSize = 0, offset = 0, size = 0;
  };
  AssetPool(const Device& device, GpuMemory& memory, HostMemory& host)
      : device_(device), memory_(memory), blocks_(&host) {}
  virtual ~AssetPool() = default;

  /// Room for `size` bytes, aligned to 256, in a buffer of the service that a shader can bind whole.
  Result<Place> allocate(GpgpService service, VkDeviceSize size);
  void free(const Place& place);

private:
  struct Range {
    VkDeviceSize offset, size;
  };
  struct Block {
    Buffer buffer;
    GpgpService service;
    bool small;                   ///< holds small assets, the others hold large ones
    std::pmr::vector<Range> used; // by offset
  };

  /// A place in one of the blocks. bytes: all that blocks for the service's assets of that size hold.
  std::optional<Place> place(GpgpService service, bool small, VkDeviceSize size, VkDeviceSize& bytes);
  Result<Buffer> makeBuffer(GpgpService service, VkDeviceSize size, VkDeviceSize wanted);

  const Device& device_;
  GpuMemory& memory_;
  std::mutex growing_; // held while a buffer is made; taken first
  std::mutex mutex_;   // guards what is below, and is held briefly
  std::pmr::vector<Block> blocks_;
};

} // namespace gpgp::core
