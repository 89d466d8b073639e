// Recording: a pass list into the engine's command buffer. Allocates nothing, locks nothing, makes no pipeline.
#include "core/recorder.h"

#include <algorithm>
#include <cstring>

namespace gpgp::core {
namespace {
constexpr VkPipelineStageFlags kWorkStages =
    VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT;
constexpr VkAccessFlags kWorkWrites = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
constexpr VkAccessFlags kWorkReads =
    VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT;

/// A barrier between passes, from and to kinds of them (bits by PassKind): stages and caches that none of them uses
/// would cost microseconds on some devices.
void passBarrier(const DeviceTable& vk, VkCommandBuffer commandBuffer, uint32_t from, uint32_t to) {
  const auto has = [](uint32_t kinds, PassKind kind) { return (kinds >> static_cast<uint32_t>(kind) & 1) != 0; };
  const auto computes = [&](uint32_t kinds) {
    return has(kinds, PassKind::dispatch) || has(kinds, PassKind::dispatchIndirect);
  };
  VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  VkPipelineStageFlags source = 0, target = 0;
  if (computes(from)) {
    source |= VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    memory.srcAccessMask |= VK_ACCESS_SHADER_WRITE_BIT;
  }
  if (has(from, PassKind::fill)) {
    source |= VK_PIPELINE_STAGE_TRANSFER_BIT;
    memory.srcAccessMask |= VK_ACCESS_TRANSFER_WRITE_BIT;
  }
  if (computes(to)) {
    target |= VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    memory.dstAccessMask |= VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
  }
  if (has(to, PassKind::dispatchIndirect)) {
    target |= VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT;
    memory.dstAccessMask |= VK_ACCESS_INDIRECT_COMMAND_READ_BIT;
  }
  if (has(to, PassKind::fill)) {
    target |= VK_PIPELINE_STAGE_TRANSFER_BIT;
    memory.dstAccessMask |= VK_ACCESS_TRANSFER_WRITE_BIT;
  }
  vk.CmdPipelineBarrier(commandBuffer, source, target, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

constexpr VkPipelineStageFlags kGraphicsStages =
    VK_PIPELINE_STAGE_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
    VK_PIPELINE_STAGE_TESSELLATION_CONTROL_SHADER_BIT | VK_PIPELINE_STAGE_TESSELLATION_EVALUATION_SHADER_BIT |
    VK_PIPELINE_STAGE_GEOMETRY_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
    VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT |
    VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;

/// 64-bit stages as 32-bit ones: the low words agree, each new stage becomes the older one that contains it.
VkPipelineStageFlags stages32(VkPipelineStageFlags2 stages) {
  VkPipelineStageFlags mapped = static_cast<VkPipelineStageFlags>(stages & 0xffffffffu);
  if (stages & (VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_RESOLVE_BIT | VK_PIPELINE_STAGE_2_BLIT_BIT |
                VK_PIPELINE_STAGE_2_CLEAR_BIT))
    mapped |= VK_PIPELINE_STAGE_TRANSFER_BIT;
  if (stages & (VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT | VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT))
    mapped |= VK_PIPELINE_STAGE_VERTEX_INPUT_BIT;
  if (stages & VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT) mapped |= VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;
  constexpr VkPipelineStageFlags2 kKnown =
      0xffffffffu | VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_RESOLVE_BIT | VK_PIPELINE_STAGE_2_BLIT_BIT |
      VK_PIPELINE_STAGE_2_CLEAR_BIT | VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT |
      VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT | VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT;
  if (stages & ~kKnown) mapped |= VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  return mapped;
}

/// Accesses of stages, the same way; none without a stage.
VkAccessFlags access32(const GpgpAccess& use) {
  if (!use.stages) return 0;
  const VkAccessFlags2 access = use.access;
  VkAccessFlags mapped = static_cast<VkAccessFlags>(access & 0xffffffffu);
  if (access & (VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT))
    mapped |= VK_ACCESS_SHADER_READ_BIT;
  if (access & VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT) mapped |= VK_ACCESS_SHADER_WRITE_BIT;
  constexpr VkAccessFlags2 kKnown = 0xffffffffu | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT |
                                    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  if (access & ~kKnown) mapped |= VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  return mapped;
}

Result<void> checkStages(const char* resource, const char* edge, const GpgpAccess& access, VkQueueFlags queue) {
  if (!(queue & VK_QUEUE_GRAPHICS_BIT) && (stages32(access.stages) & kGraphicsStages))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "%s.%s.stages names graphics stages, but the recorder's queue family has no graphics", resource,
                     edge);
  return {};
}
} // namespace

Result<void> Recorder::check(const Record& record) const {
  if (auto ok = context.checkAlive(); !ok) return ok;
  if (!record.commandBuffer) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "commandBuffer is NULL");
  const VkPhysicalDeviceLimits& limits = context.device.limits;
  const GpgpTimestamps& timestamps = record.info->timestamps;
  if (timestamps.queryPool && timestamps.queryCount < passes_.passes.size() + 1)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "base.timestamps.queryCount is %u, but %zu passes need %zu",
                     timestamps.queryCount, passes_.passes.size(), passes_.passes.size() + 1);
  if (timestamps.queryPool && timestampBits_ == 0)
    return makeError(GPGP_ERROR_UNSUPPORTED, "queue family %u writes no timestamps", queueFamily_);
  if (record.info->accessMode & ~GPGP_ACCESS_EXTERNAL_BARRIERS)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "base.accessMode has unknown bits");
  if (engineScratch_) {
    const GpgpBuffer& scratch = record.info->scratch;
    if (!scratch.buffer)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                       "base.scratch.buffer is NULL; the recorder was made with engineScratch");
    if (scratch.offset % scratchAlignment())
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "base.scratch.offset must be a multiple of %llu",
                       static_cast<unsigned long long>(scratchAlignment()));
    if (scratch.offset > UINT64_MAX - scratch.size)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "base.scratch.offset + size is beyond 64 bits");
    if (scratch.size < passes_.scratchBytes)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "base.scratch.size is %llu, gpgpGetScratchSize says %llu",
                       static_cast<unsigned long long>(scratch.size),
                       static_cast<unsigned long long>(passes_.scratchBytes));
  }
  for (const Step& step : record.steps)
    for (uint32_t axis = 0; axis < 3; ++axis)
      if (step.groups[axis] > limits.maxComputeWorkGroupCount[axis])
        return makeError(GPGP_ERROR_UNSUPPORTED, "a step needs %u workgroups in a row; this device dispatches %u",
                         step.groups[axis], limits.maxComputeWorkGroupCount[axis]);
  for (uint32_t i = 0; i < passes_.groupCounts; ++i)
    for (uint32_t axis = 0; axis < 3; ++axis)
      if (record.groups[i][axis] > limits.maxComputeWorkGroupCount[axis])
        return makeError(GPGP_ERROR_UNSUPPORTED,
                         "the recording needs %u workgroups in a row; this device dispatches %u",
                         record.groups[i][axis], limits.maxComputeWorkGroupCount[axis]);
  for (size_t i = 0; i < passes_.resources.size(); ++i) {
    const Resource& resource = passes_.resources[i];
    const Binding& binding = record.bindings[i];
    const char* name = binding.name ? binding.name : resource.name;
    if (resource.kind == ResourceKind::buffer) {
      if (binding.ownBuffer || !binding.hostData.empty() || binding.scratch != UINT32_MAX) continue;
      if (!binding.engineBuffer || !binding.engineBuffer->buffer) {
        if (resource.optional) continue;
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.buffer is NULL", name);
      }
      const GpgpBuffer& buffer = *binding.engineBuffer;
      if (buffer.size == 0 || buffer.size > limits.maxStorageBufferRange)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.size is %llu; it must be 1 to %u (maxStorageBufferRange)",
                         name, static_cast<unsigned long long>(buffer.size), limits.maxStorageBufferRange);
      if (buffer.offset > UINT64_MAX - buffer.size)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.offset + size is beyond 64 bits", name);
      if (buffer.offset % limits.minStorageBufferOffsetAlignment)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                         "%s.offset must be a multiple of %llu (minStorageBufferOffsetAlignment)", name,
                         static_cast<unsigned long long>(limits.minStorageBufferOffsetAlignment));
      for (const auto& [edge, access] : {std::pair{"before", buffer.before}, {"after", buffer.after}})
        if (auto ok = checkStages(name, edge, access, queueFlags_); !ok) return ok;
    } else if (resource.kind == ResourceKind::image) {
      if (!binding.image || !binding.image->view) {
        if (resource.optional) continue;
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.view is NULL", name);
      }
      if (binding.image->after.stages && binding.image->after.layout == VK_IMAGE_LAYOUT_UNDEFINED &&
          !(record.info->accessMode & GPGP_ACCESS_EXTERNAL_BARRIERS))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.after.layout is UNDEFINED: nothing could be found there",
                         name);
      if (!binding.image->image) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.image is NULL", name);
      for (const auto& [edge, access] : {std::pair{"before", binding.image->before}, {"after", binding.image->after}})
        if (auto ok = checkStages(name, edge, access, queueFlags_); !ok) return ok;
    }
  }
  return {};
}

