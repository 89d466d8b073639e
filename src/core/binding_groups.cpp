// A recorder's descriptors: which shaders share a set, its layouts, and the sets of each recording in flight.
#include "core/recorder.h"

#include <algorithm>
#include <bit>

namespace gpgp::core {
namespace {
constexpr VkDeviceSize kPushConstantBytes = 128;

constexpr uint64_t bit(size_t resource) { return uint64_t(1) << resource; }

bool isStorageBuffer(const Resource& resource) {
  return descriptorType(resource.kind) == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

} // namespace

Result<void> Recorder::groupBindings(uint32_t formCount) {
  const uint32_t limit = context.device.limits.maxPerStageDescriptorStorageBuffers;
  uint64_t all = 0, buffers = 0;
  for (size_t i = 0; i < passes_.resources.size(); ++i) {
    if (passes_.resources[i].kind != ResourceKind::texture) all |= bit(i);
    if (isStorageBuffer(passes_.resources[i])) buffers |= bit(i);
  }
  groupOf_.assign(passes_.shaders.size(), 0);
  computeGroups_ = 1;
  if (static_cast<uint32_t>(std::popcount(buffers)) <= limit) {
    groups_.push_back({all});
    return {};
  }
  const auto bindingsOfCode = [&](const ShaderCode& code) -> Result<uint64_t> {
    if (code.count == 0) return uint64_t(0);
    const auto words = ShaderWords::of(code, &context.host());
    if (!words) return words.error();
    return bindingsOf(words->words());
  };
  const auto checkFits = [&](const char* shader, uint64_t resources) -> Result<void> {
    if (const int count = std::popcount(resources & buffers); static_cast<uint32_t>(count) > limit)
      return makeError(GPGP_ERROR_UNSUPPORTED,
                       "the shader \"%s\" takes %d storage buffers, but a stage of the device has %u "
                       "(maxPerStageDescriptorStorageBuffers)",
                       shader, count, limit);
    return {};
  };
  size_t open = SIZE_MAX; // the group that the next shader joins where it fits
  for (size_t i = 0; i < passes_.shaders.size(); ++i) {
    const ShaderDesc& shader = passes_.shaders[i];
    uint64_t resources = shader.bindings;
    if (!resources) {
      const auto found = bindingsOfCode(shader.spirv);
      if (!found) return found.error();
      resources = *found;
    }
    if (auto ok = checkFits(shader.name, resources); !ok) return ok;
    const auto fits = [&](uint64_t group) {
      return static_cast<uint32_t>(std::popcount((group | resources) & buffers)) <= limit;
    };
    if (shader.bindings) { // alone, so that it is the same in all recorders
      groupOf_[i] = static_cast<uint8_t>(groups_.size());
      groups_.push_back({resources});
    } else if (open != SIZE_MAX && fits(groups_[open].resources)) {
      groupOf_[i] = static_cast<uint8_t>(open);
      groups_[open].resources |= resources;
    } else {
      open = groups_.size();
      groupOf_[i] = static_cast<uint8_t>(open);
      groups_.push_back({resources});
    }
  }
  computeGroups_ = static_cast<uint32_t>(groups_.size());
  for (uint32_t form = 0; form < formCount; ++form) {
    uint64_t resources = 0;
    const DrawShaders& draw = draw_[form];
    for (const ShaderDesc* shader : {&draw.vertex, &draw.fragment, &draw.multiviewVertex, &draw.multiviewFragment}) {
      const auto found = bindingsOfCode(shader->spirv);
      if (!found) return found.error();
      resources |= *found;
    }
    if (auto ok = checkFits(draw.fragment.name, resources); !ok) return ok;
    groupOfDraw_[form] = static_cast<uint8_t>(groups_.size());
    groups_.push_back({resources});
  }
  return {};
}

Result<void> Recorder::createLayouts() {
  const Device& device = context.device;
  const VkShaderStageFlags stages = shaderStages();
  std::array<VkDescriptorSetLayoutBinding, kMaxResources> bindings{};
  VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  setInfo.pBindings = bindings.data();
  for (uint32_t i = 0; i < passes_.resources.size(); ++i) {
    if (passes_.resources[i].kind != ResourceKind::texture) continue;
    if (textureCount_ == 0) firstTexture_ = i;
    bindings[textureCount_++] = {i - firstTexture_, descriptorType(ResourceKind::texture), 1, stages, nullptr};
  }
  if (textureCount_) {
    setInfo.bindingCount = textureCount_;
    const VkResult result = device.vk.CreateDescriptorSetLayout(device.device, &setInfo, nullptr, &textureLayout_);
    if (result != VK_SUCCESS) return vulkanError(result, "vkCreateDescriptorSetLayout");
  }
  for (BindingGroup& group : groups_) {
    setInfo.bindingCount = 0;
    for (uint32_t i = 0; i < passes_.resources.size(); ++i)
      if (group.resources & bit(i))
        bindings[setInfo.bindingCount++] = {i, descriptorType(passes_.resources[i].kind), 1, stages, nullptr};
    VkResult result = device.vk.CreateDescriptorSetLayout(device.device, &setInfo, nullptr, &group.setLayout);
    if (result != VK_SUCCESS) return vulkanError(result, "vkCreateDescriptorSetLayout");
    const VkDescriptorSetLayout setLayouts[2] = {group.setLayout, textureLayout_};
    const VkPushConstantRange range{stages, 0, kPushConstantBytes};
    VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layoutInfo.setLayoutCount = textureCount_ ? 2 : 1;
    layoutInfo.pSetLayouts = setLayouts;
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &range;
    result = device.vk.CreatePipelineLayout(device.device, &layoutInfo, nullptr, &group.layout);
    if (result != VK_SUCCESS) return vulkanError(result, "vkCreatePipelineLayout");
  }
  return {};
}

Result<void> Recorder::createSets(uint32_t slotCount) {
  const Device& device = context.device;
  std::array<VkDescriptorPoolSize, 4> sizes{{{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 0},
                                             {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 0},
                                             {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 0},
                                             {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 0}}};
  const auto count = [&](VkDescriptorType type, uint32_t descriptors) {
    for (VkDescriptorPoolSize& size : sizes)
      if (size.type == type) size.descriptorCount += descriptors;
  };
  for (const BindingGroup& group : groups_)
    for (size_t i = 0; i < passes_.resources.size(); ++i)
      if (group.resources & bit(i)) count(descriptorType(passes_.resources[i].kind), slotCount + 1);
  count(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, textureCount_ * (slotCount * passes_.texturePages + 1));
  sizes[0].descriptorCount = std::max(1u, sizes[0].descriptorCount);
  const auto end = std::partition(sizes.begin(), sizes.end(),
                                  [](const VkDescriptorPoolSize& size) { return size.descriptorCount != 0; });

  std::pmr::vector<VkDescriptorSetLayout> layouts(&context.host());
  for (uint32_t slot = 0; slot <= slotCount; ++slot)
    for (const BindingGroup& group : groups_) layouts.push_back(group.setLayout);
  sets_.resize(layouts.size());
  textureSets_.resize(textureCount_ ? size_t(slotCount) * passes_.texturePages + 1 : 0);
  VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  poolInfo.maxSets = static_cast<uint32_t>(sets_.size() + textureSets_.size());
  poolInfo.poolSizeCount = static_cast<uint32_t>(end - sizes.begin());
  poolInfo.pPoolSizes = sizes.data();
  VkResult result = device.vk.CreateDescriptorPool(device.device, &poolInfo, nullptr, &pool_);
  if (result != VK_SUCCESS) return vulkanError(result, "vkCreateDescriptorPool");
  const auto allocate = [&](std::pmr::vector<VkDescriptorSet>& sets) {
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorPool = pool_;
    info.descriptorSetCount = static_cast<uint32_t>(sets.size());
    info.pSetLayouts = layouts.data();
    return sets.empty() ? VK_SUCCESS : device.vk.AllocateDescriptorSets(device.device, &info, sets.data());
  };
  result = allocate(sets_);
  if (result != VK_SUCCESS) return vulkanError(result, "vkAllocateDescriptorSets");
  layouts.assign(textureSets_.size(), textureLayout_);
  result = allocate(textureSets_);
  if (result != VK_SUCCESS) return vulkanError(result, "vkAllocateDescriptorSets");
  return {};
}

void Recorder::writeDescriptors(uint32_t slot, uint32_t first, uint32_t groupCount,
                                const std::array<Binding, kMaxResources>& bindings, VkBuffer scratch,
                                VkDeviceSize scratchOffset, bool reports) const {
  std::array<VkWriteDescriptorSet, kMaxResources> writes;
  std::array<VkDescriptorBufferInfo, kMaxResources> buffers;
  std::array<VkDescriptorImageInfo, kMaxResources> images;
  uint32_t count = 0;
  // Images and textures without a view, by resource: passes that use them are skipped. But lavapipe looks at all
  // descriptors of a set when it is bound, and the images of an earlier recording may be gone.
  uint64_t leftOut = 0;
  const auto empty = static_cast<uint32_t>(slots_.size()); // whose sets are never written
  const VkDescriptorSet textureSet = textureSets_.empty() ? VK_NULL_HANDLE : textureSets_[slot * passes_.texturePages];
  for (uint32_t i = 0; i < passes_.resources.size(); ++i) {
    const Resource& resource = passes_.resources[i];
    const Binding& binding = bindings[i];
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, VK_NULL_HANDLE, i,      0, 1,
                               descriptorType(resource.kind),          nullptr, &buffers[i],    nullptr};
    // What a recording leaves out is bound to a harmless range: passes that would use it are skipped or check a flag.
    buffers[i] = {constants_.handle(), resource.written ? unusedOffset_ : 0,
                  resource.written ? kUnusedBytes : std::clamp<VkDeviceSize>(passes_.constantsBytes, 16, kUnusedBytes)};
    if (resource.kind == ResourceKind::image) {
      if (!binding.image || !binding.image->view) {
        leftOut |= uint64_t(1) << i;
        continue;
      }
      images[i] = {VK_NULL_HANDLE, binding.image->view, VK_IMAGE_LAYOUT_GENERAL};
      write.pImageInfo = &images[i];
      write.pBufferInfo = nullptr;
    } else if (resource.kind == ResourceKind::texture) {
      if (!binding.texture.imageView) { // or textures come in pages
        leftOut |= uint64_t(1) << i;
        continue;
      }
      images[i] = binding.texture;
      write.dstSet = textureSet;
      write.dstBinding = i - firstTexture_;
      write.pImageInfo = &images[i];
      write.pBufferInfo = nullptr;
    } else if (resource.kind == ResourceKind::scratch) {
      if (scratch)
        buffers[i] = {scratch, scratchOffset + passes_.scratchOffsets[i], std::max<VkDeviceSize>(resource.bytes, 4)};
    } else if (resource.kind == ResourceKind::constants || resource.kind == ResourceKind::uniforms) {
      buffers[i] = {constants_.handle(), slot * passes_.constantsBytes + passes_.scratchOffsets[i], resource.bytes};
    } else if (resource.kind == ResourceKind::report) {
      if (reports) buffers[i] = {reports_.handle(), slot * reportStride_, passes_.reportBytes};
    } else if (binding.scratch != UINT32_MAX) {
      if (scratch)
        buffers[i] = {scratch, scratchOffset + passes_.scratchOffsets[binding.scratch],
                      passes_.resources[binding.scratch].bytes};
    } else if (!binding.hostData.empty()) {
      buffers[i] = {constants_.handle(), slot * passes_.constantsBytes + passes_.scratchOffsets[i],
                    binding.hostData.size()};
    } else if (binding.ownBuffer) {
      buffers[i] = {binding.ownBuffer, binding.ownOffset, binding.ownSize};
    } else if (binding.engineBuffer && binding.engineBuffer->buffer) {
      buffers[i] = {binding.engineBuffer->buffer, binding.engineBuffer->offset, binding.engineBuffer->size};
    }
    writes[count++] = write;
  }
  for (uint32_t group = first; group < first + groupCount; ++group) {
    std::array<VkWriteDescriptorSet, kMaxResources> ofGroup;
    std::array<VkCopyDescriptorSet, kMaxResources> emptied;
    uint32_t written = 0, emptiedCount = 0;
    for (uint32_t i = 0; i < count; ++i) {
      const bool isTexture = writes[i].dstSet != VK_NULL_HANDLE;
      if (isTexture ? group != first : !(groups_[group].resources >> writes[i].dstBinding & 1)) continue;
      ofGroup[written] = writes[i];
      if (!isTexture) ofGroup[written].dstSet = setOf(slot, group);
      ++written;
    }
    for (uint32_t i = 0; leftOut >> i; ++i) {
      if (!(leftOut >> i & 1)) continue;
      const bool isTexture = passes_.resources[i].kind == ResourceKind::texture;
      if (isTexture ? group != first : !(groups_[group].resources >> i & 1)) continue;
      const uint32_t binding = isTexture ? i - firstTexture_ : i;
      emptied[emptiedCount++] = {VK_STRUCTURE_TYPE_COPY_DESCRIPTOR_SET,
                                 nullptr,
                                 isTexture ? textureSets_.back() : setOf(empty, group),
                                 binding,
                                 0,
                                 isTexture ? textureSet : setOf(slot, group),
                                 binding,
                                 0,
                                 1};
    }
    context.device.vk.UpdateDescriptorSets(context.device.device, written, ofGroup.data(), emptiedCount,
                                           emptied.data());
  }
}

} // namespace gpgp::core
