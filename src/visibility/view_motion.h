// The cameras of a viewer who walks and turns while a result is on its way.
#pragma once
#include "core/result.h"

#include <gpgp/visibility.h>

namespace gpgp::visibility {

/// What gpgpGetViewMotionCameras promises; `room` cameras are written.
core::Result<GpgpViewMotionCoverage> viewMotionCameras(const GpgpViewMotionInfo& info, uint32_t room,
                                                       GpgpCamera* cameras);

} // namespace gpgp::visibility
