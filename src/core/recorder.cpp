#include "core/recorder.h"

#include <algorithm>
#include <cstring>

namespace gpgp::core {
namespace {
constexpr VkDeviceSize kPushConstantBytes = 128;

VkShaderStageFlags shaderStages(bool draws) {
  return VkShaderStageFlags(VK_SHADER_STAGE_COMPUTE_BIT) |
         (draws ? VkShaderStageFlags(VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT) : 0);
}

} // namespace

Recorder::Recorder(Context& ctx, Kind recorderKind, const GpgpRecorderCreateInfo& info, GpgpService service)
    : Object(ctx, recorderKind, info.label), service_(service), queueFamily_(info.queueFamily),
      queueFlags_(info.queueFlags), engineScratch_(info.engineScratch != VK_FALSE), passes_(&ctx.host()),
      sets_(&ctx.host()), textureSets_(&ctx.host()), pipelines_(&ctx.host()), slots_(&ctx.host()), ran_(&ctx.host()),
      harvested_(&ctx.host()), readBacks_(&ctx.host()), queue_(&ctx.host()) {}

void Recorder::unlink() {
  if (!linked_) return;
  linked_ = false;
  (previousRecorder_ ? previousRecorder_->nextRecorder_ : context.recorders) = nextRecorder_;
  if (nextRecorder_) nextRecorder_->previousRecorder_ = previousRecorder_;
}

Recorder::~Recorder() {
  unlink();
  const Device& device = context.device;
  for (VkPipeline pipeline : pipelines_) device.vk.DestroyPipeline(device.device, pipeline, nullptr);
  for (uint32_t i = 0; i < targetCount_; ++i)
    for (VkPipeline pipeline : targets_[i].pipelines) device.vk.DestroyPipeline(device.device, pipeline, nullptr);
  device.vk.DestroyDescriptorPool(device.device, pool_, nullptr);
  device.vk.DestroyPipelineLayout(device.device, layout_, nullptr);
  device.vk.DestroyDescriptorSetLayout(device.device, setLayout_, nullptr);
  device.vk.DestroyDescriptorSetLayout(device.device, textureLayout_, nullptr);
}

void Recorder::retire() {
  unlink(); // nobody can ask for its reports any more
  scratch_.markPending();
  constants_.markPending();
  reports_.markPending();
}

VkDeviceSize Recorder::scratchAlignment() const { return context.device.limits.minStorageBufferOffsetAlignment; }

Result<void> Recorder::init(PassList passes, std::span<const DrawShaders> draws) {
  const Device& device = context.device;
  uint32_t familyCount = 0;
  device.vki.GetPhysicalDeviceQueueFamilyProperties(device.physicalDevice, &familyCount, nullptr);
  std::pmr::vector<VkQueueFamilyProperties> families(familyCount, &context.host());
  device.vki.GetPhysicalDeviceQueueFamilyProperties(device.physicalDevice, &familyCount, families.data());
  if (queueFamily_ >= familyCount)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "base.queueFamily is %u, but the device has %u families",
                     queueFamily_, familyCount);
  timestampBits_ = families[queueFamily_].timestampValidBits;
  if (queueFlags_ == 0) queueFlags_ = families[queueFamily_].queueFlags;
  if (!(queueFlags_ & VK_QUEUE_COMPUTE_BIT))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "queue family %u has no VK_QUEUE_COMPUTE_BIT", queueFamily_);

  passes_ = std::move(passes);
  passes_.finish(std::max<VkDeviceSize>(
      {device.limits.minStorageBufferOffsetAlignment, device.limits.minUniformBufferOffsetAlignment, 16}));
  draws_ = !draws.empty() && (queueFlags_ & VK_QUEUE_GRAPHICS_BIT);
  drawForms_ = static_cast<uint32_t>(draws.size());
  std::copy(draws.begin(), draws.end(), draw_.begin());
  for (const Resource& resource : passes_.resources)
    if (resource.bytes > device.limits.maxStorageBufferRange)
      return makeError(
          GPGP_ERROR_UNSUPPORTED, "the budgets need %llu bytes for \"%s\", but this device binds at most %u",
          static_cast<unsigned long long>(resource.bytes), resource.name, device.limits.maxStorageBufferRange);

  const uint32_t resourceCount = static_cast<uint32_t>(passes_.resources.size());
  std::array<VkDescriptorSetLayoutBinding, kMaxResources> bindings{}, textureBindings{};
  uint32_t images = 0, textures = 0, uniforms = 0;
  for (uint32_t i = 0; i < resourceCount; ++i) {
    const VkShaderStageFlags stages = shaderStages(draws_);
    const ResourceKind ofResource = passes_.resources[i].kind;
    if (ofResource == ResourceKind::texture) {
      if (textures == 0) firstTexture_ = i;
      textureBindings[textures++] = {i - firstTexture_, descriptorType(ofResource), 1, stages, nullptr};
      continue;
    }
    bindings[i - textures] = {i, descriptorType(ofResource), 1, stages, nullptr};
    images += ofResource == ResourceKind::image;
    uniforms += ofResource == ResourceKind::uniforms;
  }
  const uint32_t buffers = resourceCount - images - textures - uniforms;
  if (buffers > device.limits.maxPerStageDescriptorStorageBuffers) // more than is asked of every device
    return makeError(GPGP_ERROR_UNSUPPORTED,
                     "this recorder takes %u storage buffers a stage, but the device has %u "
                     "(maxPerStageDescriptorStorageBuffers)",
                     buffers, device.limits.maxPerStageDescriptorStorageBuffers);
  VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  setInfo.bindingCount = resourceCount - textures;
  setInfo.pBindings = bindings.data();
  VkResult result = device.vk.CreateDescriptorSetLayout(device.device, &setInfo, nullptr, &setLayout_);
  if (result != VK_SUCCESS) return vulkanError(result, "vkCreateDescriptorSetLayout");
  if (textures) {
    setInfo.bindingCount = textures;
    setInfo.pBindings = textureBindings.data();
    result = device.vk.CreateDescriptorSetLayout(device.device, &setInfo, nullptr, &textureLayout_);
    if (result != VK_SUCCESS) return vulkanError(result, "vkCreateDescriptorSetLayout");
  }
  const VkDescriptorSetLayout setLayouts[2] = {setLayout_, textureLayout_};
  const VkPushConstantRange range{shaderStages(draws_), 0, kPushConstantBytes};
  VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layoutInfo.setLayoutCount = textures ? 2 : 1;
  layoutInfo.pSetLayouts = setLayouts;
  layoutInfo.pushConstantRangeCount = 1;
  layoutInfo.pPushConstantRanges = &range;
  result = device.vk.CreatePipelineLayout(device.device, &layoutInfo, nullptr, &layout_);
  if (result != VK_SUCCESS) return vulkanError(result, "vkCreatePipelineLayout");

  const uint32_t slotCount = context.maxFramesInFlight * context.maxRecordingsPerFrame;
  std::array<VkDescriptorPoolSize, 4> sizes{{{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, std::max(1u, buffers * slotCount)}}};
  uint32_t sizeCount = 1;
  if (uniforms) sizes[sizeCount++] = {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, uniforms * slotCount};
  if (images) sizes[sizeCount++] = {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, images * slotCount};
  if (textures)
    sizes[sizeCount++] = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, textures * slotCount * passes_.texturePages};
  VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  poolInfo.maxSets = textures ? (1 + passes_.texturePages) * slotCount : slotCount;
  poolInfo.poolSizeCount = sizeCount;
  poolInfo.pPoolSizes = sizes.data();
  result = device.vk.CreateDescriptorPool(device.device, &poolInfo, nullptr, &pool_);
  if (result != VK_SUCCESS) return vulkanError(result, "vkCreateDescriptorPool");
  std::pmr::vector<VkDescriptorSetLayout> layouts(slotCount, setLayout_, &context.host());
  sets_.resize(slotCount);
  VkDescriptorSetAllocateInfo allocateInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocateInfo.descriptorPool = pool_;
  allocateInfo.descriptorSetCount = slotCount;
  allocateInfo.pSetLayouts = layouts.data();
  result = device.vk.AllocateDescriptorSets(device.device, &allocateInfo, sets_.data());
  if (result != VK_SUCCESS) return vulkanError(result, "vkAllocateDescriptorSets");
  if (textures) {
    textureCount_ = textures;
    layouts.assign(slotCount * passes_.texturePages, textureLayout_);
    textureSets_.resize(layouts.size());
    allocateInfo.descriptorSetCount = static_cast<uint32_t>(layouts.size());
    allocateInfo.pSetLayouts = layouts.data();
    result = device.vk.AllocateDescriptorSets(device.device, &allocateInfo, textureSets_.data());
    if (result != VK_SUCCESS) return vulkanError(result, "vkAllocateDescriptorSets");
  }

  if (!engineScratch_ && passes_.scratchBytes) {
    auto scratch = Buffer::create(device, context.gpu(), service_, "scratch", passes_.scratchBytes, kScratchUsage,
                                  MemoryPlace::device);
    if (!scratch) return scratch.error();
    scratch_ = std::move(*scratch);
  }
  unusedOffset_ = (std::max<VkDeviceSize>(passes_.constantsBytes, 16) * slotCount + 255) / 256 * 256;
  auto constants =
      Buffer::create(device, context.gpu(), service_, "constants", unusedOffset_ + kUnusedBytes,
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryPlace::constants);
  if (!constants) return constants.error();
  constants_ = std::move(*constants);
  const VkDeviceSize reportAlignment = std::max<VkDeviceSize>(64, device.limits.minStorageBufferOffsetAlignment);
  reportStride_ = (readBackAt() + passes_.readBackBytes + reportAlignment - 1) / reportAlignment * reportAlignment;
  auto reports =
      Buffer::create(device, context.gpu(), service_, "reports", reportStride_ * slotCount,
                     VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryPlace::readBack);
  if (!reports) return reports.error();
  reports_ = std::move(*reports);

  slots_.resize(slotCount);
  queue_.resize(slotCount);
  harvested_.resize(size_t(slotCount) * (passes_.reportBytes / 4));
  readBacks_.resize(size_t(slotCount) * (passes_.readBackBytes / 8));
  pipelines_.resize(passes_.shaders.size(), VK_NULL_HANDLE);
  ran_.resize(passes_.passes.size());

  nextRecorder_ = context.recorders;
  if (nextRecorder_) nextRecorder_->previousRecorder_ = this;
  context.recorders = this;
  linked_ = true;
  return {};
}

