// The recorder: one recording clears, numbers the triangles, draws depth, draws ids, gathers bits and lists.
//
// Chapter 6, method "standard" (6.1.1), in compute: works on queues without graphics. docs/internals/visibility.md has
// the flow.
#pragma once
#include "core/recorder.h"
#include "visibility/geometry_set.h"
#include "visibility/sampling/passes.h"

namespace gpgp::visibility {

class VisibilityRecorder final : public core::Recorder {
public:
  /// Budgets of zero mean the defaults of gpgp/visibility.h.
  static core::Result<core::Unique<VisibilityRecorder>> create(core::Context& context,
                                                               const GpgpVisibilityRecorderCreateInfo& info);
  VisibilityRecorder(core::Context& owner, const GpgpVisibilityRecorderCreateInfo& info);

  /// Checks what depends on the budgets and the buffers' sizes, then records. history may be null.
  core::Result<void> prepare(VkCommandBuffer commandBuffer, const GpgpVisibilityInfo& info, const GeometrySet& geometry,
                             const CameraHistory* history);
  /// Compares two sets of triangles.
  core::Result<void> measure(VkCommandBuffer commandBuffer, const GpgpVisibilityMetricsInfo& info);
  /// False: none is there.
  bool takeSampleReport(GpgpVisibilityReport& report);

private:
  const Budgets budgets_;
};

} // namespace gpgp::visibility
