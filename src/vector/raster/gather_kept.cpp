// What the pixels of a recording's things depend on, as hashes, and the tiles that they may touch (kept.h).
#include "vector/raster/gather.h"
#include "vector/shared/shape.h"
#include "vector/shared/tiles.h"

#include <algorithm>

namespace gpgp::vector {
using shader::ItemRecord;
using shader::ShapeRecord;
using shader::vec4;

uint64_t Gather::identityOf(const core::Object& asset) {
  return StateHash().add(asset.handle).add(asset.handle->generation).value();
}

/// Indices count in the recording, so what they lead to stands for them.
uint64_t Gather::stateOf(const ItemRecord& source) const {
  ItemRecord record = source;
  record.clip = record.layer = record.firstImage = 0;
  StateHash hash;
  hash.add(record).add(source.clip ? tables_.clipStateHashes[source.clip - 1] : 0);
  // A layer composites its things with each other: those of another one are not they, however alike.
  for (uint32_t layer = source.layer; layer; layer = tables_.layers[layer - 1].parent)
    hash.add(layer).add(tables_.layers[layer - 1].opacity);
  return hash.value();
}

void Gather::addImage(StateHash& hash, uint64_t index) const {
  const GpgpCanvasImage& image = info_.images[index];
  hash.add(image.view).add(image.sampler).add(image.premultiplied).add(image.encoding).add(image.filter);
  hash.add(image.version);
}

TileBox Gather::tilesOf(const ItemRecord& item, const vec4& box, const vec4& frame) const {
  const uint32_t x = (info_.width + shader::kTileSize - 1) / shader::kTileSize,
                 y = (info_.height + shader::kTileSize - 1) / shader::kTileSize;
  const shader::uvec4 tiles = shader::tileBox(item, box, frame, shader::vec2(x, y));
  return {static_cast<uint16_t>(tiles.x), static_cast<uint16_t>(tiles.y), static_cast<uint16_t>(tiles.z),
          static_cast<uint16_t>(tiles.w)};
}

TileBox Gather::tilesOf(const ShapeRecord& shape, uint32_t source) const {
  const bool triangle = shader::isTriangle(shape);
  return tilesOf(tables_.sources[source], triangle ? shader::triangleBox(shape) : shape.box,
                 triangle ? kNoFrame : shape.frame);
}

bool Gather::showsShape(const List& list, const List::Shape& shape, uint32_t source) {
  const auto state = [&](StateHash& hash) {
    ShapeRecord record = shape.record;
    record.paint = 0;
    hash.add(record).add(shape.color);
    if (!shape.record.paint) return;
    shader::PaintRecord paint = list.paints().paints[shape.record.paint - 1];
    const uint32_t first = paint.kind == shader::kPaintSlices ? paint.slices : paint.firstStop;
    if (paint.kind >= shader::kPaintImage)
      addImage(hash, uint64_t(tables_.sources[source].firstImage) + paint.firstStop);
    if (paint.stopCount) (paint.kind == shader::kPaintSlices ? paint.slices : paint.firstStop) = 0;
    hash.add(paint);
    for (uint32_t i = 0; i < paint.stopCount; ++i) hash.add(list.paints().stops[first + i]);
  };
  return shows(source, state, [&] { return planner_ ? TileBox{} : tilesOf(shape.record, source); });
}

} // namespace gpgp::vector