Result<uint32_t> Recorder::acquire() const {
  uint32_t inFrame = 0, free = UINT32_MAX;
  for (uint32_t i = 0; i < slots_.size(); ++i) {
    if (!slots_[i].marker)
      free = i;
    else
      inFrame += slots_[i].frame == context.current();
  }
  if (inFrame >= context.maxRecordingsPerFrame || free == UINT32_MAX)
    return makeError(GPGP_ERROR_TOO_MANY_RECORDINGS,
                     "the context was made for %u recordings per frame and recorder, and %u "
                     "frames in flight",
                     context.maxRecordingsPerFrame, context.maxFramesInFlight);
  return free;
}

void Recorder::take(uint32_t slot, uint64_t tag, bool report, uint32_t readBackBytes) {
  slots_[slot] = {context.current(), tag, nextMarker_, report, report, readBackBytes, {}};
  if (++nextMarker_ == 0) nextMarker_ = 1;
}

void Recorder::beginLabel(VkCommandBuffer commandBuffer, const char* pass) const {
  const DeviceTable& vk = context.device.vk;
  if (!vk.CmdBeginDebugUtilsLabelEXT) return;
  static constexpr const char* kServices[GPGP_SERVICE_COUNT] = {"core", "spawn", "vector", "visibility"};
  char name[160];
  if (pass)
    std::snprintf(name, sizeof name, "gpgp/%s/%s", kServices[service_], pass);
  else
    std::snprintf(name, sizeof name, "gpgp/%s %s", kServices[service_], label.text);
  const VkDebugUtilsLabelEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, name, {}};
  vk.CmdBeginDebugUtilsLabelEXT(commandBuffer, &info);
}

