// The canvas: drawings to pixels in one record.
//
// gather -> boxes -> coarse (which groups of 64 patches may touch a tile of 128 pixels) -> bin (which patches touch a
// tile of 16 pixels, and which of their curves pass through it) -> raster (samples). Lists are in painting order by
// construction. Where the lists do not fit, the last paths are left out whole and the lists are made again, all on
// the GPU.
#pragma once
#include "core/worker.h"
#include "vector/raster/drawing_asset.h"

namespace gpgp::vector {

class Canvas final : public core::Worker {
public:
  static core::Result<core::Unique<Canvas>> create(core::Context& context, const GpgpCanvasCreateInfo& info);
  Canvas(core::Context& owner, const GpgpCanvasCreateInfo& info);

  /// Drawings of `info.items` in order, resolved; the view may be null. Arguments are checked here.
  core::Result<void> prepare(VkCommandBuffer commandBuffer, const GpgpCanvasInfo& info,
                             std::span<DrawingAsset* const> drawings, CanvasView* view);
  core::Result<void> draw(VkCommandBuffer commandBuffer, const GpgpCanvasDrawInfo& info, CanvasView& view);
  bool takeCanvasReport(GpgpCanvasReport& report);
  uint32_t maxDrawings() const { return maxDrawings_; }
  /// Room for the drawings of a record, so that recording does not allocate.
  std::span<DrawingAsset*> drawings(uint32_t count) { return std::span(drawings_).first(count); }

private:
  core::PassList describe() const;
  core::Result<void> checkInfo(const GpgpCanvasInfo& info, const CanvasView* view) const;

  const uint32_t maxWidth_, maxHeight_, maxPatches_, maxEntries_, maxDrawings_;
  std::pmr::vector<std::byte> constants_; // room for one record's
  std::pmr::vector<DrawingAsset*> drawings_;
};

} // namespace gpgp::vector