// ---------------------------------------------------------------- pipelines

Result<VkShaderModule> Recorder::createModule(const ShaderDesc& shader) const {
  const auto code = ShaderWords::of(shader.spirv, &context.host());
  if (!code) return code.error();
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = code->words().size_bytes();
  info.pCode = code->words().data();
  VkShaderModule module = VK_NULL_HANDLE;
  const VkResult result = context.device.vk.CreateShaderModule(context.device.device, &info, nullptr, &module);
  if (result != VK_SUCCESS) return vulkanError(result, "vkCreateShaderModule");
  return module;
}

Result<VkPipeline> Recorder::createComputePipeline(const ShaderDesc& shader) const {
  const Device& device = context.device;
  const auto module = createModule(shader);
  if (!module) return module.error();
  std::array<VkSpecializationMapEntry, kMaxSpecialization> entries{};
  for (uint32_t i = 0; i < kMaxSpecialization; ++i) entries[i] = {i, i * 4, 4};
  const VkSpecializationInfo specialization{shader.specializationCount, entries.data(), shader.specializationCount * 4,
                                            shader.specialization.data()};
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = {
      VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,   nullptr, 0, VK_SHADER_STAGE_COMPUTE_BIT, *module, "main",
      shader.specializationCount ? &specialization : nullptr};
  info.layout = layout_;
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result =
      device.vk.CreateComputePipelines(device.device, context.pipelineCache, 1, &info, nullptr, &pipeline);
  device.vk.DestroyShaderModule(device.device, *module, nullptr);
  if (result != VK_SUCCESS) return vulkanError(result, "vkCreateComputePipelines");
  device.setName(VK_OBJECT_TYPE_PIPELINE, pipeline, label.text, shader.name);
  return pipeline;
}

