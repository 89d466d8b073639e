// The CPU evaluator beside the device: what it derives of the same axioms, how long it takes, whether both agree.
#pragma once
#include "spawn/evaluator/evaluator.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpgp::cli {

/// What rules ask of the world around them: the camera, and fields.
struct World {
  const shader::View* view = nullptr;
  const spawn::BoundFields* fields = nullptr;
};

/// Counts what becomes of all axioms; not complete where that are more shapes than the evaluator takes. Throws Failure
/// where one axiom alone is that many: it may never end, and larger budgets of the device would only make it last
/// longer. Axioms behind the place where the evaluator gives up are not looked at. grammar: its name.
spawn::Derivation checkThatItEnds(std::span<const uint32_t> words, std::span<const GpgpAxiom> axioms, uint32_t maxDepth,
                                  const std::string& grammar, const World& world = {});

/// How deep rules nest in themselves, where that is at most 2^16 and all axioms end before the evaluator gives up.
std::optional<uint32_t> depthOf(std::span<const uint32_t> words, std::span<const GpgpAxiom> axioms,
                                const World& world = {});

/// Of one thread, instances or vertices included, into memory that was touched before: the device's buffers are there
/// before it starts as well.
struct Reference {
  spawn::Derivation result;
  double milliseconds = 0;
};

/// What checkThatItEnds() lets pass; only counts where that is not complete. layout: of vertices, if any.
Reference evaluate(std::span<const uint32_t> words, const std::vector<GpgpAxiom>& axioms, uint32_t maxDepth,
                   const spawn::VertexLayout* layout, const std::string& grammar, const World& world = {});

/// Empty where both derived the same, else what they differ in: counts, the hash of keys, or, where the instances are
/// at hand, anything of them that is equal bit for bit on every device. Those are all fields but the transform, whose
/// rounding differs.
std::string difference(const spawn::Derivation& reference, const GpgpSpawnReport& report,
                       std::span<const GpgpInstance> instances);

} // namespace gpgp::cli
