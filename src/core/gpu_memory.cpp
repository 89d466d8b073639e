#include "core/gpu_memory.h"

#include "core/device.h"

#include <algorithm>

namespace gpgp::core {
namespace {
constexpr VkDeviceSize kBlockBytes = VkDeviceSize(32) << 20;
constexpr VkDeviceSize kSmallBlockBytes = VkDeviceSize(4) << 20; // the first block of a type: small contexts stay small

VkDeviceSize alignUp(VkDeviceSize value, VkDeviceSize alignment) {
  return (value + alignment - 1) / alignment * alignment;
}
} // namespace

GpuMemory::GpuMemory(const Device& device, HostMemory& host, const GpgpGpuAllocator* callbacks)
    : device_(device), host_(host), blocks_(&host), givenBack_(&host) {
  if (callbacks) callbacks_ = *callbacks;
  device_.vki.GetPhysicalDeviceMemoryProperties(device_.physicalDevice, &properties_);
}

GpuMemory::~GpuMemory() {
  freeGivenBack();
  for (const Block& block : blocks_) device_.vk.FreeMemory(device_.device, block.memory, nullptr);
}

void GpuMemory::count(GpgpService service, VkDeviceSize GpgpServiceMemory::*counter, VkDeviceSize bytes) {
  const std::lock_guard lock(mutex_);
  services_[service].*counter += bytes;
}

void GpuMemory::report(GpgpMemoryReport& report) const {
  const std::lock_guard lock(mutex_);
  std::copy_n(services_, GPGP_SERVICE_COUNT, report.services);
  report.blockBytes = 0;
  for (const Block& block : blocks_) report.blockBytes += block.size;
}

Result<uint32_t> GpuMemory::chooseType(const GpgpGpuAllocationRequest& request) const {
  for (const VkMemoryPropertyFlags wanted : {request.required | request.preferred, request.required})
    for (uint32_t type = 0; type < properties_.memoryTypeCount; ++type)
      if ((request.requirements.memoryTypeBits >> type & 1) &&
          (properties_.memoryTypes[type].propertyFlags & wanted) == wanted)
        return type;
  return makeError(GPGP_ERROR_OUT_OF_DEVICE_MEMORY, "no memory type of the device suits %s", request.label);
}

/// The engine's callbacks never overlap, and a frame does not wait for them: what it frees meanwhile is given back
/// here.
Result<GpgpGpuAllocation> GpuMemory::allocateFromEngine(const GpgpGpuAllocationRequest& request) {
  const std::lock_guard growing(growing_);
  freeGivenBack();
  {
    const std::lock_guard lock(mutex_);
    if (givenBack_.capacity() <= engineAllocations_) givenBack_.reserve(2 * engineAllocations_ + 16);
  }
  GpgpGpuAllocation allocation{};
  const VkResult result = callbacks_.allocate(callbacks_.userData, &request, &allocation);
  if (result != VK_SUCCESS) return vulkanError(result, "the engine's GPU allocator");
  if ((request.required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) && !allocation.mapped) {
    callbacks_.free(callbacks_.userData, &allocation);
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "the engine's GPU allocator returned host-visible memory that is "
                     "not mapped, for %s",
                     request.label);
  }
  const std::lock_guard lock(mutex_);
  ++engineAllocations_;
  return allocation;
}

void GpuMemory::freeGivenBack() {
  for (;;) {
    GpgpGpuAllocation allocation;
    {
      const std::lock_guard lock(mutex_);
      if (givenBack_.empty()) return;
      allocation = givenBack_.back();
      givenBack_.pop_back();
      --engineAllocations_;
    }
    callbacks_.free(callbacks_.userData, &allocation);
  }
}

/// A place in one of the blocks.
std::optional<GpgpGpuAllocation> GpuMemory::place(uint32_t type, const VkMemoryRequirements& requirements) {
  for (Block& block : blocks_) {
    if (block.type != type) continue;
    VkDeviceSize start = 0;
    auto at = block.used.begin();
    for (; at != block.used.end() && start + requirements.size > at->offset; ++at)
      start = alignUp(at->offset + at->size, requirements.alignment);
    if (at == block.used.end() && start + requirements.size > block.size) continue;
    block.used.insert(at, Range{start, requirements.size});
    return GpgpGpuAllocation{block.memory, start, block.mapped ? block.mapped + start : nullptr, nullptr};
  }
  return std::nullopt;
}

/// A block that is used from its beginning by `size` bytes.
Result<GpuMemory::Block> GpuMemory::makeBlock(uint32_t type, VkDeviceSize size) {
  Block block{VK_NULL_HANDLE, size, type, nullptr, std::pmr::vector<Range>(&host_)};
  {
    const std::lock_guard lock(mutex_);
    const bool first = std::none_of(blocks_.begin(), blocks_.end(), [&](const Block& b) { return b.type == type; });
    block.size = std::max(size, first ? kSmallBlockBytes : kBlockBytes);
    blocks_.reserve(blocks_.size() + 1); // what can throw comes before what must be undone; only growing adds blocks
  }
  block.used.push_back({0, size});
  const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, block.size, type};
  VkResult result = device_.vk.AllocateMemory(device_.device, &info, nullptr, &block.memory);
  if (result != VK_SUCCESS) return vulkanError(result, "vkAllocateMemory");
  if (properties_.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
    void* mapped = nullptr;
    result = device_.vk.MapMemory(device_.device, block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
    if (result != VK_SUCCESS) {
      device_.vk.FreeMemory(device_.device, block.memory, nullptr);
      return vulkanError(result, "vkMapMemory");
    }
    block.mapped = static_cast<char*>(mapped);
  }
  return block;
}

