// The cameras of a view cell (6.3.5): the middle, a grid of pixel offsets, points round it.
#pragma once
#include "core/result.h"

#include <glm/vec4.hpp>
#include <gpgp/visibility.h>

namespace gpgp::visibility {

/// What gpgpGetViewCellCameras promises; `room` cameras are written, the result is how many there are.
core::Result<uint32_t> viewCellCameras(const GpgpViewCellInfo& info, uint32_t room, GpgpCamera* cameras);

/// What turns a perspective camera's depths into inverse distances, and those into pixels by which things move that are
/// seen from `reach` away (nearby.h). Zeros for a parallel one.
glm::vec4 depthScale(const GpgpCamera& camera, uint32_t width, uint32_t height, float reach);

} // namespace gpgp::visibility
