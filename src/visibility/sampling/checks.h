// Checks of a recorder's budgets; and of a recording, by what the recorder was made for and the sizes of the engine's
// buffers.
#pragma once
#include "core/result.h"
#include "visibility/geometry_set.h"
#include "visibility/sampling/budgets.h"

namespace gpgp::visibility {

core::Result<void> checkSize(const char* name, const GpgpBuffer& buffer, uint64_t needed, const char* why);

/// Budgets of a recorder.
core::Result<void> checkCreateInfo(const GpgpVisibilityRecorderCreateInfo& info);

/// history may be null.
core::Result<void> checkSampleInfo(const GpgpVisibilityInfo& info, const Budgets& budgets,
                                   const CameraHistory* history);

} // namespace gpgp::visibility
