// What the items of a recording or a hit test show.
#pragma once
#include "api/check.h"
#include "vector/raster/gather.h"

namespace gpgp::api {

/// What items[i] shows, which is one thing.
inline Result<vector::ItemAsset> resolveItem(Call& call, const GpgpCanvasItem& item, uint32_t i,
                                             const Context& context) {
  vector::ItemAsset asset;
  if (item.list && (item.drawing || item.glyphSet))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u]: both list and drawing or glyphSet are given", i);
  if (item.drawing && item.glyphSet)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u]: both drawing and glyphSet are given", i);
  if (item.list) {
    const auto list = resolve<vector::List>(call, item.list, Kind::list, "items[].list", &context);
    if (!list) return list.error();
    asset.list = *list;
  } else if (item.glyphSet) {
    const auto set = resolve<vector::GlyphSet>(call, item.glyphSet, Kind::glyphSet, "items[].glyphSet", &context);
    if (!set) return set.error();
    if (!((*set)->methods() & GPGP_DRAWING_FLATTENED))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].glyphSet was made without GPGP_DRAWING_FLATTENED", i);
    asset.glyphSet = *set;
  } else {
    const auto drawing = resolve<vector::DrawingAsset>(call, item.drawing, Kind::drawing, "items[].drawing", &context);
    if (!drawing) return drawing.error();
    if (!((*drawing)->methods() & GPGP_DRAWING_FLATTENED))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].drawing was made without GPGP_DRAWING_FLATTENED", i);
    asset.drawing = *drawing;
  }
  return asset;
}

} // namespace gpgp::api
