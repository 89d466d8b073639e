#include "cli/spawn/reference.h"

#include "cli/shared/common.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>

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

spawn::Derivation checkThatItEnds(std::span<const uint32_t> words, std::span<const GpgpAxiom> axioms, uint32_t maxDepth,
                                  const std::string& grammar, const World& world) {
  spawn::DeriveOptions options;
  options.view = world.view;
  options.fields = world.fields;
  if (maxDepth) options.maxDepth = maxDepth;
  options.keepInstances = false;
  spawn::Derivation all = spawn::derive(words, axioms, options);
  if (all.complete) return all;
  if (axioms.size() > 1 && spawn::derive(words, axioms.subspan(all.lastAxiom, 1), options).complete) return all;
  const std::string many = "more than " + std::to_string(options.maxShapes / 1'000'000) + " million shapes";
  throw Failure(grammar + ": " +
                (axioms.size() > 1
                     ? "axiom " + std::to_string(all.lastAxiom + 1) + " of " + std::to_string(axioms.size())
                     : std::string("one axiom")) +
                " alone becomes " + many +
                ": it is too large, or the derivation never ends; --max-depth bounds how deep rules nest");
}

std::optional<uint32_t> depthOf(std::span<const uint32_t> words, std::span<const GpgpAxiom> axioms,
                                const World& world) {
  spawn::DeriveOptions options;
  options.view = world.view;
  options.fields = world.fields;
  options.maxDepth = 1u << 16; // each level is a place on the evaluator's stack
  options.keepInstances = false;
  const spawn::Derivation all = spawn::derive(words, axioms, options);
  return all.complete && !all.unfinishedShapes ? std::optional(all.depth) : std::nullopt;
}

Reference evaluate(std::span<const uint32_t> words, const std::vector<GpgpAxiom>& axioms, uint32_t maxDepth,
                   const spawn::VertexLayout* layout, const std::string& grammar, const World& world) {
  spawn::Derivation memory = checkThatItEnds(words, axioms, maxDepth, grammar, world);
  if (!memory.complete) return {std::move(memory), 0};
  memory.instances.resize(memory.terminals);
  spawn::DeriveOptions options;
  if (maxDepth) options.maxDepth = maxDepth;
  options.view = world.view;
  options.fields = world.fields;
  options.vertices = layout;
  Reference reference;
  const auto begin = std::chrono::steady_clock::now();
  reference.result = spawn::derive(words, axioms, options, std::move(memory));
  reference.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return reference;
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
