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
    : device_(device), host_(host), blocks_(&host) {
  if (callbacks) callbacks_ = *callbacks;
  device_.vki.GetPhysicalDeviceMemoryProperties(device_.physicalDevice, &properties_);
}

GpuMemory::~GpuMemory() {
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

Result<GpgpGpuAllocation> GpuMemory::allocate(const GpgpGpuAllocationRequest& request) {
  const std::lock_guard lock(mutex_);
  const VkDeviceSize size = request.requirements.size;
  if (callbacks_.allocate) {
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
    return allocation;
  }
  const auto type = chooseType(request);
  if (!type) return type.error();

  VkDeviceSize typeBytes = 0;
  for (Block& block : blocks_) {
    if (block.type != *type) continue;
    typeBytes += block.size;
    VkDeviceSize start = 0;
    auto at = block.used.begin();
    for (; at != block.used.end() && start + size > at->offset; ++at)
      start = alignUp(at->offset + at->size, request.requirements.alignment);
    if (at == block.used.end() && start + size > block.size) continue;
    block.used.insert(at, Range{start, size});
    return GpgpGpuAllocation{block.memory, start, block.mapped ? block.mapped + start : nullptr, nullptr};
  }

  const VkDeviceSize blockSize = std::max(size, typeBytes ? kBlockBytes : kSmallBlockBytes);
  Block block{VK_NULL_HANDLE, blockSize, *type, nullptr, std::pmr::vector<Range>(&host_)};
  block.used.push_back({0, size});
  blocks_.reserve(blocks_.size() + 1); // what can throw comes before what must be undone
  const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, blockSize, *type};
  VkResult result = device_.vk.AllocateMemory(device_.device, &info, nullptr, &block.memory);
  if (result != VK_SUCCESS) return vulkanError(result, "vkAllocateMemory");
  if (properties_.memoryTypes[*type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
    void* mapped = nullptr;
    result = device_.vk.MapMemory(device_.device, block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
    if (result != VK_SUCCESS) {
      device_.vk.FreeMemory(device_.device, block.memory, nullptr);
      return vulkanError(result, "vkMapMemory");
    }
    block.mapped = static_cast<char*>(mapped);
  }
  const GpgpGpuAllocation allocation{block.memory, 0, block.mapped, nullptr};
  blocks_.push_back(std::move(block));
  return allocation;
}

void GpuMemory::free(const GpgpGpuAllocation& allocation) {
  const std::lock_guard lock(mutex_);
  if (callbacks_.allocate) return callbacks_.free(callbacks_.userData, &allocation);
  for (auto block = blocks_.begin(); block != blocks_.end(); ++block) {
    if (block->memory != allocation.memory) continue;
    std::erase_if(block->used, [&](const Range& range) { return range.offset == allocation.offset; });
    if (block->used.empty()) {
      device_.vk.FreeMemory(device_.device, block->memory, nullptr);
      blocks_.erase(block);
    }
    return;
  }
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
