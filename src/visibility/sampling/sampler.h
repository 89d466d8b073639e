// The sampler: one record clears, numbers the triangles, draws depth, draws ids, gathers bits and lists.
//
// Chapter 6, method "standard" (6.1.1), in compute: works on queues without graphics. docs/visibility.md has the flow.
#pragma once
#include "core/worker.h"
#include "visibility/geometry_set.h"
#include "visibility/sampling/passes.h"

namespace gpgp::visibility {

class Sampler final : public core::Worker {
public:
  /// Budgets of zero mean the defaults of gpgp/visibility.h.
  static core::Result<core::Unique<Sampler>> create(core::Context& context, const GpgpSamplerCreateInfo& info);
  Sampler(core::Context& owner, const GpgpSamplerCreateInfo& info);

  /// Checks what depends on the budgets and the buffers' sizes, then records. view may be null.
  core::Result<void> prepare(VkCommandBuffer commandBuffer, const GpgpSampleInfo& info, const GeometrySet& geometry,
                             const CameraView* view);
  /// Compares two sets of triangles.
  core::Result<void> measure(VkCommandBuffer commandBuffer, const GpgpVisibilityMetricsInfo& info);
  /// False: none is there.
  bool takeSampleReport(GpgpSampleReport& report);

private:
  const Budgets budgets_;
};

} // namespace gpgp::visibility
