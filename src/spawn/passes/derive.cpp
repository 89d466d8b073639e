// Derivation: for each phase its rounds, and before all but the first one what makes colliders searchable.
#include "spawn/passes/builder.h"

#include "shaders/spawn_derive.spv.h"
#include "shaders/spawn_derive_colliders.spv.h"
#include "shaders/spawn_derive_colliders_subgroups.spv.h"
#include "shaders/spawn_derive_software.spv.h"
#include "shaders/spawn_derive_subgroups.spv.h"
#include "shaders/spawn_link.spv.h"
#include "spawn/schedule/fits.h"

namespace gpgp::spawn {
using enum core::UseKind;

void addClear(PassBuilder& b) {
  b.list.fill("clear counters", shader::kBindCounters, 0);
  b.list.fill("clear buckets", shader::kBindBuckets, 0).condition = kBucketed;
  b.list.fill("clear bounds", shader::kBindBoundKeys, 0).condition = kBounded;
  if (b.sizes.maxColliders) b.list.fill("clear cells", shader::kBindColliderCells, 0).condition = kColliding;
}

void addDerive(PassBuilder& b) {
  const auto uses = {
      core::Use{shader::kBindGraph, read}, {shader::kBindAxioms, read},         {shader::kBindInstances, write},
      {shader::kBindDraws, readWrite},     {shader::kBindQueues, readWrite},    {shader::kBindStacks, readWrite},
      {shader::kBindRecords, write},       {shader::kBindCounters, readWrite},  {shader::kBindBuckets, readWrite},
      {shader::kBindConstants, read},      {shader::kBindColliders, readWrite}, {shader::kBindColliderCells, read},
      {shader::kBindCount, write},         {shader::kBindAxiomCounter, read},   {shader::kBindReport, write},
      {shader::kBindRanges, readWrite},    {shader::kBindFields, read}};
  uint64_t bindings = 0; // of every kernel, too
  for (const core::Use& use : uses) bindings |= uint64_t(1) << use.resource;
  const auto interpreter = [&](bool colliders, Spirv spirv) {
    const Fit fit = fitOf(b.device, interpreterFor(b.device, colliders), false);
    return b.list.add(core::ShaderDesc{"derive", spirv, specialization(b.device, fit), kDeriveConstants, bindings,
                                       !b.sizes.interprets});
  };
  b.derive = interpreter(false, takesBatches(b.device) ? Spirv(spawn_derive_software)
                                : b.subgroups          ? Spirv(spawn_derive_subgroups)
                                                       : Spirv(spawn_derive));
  uint32_t link = 0;
  if (b.sizes.maxColliders) {
    b.deriveColliding = // takes the other's place in recordings that need it
        interpreter(true, b.subgroups ? Spirv(spawn_derive_colliders_subgroups) : Spirv(spawn_derive_colliders));
    link = b.list.add(core::ShaderDesc{"link", spawn_link});
  }
  for (uint32_t phase = 0; phase < b.sizes.phases(); ++phase) {
    const uint32_t first = phase * b.sizes.phaseStride();
    if (phase == 0)
      b.list.dispatch("derive", b.derive, uses, kAxiomGroups, {0, 0, 0});
    else
      b.list
          .dispatch("link", link,
                    {{shader::kBindAxioms, read},
                     {shader::kBindCounters, readWrite},
                     {shader::kBindConstants, read},
                     {shader::kBindColliders, read},
                     {shader::kBindColliderCells, readWrite}},
                    kLinkGroups, {first, first - b.sizes.phaseStride()})
          .condition = kPhases + phase - 1;
    for (uint32_t round = phase ? 0 : 1; round < b.sizes.rounds; ++round) {
      // Where there is work for a second round, it is for all; those behind it are mostly empty.
      const std::initializer_list<uint32_t> pushed = {first + round, phase, first};
      core::Pass& pass = first + round == 1 ? b.list.dispatch("derive", b.derive, uses, kRoundGroups, pushed)
                                            : b.list.dispatchIndirect("derive", b.derive, uses, shader::kBindCounters,
                                                                      PassBuilder::roundAt(first + round), pushed);
      pass.level = round;
      if (phase) pass.condition = kPhases + phase - 1;
    }
  }
}

} // namespace gpgp::spawn
