// What lies under a point: the curves that the raster draws, asked in double precision on the host.
#pragma once
#include "vector/raster/gather.h"

namespace gpgp::vector {

/// A point of the canvas against one item: true where something of it is hit, with all of `hit` filled in but the item.
core::Result<bool> hitItem(const GpgpCanvasItem& item, const ItemAsset& asset, double x, double y, GpgpHit& hit);

} // namespace gpgp::vector