Result<VkPipeline> Recorder::createDrawPipeline(const DrawShaders& draw, const GpgpTargetInfo& target) const {
  const Device& device = context.device;
  const auto vertex = createModule(target.viewMask ? draw.multiviewVertex : draw.vertex);
  if (!vertex) return vertex.error();
  const auto fragment = createModule(target.viewMask ? draw.multiviewFragment : draw.fragment);
  if (!fragment) {
    device.vk.DestroyShaderModule(device.device, *vertex, nullptr);
    return fragment.error();
  }
  const uint32_t samples = target.samples ? target.samples : 1;
  const VkSpecializationMapEntry entry{0, 0, sizeof samples};
  const VkSpecializationInfo specialization{1, &entry, sizeof samples, &samples};
  const std::array<VkPipelineShaderStageCreateInfo, 2> stages{{
      {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, VK_SHADER_STAGE_VERTEX_BIT, *vertex, "main",
       &specialization},
      {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, VK_SHADER_STAGE_FRAGMENT_BIT, *fragment, "main",
       &specialization},
  }};
  VkPipelineVertexInputStateCreateInfo vertexInput{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  multisample.rasterizationSamples = target.samples ? target.samples : VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  depth.depthTestEnable = target.depthTest;
  depth.depthCompareOp = target.depthCompare;
  VkPipelineColorBlendAttachmentState blend{};
  blend.blendEnable = VK_TRUE;
  blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  blend.colorWriteMask = 0xf;
  VkPipelineColorBlendStateCreateInfo blendState{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blendState.attachmentCount = 1;
  blendState.pAttachments = &blend;
  const std::array<VkDynamicState, 2> dynamicStates{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = static_cast<uint32_t>(dynamicStates.size());
  dynamic.pDynamicStates = dynamicStates.data();
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.viewMask = target.viewMask;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &target.colorFormat;
  rendering.depthAttachmentFormat = target.depthFormat;
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  if (!target.renderPass) info.pNext = &rendering;
  info.stageCount = static_cast<uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &vertexInput;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &multisample;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blendState;
  info.pDynamicState = &dynamic;
  info.layout = layout_;
  info.renderPass = target.renderPass;
  info.subpass = target.subpass;
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result =
      device.vk.CreateGraphicsPipelines(device.device, context.pipelineCache, 1, &info, nullptr, &pipeline);
  device.vk.DestroyShaderModule(device.device, *vertex, nullptr);
  device.vk.DestroyShaderModule(device.device, *fragment, nullptr);
  if (result != VK_SUCCESS) return vulkanError(result, "vkCreateGraphicsPipelines");
  device.setName(VK_OBJECT_TYPE_PIPELINE, pipeline, label.text, "draw");
  return pipeline;
}

Result<void> Recorder::prewarm(const GpgpPrewarmInfo* info) {
  struct Prewarming {
    std::atomic<bool>& flag;
    explicit Prewarming(std::atomic<bool>& f) : flag(f) { flag = true; }
    ~Prewarming() { flag = false; }
  } const prewarming(prewarming_);
  const uint32_t wanted = info ? info->targetCount : 0;
  if (wanted && !info->targets)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "targets is NULL, targetCount is %u", wanted);
  if (wanted && !draws_)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     drawForms_ == 0 ? "a %s does not draw: targetCount must be 0"
                                     : "this %s is on a queue family without "
                                       "graphics: targetCount must be 0",
                     kindName(kind));
  for (uint32_t i = 0; i < wanted; ++i) {
    const GpgpTargetInfo& target = info->targets[i];
    if (target.sType != GPGP_STRUCTURE_TARGET_INFO || target.pNext)
      return makeError(GPGP_ERROR_INVALID_STRUCT,
                       "targets[%u] must have sType GPGP_STRUCTURE_TARGET_INFO and pNext "
                       "NULL",
                       i);
    if (!target.renderPass && !context.device.has(GPGP_FEATURE_DYNAMIC_RENDERING))
      return makeError(GPGP_ERROR_MISSING_FEATURE,
                       "targets[%u] has no renderPass and GPGP_FEATURE_DYNAMIC_RENDERING "
                       "is not declared",
                       i);
    if (!target.renderPass && target.colorFormat == VK_FORMAT_UNDEFINED)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "targets[%u] has neither renderPass nor colorFormat", i);
    if (target.viewMask > 3)
      return makeError(GPGP_ERROR_UNSUPPORTED, "targets[%u].viewMask is 0x%x: at most views 0 and 1 are drawn", i,
                       target.viewMask);
    if (target.viewMask && !context.device.has(GPGP_FEATURE_MULTIVIEW))
      return makeError(GPGP_ERROR_MISSING_FEATURE,
                       "targets[%u] has a viewMask, but GPGP_FEATURE_MULTIVIEW is not declared", i);
  }

  struct Job {
    const Recorder* recorder;
    VkPipeline* pipelines;
    std::pmr::vector<Error> errors;
  } job{this, pipelines_.data(), std::pmr::vector<Error>(pipelines_.size(), &context.host())};
  const GpgpJobFn compile = [](void* argument, uint32_t index) GPGP_CALL {
    Job& j = *static_cast<Job*>(argument);
    if (j.pipelines[index]) return;
    try {
      const auto pipeline = j.recorder->createComputePipeline(j.recorder->passes_.shaders[index]);
      if (pipeline)
        j.pipelines[index] = *pipeline;
      else
        j.errors[index] = pipeline.error();
    } catch (...) {
      j.errors[index] = makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "a pipeline could not be made");
    }
  };
  const uint32_t count = static_cast<uint32_t>(pipelines_.size());
  if (context.jobSystem.parallelFor)
    context.jobSystem.parallelFor(context.jobSystem.userData, count, compile, &job);
  else
    for (uint32_t i = 0; i < count; ++i) compile(&job, i);
  for (const Error& error : job.errors)
    if (error.code != GPGP_SUCCESS) return error;

  for (uint32_t i = 0; i < wanted; ++i) {
    const uint32_t have = targetCount_.load();
    if (std::any_of(targets_.begin(), targets_.begin() + have,
                    [&](const Target& t) { return sameTarget(t.info, info->targets[i]); }))
      continue;
    if (have == kMaxTargets)
      return makeError(GPGP_ERROR_UNSUPPORTED, "a recorder draws into at most %u different targets", kMaxTargets);
    Target& target = targets_[have];
    target = {info->targets[i], {}};
    for (uint32_t form = 0; form < drawForms_; ++form) {
      const auto pipeline = createDrawPipeline(draw_[form], target.info);
      if (!pipeline) {
        for (VkPipeline made : target.pipelines)
          context.device.vk.DestroyPipeline(context.device.device, made, nullptr);
        return pipeline.error();
      }
      target.pipelines[form] = *pipeline;
    }
    targetCount_.store(have + 1, std::memory_order_release);
  }
  ready_.store(true, std::memory_order_release);
  return {};
}

