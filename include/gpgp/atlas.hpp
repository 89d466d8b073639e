/* gpgp atlas.hpp: C++17 wrapper of atlas.h. The rules of the wrapper are in core.hpp. */
#ifndef GPGP_ATLAS_HPP
#define GPGP_ATLAS_HPP

#include <gpgp/atlas.h>
#include <gpgp/core.hpp>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpAtlasCreateInfo, GPGP_STRUCTURE_ATLAS_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpAtlasRecorderCreateInfo, GPGP_STRUCTURE_ATLAS_RECORDER_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpAtlasInfo, GPGP_STRUCTURE_ATLAS_INFO);
GPGP_STRUCTURE_OF(GpgpAtlasReport, GPGP_STRUCTURE_ATLAS_REPORT);

/// Which triangles have blocks of a shading atlas, and where (gpgpCreateAtlas).
class Atlas : public History {
public:
  using History::History;
  static Result<Atlas> create(GpgpContext context, const GpgpAtlasCreateInfo& info) noexcept {
    return detail::create<Atlas>(gpgpCreateAtlas, context, info);
  }
};

/// Allocates blocks of atlases and lists what is to be shaded (gpgpCreateAtlasRecorder).
class AtlasRecorder : public Recorder {
public:
  using Recorder::Recorder;
  static Result<AtlasRecorder> create(GpgpContext context, const GpgpAtlasRecorderCreateInfo& info) noexcept {
    return detail::create<AtlasRecorder>(gpgpCreateAtlasRecorder, context, info);
  }
  /// gpgpRecordPrepareAtlas: outside render passes.
  [[nodiscard]] GpgpResult recordPrepare(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                         const GpgpAtlasInfo& info) noexcept {
    return gpgpRecordPrepareAtlas(get(), commandBuffer, &frame, &info);
  }
  /// gpgpGetAtlasReport: the oldest report that was not taken yet, or GPGP_NOT_READY.
  Result<GpgpAtlasReport> report() noexcept { return detail::report(gpgpGetAtlasReport, get()); }
};

} // namespace gpgp

#endif
