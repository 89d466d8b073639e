// Buffers that assets share: a recording binds a few buffers, whatever number of assets it shows.
#pragma once
#include "core/gpu_memory.h"

namespace gpgp::core {

/// Any thread may use it, but never while it records.
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

  const Device& device_;
  GpuMemory& memory_;
  std::mutex mutex_; // guards what is below
  std::pmr::vector<Block> blocks_;
};

} // namespace gpgp::core
