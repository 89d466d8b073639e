// The CPU reference of the derivation on the GPU: one thread, depth first, the same operators on the same graph.
//
// Counts, keys, seeds, shapes and the hash are bit-identical to the GPU's; transforms agree within rounding. Used as
// the oracle of tests, by the command, and as the baseline of benchmarks. Engines have libgpgp_evaluator: the same walk
// over ranges of axioms (evaluation.h).
#pragma once
#include "spawn/evaluator/walker.h"

namespace gpgp::spawn {

struct DeriveOptions {
  uint32_t maxDepth = 64;                 ///< recursive edges, as GpgpSpawnerCreateInfo
  bool keepInstances = true;              ///< false: only count
  const VertexLayout* vertices = nullptr; ///< instances come with their vertices
  const shader::View* view = nullptr;     ///< of a camera (schedule/camera.h)
  const BoundFields* fields = nullptr;    ///< in host memory (schedule/fields.h); null: the grammar reads none
  uint64_t maxShapes = 100'000'000;       ///< gives up beyond, so that a grammar without end cannot hang the caller
};

struct Derivation : Counts {
  std::vector<GpgpInstance> instances; ///< by phase, then by axiom, then depth first
  std::vector<uint32_t> vertexWords;   ///< of all instances, one after the other
  std::vector<uint32_t> quads;         ///< of each instance: 4 vertices, 6 indices
  std::vector<uint32_t> buckets;       ///< terminals by bucket
  uint64_t colliders = 0;              ///< that Collider registered
  bool complete = true;                ///< false: maxShapes was reached
  uint32_t lastAxiom = 0;              ///< then: by number, whose shape would have been one too many
};

/// Derives axioms with a baked grammar's words, which load() has accepted. memory: an earlier result that is no longer
/// needed; its instances' memory is used again.
Derivation derive(std::span<const uint32_t> grammar, std::span<const GpgpAxiom> axioms,
                  const DeriveOptions& options = {}, Derivation&& memory = {});

/// An axiom at the origin.
GpgpAxiom makeAxiom(float x, float y, float z, uint32_t seed = 0, uint32_t id = 0);

} // namespace gpgp::spawn
