// What the shaders read of one recording, worked out from what the engine gave. The recording has been checked.
#pragma once
#include "visibility/geometry_set.h"
#include "visibility/sampling/budgets.h"
#include "visibility/shared/layout.h"

namespace gpgp::visibility {

constexpr uint32_t kCommandBytes = sizeof(VkDrawIndexedIndirectCommand);

/// What positions or texture coordinates are: shader::kFloats and so on, and a number's bytes; 0 for formats that are
/// not read.
struct PositionFormat {
  uint32_t kind = shader::kFloats, bytes = 0;
};
PositionFormat positionFormatOf(VkFormat format);
PositionFormat textureFormatOf(VkFormat format);

/// A pixel's samples, per side.
uint32_t samplesOf(const GpgpVisibilityInfo& info);

/// history may be null.
shader::Params parametersOf(const GpgpVisibilityInfo& info, const Budgets& budgets, const GeometrySet& geometry,
                            const CameraHistory* history);

} // namespace gpgp::visibility