// ---------------------------------------------------------------- reports

bool Recorder::takeReport(RawReport& report) {
  if (queueCount_ == 0) return false;
  losesReports_ = false;
  report = queue_[queueHead_];
  queueHead_ = (queueHead_ + 1) % queue_.size();
  --queueCount_;
  return true;
}

void Recorder::advance() {
  const uint32_t words = passes_.reportBytes / 4;
  for (;;) { // in order of recording
    InFlight* oldest = nullptr;
    for (InFlight& slot : slots_)
      if (slot.marker && (!oldest || static_cast<int32_t>(slot.marker - oldest->marker) < 0)) oldest = &slot;
    if (!oldest || oldest->frame > context.safe()) return;
    if (oldest->report) {
      const size_t index = static_cast<size_t>(oldest - slots_.data());
      const char* data = reports_.mapped() + index * reportStride_;
      uint32_t marker = 0;
      std::memcpy(&marker, data + passes_.reportBytes, 4);
      const bool ran = marker == oldest->marker;
      if (queueCount_ == queue_.size()) {
        if (!losesReports_)
          context.message(
              GPGP_SEVERITY_WARNING, GPGP_INCOMPLETE, "gpgpAdvance", label.text,
              "reports are not taken in time, and the oldest are lost; this is said once until one is taken");
        losesReports_ = true;
        queueHead_ = (queueHead_ + 1) % queue_.size();
        --queueCount_;
      }
      const size_t place = (queueHead_ + queueCount_++) % queue_.size();
      uint32_t* copy = harvested_.data() + place * words;
      if (ran && oldest->counts)
        std::memcpy(copy, data, passes_.reportBytes);
      else
        std::fill_n(copy, words, 0u);
      auto* const behind = reinterpret_cast<std::byte*>(readBacks_.data()) + place * passes_.readBackBytes;
      const uint32_t bytes = ran ? oldest->readBackBytes : 0;
      if (bytes) std::memcpy(behind, data + readBackAt(), bytes);
      queue_[place] = {{ran ? GPGP_SUCCESS : GPGP_NOT_EXECUTED, oldest->tag, oldest->frame},
                       {copy, words},
                       oldest->note,
                       {behind, bytes}};
      harvested(queue_[place]);
    }
    *oldest = {};
  }
}

} // namespace gpgp::core
