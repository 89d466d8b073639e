/* gpgp tiles.hpp: C++17 wrapper of tiles.h. The rules of the wrapper are in core.hpp. */
#ifndef GPGP_TILES_HPP
#define GPGP_TILES_HPP

#include <gpgp/spawn.hpp>
#include <gpgp/tiles.h>

#include <cstdint>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpTileSetCreateInfo, GPGP_STRUCTURE_TILE_SET_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpTileInfo, GPGP_STRUCTURE_TILE_INFO);
GPGP_STRUCTURE_OF(GpgpTileSetReport, GPGP_STRUCTURE_TILE_SET_REPORT);

/// gpgpGetTileStride: bytes from a tile's draw commands to the next tile's.
inline Result<VkDeviceSize> tileStride(GpgpRecorder spawner, GpgpAsset grammar) noexcept {
  VkDeviceSize value = 0;
  const GpgpResult code = gpgpGetTileStride(spawner, grammar, &value);
  return Result<VkDeviceSize>(code, value);
}

/// Tiles in the engine's buffers (gpgpCreateTileSet).
class TileSet : public Handle<GpgpHistory> {
public:
  using Handle::Handle;
  static Result<TileSet> create(GpgpContext context, const GpgpTileSetCreateInfo& info) noexcept {
    return detail::create<TileSet>(gpgpCreateTileSet, context, info);
  }
  /// gpgpRecordTile. tile: 0 for a new one.
  [[nodiscard]] GpgpResult record(VkCommandBuffer commandBuffer, const GpgpFrame& frame, const GpgpTileInfo& info,
                                  GpgpTile& tile) noexcept {
    return gpgpRecordTile(get(), commandBuffer, &frame, &info, &tile);
  }
  /// gpgpRecordFreeTile
  [[nodiscard]] GpgpResult recordFree(VkCommandBuffer commandBuffer, const GpgpFrame& frame, GpgpTile tile,
                                      GpgpAccessMode accessMode = 0) noexcept {
    return gpgpRecordFreeTile(get(), commandBuffer, &frame, tile, accessMode);
  }
  /// gpgpTrimTile
  [[nodiscard]] GpgpResult trim(GpgpTile tile, uint32_t used) noexcept { return gpgpTrimTile(get(), tile, used); }
  /// gpgpGetTileRange
  Result<GpgpTileRange> range(GpgpTile tile) const noexcept {
    GpgpTileRange value = GpgpTileRange();
    const GpgpResult code = gpgpGetTileRange(get(), tile, &value);
    return Result<GpgpTileRange>(code, value);
  }
  /// gpgpGetTileSetReport
  Result<GpgpTileSetReport> report() const noexcept {
    GpgpTileSetReport value = init<GpgpTileSetReport>();
    const GpgpResult code = gpgpGetTileSetReport(get(), &value);
    return Result<GpgpTileSetReport>(code, value);
  }
};

} // namespace gpgp

#endif
