// What the stages that describe the spawner's passes share: the list, its resources, and what they depend on.
#pragma once
#include "core/passes.h"
#include "spawn/passes/names.h"
#include "spawn/schedule/vertices.h"
#include "spawn/shared/layout.h"

namespace gpgp::spawn {

/// How much a spawner has room for, and what it writes.
struct SpawnerSizes {
  uint32_t maxShapes = 0, maxTerminals = 0, maxColliders = 0, maxHostAxioms = 0;
  uint32_t rounds = 0;                                   ///< of a phase
  uint32_t maxMeasuredAxioms = 0, maxOccupancyWords = 0; ///< words of an axiom's grid
  bool ordered = false;
  bool compact = false; ///< GpgpCompactInstance
  bool interprets = true;
  VertexLayout layout; ///< of vertices; without a stride it writes instances

  /// Words of a target; at least one, as buffers are not empty.
  uint32_t gridRoom() const { return maxOccupancyWords ? maxOccupancyWords : 1; }
  bool vertices() const { return layout.strideWords != 0; }
  uint32_t phases() const { return maxColliders ? shader::kMaxPhases : 1; }
  /// Counters from the first round of a phase to the next phase's: its rounds, and what the last one left.
  uint32_t phaseStride() const { return rounds + 1; }
  /// Shapes on the stacks of all workgroups.
  uint32_t stackShapes() const;
  /// In which colliders are linked.
  uint32_t cells() const;
};

using Spirv = core::ShaderCode;

class PassBuilder {
public:
  PassBuilder(const SpawnerSizes& sizes, const core::Device& device, std::pmr::memory_resource* memory);

  /// Where counters have a round's.
  static VkDeviceSize roundAt(uint32_t round) {
    return sizeof(shader::SpawnState) + sizeof(shader::SpawnRound) * round;
  }
  /// Workgroups for each terminal record.
  VkDeviceSize perRecord() const { return roundAt(sizes.phases() * sizes.phaseStride()); }

  core::PassList list;
  const SpawnerSizes& sizes;
  const core::Device& device;
  const bool subgroups;                     ///< shaders with subgroup arithmetic
  uint32_t derive = 0, deriveColliding = 0; ///< shaders, the second one in place of the first
};

// Stages, in the order in which they are recorded.
void addClear(PassBuilder& builder);        ///< what counters and lists begin with
void addDerive(PassBuilder& builder);       ///< all rounds of all phases, link between phases
void addOrderedQuads(PassBuilder& builder); ///< order, for ordered vertices
void addExpand(PassBuilder& builder);       ///< vertices and indices
void addPlace(PassBuilder& builder);        ///< buckets
void addOrder(PassBuilder& builder);        ///< order, for ordered instances
void addEmit(PassBuilder& builder);         ///< sorted instances
void addBounds(PassBuilder& builder);
void addMeasures(PassBuilder& builder); ///< what is measured of each axiom

struct SpawnPasses {
  core::PassList list;
  uint32_t derive, deriveColliding; ///< shaders
};
/// All passes of a spawner. `sizes` only need live during the call.
SpawnPasses describePasses(const SpawnerSizes& sizes, const core::Device& device, std::pmr::memory_resource* memory);

} // namespace gpgp::spawn
