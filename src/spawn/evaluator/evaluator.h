// The CPU reference of the derivation on the GPU: one thread, depth first, the same operators on the same graph.
//
// Counts, keys, seeds, shapes and the hash are bit-identical to the GPU's; transforms agree within rounding. Used as
// the oracle of tests, by the command, and as the baseline of benchmarks.
#pragma once
#include "spawn/schedule/vertices.h"

#include <gpgp/spawn.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gpgp::spawn {

struct DeriveOptions {
  uint32_t maxDepth = 64;                 ///< recursive edges, as GpgpSpawnerCreateInfo
  bool keepInstances = true;              ///< false: only count
  const VertexLayout* vertices = nullptr; ///< instances come with their vertices
  uint64_t maxShapes = 100'000'000;       ///< gives up beyond, so that a grammar without end cannot hang the caller
};

struct Derivation {
  std::vector<GpgpInstance> instances; ///< by phase, then by axiom, then depth first
  std::vector<uint32_t> vertexWords;   ///< of all instances, one after the other
  std::vector<uint32_t> quads;         ///< of each instance: 4 vertices, 6 indices
  std::vector<uint32_t> buckets;       ///< terminals by bucket
  uint64_t terminals = 0;
  uint64_t shapes = 0;        ///< that were taken up, terminals included
  uint32_t droppedShapes = 0; ///< axioms whose rule does not exist, shapes that a Repeat would cut too often, and
  uint32_t uncutShapes = 0;   ///< those that a SubDiv cannot cut
  uint32_t unfinishedShapes = 0;
  uint64_t colliders = 0; ///< that Collider registered
  uint32_t depth = 0;     ///< the most recursive edges on a path
  uint32_t keyHash[2] = {0, 0};
  bool complete = true;   ///< false: maxShapes was reached
  uint32_t lastAxiom = 0; ///< then: by number, whose shape would have been one too many
};

/// Derives axioms with a baked grammar's words, which load() has accepted. memory: an earlier result that is no longer
/// needed; its instances' memory is used again.
Derivation derive(std::span<const uint32_t> grammar, std::span<const GpgpAxiom> axioms,
                  const DeriveOptions& options = {}, Derivation&& memory = {});

/// An axiom at the origin.
GpgpAxiom makeAxiom(float x, float y, float z, uint32_t seed = 0, uint32_t id = 0);

} // namespace gpgp::spawn