void Recorder::endLabel(VkCommandBuffer commandBuffer) const {
  if (context.device.vk.CmdEndDebugUtilsLabelEXT) context.device.vk.CmdEndDebugUtilsLabelEXT(commandBuffer);
}

/// One barrier at each end of a recording. Entry: the engine's last uses, and this recorder's previous recording
/// (scratch, histories). Exit: the engine's next uses, the draw path, and the host that reads the report.
void Recorder::edgeBarrier(const Record& record, bool entry) const {
  const bool engine = !(record.info->accessMode & GPGP_ACCESS_EXTERNAL_BARRIERS);
  const VkPipelineStageFlags drawStage = draws_ ? VkPipelineStageFlags(VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT) : 0;
  VkPipelineStageFlags outside = entry ? kWorkStages | drawStage : VK_PIPELINE_STAGE_HOST_BIT | drawStage;
  const VkAccessFlags drawAccess = draws_ ? VkAccessFlags(VK_ACCESS_SHADER_READ_BIT) : 0;
  VkAccessFlags outsideAccess = entry ? kWorkWrites : VK_ACCESS_HOST_READ_BIT | drawAccess;
  std::array<VkImageMemoryBarrier, 4> images;
  uint32_t imageCount = 0;
  for (size_t i = 0; engine && i < passes_.resources.size(); ++i) {
    const Binding& binding = record.bindings[i];
    if (binding.engineBuffer && binding.engineBuffer->buffer) {
      const GpgpAccess& access = entry ? binding.engineBuffer->before : binding.engineBuffer->after;
      outside |= stages32(access.stages);
      outsideAccess |= access32(access);
    }
    if (binding.image && binding.image->view && imageCount < images.size()) {
      const GpgpAccess& access = entry ? binding.image->before : binding.image->after;
      if (!entry && !access.stages) continue; // the engine places it
      outside |= stages32(access.stages);
      VkImageMemoryBarrier& barrier = images[imageCount++];
      barrier = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
      barrier.srcAccessMask = entry ? access32(access) : VkAccessFlags(VK_ACCESS_SHADER_WRITE_BIT);
      barrier.dstAccessMask =
          entry ? VkAccessFlags(VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT) : access32(access);
      barrier.oldLayout = entry ? access.layout : VK_IMAGE_LAYOUT_GENERAL;
      barrier.newLayout = entry ? VK_IMAGE_LAYOUT_GENERAL : access.layout;
      barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
      barrier.image = binding.image->image;
      barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, binding.image->mipLevel, 1, binding.image->arrayLayer, 1};
    }
  }
  VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  memory.srcAccessMask = entry ? outsideAccess : kWorkWrites;
  memory.dstAccessMask = entry ? kWorkReads | kWorkWrites : outsideAccess;
  context.device.vk.CmdPipelineBarrier(record.commandBuffer, entry ? outside : kWorkStages,
                                       entry ? kWorkStages : outside, 0, 1, &memory, 0, nullptr, imageCount,
                                       images.data());
}

