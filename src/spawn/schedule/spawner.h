// The spawner: derives any grammar with the interpreter kernel, in wavefront rounds.
//
// Passes of a record: clear, then `maxDepth` rounds (those that the grammar cannot need are left out), place, emit.
// A round takes every shape of a queue through its chain of operators and writes the children into the other queue
// (the thesis's rewriting schedule, section 4.2.2, with chains fused). No pass depends on the grammar.
#pragma once
#include "core/worker.h"
#include "spawn/schedule/grammar.h"

#include <gpgp/spawn.h>

namespace gpgp::spawn {

class Spawner final : public core::Worker {
public:
  static core::Result<core::Unique<Spawner>> create(core::Context& context, const GpgpSpawnerCreateInfo& info);
  Spawner(core::Context& owner, const GpgpWorkerCreateInfo& base)
      : Worker(owner, core::Kind::spawner, base, GPGP_SERVICE_SPAWN) {}

  /// Sizes of buffers are the caller's to check; the rest is checked here.
  core::Result<void> prepare(VkCommandBuffer commandBuffer, const GpgpSpawnInfo& info, const Grammar& grammar);
  bool takeReport(GpgpSpawnReport& report);

private:
  uint32_t maxDepth_ = 0;
};

} // namespace gpgp::spawn