Result<GpgpGpuAllocation> GpuMemory::allocate(const GpgpGpuAllocationRequest& request) {
  if (callbacks_.allocate) return allocateFromEngine(request);
  const auto type = chooseType(request);
  if (!type) return type.error();
  const auto placed = [&] {
    const std::lock_guard lock(mutex_);
    return place(*type, request.requirements);
  };
  if (const auto found = placed()) return *found;
  const std::lock_guard growing(growing_);
  if (const auto found = placed()) return *found; // another thread has made a block meanwhile
  auto block = makeBlock(*type, request.requirements.size);
  if (!block) return block.error();
  const std::lock_guard lock(mutex_);
  blocks_.push_back(std::move(*block));
  return GpgpGpuAllocation{blocks_.back().memory, 0, blocks_.back().mapped, nullptr};
}

void GpuMemory::free(const GpgpGpuAllocation& allocation) {
  if (callbacks_.allocate) {
    {
      const std::lock_guard lock(mutex_);
      givenBack_.push_back(allocation); // into reserved room
    }
    if (const std::unique_lock growing(growing_, std::try_to_lock); growing) freeGivenBack();
    return;
  }
  VkDeviceMemory unused = VK_NULL_HANDLE;
  {
    const std::lock_guard lock(mutex_);
    const auto block =
        std::find_if(blocks_.begin(), blocks_.end(), [&](const Block& b) { return b.memory == allocation.memory; });
    if (block == blocks_.end()) return;
    std::erase_if(block->used, [&](const Range& range) { return range.offset == allocation.offset; });
    if (!block->used.empty()) return;
    unused = block->memory;
    blocks_.erase(block);
  }
  device_.vk.FreeMemory(device_.device, unused, nullptr);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  if (this == &other) return *this;
  reset();
  device_ = other.device_, memory_ = other.memory_, buffer_ = other.buffer_, allocation_ = other.allocation_;
  size_ = other.size_, service_ = other.service_, hostVisible_ = other.hostVisible_, pending_ = other.pending_;
  other.buffer_ = VK_NULL_HANDLE;
  return *this;
}

Result<Buffer> Buffer::create(const Device& device, GpuMemory& memory, GpgpService service, const char* label,
                              VkDeviceSize size, VkBufferUsageFlags usage, MemoryPlace place) {
  Buffer buffer;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = size;
  info.usage = usage;
  VkBuffer handle = VK_NULL_HANDLE;
  VkResult result = device.vk.CreateBuffer(device.device, &info, nullptr, &handle);
  if (result != VK_SUCCESS) return vulkanError(result, "vkCreateBuffer");

  GpgpGpuAllocationRequest request{};
  device.vk.GetBufferMemoryRequirements(device.device, handle, &request.requirements);
  request.service = service;
  request.label = label;
  if (place == MemoryPlace::device) {
    request.preferred = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  } else {
    request.required = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    if (place == MemoryPlace::constants) request.preferred = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    if (place == MemoryPlace::readBack) request.preferred = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  }
  Result<GpgpGpuAllocation> allocation = Error{};
  try {
    allocation = memory.allocate(request);
  } catch (...) {
    device.vk.DestroyBuffer(device.device, handle, nullptr);
    throw;
  }
  if (!allocation) {
    device.vk.DestroyBuffer(device.device, handle, nullptr);
    return allocation.error();
  }
  result = device.vk.BindBufferMemory(device.device, handle, allocation->memory, allocation->offset);
  if (result != VK_SUCCESS) {
    device.vk.DestroyBuffer(device.device, handle, nullptr);
    memory.free(*allocation);
    return vulkanError(result, "vkBindBufferMemory");
  }
  device.setName(VK_OBJECT_TYPE_BUFFER, handle, label, "");
  buffer.device_ = &device, buffer.memory_ = &memory, buffer.buffer_ = handle, buffer.allocation_ = *allocation;
  buffer.size_ = size, buffer.service_ = service, buffer.hostVisible_ = place != MemoryPlace::device;
  memory.count(service, buffer.counter(), size);
  return buffer;
}

void Buffer::markPending() {
  if (!buffer_ || pending_) return;
  memory_->count(service_, &GpgpServiceMemory::pendingBytes, size_);
  pending_ = true;
}

void Buffer::reset() {
  if (!buffer_) return;
  device_->vk.DestroyBuffer(device_->device, buffer_, nullptr);
  memory_->free(allocation_);
  memory_->count(service_, counter(), -size_);
  if (pending_) memory_->count(service_, &GpgpServiceMemory::pendingBytes, -size_);
  buffer_ = VK_NULL_HANDLE;
}

} // namespace gpgp::core