void recordFillBarrier(const Device& device, VkCommandBuffer commandBuffer, const GpgpAccess& use, bool entry) {
  const VkPipelineStageFlags stages = stages32(use.stages) | kWorkStages, fills = VK_PIPELINE_STAGE_TRANSFER_BIT;
  VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  memory.srcAccessMask = entry ? access32(use) | kWorkWrites : VkAccessFlags(VK_ACCESS_TRANSFER_WRITE_BIT);
  memory.dstAccessMask = entry ? VkAccessFlags(VK_ACCESS_TRANSFER_WRITE_BIT) : access32(use) | kWorkReads | kWorkWrites;
  device.vk.CmdPipelineBarrier(commandBuffer, entry ? stages : fills, entry ? fills : stages, 0, 1, &memory, 0, nullptr,
                               0, nullptr);
}

/// What stands in place of a recording that has nothing to do: that it ran, and where the engine's images go.
void Recorder::recordNothing(const Record& record, uint32_t slot) const {
  const DeviceTable& vk = context.device.vk;
  const VkCommandBuffer cmd = record.commandBuffer;
  const bool engine = !(record.info->accessMode & GPGP_ACCESS_EXTERNAL_BARRIERS);
  beginLabel(cmd, nullptr);
  vk.CmdFillBuffer(cmd, reports_.handle(), slot * reportStride_ + passes_.reportBytes, 4, slots_[slot].marker);
  VkPipelineStageFlags from = VK_PIPELINE_STAGE_TRANSFER_BIT, to = VK_PIPELINE_STAGE_HOST_BIT;
  std::array<VkImageMemoryBarrier, 4> images;
  uint32_t imageCount = 0;
  for (size_t i = 0; engine && i < passes_.resources.size(); ++i) {
    const GpgpImage* image = record.bindings[i].image;
    if (!image || !image->view || imageCount == images.size()) continue;
    from |= stages32(image->before.stages);
    to |= stages32(image->after.stages);
    VkImageMemoryBarrier& barrier = images[imageCount++];
    barrier = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    barrier.srcAccessMask = access32(image->before);
    barrier.dstAccessMask = access32(image->after);
    barrier.oldLayout = image->before.layout;
    barrier.newLayout = image->after.stages ? image->after.layout : VK_IMAGE_LAYOUT_GENERAL; // as all passes leave it
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image->image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, image->mipLevel, 1, image->arrayLayer, 1};
  }
  const VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_WRITE_BIT,
                               VK_ACCESS_HOST_READ_BIT};
  vk.CmdPipelineBarrier(cmd, from, to, 0, 1, &memory, 0, nullptr, imageCount, images.data());
  const GpgpTimestamps& timestamps = record.info->timestamps;
  for (uint32_t i = 0; timestamps.queryPool && i <= passes_.passes.size(); ++i)
    vk.CmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps.queryPool, timestamps.firstQuery + i);
  endLabel(cmd);
}

