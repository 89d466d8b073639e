// Layers: operations on the pictures that the raster leaves, as many as a recording lists, and the canvas they make.
#include "vector/passes/builder.h"

namespace gpgp::vector {
using enum core::UseKind;

void addLayers(PassBuilder& b) {
  static constexpr const char* kNames[] = {"composite",     "blur",         "filter, colours", "filter, neighbourhoods",
                                           "filter, noise", "filter, light"};
  for (uint32_t k = 0; k < std::size(kNames); ++k)
    b.dispatch(kNames[k], vector_operate[k], {{b.operations, read}, {b.pictures, readWrite}}, kPresents, UINT32_MAX)
        .stepped = true;
  static constexpr FormNames kPresentNames = {"present", "present rgba8", "present rgba16f"};
  for (uint32_t t = 0; t < 3; ++t)
    if (b.sizes.writes(t))
      b.target(b.dispatch(kPresentNames[t], vector_present[t],
                          {{b.operations, read}, {b.pictures, read}, {b.layeredHistory, write}}, kPresents, kPresent),
               t, kPresent);
}

} // namespace gpgp::vector
