// Checks of a spawner's budgets; and of a recording, by what the spawner was made for and the sizes of the engine's
// buffers.
#pragma once
#include "spawn/schedule/spawner.h"

namespace gpgp::spawn {

core::Result<void> checkCreateInfo(const GpgpSpawnerCreateInfo& info);
/// buckets: of the grammar.
core::Result<void> checkSpawnInfo(const GpgpSpawnInfo& info, const Spawner& spawner, uint32_t buckets);

} // namespace gpgp::spawn