std::byte* Recorder::constants() const {
  const auto slot = acquire();
  return slot ? reinterpret_cast<std::byte*>(constants_.mapped()) + *slot * passes_.constantsBytes : nullptr;
}

Result<void> Recorder::record(const Record& record) {
  const auto acquired = acquire();
  if (!acquired) return acquired.error();
  const uint32_t slot = *acquired;
  std::byte* to = constants();
  take(slot, record.info->tag, true, record.readBackBytes);
  slots_[slot].counts = !record.nothing;
  slots_[slot].note = record.note;

  const DeviceTable& vk = context.device.vk;
  const VkCommandBuffer cmd = record.commandBuffer;
  const VkBuffer scratch = engineScratch_ ? record.info->scratch.buffer : scratch_.handle();
  const VkDeviceSize scratchOffset = engineScratch_ ? record.info->scratch.offset : 0;
  char* report = reports_.mapped() + slot * reportStride_;
  std::memset(report + passes_.reportBytes, 0, 4);
  if (record.nothing) {
    std::fill(ran_.begin(), ran_.end(), uint8_t(0));
    recordNothing(record, slot);
    return {};
  }
  for (const std::span<const std::byte> part : record.constants) {
    if (!part.empty() && part.data() != to) std::memcpy(to, part.data(), part.size());
    to += part.size();
  }
  for (size_t i = 0; i < passes_.resources.size(); ++i)
    if (const auto data = record.bindings[i].hostData; !data.empty())
      std::memcpy(constants_.mapped() + slot * passes_.constantsBytes + passes_.scratchOffsets[i], data.data(),
                  data.size());
  writeDescriptors(slot, 0, computeGroups_, record.bindings, scratch, scratchOffset, record.reports);
  const VkDescriptorSet* const textureSets =
      textureSets_.empty() ? nullptr : &textureSets_[slot * passes_.texturePages];
  const uint32_t pages = static_cast<uint32_t>(record.pageConstants.size());
  for (uint32_t page = 0; page < pages; ++page) {
    const VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     nullptr,
                                     textureSets[page],
                                     0,
                                     0,
                                     textureCount_, // bindings of one type go on from one to the next
                                     descriptorType(ResourceKind::texture),
                                     &record.pages[size_t(page) * textureCount_],
                                     nullptr,
                                     nullptr};
    vk.UpdateDescriptorSets(context.device.device, 1, &write, 0, nullptr);
  }

  // Where a buffer resource lies, for transfers and indirect arguments.
  const auto place = [&](ResourceIndex i) -> std::pair<VkBuffer, VkDeviceSize> {
    const Binding& binding = record.bindings[i];
    if (passes_.resources[i].kind == ResourceKind::scratch) return {scratch, scratchOffset + passes_.scratchOffsets[i]};
    if (binding.ownBuffer) return {binding.ownBuffer, binding.ownOffset};
    return {binding.engineBuffer->buffer, binding.engineBuffer->offset};
  };
  const auto placeSize = [&](ResourceIndex i) -> VkDeviceSize {
    const Binding& binding = record.bindings[i];
    if (passes_.resources[i].kind == ResourceKind::scratch) return passes_.resources[i].bytes;
    return binding.engineBuffer ? binding.engineBuffer->size : binding.ownSize;
  };

  beginLabel(cmd, nullptr);
  edgeBarrier(record, true);
  // Says that the recording ran, to who reads it when the frame has ended; beside the first passes it costs nothing.
  vk.CmdFillBuffer(cmd, reports_.handle(), slot * reportStride_ + passes_.reportBytes, 4, slots_[slot].marker);
  const GpgpTimestamps& timestamps = record.info->timestamps;
  uint32_t query = timestamps.firstQuery;
  if (timestamps.queryPool)
    vk.CmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps.queryPool, query++);
  uint32_t boundGroup = UINT32_MAX;
  VkPipelineLayout layout = VK_NULL_HANDLE; // of the group that is bound
  const bool hasTextures = textureSets && (pages || record.bindings[firstTexture_].texture.imageView);
  const auto bindPage = [&](uint32_t page) {
    vk.CmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 1, 1, &textureSets[page], 0, nullptr);
  };
  const auto bindGroup = [&](uint32_t group) {
    if (boundGroup == group) return;
    boundGroup = group;
    layout = groups_[group].layout;
    const VkDescriptorSet set = setOf(slot, group);
    vk.CmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
    if (hasTextures) bindPage(0);
  };
  bindGroup(0);
  VkPipeline bound = VK_NULL_HANDLE;
  const VkShaderStageFlags stages = shaderStages();
  const auto bind = [&](uint32_t shader) {
    bindGroup(groupOf_[shader]);
    const VkPipeline pipeline = shader == record.replacedShader ? record.replacement : pipelines_[shader];
    if (bound == pipeline) return;
    bound = pipeline;
    vk.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, bound);
  };
  std::span<const Step> steps = record.steps;
  bool barrier = false; // owed by a pass that was left out, or needed by this one
  uint32_t since = 0;   // kinds of the passes since the last barrier
  std::fill(ran_.begin(), ran_.end(), uint8_t(0));
  for (uint32_t p = 0; p < passes_.passes.size(); ++p) {
    const Pass& pass = passes_.passes[p];
    barrier = barrier || pass.barrierBefore;
    const bool wanted = !pass.stepped && pass.level < record.levels &&
                        (pass.condition == UINT32_MAX || record.conditions[pass.condition]);
    ran_[p] = wanted || (pass.stepped && ran_[p]);
    if (pass.stepped) {
      for (const Step& step : steps) {
        const Pass& stepped = passes_.passes[step.pass];
        if (!step.alongside)
          passBarrier(vk, cmd, since ? since : 1u << static_cast<uint32_t>(stepped.kind), stepped.kindsAhead);
        since = 1u << static_cast<uint32_t>(stepped.kind);
        ran_[step.pass] = true;
        beginLabel(cmd, stepped.name);
        bind(stepped.shader);
        vk.CmdPushConstants(cmd, layout, stages, 0, sizeof step.constant, &step.constant);
        vk.CmdDispatch(cmd, step.groups[0], step.groups[1], step.groups[2]);
        endLabel(cmd);
      }
      barrier = barrier || !steps.empty();
      steps = {};
    }
    if (wanted && barrier) {
      barrier = false;
      if (since) passBarrier(vk, cmd, since, pass.kindsAhead);
      since = 0;
    }
    if (wanted) {
      since |= 1u << static_cast<uint32_t>(pass.kind);
      beginLabel(cmd, pass.name);
      if (pass.kind == PassKind::fill) {
        const auto [buffer, offset] = place(pass.target);
        const VkDeviceSize size = pass.size == VK_WHOLE_SIZE ? placeSize(pass.target) - pass.offset : pass.size;
        vk.CmdFillBuffer(cmd, buffer, offset + pass.offset, size / 4 * 4, pass.value);
      } else {
        bind(pass.shader);
        if (pass.constantCount)
          vk.CmdPushConstants(cmd, layout, stages, 0, pass.constantCount * 4, pass.constants.data());
        if (pass.kind == PassKind::dispatchIndirect) {
          const auto [buffer, offset] = place(pass.target);
          vk.CmdDispatchIndirect(cmd, buffer, offset + pass.offset);
        } else {
          const auto& groups = record.groups[pass.groups];
          for (uint32_t page = 0; pass.paged && page < pages; ++page) {
            const uint32_t constants[] = {page, record.pageConstants[page]};
            // Each writes what is its own, but nobody sees that pages lie apart.
            const uint32_t dispatches = 1u << static_cast<uint32_t>(pass.kind);
            if (page) passBarrier(vk, cmd, dispatches, dispatches);
            bindPage(page);
            vk.CmdPushConstants(cmd, layout, stages, 0, sizeof constants, constants);
            vk.CmdDispatch(cmd, groups[0], groups[1], groups[2]);
          }
          if (pass.paged)
            bindPage(0);
          else if (groups[0] && groups[1] && groups[2])
            vk.CmdDispatch(cmd, groups[0], groups[1], groups[2]);
        }
      }
      endLabel(cmd);
      if (inspection_.target && inspection_.pass == p) {
        const VkMemoryBarrier made{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, kWorkWrites, VK_ACCESS_TRANSFER_READ_BIT};
        vk.CmdPipelineBarrier(cmd, kWorkStages, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &made, 0, nullptr, 0, nullptr);
        const VkBufferCopy all{scratchOffset, 0, passes_.scratchBytes};
        vk.CmdCopyBuffer(cmd, scratch, inspection_.target, 1, &all);
        const VkMemoryBarrier read{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_READ_BIT, kWorkWrites};
        vk.CmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, kWorkStages, 0, 1, &read, 0, nullptr, 0, nullptr);
      }
    }
    if (timestamps.queryPool)
      vk.CmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps.queryPool, query++);
  }

  if ((passes_.reportBytes && !record.reports) || record.readBackBytes) {
    const VkMemoryBarrier counted{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, kWorkWrites, VK_ACCESS_TRANSFER_READ_BIT};
    vk.CmdPipelineBarrier(cmd, kWorkStages, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &counted, 0, nullptr, 0, nullptr);
    const auto copy = [&](ResourceIndex resource, VkDeviceSize offset, VkDeviceSize bytes) {
      if (!bytes) return;
      const auto [source, sourceOffset] = place(resource);
      const VkBufferCopy region{sourceOffset, slot * reportStride_ + offset, bytes};
      vk.CmdCopyBuffer(cmd, source, reports_.handle(), 1, &region);
    };
    copy(passes_.report, 0, record.reports ? 0 : passes_.reportBytes);
    copy(passes_.readBack, readBackAt(), record.readBackBytes);
  }
  edgeBarrier(record, false);
  endLabel(cmd);
  return {};
}

