// The C functions of core.h.
#include "api/check.h"
#include "core/requirements.h"

#include <algorithm>

using namespace gpgp;
using namespace gpgp::api;

GpgpResult GPGP_CALL gpgpGetRequirements(const GpgpRequirementsInfo* info, GpgpRequirements* requirements) {
  return guarded("gpgpGetRequirements", [&](Call&) -> Result<void> {
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_REQUIREMENTS_INFO, "info"); !ok) return ok;
    if (auto ok = checkStruct(requirements, GPGP_STRUCTURE_REQUIREMENTS, "requirements"); !ok) return ok;
    if (!info->instance || !info->physicalDevice || !info->getInstanceProcAddr)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "instance, physicalDevice and getInstanceProcAddr must be set");
    if (auto ok = core::fillRequirements(*info, *requirements); !ok) return ok;
    if (requirements->missingCount)
      return makeError(GPGP_ERROR_MISSING_FEATURE, "the device lacks %s", requirements->missing[0]);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpCreateContext(const GpgpContextCreateInfo* info, GpgpContext* context) {
  const auto checks = [&]() -> Result<void> {
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_CONTEXT_CREATE_INFO, "info"); !ok) return ok;
    if (!context) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "context is NULL");
    if (!info->instance || !info->physicalDevice || !info->device || !info->getInstanceProcAddr)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                       "instance, physicalDevice, device and getInstanceProcAddr must be set");
    if (info->apiVersion && info->apiVersion < VK_API_VERSION_1_2)
      return makeError(GPGP_ERROR_MISSING_FEATURE, "apiVersion is below Vulkan 1.2");
    if (info->features & ~GPGP_FEATURE_ALL) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "features has unknown bits");
    if (info->maxFramesInFlight > 8)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxFramesInFlight is %u; at most 8", info->maxFramesInFlight);
    if (info->maxRecordingsPerFrame > 4096)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxRecordingsPerFrame is %u; at most 4096",
                       info->maxRecordingsPerFrame);
    if (info->hostAllocator && (!info->hostAllocator->allocate || !info->hostAllocator->free))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "hostAllocator needs both allocate and free");
    if (info->gpuAllocator && (!info->gpuAllocator->allocate || !info->gpuAllocator->free))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "gpuAllocator needs both allocate and free");
    if (info->jobSystem && !info->jobSystem->parallelFor)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "jobSystem needs parallelFor");
    if (info->fileSystem && !info->fileSystem->read)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "fileSystem needs read");
    if (info->pipelineCacheSize && !info->pipelineCacheData)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "pipelineCacheData is NULL, pipelineCacheSize is not 0");
    GpgpRequirementsInfo requirementsInfo = GPGP_REQUIREMENTS_INFO_INIT;
    requirementsInfo.instance = info->instance;
    requirementsInfo.physicalDevice = info->physicalDevice;
    requirementsInfo.getInstanceProcAddr = info->getInstanceProcAddr;
    GpgpRequirements requirements = GPGP_REQUIREMENTS_INIT;
    if (auto ok = core::fillRequirements(requirementsInfo, requirements); !ok) return ok;
    if (requirements.missingCount)
      return makeError(GPGP_ERROR_MISSING_FEATURE, "the device lacks %s", requirements.missing[0]);
    return {};
  };
  // No context exists yet to carry the message, so it goes to the callback of the info.
  Error error;
  const GpgpResult result = guarded("gpgpCreateContext", [&](Call&) -> Result<void> {
    if (auto ok = checks(); !ok) {
      error = ok.error();
      return error;
    }
    auto made = Context::create(*info);
    if (!made) {
      error = made.error();
      return error;
    }
    *context = reinterpret_cast<GpgpContext>(*made);
    return {};
  });
  if (result < 0 && info && info->sType == GPGP_STRUCTURE_CONTEXT_CREATE_INFO && info->messageFn) {
    const GpgpMessage message{GPGP_SEVERITY_ERROR, result, "gpgpCreateContext", info->label ? info->label : "",
                              error.code ? error.text : "the host allocator returned NULL"};
    info->messageFn(info->messageUserData, &message);
  }
  return result;
}

