#include "pass_lists.h"
#include "vector/passes/builder.h"

namespace gpgp::test {

core::PassList canvasPasses(bool software, bool patches) {
  vector::CanvasSizes sizes{};
  sizes.maxWidth = sizes.maxHeight = 1024;
  sizes.maxEntries = sizes.maxWords = 1 << 16;
  sizes.targets = GPGP_CANVAS_TARGET_HISTORY | GPGP_CANVAS_TARGET_RGBA8 | GPGP_CANVAS_TARGET_RGBA16F;
  sizes.items = {16, 1024, 16, 1024};
  sizes.software = software;
  if (patches) sizes.maxTilePatches = 1 << 16;
  if (!software) sizes.layers = {1 << 20, 64}; // their passes are the same there
  return vector::describePasses(sizes, deviceOf(software), std::pmr::get_default_resource());
}

} // namespace gpgp::test