Result<void> Recorder::recordDraw(const DrawRecord& record) {
  if (auto ok = context.checkAlive(); !ok) return ok;
  if (!record.commandBuffer) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "commandBuffer is NULL");
  VkPipeline pipeline = VK_NULL_HANDLE;
  for (uint32_t i = 0; i < targetCount_.load(std::memory_order_acquire); ++i)
    if (sameTarget(targets_[i].info, *record.target)) pipeline = targets_[i].pipelines[record.form];
  if (!pipeline) {
    if (!ready() || prewarming_) return makeError(GPGP_NOT_READY, "gpgpPrewarm has not returned for the target");
    return makeError(
        GPGP_ERROR_INVALID_ARGUMENT,
        "no target that was given to gpgpPrewarm equals this one (colorFormat %d, depthFormat %d, samples %d, "
        "viewMask 0x%x)",
        record.target->colorFormat, record.target->depthFormat, record.target->samples, record.target->viewMask);
  }
  const auto acquired = acquire();
  if (!acquired) return acquired.error();
  const uint32_t slot = *acquired;
  take(slot, 0, false);

  const DeviceTable& vk = context.device.vk;
  const uint32_t group = groupOfDraw_[record.form];
  const VkDescriptorSet set = setOf(slot, group);
  writeDescriptors(slot, group, 1, record.bindings, scratch_.handle(), 0, false);
  beginLabel(record.commandBuffer, "draw");
  vk.CmdBindPipeline(record.commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  vk.CmdBindDescriptorSets(record.commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, groups_[group].layout, 0, 1, &set, 0,
                           nullptr);
  if (!record.pushConstants.empty())
    vk.CmdPushConstants(record.commandBuffer, groups_[group].layout, shaderStages(), 0,
                        static_cast<uint32_t>(record.pushConstants.size()), record.pushConstants.data());
  vk.CmdDraw(record.commandBuffer, record.vertexCount, record.instanceCount, 0, 0);
  endLabel(record.commandBuffer);
  return {};
}

} // namespace gpgp::core
