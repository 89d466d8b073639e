// The patch recorder: drawings and texts as geometry inside the engine's render pass.
//
// One draw. The host writes views and placements (shaders/vector/in_pass/recording.h); paths and their cells
// are quads, found by their number among all placements' quads. There is no pass before it, and nothing is kept.
#pragma once
#include "core/recorder.h"
#include "vector/raster/gather.h"

#include <functional>

namespace gpgp::vector {

class PatchRecorder final : public core::Recorder {
public:
  static core::Result<core::Unique<PatchRecorder>> create(core::Context& context,
                                                          const GpgpPatchRecorderCreateInfo& info);
  PatchRecorder(core::Context& owner, const GpgpPatchRecorderCreateInfo& info);

  /// Arguments are checked here. assetOf: what an item shows. NOT_READY where that is not resident.
  template <class AssetOf>
  core::Result<void> draw(VkCommandBuffer commandBuffer, const GpgpPatchDrawInfo& info, const AssetOf& assetOf) {
    if (info.itemCount > maxItems_)
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "itemCount is %u; the recorder was made for %u (maxItems)",
                             info.itemCount, maxItems_);
    if (auto ok = begin(info); !ok) return ok;
    for (uint32_t i = 0; i < info.itemCount; ++i) {
      const auto asset = assetOf(i);
      if (!asset) return asset.error();
      if (auto ok = add(info, i, *asset); !ok) return ok;
    }
    return finish(commandBuffer, info);
  }

private:
  core::Result<void> begin(const GpgpPatchDrawInfo& info);
  core::Result<void> add(const GpgpPatchDrawInfo& info, uint32_t index, const ItemAsset& asset);
  core::Result<void> finish(VkCommandBuffer commandBuffer, const GpgpPatchDrawInfo& info);
  /// The slot of an asset's buffer, a new one where it has none; kPatchBuffers: there is none left.
  uint32_t slotOf(const core::Resident& asset);

  const uint32_t maxItems_, maxGlyphs_;
  // Of the recording at hand.
  std::byte* place_ = nullptr; ///< where its constants lie
  std::array<const core::Resident*, 8> bound_ = {};
  uint32_t slots_ = 0, views_ = 0, placements_ = 0, glyphs_ = 0;
  uint64_t quads_ = 0;
};

} // namespace gpgp::vector
