// The cameras of a view cell (6.3.5): the middle, a grid of pixel offsets, points round it.
#pragma once
#include "core/result.h"

#include <gpgp/visibility.h>

namespace gpgp::visibility {

/// What gpgpGetViewCellCameras promises; `room` cameras are written, the result is how many there are.
core::Result<uint32_t> viewCellCameras(const GpgpViewCellInfo& info, uint32_t room, GpgpCamera* cameras);

} // namespace gpgp::visibility
