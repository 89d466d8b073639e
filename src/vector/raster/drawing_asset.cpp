#include "vector/raster/drawing_asset.h"

#include <algorithm>
#include <cstring>

namespace gpgp::vector {

core::Result<core::Unique<DrawingAsset>> DrawingAsset::create(core::Context& context, const char* label,
                                                              const Drawing& drawing) {
  auto asset = core::makeUnique<DrawingAsset>(context.host(), context, label);
  asset->curves_ = static_cast<uint32_t>(drawing.curves.size());
  asset->ends_.assign(drawing.paths.size(), Ends{});
  for (const PatchRecord& patch : drawing.patches) {
    Ends& ends = asset->ends_[patch.path];
    ++ends.patches;
    ends.curves = std::max(ends.curves, std::max(patch.left, patch.right) + 1);
  }
  for (size_t i = 1; i < asset->ends_.size(); ++i) {
    asset->ends_[i].patches += asset->ends_[i - 1].patches;
    asset->ends_[i].curves = std::max(asset->ends_[i].curves, asset->ends_[i - 1].curves);
  }
  std::copy_n(drawing.bounds, 4, asset->bounds_);
  std::copy_n(drawing.viewport, 4, asset->viewport_);
  const auto curves = std::as_bytes(std::span(drawing.curves));
  const auto patches = std::as_bytes(std::span(drawing.patches));
  const auto paths = std::as_bytes(std::span(drawing.paths));
  std::pmr::vector<std::byte> bytes(&context.host());
  bytes.reserve(curves.size() + patches.size() + paths.size());
  for (const auto part : {curves, patches, paths}) bytes.insert(bytes.end(), part.begin(), part.end());
  if (bytes.size() > context.device.limits.maxStorageBufferRange)
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "the drawing has %zu bytes, but this device binds at most %u",
                           bytes.size(), context.device.limits.maxStorageBufferRange);
  if (auto ok = asset->makeResident(GPGP_SERVICE_VECTOR, std::move(bytes), 16); !ok) return ok.error();
  return asset;
}

core::Result<core::Unique<CanvasView>> CanvasView::create(core::Context& context,
                                                          const GpgpCanvasViewCreateInfo& info) {
  auto view = core::makeUnique<CanvasView>(context.host(), context, info.label);
  view->width = info.width;
  view->height = info.height;
  const std::pmr::vector<std::byte> none(&context.host());
  if (auto ok = view->makeResident(GPGP_SERVICE_VECTOR, none, VkDeviceSize(info.width) * info.height * 8); !ok)
    return ok.error();
  return view;
}

} // namespace gpgp::vector
