// The CPU evaluator beside the device: what it derives of the same axioms, how long it takes, whether both agree.
#pragma once
#include "spawn/evaluator/evaluator.h"

#include <span>
#include <string>
#include <vector>

namespace gpgp::cli {

/// Of one thread, instances or vertices included, into memory that an earlier run has touched: the device's buffers are
/// there before it starts as well.
struct Reference {
  spawn::Derivation result;
  double milliseconds = 0;
};

/// layout: of vertices, if any. Throws nothing: result.complete says whether the evaluator came to an end.
Reference evaluate(std::span<const uint32_t> words, const std::vector<GpgpAxiom>& axioms, uint32_t maxDepth,
                   const spawn::VertexLayout* layout);

/// Throws Failure where of one axiom alone, the first of a start, come more shapes than the evaluator takes: probably
/// without end, and larger budgets would only make that last longer.
void checkThatItEnds(std::span<const uint32_t> words, std::span<const GpgpAxiom> axioms, uint32_t maxDepth,
                     const std::string& grammar);

/// Empty where both derived the same, else what they differ in: counts, the hash of keys, or, where the instances are
/// at hand, anything of them that is equal bit for bit on every device. Those are all fields but the transform, whose
/// rounding differs.
std::string difference(const spawn::Derivation& reference, const GpgpSpawnReport& report,
                       std::span<const GpgpInstance> instances);

} // namespace gpgp::cli
