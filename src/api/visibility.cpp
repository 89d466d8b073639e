// The C functions of visibility.h.
#include "api/check.h"
#include "visibility/sampling/recorder.h"
#include "visibility/triangle_order.h"
#include "visibility/view_cell.h"
#include "visibility/view_motion.h"

#include <algorithm>
#include <iterator>

using namespace gpgp;
using namespace gpgp::api;
using namespace gpgp::visibility;

GpgpResult GPGP_CALL gpgpCreateGeometrySet(GpgpContext handle, const GpgpGeometrySetCreateInfo* info,
                                           GpgpAsset* geometrySet) {
  return guarded("gpgpCreateGeometrySet", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_GEOMETRY_SET_CREATE_INFO, "info"); !ok) return ok;
    if (!geometrySet) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "geometrySet is NULL");
    if (info->meshCount && !info->meshes)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "meshes is NULL, but meshCount is %u", info->meshCount);
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    auto made = GeometrySet::create(**context, *info);
    if (!made) return made.error();
    *geometrySet = adopt<GpgpAsset>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpOrderTriangles(const float* positions, uint32_t positionStride, uint32_t vertexCount,
                                        const uint32_t* indices, uint32_t indexCount, uint32_t* order) {
  return guarded("gpgpOrderTriangles", [&](Call&) -> Result<void> {
    if (indexCount && (!positions || !indices || !order))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "positions, indices or order is NULL");
    return orderTriangles(positions, positionStride, vertexCount, {indices, indexCount}, order);
  });
}

GpgpResult GPGP_CALL gpgpCreateVisibilityRecorder(GpgpContext handle, const GpgpVisibilityRecorderCreateInfo* info,
                                                  GpgpRecorder* recorder) {
  return guarded("gpgpCreateVisibilityRecorder", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_VISIBILITY_RECORDER_CREATE_INFO, "info"); !ok) return ok;
    if (!recorder) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "recorder is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    auto made = VisibilityRecorder::create(**context, *info);
    if (!made) return made.error();
    *recorder = adopt<GpgpRecorder>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpCreateCameraHistory(GpgpContext handle, const GpgpCameraHistoryCreateInfo* info,
                                             GpgpHistory* history) {
  return guarded("gpgpCreateCameraHistory", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_CAMERA_HISTORY_CREATE_INFO, "info"); !ok) return ok;
    if (!history) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "history is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    auto made = CameraHistory::create(**context, *info);
    if (!made) return made.error();
    *history = adopt<GpgpHistory>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetViewCellCameras(const GpgpViewCellInfo* info, uint32_t* count, GpgpCamera* cameras) {
  return guarded("gpgpGetViewCellCameras", [&](Call&) -> Result<void> {
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_VIEW_CELL_INFO, "info"); !ok) return ok;
    if (!count) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "count is NULL");
    const uint32_t room = cameras ? *count : 0;
    const auto made = viewCellCameras(*info, room, cameras);
    if (!made) return made.error();
    *count = *made;
    if (cameras && *made > room) return makeError(GPGP_INCOMPLETE, "cameras is too small");
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetViewMotionCameras(const GpgpViewMotionInfo* info, uint32_t* count, GpgpCamera* cameras,
                                              GpgpViewMotionCoverage* coverage) {
  return guarded("gpgpGetViewMotionCameras", [&](Call&) -> Result<void> {
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_VIEW_MOTION_INFO, "info"); !ok) return ok;
    if (!count) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "count is NULL");
    const uint32_t room = cameras ? *count : 0;
    const auto made = viewMotionCameras(*info, room, cameras);
    if (!made) return made.error();
    *count = made->cameraCount;
    if (coverage) *coverage = *made;
    if (cameras && *count > room) return makeError(GPGP_INCOMPLETE, "cameras is too small");
    return {};
  });
}

GpgpResult GPGP_CALL gpgpRecordPrepareVisibility(GpgpRecorder handle, VkCommandBuffer commandBuffer,
                                                 const GpgpFrame* frame, const GpgpVisibilityInfo* info) {
  return guarded("gpgpRecordPrepareVisibility", [&](Call& call) -> Result<void> {
    const auto recorder = resolve<VisibilityRecorder>(call, handle, Kind::visibilityRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_VISIBILITY_INFO, "info"); !ok) return ok;
    const core::Context& context = (*recorder)->context;
    const auto geometry = resolve<GeometrySet>(call, info->geometrySet, Kind::geometrySet, "geometrySet", &context);
    if (!geometry) return geometry.error();
    CameraHistory* history = nullptr;
    if (info->history) {
      const auto resolved = resolve<CameraHistory>(call, info->history, Kind::cameraHistory, "history", &context);
      if (!resolved) return resolved.error();
      history = *resolved;
    }
    if (info->moreCameraCount && !info->moreCameras)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "moreCameras is NULL, but moreCameraCount is %u",
                       info->moreCameraCount);
    const core::RecorderUse use(**recorder);
    if (!use) return core::RecorderUse::error();
    if (auto ok = checkRecord(**recorder, frame); !ok) return ok;
    if (!(*geometry)->resident()) return makeError(GPGP_NOT_READY, "geometrySet is not resident");
    if (history && !history->resident()) return makeError(GPGP_NOT_READY, "history is not resident");
    return (*recorder)->prepare(commandBuffer, *info, **geometry, history);
  });
}

GpgpResult GPGP_CALL gpgpRecordPrepareVisibilityMetrics(GpgpRecorder handle, VkCommandBuffer commandBuffer,
                                                        const GpgpFrame* frame, const GpgpVisibilityMetricsInfo* info) {
  return guarded("gpgpRecordPrepareVisibilityMetrics", [&](Call& call) -> Result<void> {
    const auto recorder = resolve<VisibilityRecorder>(call, handle, Kind::visibilityRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_VISIBILITY_METRICS_INFO, "info"); !ok) return ok;
    const core::RecorderUse use(**recorder);
    if (!use) return core::RecorderUse::error();
    if (auto ok = checkRecord(**recorder, frame); !ok) return ok;
    return (*recorder)->measure(commandBuffer, *info);
  });
}

GpgpResult GPGP_CALL gpgpGetVisibilityReport(GpgpRecorder handle, GpgpVisibilityReport* report) {
  return guarded("gpgpGetVisibilityReport", [&](Call& call) -> Result<void> {
    const auto recorder = resolve<VisibilityRecorder>(call, handle, Kind::visibilityRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (auto ok = checkStruct(report, GPGP_STRUCTURE_VISIBILITY_REPORT, "report"); !ok) return ok;
    const core::RecorderUse use(**recorder);
    if (!use) return core::RecorderUse::error();
    if (!(*recorder)->takeSampleReport(*report)) return noReport();
    return {};
  });
}
