// The checks of a recording that depend on what the recorder was made for, and on the sizes of the engine's buffers.
#pragma once
#include "core/result.h"
#include "visibility/geometry_set.h"
#include "visibility/sampling/budgets.h"

namespace gpgp::visibility {

core::Result<void> checkSize(const char* name, const GpgpBuffer& buffer, uint64_t needed, const char* why);

/// history may be null.
core::Result<void> checkSampleInfo(const GpgpVisibilityInfo& info, const Budgets& budgets,
                                   const CameraHistory* history);

} // namespace gpgp::visibility
