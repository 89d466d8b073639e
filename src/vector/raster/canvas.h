// The canvas: drawings and texts to pixels in one record.
//
// begin (every item gets its place, each glyph of a text and shape of a list as one) ->
// place (paths' boxes) -> mark (which tiles each path's boundary meets, which lie inside) and bin (which paths may
// touch a square of 128 pixels) -> allocate (room for the tiles with edges) -> fill (what boundaries do to their pixels)
// -> raster (front to back). Lists need no sorting: paths are bits in painting order. Where room does not suffice, the
// last paths are left out whole, on the GPU.
#pragma once
#include "core/recorder.h"
#include "vector/raster/gather.h"

namespace gpgp::vector {

class Canvas final : public core::Recorder {
public:
  static core::Result<core::Unique<Canvas>> create(core::Context& context, const GpgpCanvasCreateInfo& info);
  Canvas(core::Context& owner, const GpgpCanvasCreateInfo& info);

  /// Assets of `info.items` in order, resolved; the view may be null. Arguments are checked here. NOT_READY where a
  /// glyph is not resident.
  core::Result<void> prepare(VkCommandBuffer commandBuffer, const GpgpCanvasInfo& info,
                             std::span<const ItemAsset> assets, CanvasHistory* view);
  core::Result<void> draw(VkCommandBuffer commandBuffer, const GpgpCanvasDrawInfo& info, CanvasHistory& view);
  bool takeCanvasReport(GpgpCanvasReport& report);
  uint32_t maxDrawings() const { return budgets_.items; }
  /// Room for the assets of a record, so that recording does not allocate.
  std::span<ItemAsset> assets(uint32_t count) { return std::span(assets_).first(count); }

private:
  core::PassList describe() const;
  uint64_t tiles() const;
  uint32_t listWords() const; ///< of a tile's list on software devices
  uint64_t binWords() const;
  uint32_t binLists() const;
  uint64_t binsEnd() const;                                              ///< words that bins, lists and all take
  uint32_t smallGlyphRoom() const { return software_ ? 0 : maxEntries_ / 2; } ///< tile entries that small glyphs may take
  /// Of the lists between mark and fill: rows of flattened segments, or pieces of them on software devices.
  uint32_t maxRows() const { return maxEntries_ * (software_ ? 4 : 8); }
  bool writes(uint32_t target) const { return targets_ >> target & 1; }
  core::Result<void> checkInfo(const GpgpCanvasInfo& info, const CanvasHistory* view) const;

  const uint32_t maxWidth_, maxHeight_, maxEntries_, maxWords_;
  const GpgpCanvasTargets targets_; ///< bits in the order of kNoImage, kHasImage8, kHasImage16
  const ItemBudgets budgets_;
  const bool software_; ///< the device has shaders without barriers
  // Room for one record's.
  std::pmr::vector<ItemAsset> assets_;
  ItemTables tables_;
};

} // namespace gpgp::vector