void GPGP_CALL gpgpDestroyContext(GpgpContext handle) {
  if (!handle) return;
  guarded("gpgpDestroyContext", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    call.context = nullptr;
    Context::destroy(*context);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpAdvance(GpgpContext handle, const GpgpFrame* frame) {
  return guarded("gpgpAdvance", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (!frame) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "frame is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    return (*context)->advance(*frame);
  });
}

void GPGP_CALL gpgpNotifyDeviceLost(GpgpContext handle) {
  guarded("gpgpNotifyDeviceLost", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    (*context)->setLost();
    return {};
  });
}

GpgpResult GPGP_CALL gpgpRecordUpload(GpgpContext handle, VkCommandBuffer commandBuffer, const GpgpFrame* frame,
                                      VkDeviceSize byteBudget, VkDeviceSize* pendingBytes) {
  return guarded("gpgpRecordUpload", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (!commandBuffer) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "commandBuffer is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    if (auto ok = (*context)->checkFrame(frame); !ok) return ok;
    const auto pending = (*context)->uploads().record(commandBuffer, byteBudget);
    if (!pending) return pending.error();
    if (pendingBytes) *pendingBytes = *pending;
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetPipelineCacheData(GpgpContext handle, size_t* size, void* data) {
  return guarded("gpgpGetPipelineCacheData", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (!size) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "size is NULL");
    const core::Device& device = (*context)->device;
    const VkResult result = device.vk.GetPipelineCacheData(device.device, (*context)->pipelineCache, size, data);
    if (result == VK_INCOMPLETE) {
      device.vk.GetPipelineCacheData(device.device, (*context)->pipelineCache, size, nullptr);
      return makeError(GPGP_INCOMPLETE, "size is too small");
    }
    if (result != VK_SUCCESS) return core::vulkanError(result, "vkGetPipelineCacheData");
    return {};
  });
}

// ---------------------------------------------------------------- objects of all kinds

namespace {
/// Any recorder, asset or history: the kind is in the handle's type, so only these ranges are accepted.
template <class T, class Handle>
Result<T*> resolveAny(Call& call, Handle handle, Kind first, Kind last, const char* name) {
  core::Object* object = objectOf(handle, &call.context);
  if (!object) return makeError(GPGP_ERROR_INVALID_HANDLE, "%s is %s", name, handle ? "destroyed" : "NULL");
  call.label = object->name();
  if (object->kind < first || object->kind > last)
    return makeError(GPGP_ERROR_INVALID_HANDLE, "%s is a %s", name, core::kindName(object->kind));
  return static_cast<T*>(object);
}

template <class Handle> void destroy(const char* function, Handle handle, Kind first, Kind last, const char* name) {
  if (!handle) return;
  guarded(function, [&](Call& call) -> Result<void> {
    const auto object = resolveAny<core::Object>(call, handle, first, last, name);
    if (!object) return object.error();
    (*object)->context.retire(**object);
    return {};
  });
}
} // namespace

