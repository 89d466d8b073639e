// The pipelines of every kind of recorder, and what they cost.
#pragma once
#include "cli/shared/command.h"
#include "host/device.h"

namespace gpgp::cli {

/// Makes recorders of all kinds, one after another and without a job system, and lists their pipelines: what an engine
/// waits for once, before the driver's and gpgp's caches are filled.
Outcome listPipelines(host::HeadlessDevice& device);

} // namespace gpgp::cli
