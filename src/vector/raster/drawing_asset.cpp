#include "vector/raster/drawing_asset.h"

#include <algorithm>
#include <cstring>

namespace gpgp::vector {

DrawingTables packDrawing(const Drawing& drawing, const Outlines& outlines, std::pmr::memory_resource* memory) {
  DrawingTables tables{std::pmr::vector<std::byte>(memory), 0, {}};
  const auto add = [&bytes = tables.bytes](const auto& records) { // returns where, in vec4
    const auto part = std::as_bytes(std::span(records));
    const size_t at = bytes.size() / sizeof(shader::vec4);
    bytes.insert(bytes.end(), part.begin(), part.end());
    return static_cast<uint32_t>(at);
  };
  add(outlines.segments);
  std::pmr::vector<shader::BoxedPath> paths(memory);
  for (size_t i = 0; i < drawing.paths.size(); ++i) paths.push_back({outlines.boxes[i], drawing.paths[i]});
  tables.paths = add(paths);
  tables.slots.paints = add(drawing.paints);
  tables.slots.stops = add(drawing.stops);
  tables.slots.clips = add(drawing.clips);
  tables.slots.layers = add(drawing.layers);
  return tables;
}

core::Result<core::Unique<DrawingAsset>> DrawingAsset::create(core::Context& context, const char* label,
                                                              Drawing&& drawing, bool editable, bool hitTestable,
                                                              const DrawingAsset* base,
                                                              std::span<const GpgpPathEdit> edits) {
  auto asset = core::makeUnique<DrawingAsset>(context.host(), context, label);
  asset->curves_ = static_cast<uint32_t>(drawing.curves.size());
  Outlines outlines = base ? editOutlines(drawing, base->kept_->outlines, edits, &context.host())
                           : makeOutlines(drawing, &context.host());
  asset->patches_ = static_cast<uint32_t>(drawing.patches.size());
  asset->ends_.assign(outlines.ends.begin(), outlines.ends.end());
  for (const PaintRecord& paint : drawing.paints)
    if (paint.kind == shader::kPaintImage) asset->images_ = std::max(asset->images_, paint.firstStop + 1);
  for (const LayerRecord& layer : drawing.layers) asset->layerDepth_ = std::max(asset->layerDepth_, layer.depth);
  std::copy_n(drawing.bounds, 4, asset->bounds_);
  std::copy_n(drawing.viewport, 4, asset->viewport_);
  DrawingTables tables = packDrawing(drawing, outlines, &context.host());
  asset->pathTable_ = tables.paths;
  asset->tables_ = tables.slots;
  if (tables.bytes.size() > context.device.limits.maxStorageBufferRange)
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "the drawing has %zu bytes, but this device binds at most %u",
                           tables.bytes.size(), context.device.limits.maxStorageBufferRange);
  if (auto ok = asset->makeResident(GPGP_SERVICE_VECTOR, std::move(tables.bytes), 16); !ok) return ok.error();
  if (!editable && hitTestable)
    asset->hit_.emplace(Hit{std::move(outlines), std::move(drawing.paths), std::move(drawing.clips)});
  if (editable) asset->kept_.emplace(Kept{std::move(drawing), std::move(outlines)});
  return asset;
}

core::Result<core::Unique<CanvasHistory>> CanvasHistory::create(core::Context& context,
                                                                const GpgpCanvasHistoryCreateInfo& info) {
  auto view = core::makeUnique<CanvasHistory>(context.host(), context, info.label);
  view->width = info.width;
  view->height = info.height;
  const std::pmr::vector<std::byte> none(&context.host());
  if (auto ok = view->makeResident(GPGP_SERVICE_VECTOR, none, VkDeviceSize(info.width) * info.height * 8); !ok)
    return ok.error();
  return view;
}

} // namespace gpgp::vector
