// Numbers by which a recording of an atlas gives workgroup counts and conditions.
#pragma once
#include "visibility/atlas/recorder.h"

namespace gpgp::visibility {

constexpr uint32_t kAtlasOneGroup = 0, kAtlasDrawGroups = 1, kAtlasTriangleGroups = 2, kAtlasRequestRows = 3,
                   kAtlasClassGroups = 4, kAtlasTileRows = 5;
constexpr uint32_t kIfPairs = 0, kIfTiles = 1;

} // namespace gpgp::visibility
