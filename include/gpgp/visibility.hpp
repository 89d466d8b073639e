/* gpgp visibility.hpp: C++17 wrapper of visibility.h. The rules of the wrapper are in core.hpp. */
#ifndef GPGP_VISIBILITY_HPP
#define GPGP_VISIBILITY_HPP

#include <gpgp/core.hpp>
#include <gpgp/visibility.h>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpGeometrySetCreateInfo, GPGP_STRUCTURE_GEOMETRY_SET_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpVisibilityRecorderCreateInfo, GPGP_STRUCTURE_VISIBILITY_RECORDER_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpVisibilityInfo, GPGP_STRUCTURE_VISIBILITY_INFO);
GPGP_STRUCTURE_OF(GpgpVisibilityReport, GPGP_STRUCTURE_VISIBILITY_REPORT);
GPGP_STRUCTURE_OF(GpgpVisibilityMetricsInfo, GPGP_STRUCTURE_VISIBILITY_METRICS_INFO);
GPGP_STRUCTURE_OF(GpgpViewCellInfo, GPGP_STRUCTURE_VIEW_CELL_INFO);
GPGP_STRUCTURE_OF(GpgpViewMotionInfo, GPGP_STRUCTURE_VIEW_MOTION_INFO);
GPGP_STRUCTURE_OF(GpgpCameraHistoryCreateInfo, GPGP_STRUCTURE_CAMERA_HISTORY_CREATE_INFO);

/// The mesh table of a scene, over index and vertex buffers of the engine (gpgpCreateGeometrySet).
class GeometrySet : public Asset {
public:
  using Asset::Asset;
  static Result<GeometrySet> create(GpgpContext context, const GpgpGeometrySetCreateInfo& info) noexcept {
    return detail::create<GeometrySet>(gpgpCreateGeometrySet, context, info);
  }
};

/// One bit per triangle: what a camera saw in its previous recording (gpgpCreateCameraHistory).
class CameraHistory : public History {
public:
  using History::History;
  static Result<CameraHistory> create(GpgpContext context, const GpgpCameraHistoryCreateInfo& info) noexcept {
    return detail::create<CameraHistory>(gpgpCreateCameraHistory, context, info);
  }
};

/// Computes the potentially visible set (PVS) of cameras (gpgpCreateVisibilityRecorder).
class VisibilityRecorder : public Recorder {
public:
  using Recorder::Recorder;
  static Result<VisibilityRecorder> create(GpgpContext context, const GpgpVisibilityRecorderCreateInfo& info) noexcept {
    return detail::create<VisibilityRecorder>(gpgpCreateVisibilityRecorder, context, info);
  }
  /// gpgpRecordPrepareVisibility: outside render passes.
  [[nodiscard]] GpgpResult recordPrepare(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                         const GpgpVisibilityInfo& info) noexcept {
    return gpgpRecordPrepareVisibility(get(), commandBuffer, &frame, &info);
  }
  /// gpgpRecordPrepareVisibilityMetrics: compares visible bits with a reference, outside render passes.
  [[nodiscard]] GpgpResult recordPrepareMetrics(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                                const GpgpVisibilityMetricsInfo& info) noexcept {
    return gpgpRecordPrepareVisibilityMetrics(get(), commandBuffer, &frame, &info);
  }
  /// gpgpGetVisibilityReport: the oldest report that was not taken yet, or GPGP_NOT_READY.
  Result<GpgpVisibilityReport> report() noexcept { return detail::report(gpgpGetVisibilityReport, get()); }
};

} // namespace gpgp

#endif
