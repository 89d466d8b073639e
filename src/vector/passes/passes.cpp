// The passes of the canvas, a stage a file.
#include "vector/passes/builder.h"

namespace gpgp::vector {

core::PassList describePasses(const CanvasSizes& sizes, const core::Device& device, std::pmr::memory_resource* memory) {
  PassBuilder builder(sizes, device, memory);
  addBegin(builder);
  addPlace(builder);
  addMark(builder);
  if (sizes.software) {
    addSoftwareFill(builder);
    addImages(builder);
    addSoftwareRaster(builder);
  } else {
    if (sizes.maxTilePatches) addPatchTiles(builder);
    addFill(builder);
    if (sizes.maxTilePatches) addPatchFill(builder);
    addImages(builder);
    addRaster(builder);
  }
  if (sizes.layers.pixels) addLayers(builder);
  return std::move(builder.list);
}

} // namespace gpgp::vector
