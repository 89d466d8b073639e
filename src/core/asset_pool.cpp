#include "core/asset_pool.h"

#include "core/device.h"

#include <algorithm>

namespace gpgp::core {
namespace {
constexpr VkDeviceSize kAlignment = 256, kLeastBlock = VkDeviceSize(1) << 20, kSmall = VkDeviceSize(64) << 10;
} // namespace

std::optional<AssetPool::Place> AssetPool::place(GpgpService service, bool small, VkDeviceSize size,
                                                 VkDeviceSize& bytes) {
  const std::lock_guard lock(mutex_);
  bytes = 0;
  for (Block& block : blocks_) {
    if (block.service != service || block.small != small) continue;
    bytes += block.buffer.size();
    VkDeviceSize start = 0;
    auto at = block.used.begin();
    for (; at != block.used.end() && start + size > at->offset; ++at) start = at->offset + at->size;
    if (at == block.used.end() && start + size > block.buffer.size()) continue;
    block.used.insert(at, Range{start, size});
    return Place{block.buffer.handle(), block.buffer.size(), start, size};
  }
  return std::nullopt;
}

/// Of the wanted bytes, or fewer where the device has no memory for as many, but at least `size`.
Result<Buffer> AssetPool::makeBuffer(GpgpService service, VkDeviceSize size, VkDeviceSize wanted) {
  for (VkDeviceSize bytes = std::max(size, wanted);;) {
    auto buffer =
        Buffer::create(device_, memory_, service, "assets", bytes,
                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryPlace::device);
    if (buffer || bytes == size) return buffer;
    bytes = std::max(size, bytes / 2 / kAlignment * kAlignment);
  }
}

/// A new block is as large as all before it, so that there are few of them, however many assets there are. Small assets
/// have blocks of their own: they lie together, whatever large ones come and go beside them.
Result<AssetPool::Place> AssetPool::allocate(GpgpService service, VkDeviceSize size) {
  size = (size + kAlignment - 1) / kAlignment * kAlignment;
  const bool small = size <= kSmall;
  VkDeviceSize all = 0;
  if (const auto found = place(service, small, size, all)) return *found;
  const std::lock_guard growing(growing_);
  if (const auto found = place(service, small, size, all)) return *found; // another thread has made a block meanwhile
  std::pmr::vector<Range> used(1, Range{0, size}, blocks_.get_allocator());
  {
    const std::lock_guard lock(mutex_);
    blocks_.reserve(blocks_.size() + 1); // what can throw comes before what must be undone; only growing adds blocks
  }
  const VkDeviceSize most = device_.limits.maxStorageBufferRange / kAlignment * kAlignment;
  auto buffer = makeBuffer(service, size, std::min(std::max(all, kLeastBlock), most));
  if (!buffer) return buffer.error();
  const std::lock_guard lock(mutex_);
  blocks_.push_back({std::move(*buffer), service, small, std::move(used)});
  const Buffer& made = blocks_.back().buffer;
  return Place{made.handle(), made.size(), 0, size};
}

void AssetPool::free(const Place& place) {
  Buffer unused; // destroyed when the pool is no longer locked
  const std::lock_guard lock(mutex_);
  const auto block =
      std::find_if(blocks_.begin(), blocks_.end(), [&](const Block& b) { return b.buffer.handle() == place.buffer; });
  if (block == blocks_.end()) return;
  std::erase_if(block->used, [&](const Range& range) { return range.offset == place.offset; });
  if (!block->used.empty()) return;
  unused = std::move(block->buffer);
  blocks_.erase(block);
}

} // namespace gpgp::core
