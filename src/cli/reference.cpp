#include "cli/reference.h"

#include "cli/command.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <set>

namespace gpgp::cli {
namespace {

/// Of all instances, in whatever order they lie.
uint64_t hashOf(std::span<const GpgpInstance> instances) {
  uint64_t sum = 0;
  for (const GpgpInstance& i : instances) {
    uint64_t hash = 0;
    for (const uint32_t word : {i.bucket, i.shape, i.axiomId, i.terminal, i.seed, std::bit_cast<uint32_t>(i.attribute),
                                i.key[0], i.key[1], i.rule, std::bit_cast<uint32_t>(i.size[0]),
                                std::bit_cast<uint32_t>(i.size[1]), std::bit_cast<uint32_t>(i.size[2])}) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 32;
    }
    sum += hash;
  }
  return sum;
}

} // namespace

Reference evaluate(std::span<const uint32_t> words, const std::vector<GpgpAxiom>& axioms, uint32_t maxDepth,
                   const spawn::VertexLayout* layout) {
  spawn::DeriveOptions options;
  if (maxDepth) options.maxDepth = maxDepth;
  options.vertices = layout;
  Reference reference;
  reference.result = spawn::derive(words, axioms, options);
  if (!reference.result.complete) return reference;
  const auto begin = std::chrono::steady_clock::now();
  reference.result = spawn::derive(words, axioms, options, std::move(reference.result));
  reference.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return reference;
}

void checkThatItEnds(std::span<const uint32_t> words, std::span<const GpgpAxiom> axioms, uint32_t maxDepth,
                     const std::string& grammar) {
  spawn::DeriveOptions options;
  if (maxDepth) options.maxDepth = maxDepth;
  options.keepInstances = false;
  std::set<uint32_t> starts;
  for (const GpgpAxiom& axiom : axioms)
    if (starts.insert(axiom.rule).second && !spawn::derive(words, {&axiom, 1}, options).complete)
      throw Failure(grammar + ": one axiom alone becomes more than " + std::to_string(options.maxShapes / 1'000'000) +
                    " million shapes, so the derivation probably never ends; --max-depth bounds how deep rules nest");
}

std::string difference(const spawn::Derivation& reference, const GpgpSpawnReport& report,
                       std::span<const GpgpInstance> instances) {
  if (reference.terminals != report.terminals)
    return std::to_string(report.terminals) + " terminals instead of " + std::to_string(reference.terminals);
  if (std::memcmp(reference.keyHash, report.keyHash, sizeof report.keyHash) != 0)
    return "as many terminals, but with other path keys, buckets or shapes";
  if (instances.size() == reference.instances.size() && hashOf(instances) != hashOf(reference.instances))
    return "the same path keys, but with other terminals, rules, sizes, seeds or attributes";
  return {};
}

} // namespace gpgp::cli
