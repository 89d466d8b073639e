// Tiles: ranges of buffers that the engine shares out among parts of its world. All of it is on the host; a tile's
// derivation is a recording of the spawner into its ranges.
//
// Ranges are counted in units: as many instances or quads as keep every range's offset aligned. The lowest range that
// is large enough is taken, so that the same calls lead to the same places, whatever the device.
#pragma once
#include "spawn/schedule/spawner.h"

#include <gpgp/tiles.h>

namespace gpgp::spawn {

/// Free ranges of [0, size), in order, none next to another. Allocates nothing after its creation.
class FreeRanges {
public:
  /// mostUsed: ranges that are in use at the same time.
  FreeRanges(uint32_t size, uint32_t mostUsed, std::pmr::memory_resource* memory);
  struct Range {
    uint32_t first, size;
  };
  /// The lowest place with room, or UINT32_MAX.
  uint32_t take(uint32_t size);
  /// Takes this place, which is free.
  void takeAt(Range range);
  void give(Range range);
  uint32_t largest() const;
  const std::pmr::vector<Range>& ranges() const { return ranges_; }

private:
  void cut(size_t at, Range range);
  std::pmr::vector<Range> ranges_;
};

class TileSet final : public core::Object {
public:
  /// What is asked of the spawner and the grammar, which the C function has resolved.
  static core::Result<core::Unique<TileSet>> create(core::Context& context, const GpgpTileSetCreateInfo& info,
                                                    const Spawner& spawner, const Grammar& grammar);
  TileSet(core::Context& context, const GpgpTileSetCreateInfo& info, uint32_t unit, uint32_t units, VkDeviceSize stride,
          uint32_t drawsEach, VkDeviceSize bytesEach, bool vertices);

  /// Bytes from a tile's draws to the next one's.
  static VkDeviceSize strideOf(const Spawner& spawner, const Grammar& grammar);

  struct Tile {
    FreeRanges::Range range{}; // units
    uint32_t generation = 0;   // odd: it exists
  };
  /// Null: there is no such tile.
  Tile* find(GpgpTile tile);
  static uint32_t slotOf(GpgpTile tile) { return static_cast<uint32_t>(tile) & (kMostTiles - 1); }
  static constexpr uint32_t kMostTiles = 1u << 20;

  core::Result<void> record(VkCommandBuffer commandBuffer, const GpgpTileInfo& info, Spawner& spawner,
                            const Grammar& grammar, GpgpTile& tile);
  void recordFree(VkCommandBuffer commandBuffer, GpgpTile tile, GpgpAccessMode mode);
  core::Result<void> trim(GpgpTile tile, uint32_t used);
  GpgpTileRange rangeOf(GpgpTile tile);
  GpgpTileSetReport report() const;

  const GpgpRecorder spawner;
  const GpgpAsset grammar;

private:
  uint32_t unitsOf(uint32_t capacity) const { return (capacity - 1) / unit_ + 1; }
  GpgpBuffer drawsOf(uint32_t slot) const;
  /// Fills one word of each of a slot's commands.
  void fill(VkCommandBuffer commandBuffer, uint32_t slot, uint32_t word, uint32_t value) const;
  static GpgpBuffer part(const GpgpBuffer& buffer, VkDeviceSize offset, VkDeviceSize size);

  /// A handle: the generation of the slot in 28 bits, the number of the set in 16, the slot in 20.
  GpgpTile handleOf(uint32_t slot) const { return (GpgpTile(tiles_[slot].generation) << 16 | number_) << 20 | slot; }

  const uint32_t number_; // of the context's sets, modulo 2^16
  const GpgpBuffer instances_, vertices_, indices_, draws_;
  const VkIndexType indexType_;
  const uint32_t unit_;          // instances or quads
  const VkDeviceSize stride_;    // of draws
  const uint32_t drawsEach_;     // commands of a tile
  const VkDeviceSize bytesEach_; // of an instance, or of four vertices
  const bool isVertices_;
  const uint32_t units_;
  std::pmr::vector<Tile> tiles_;
  std::pmr::vector<uint32_t> freeSlots_; // the last is taken first
  FreeRanges free_;
};

} // namespace gpgp::spawn
