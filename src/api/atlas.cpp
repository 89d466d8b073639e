// The C functions of atlas.h.
#include "api/check.h"
#include "visibility/atlas/recorder.h"

using namespace gpgp;
using namespace gpgp::api;
using namespace gpgp::visibility;

GpgpResult GPGP_CALL gpgpCreateAtlas(GpgpContext handle, const GpgpAtlasCreateInfo* info, GpgpHistory* atlas) {
  return guarded("gpgpCreateAtlas", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_ATLAS_CREATE_INFO, "info"); !ok) return ok;
    if (!atlas) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "atlas is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    auto made = Atlas::create(**context, *info);
    if (!made) return made.error();
    *atlas = adopt<GpgpHistory>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpCreateAtlasRecorder(GpgpContext handle, const GpgpAtlasRecorderCreateInfo* info,
                                             GpgpRecorder* recorder) {
  return guarded("gpgpCreateAtlasRecorder", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_ATLAS_RECORDER_CREATE_INFO, "info"); !ok) return ok;
    if (!recorder) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "recorder is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    auto made = AtlasRecorder::create(**context, *info);
    if (!made) return made.error();
    *recorder = adopt<GpgpRecorder>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpRecordPrepareAtlas(GpgpRecorder handle, VkCommandBuffer commandBuffer, const GpgpFrame* frame,
                                            const GpgpAtlasInfo* info) {
  return guarded("gpgpRecordPrepareAtlas", [&](Call& call) -> Result<void> {
    const auto recorder = resolve<AtlasRecorder>(call, handle, Kind::atlasRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_ATLAS_INFO, "info"); !ok) return ok;
    const core::Context& context = (*recorder)->context;
    const auto atlas = resolve<Atlas>(call, info->atlas, Kind::atlas, "atlas", &context);
    if (!atlas) return atlas.error();
    GeometrySet* geometry = nullptr;
    if (info->geometrySet || info->drawCount) {
      const auto resolved = resolve<GeometrySet>(call, info->geometrySet, Kind::geometrySet, "geometrySet", &context);
      if (!resolved) return resolved.error();
      geometry = *resolved;
    }
    const core::RecorderUse use(**recorder);
    if (!use) return core::RecorderUse::error();
    if (auto ok = checkRecord(**recorder, frame); !ok) return ok;
    if (!(*atlas)->resident()) return makeError(GPGP_NOT_READY, "atlas is not resident");
    if (geometry && !geometry->resident()) return makeError(GPGP_NOT_READY, "geometrySet is not resident");
    return (*recorder)->prepare(commandBuffer, *info, **atlas, geometry);
  });
}

GpgpResult GPGP_CALL gpgpGetAtlasReport(GpgpRecorder handle, GpgpAtlasReport* report) {
  return guarded("gpgpGetAtlasReport", [&](Call& call) -> Result<void> {
    const auto recorder = resolve<AtlasRecorder>(call, handle, Kind::atlasRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (auto ok = checkStruct(report, GPGP_STRUCTURE_ATLAS_REPORT, "report"); !ok) return ok;
    const core::RecorderUse use(**recorder);
    if (!use) return core::RecorderUse::error();
    if (!(*recorder)->takeAtlasReport(*report)) return noReport();
    return {};
  });
}
