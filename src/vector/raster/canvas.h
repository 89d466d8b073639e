// The canvas: drawings and texts to pixels in one recording.
//
// begin (every item gets its place, each glyph of a text and shape of a list as one) ->
// place (paths' boxes) -> mark (which tiles each path's boundary meets, which lie inside) and bin (which paths may
// touch a square of 128 pixels) -> allocate (room for the tiles with edges) -> fill (what boundaries do to their
// pixels)
// -> raster (front to back). Lists need no sorting: paths are bits in painting order. Where room does not suffice, the
// last paths are left out whole, on the GPU.
#pragma once
#include "core/recorder.h"
#include "vector/passes/sizes.h"
#include "vector/raster/gather.h"

namespace gpgp::vector {

class Canvas final : public core::Recorder {
public:
  static core::Result<core::Unique<Canvas>> create(core::Context& context, const GpgpCanvasCreateInfo& info);
  Canvas(core::Context& owner, const GpgpCanvasCreateInfo& info);

  /// Assets of `info.items` in order, resolved; the history may be null. Arguments are checked here. NOT_READY where a
  /// glyph is not resident.
  core::Result<void> prepare(VkCommandBuffer commandBuffer, const GpgpCanvasInfo& info,
                             std::span<const ItemAsset> assets, CanvasHistory* history);
  core::Result<void> draw(VkCommandBuffer commandBuffer, const GpgpCanvasDrawInfo& info, CanvasHistory& history);
  bool takeCanvasReport(GpgpCanvasReport& report);
  uint32_t maxDrawings() const { return sizes_.items.items; }
  /// For tests: what the last recording did with pictures of layers.
  std::span<const shader::OperationRecord> operations() const {
    return std::span(layers_.operations).first(operationCount_);
  }
  std::span<const core::Step> steps() const {
    return std::span(layers_.steps).first(operationCount_ ? operationCount_ - 1 : 0);
  }
  /// Room for the assets of a recording, so that recording does not allocate.
  std::span<ItemAsset> assets(uint32_t count) { return std::span(assets_).first(count); }

private:
  core::Result<void> checkInfo(const GpgpCanvasInfo& info, const CanvasHistory* history) const;
  void harvested(const core::RawReport& report) override;
  uint64_t settingsOf(const GpgpCanvasInfo& info, bool pictured) const;
  /// Where nothing is to be drawn.
  core::Result<void> recordNothing(core::Record& r, const GpgpCanvasInfo& info);

  const CanvasSizes sizes_;
  // Room for one recording's.
  std::pmr::vector<ItemAsset> assets_;
  ItemTables tables_;
  LayerTables layers_;
  std::pmr::vector<VkDescriptorImageInfo> images_; ///< of pages, where there is more than one
  std::pmr::vector<uint32_t> imagesHold_;          ///< by page, as CanvasHeader::images
  size_t operationCount_ = 0;                      ///< of the last recording
  std::array<uint32_t, 6> operationPasses_{};      ///< by OPERATIONS (operate.comp)
  std::pmr::vector<uint32_t> damage_;              ///< of the recording at hand, where one is kept
  uint32_t recordings_ = 0, broken_ = 0;           ///< so far; number of the last one not known to have run whole
};

} // namespace gpgp::vector
