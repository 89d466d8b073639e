#include "core/recorder.h"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace gpgp::core {

Recorder::Recorder(Context& ctx, Kind recorderKind, const GpgpRecorderCreateInfo& info, GpgpService service)
    : Object(ctx, recorderKind, info.label), service_(service), queueFamily_(info.queueFamily),
      queueFlags_(info.queueFlags), engineScratch_(info.engineScratch != VK_FALSE), passes_(&ctx.host()),
      groups_(&ctx.host()), groupOf_(&ctx.host()), sets_(&ctx.host()), textureSets_(&ctx.host()),
      pipelines_(&ctx.host()), pipelineTimes_(&ctx.host()), slots_(&ctx.host()), ran_(&ctx.host()),
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
  for (const BindingGroup& group : groups_) {
    device.vk.DestroyPipelineLayout(device.device, group.layout, nullptr);
    device.vk.DestroyDescriptorSetLayout(device.device, group.setLayout, nullptr);
  }
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

  const uint32_t slotCount = context.maxFramesInFlight * context.maxRecordingsPerFrame;
  if (auto ok = groupBindings(draws_ ? drawForms_ : 0); !ok) return ok;
  if (auto ok = createLayouts(); !ok) return ok;
  if (auto ok = createSets(slotCount); !ok) return ok;

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
  pipelineTimes_.resize(passes_.shaders.size());
  ran_.resize(passes_.passes.size());

  nextRecorder_ = context.recorders;
  if (nextRecorder_) nextRecorder_->previousRecorder_ = this;
  context.recorders = this;
  linked_ = true;
  return {};
}

// ---------------------------------------------------------------- pipelines

namespace {
class Stopwatch {
public:
  float milliseconds() const {
    return std::chrono::duration<float, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};
} // namespace

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

Result<VkPipeline> Recorder::createComputePipeline(const ShaderDesc& shader, uint32_t place) const {
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
  info.layout = groups_[groupOf_[place]].layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result =
      device.vk.CreateComputePipelines(device.device, context.pipelineCache, 1, &info, nullptr, &pipeline);
  device.vk.DestroyShaderModule(device.device, *module, nullptr);
  if (result != VK_SUCCESS) return vulkanError(result, "vkCreateComputePipelines");
  device.setName(VK_OBJECT_TYPE_PIPELINE, pipeline, label.text, shader.name);
  return pipeline;
}

Result<VkPipeline> Recorder::createDrawPipeline(uint32_t form, const GpgpTargetInfo& target) const {
  const Device& device = context.device;
  const DrawShaders& draw = draw_[form];
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
  info.layout = groups_[groupOfDraw_[form]].layout;
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

std::pmr::vector<GpgpPipelineInfo> Recorder::pipelines() const {
  std::pmr::vector<GpgpPipelineInfo> all(&context.host());
  for (size_t i = 0; i < passes_.shaders.size(); ++i) {
    const ShaderDesc& shader = passes_.shaders[i];
    if (!shader.replaced) all.push_back({shader.name, shader.spirv.count * 4, pipelineTimes_[i]});
  }
  for (uint32_t i = 0; i < targetCount_.load(std::memory_order_acquire); ++i)
    for (uint32_t form = 0; form < drawForms_; ++form) {
      const DrawShaders& draw = draw_[form];
      const bool multiview = targets_[i].info.viewMask != 0;
      const uint32_t words = multiview ? draw.multiviewVertex.spirv.count + draw.multiviewFragment.spirv.count
                                       : draw.vertex.spirv.count + draw.fragment.spirv.count;
      all.push_back({"draw", words * 4, targets_[i].times[form]});
    }
  return all;
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
    float* times;
    std::pmr::vector<Error> errors;
  } job{this, pipelines_.data(), pipelineTimes_.data(), std::pmr::vector<Error>(pipelines_.size(), &context.host())};
  const GpgpJobFn compile = [](void* argument, uint32_t index) GPGP_CALL {
    Job& j = *static_cast<Job*>(argument);
    if (j.pipelines[index] || j.recorder->passes_.shaders[index].replaced) return;
    try {
      const Stopwatch watch;
      const auto pipeline = j.recorder->createComputePipeline(j.recorder->passes_.shaders[index], index);
      j.times[index] = watch.milliseconds();
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
    target = {info->targets[i], {}, {}};
    for (uint32_t form = 0; form < drawForms_; ++form) {
      const Stopwatch watch;
      const auto pipeline = createDrawPipeline(form, target.info);
      target.times[form] = watch.milliseconds();
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
