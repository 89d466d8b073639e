// The C functions of tiles.h.
#include "api/check.h"
#include "spawn/tiles/tile_set.h"

#include <gpgp/tiles.h>

using namespace gpgp;
using namespace gpgp::api;
using spawn::TileSet;

namespace {
struct Parts {
  spawn::Spawner* spawner;
  spawn::Grammar* grammar;
};
/// The spawner and the grammar of a tile set, which may have been destroyed since.
Result<Parts> partsOf(Call& call, GpgpRecorder recorder, GpgpAsset asset, const Context* context) {
  const auto spawner = resolve<spawn::Spawner>(call, recorder, Kind::spawner, "spawner", context);
  if (!spawner) return spawner.error();
  const auto grammar = resolve<spawn::Grammar>(call, asset, Kind::grammar, "grammar", &(*spawner)->context);
  if (!grammar) return grammar.error();
  return Parts{*spawner, *grammar};
}

core::Error noTile() { return makeError(GPGP_ERROR_INVALID_HANDLE, "tile was freed, or is none of this tile set"); }
} // namespace

GpgpResult GPGP_CALL gpgpGetTileStride(GpgpRecorder recorder, GpgpAsset asset, VkDeviceSize* stride) {
  return guarded("gpgpGetTileStride", [&](Call& call) -> Result<void> {
    const auto parts = partsOf(call, recorder, asset, nullptr);
    if (!parts) return parts.error();
    if (!stride) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "stride is NULL");
    *stride = TileSet::strideOf(*parts->spawner, *parts->grammar);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpCreateTileSet(GpgpContext handle, const GpgpTileSetCreateInfo* info, GpgpHistory* tileSet) {
  return guarded("gpgpCreateTileSet", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_TILE_SET_CREATE_INFO, "info"); !ok) return ok;
    if (!tileSet) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "tileSet is NULL");
    const auto parts = partsOf(call, info->spawner, info->grammar, *context);
    if (!parts) return parts.error();
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    auto made = TileSet::create(**context, *info, *parts->spawner, *parts->grammar);
    if (!made) return made.error();
    *tileSet = adopt<GpgpHistory>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpRecordTile(GpgpHistory handle, VkCommandBuffer commandBuffer, const GpgpFrame* frame,
                                    const GpgpTileInfo* info, GpgpTile* tile) {
  return guarded("gpgpRecordTile", [&](Call& call) -> Result<void> {
    const auto set = resolve<TileSet>(call, handle, Kind::tileSet, "tileSet");
    if (!set) return set.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_TILE_INFO, "info"); !ok) return ok;
    if (!tile) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "tile is NULL");
    if (*tile && !(*set)->find(*tile)) return noTile();
    const auto parts = partsOf(call, (*set)->spawner, (*set)->grammar, &(*set)->context);
    if (!parts) return parts.error();
    const core::RecorderUse use(*parts->spawner);
    if (!use) return core::RecorderUse::error();
    if (auto ok = checkRecord(*parts->spawner, frame); !ok) return ok;
    if (!parts->grammar->resident()) return makeError(GPGP_NOT_READY, "the grammar is not resident");
    return (*set)->record(commandBuffer, *info, *parts->spawner, *parts->grammar, *tile);
  });
}

GpgpResult GPGP_CALL gpgpRecordFreeTile(GpgpHistory handle, VkCommandBuffer commandBuffer, const GpgpFrame* frame,
                                        GpgpTile tile, GpgpAccessMode accessMode) {
  return guarded("gpgpRecordFreeTile", [&](Call& call) -> Result<void> {
    const auto set = resolve<TileSet>(call, handle, Kind::tileSet, "tileSet");
    if (!set) return set.error();
    if (!(*set)->find(tile)) return noTile();
    if (!commandBuffer) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "commandBuffer is NULL");
    if (accessMode & ~GPGP_ACCESS_EXTERNAL_BARRIERS)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "accessMode has unknown bits");
    if (auto ok = (*set)->context.checkAlive(); !ok) return ok;
    if (auto ok = (*set)->context.checkFrame(frame); !ok) return ok;
    (*set)->recordFree(commandBuffer, tile, accessMode);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpTrimTile(GpgpHistory handle, GpgpTile tile, uint32_t used) {
  return guarded("gpgpTrimTile", [&](Call& call) -> Result<void> {
    const auto set = resolve<TileSet>(call, handle, Kind::tileSet, "tileSet");
    if (!set) return set.error();
    if (!(*set)->find(tile)) return noTile();
    return (*set)->trim(tile, used);
  });
}

GpgpResult GPGP_CALL gpgpGetTileRange(GpgpHistory handle, GpgpTile tile, GpgpTileRange* range) {
  return guarded("gpgpGetTileRange", [&](Call& call) -> Result<void> {
    const auto set = resolve<TileSet>(call, handle, Kind::tileSet, "tileSet");
    if (!set) return set.error();
    if (!range) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "range is NULL");
    if (!(*set)->find(tile)) return noTile();
    *range = (*set)->rangeOf(tile);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetTileSetReport(GpgpHistory handle, GpgpTileSetReport* report) {
  return guarded("gpgpGetTileSetReport", [&](Call& call) -> Result<void> {
    const auto set = resolve<TileSet>(call, handle, Kind::tileSet, "tileSet");
    if (!set) return set.error();
    if (auto ok = checkStruct(report, GPGP_STRUCTURE_TILE_SET_REPORT, "report"); !ok) return ok;
    *report = (*set)->report();
    return {};
  });
}
