// The camera of a recording or an evaluation, as shaders/spawn/shared/view.h reads it.
#pragma once
#include "core/result.h"
#include "spawn/shared/layout.h"

#include <gpgp/spawn.h>

namespace gpgp::spawn {

/// NULL: without a camera. The same bits for the same camera, for GPU and CPU.
core::Result<shader::View> viewOf(const GpgpSpawnCamera* camera);
/// Times ScreenSize().
float detailOf(const GpgpSpawnCamera* camera);

} // namespace gpgp::spawn
