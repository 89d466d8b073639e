// Atlases and their recorder: which triangles have blocks of a shading atlas, and where.
//
// After Shading Atlas Streaming (Mueller et al. 2018): request, provision, assign. Places come from scans over the
// triangles in order, not from stacks, so that one input gives one atlas. docs/internals/atlas.md has the flow.
#pragma once
#include "core/recorder.h"
#include "core/resident.h"
#include "visibility/atlas/layout.h"
#include "visibility/geometry_set.h"

#include <gpgp/atlas.h>

namespace gpgp::visibility {

class Atlas final : public core::Resident {
public:
  static core::Result<core::Unique<Atlas>> create(core::Context& context, const GpgpAtlasCreateInfo& info);
  Atlas(core::Context& owner, const GpgpAtlasCreateInfo& info);
  static uint64_t bytesFor(uint32_t maxTriangles);
  uint32_t maxTriangles() const { return maxTriangles_; }
  uint32_t superColumns() const { return width_ / shader::kSuperSide; }
  uint32_t superCount() const { return superColumns() * (height_ / shader::kSuperSide); }

private:
  const uint32_t width_, height_, maxTriangles_;
};

struct AtlasBudgets {
  uint32_t maxTriangles, maxBuckets;
  explicit AtlasBudgets(const GpgpAtlasRecorderCreateInfo& info);
  uint32_t groups() const { return (maxTriangles + shader::kAtlasGroup - 1) / shader::kAtlasGroup; }
  uint64_t rowWords() const;
};

core::PassList describeAtlasPasses(const AtlasBudgets& budgets, std::pmr::memory_resource* memory);

class AtlasRecorder final : public core::Recorder {
public:
  static core::Result<core::Unique<AtlasRecorder>> create(core::Context& context,
                                                          const GpgpAtlasRecorderCreateInfo& info);
  AtlasRecorder(core::Context& owner, const GpgpAtlasRecorderCreateInfo& info);

  /// Checks what depends on the budgets and the buffers' sizes, then records. geometry may be null.
  core::Result<void> prepare(VkCommandBuffer commandBuffer, const GpgpAtlasInfo& info, const Atlas& atlas,
                             const GeometrySet* geometry);
  /// False: none is there.
  bool takeAtlasReport(GpgpAtlasReport& report);

private:
  const AtlasBudgets budgets_;
};

/// What the shaders and the CPU reference are given; buffers are not looked at beyond their sizes.
shader::AtlasParams atlasParamsOf(const GpgpAtlasInfo& info, const Atlas& atlas, const GeometrySet* geometry);

} // namespace gpgp::visibility