GpgpResult GPGP_CALL gpgpPrewarm(GpgpRecorder handle, const GpgpPrewarmInfo* info) {
  return guarded("gpgpPrewarm", [&](Call& call) -> Result<void> {
    const auto recorder = resolveAny<core::Recorder>(call, handle, Kind::spawner, Kind::atlasRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (info)
      if (auto ok = checkStruct(info, GPGP_STRUCTURE_PREWARM_INFO, "info"); !ok) return ok;
    if (auto ok = (*recorder)->context.checkAlive(); !ok) return ok;
    return (*recorder)->prewarm(info);
  });
}

GpgpResult GPGP_CALL gpgpGetScratchSize(GpgpRecorder handle, VkDeviceSize* size, VkDeviceSize* alignment,
                                        VkBufferUsageFlags* usage) {
  return guarded("gpgpGetScratchSize", [&](Call& call) -> Result<void> {
    const auto recorder = resolveAny<core::Recorder>(call, handle, Kind::spawner, Kind::atlasRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (!size) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "size is NULL");
    *size = (*recorder)->scratchBytes();
    if (alignment) *alignment = (*recorder)->scratchAlignment();
    if (usage) *usage = core::Recorder::kScratchUsage;
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetPasses(GpgpRecorder handle, uint32_t* count, const char** names) {
  return guarded("gpgpGetPasses", [&](Call& call) -> Result<void> {
    const auto recorder = resolveAny<core::Recorder>(call, handle, Kind::spawner, Kind::atlasRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (!count) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "count is NULL");
    const auto& passes = (*recorder)->passes().passes;
    const uint32_t all = static_cast<uint32_t>(passes.size());
    const uint32_t written = names ? std::min(*count, all) : 0;
    for (uint32_t i = 0; i < written; ++i) names[i] = passes[i].name;
    *count = all;
    if (names && written < all) return makeError(GPGP_INCOMPLETE, "names is too small");
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetPipelines(GpgpRecorder handle, uint32_t* count, GpgpPipelineInfo* pipelines) {
  return guarded("gpgpGetPipelines", [&](Call& call) -> Result<void> {
    const auto recorder = resolveAny<core::Recorder>(call, handle, Kind::spawner, Kind::atlasRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (!count) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "count is NULL");
    const auto list = (*recorder)->pipelines();
    const uint32_t all = static_cast<uint32_t>(list.size()), written = pipelines ? std::min(*count, all) : 0;
    std::copy_n(list.begin(), written, pipelines);
    *count = all;
    if (pipelines && written < all) return makeError(GPGP_INCOMPLETE, "pipelines is too small");
    return {};
  });
}

void GPGP_CALL gpgpGetRecordingAccess(GpgpAccess* buffer, GpgpAccess* image) {
  const GpgpAccess access{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                          VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_TRANSFER_READ_BIT |
                              VK_ACCESS_2_TRANSFER_WRITE_BIT,
                          VK_IMAGE_LAYOUT_UNDEFINED};
  if (buffer) *buffer = access;
  if (image)
    *image = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT,
              VK_IMAGE_LAYOUT_GENERAL};
}

GpgpResult GPGP_CALL gpgpGetResidency(GpgpAsset handle, VkBool32* resident) {
  return guarded("gpgpGetResidency", [&](Call& call) -> Result<void> {
    const auto asset = resolveAny<core::Resident>(call, handle, Kind::grammar, Kind::geometrySet, "asset");
    if (!asset) return asset.error();
    if (!resident) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "resident is NULL");
    *resident = (*asset)->resident() ? VK_TRUE : VK_FALSE;
    return {};
  });
}

void GPGP_CALL gpgpDestroyAsset(GpgpAsset asset) {
  destroy("gpgpDestroyAsset", asset, Kind::grammar, Kind::geometrySet, "asset");
}
void GPGP_CALL gpgpDestroyRecorder(GpgpRecorder recorder) {
  destroy("gpgpDestroyRecorder", recorder, Kind::spawner, Kind::atlasRecorder, "recorder");
}
void GPGP_CALL gpgpDestroyHistory(GpgpHistory history) {
  destroy("gpgpDestroyHistory", history, Kind::canvasHistory, Kind::tileSet, "history");
}

GpgpResult GPGP_CALL gpgpGetMemoryReport(GpgpContext handle, GpgpMemoryReport* report) {
  return guarded("gpgpGetMemoryReport", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(report, GPGP_STRUCTURE_MEMORY_REPORT, "report"); !ok) return ok;
    (*context)->gpu().report(*report);
    report->services[GPGP_SERVICE_CORE].hostBytes = (*context)->host().bytes();
    return {};
  });
}
