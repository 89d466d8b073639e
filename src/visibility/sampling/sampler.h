// The sampler: one record clears, numbers the triangles, draws depth, draws ids, gathers bits and lists.
//
// Chapter 6, method "standard" (6.1.1), in compute: works on queues without graphics. docs/visibility.md has the flow.
#pragma once
#include "core/worker.h"
#include "visibility/geometry_set.h"
#include "visibility/layout.h"

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
  core::PassList describe() const;
  void describeExact(core::PassList& list) const;
  void describeConservative(core::PassList& list) const;
  void describeDraws(core::PassList& list) const;
  void describeMetrics(core::PassList& list) const;
  static uint32_t samplesOf(const GpgpSampleInfo& info);
  void setGrid(const GpgpSampleInfo& info, shader::Params& params) const;
  core::Result<void> checkInfo(const GpgpSampleInfo& info, const CameraView* view) const;

  uint64_t chunkCapacity() const;
  uint64_t slotCapacity() const;
  uint32_t mediumRecords() const;
  uint32_t largeRecords() const;

  uint32_t defaultPairs() const;

  const uint32_t maxWidth_, maxHeight_, maxCameras_, maxDraws_, maxTriangles_, maxSamples_, methods_, maxCandidates_,
      maxPairs_;
};

} // namespace gpgp::visibility
