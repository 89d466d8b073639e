// The spawner: derives any grammar with the interpreter kernel, in rounds of workgroups that derive by themselves.
//
// Passes of a recording: clear, then the rounds, place, emit. A round shares a queue of shapes among workgroups; each
// derives what comes of its shapes with a stack of its own and leaves to the next round what it should not or cannot do
// alone (shaders/spawn/derive/derive.comp). Terminals leave as instances, and the last workgroup says how many, without
// place. Where these are sorted by bucket, or ordered, terminals become records first, and emit puts them in their
// places. A spawner for vertices makes records as well, and expand vertices and indices of them, before place; where
// they are ordered, before expand.
//
// Grammars with Collider and IfCollides are derived in phases: all rounds of one, link, which makes the colliders so
// far searchable, all rounds of the next. A spawner made for colliders records those passes for such grammars only.
#pragma once
#include "core/recorder.h"
#include "spawn/passes/builder.h"
#include "spawn/schedule/grammar.h"

#include <gpgp/spawn.h>

namespace gpgp::spawn {

class Spawner final : public core::Recorder {
public:
  static core::Result<core::Unique<Spawner>> create(core::Context& context, const GpgpSpawnerCreateInfo& info);
  Spawner(core::Context& owner, const GpgpRecorderCreateInfo& base)
      : Recorder(owner, core::Kind::spawner, base, GPGP_SERVICE_SPAWN), measuring_(&owner.host()) {}

  /// Sizes of buffers are the caller's to check; the rest is checked here.
  core::Result<void> prepare(VkCommandBuffer commandBuffer, const GpgpSpawnInfo& info, const Grammar& grammar);
  /// Makes pipelines of the grammar's kernels that are for this device and fit it.
  core::Result<void> prewarm(Grammar& grammar) const;
  using Recorder::prewarm;
  bool takeReport(GpgpSpawnReport& report);
  /// It writes vertices, not instances.
  bool vertices() const { return sizes_.vertices(); }
  /// Of an instance, in its layout.
  uint32_t instanceBytes() const {
    return static_cast<uint32_t>(sizes_.compact ? sizeof(GpgpCompactInstance) : sizeof(GpgpInstance));
  }
  bool ordered() const { return sizes_.ordered; }
  bool compact() const { return sizes_.compact; }
  const VertexLayout& layout() const { return sizes_.layout; }

private:
  /// That a recording takes where neither the engine nor a tuned kernel says so.
  uint32_t roundsFor(const GpgpSpawnInfo& info, const Grammar& grammar, const Fit& fit) const;

  /// Why a spawner without an interpreter cannot derive a grammar.
  static core::Error noKernel(const Grammar& grammar);

  /// What GpgpSpawnInfo::measures asks of a recording.
  core::Result<void> measure(const GpgpSpawnInfo& info, const Grammar& grammar, core::Record& record);

  SpawnerSizes sizes_;
  std::pmr::vector<uint32_t> measuring_; // shader::Measuring, and a target
  uint32_t maxDepth_ = 0;
  uint32_t derive_ = 0, deriveColliding_ = 0; // shaders
  bool roundsGiven_ = false;                  // by the engine
};

} // namespace gpgp::spawn
