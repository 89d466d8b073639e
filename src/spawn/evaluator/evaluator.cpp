#include "spawn/evaluator/evaluator.h"

#include "spawn/operators.h"

#include <algorithm>
#include <limits>

namespace gpgp::spawn {
namespace {
using namespace shader;

struct Pending {
  Shape shape;
  uint32_t round;
};

void emit(Derivation& out, const uint32_t* words, const Shape& shape, const GpgpAxiom& axiom, bool keep) {
  const uint32_t bucket = words[shape.node + kNodeArgument2];
  const uint32_t type = shapeType(shape);
  const uvec2 hash = terminalHash(shape.key, bucket, type);
  out.keyHash[0] += hash.x;
  out.keyHash[1] += hash.y;
  ++out.terminals;
  ++out.buckets[bucket];
  if (!keep) return;
  GpgpInstance& instance = out.instances.emplace_back();
  for (uint32_t r = 0; r < 3; ++r) {
    const float* t = axiom.transform + 4 * r;
    const vec4 row = instanceRow(shape, vec4(t[0], t[1], t[2], t[3]));
    for (int c = 0; c < 4; ++c) instance.transform[4 * r + uint32_t(c)] = row[c];
  }
  instance.bucket = bucket;
  instance.shape = type;
  instance.axiomId = axiom.id;
  instance.terminal = words[shape.node + kNodeArgument];
  instance.seed = shape.seed;
  instance.attribute = shape.custom;
  instance.key[0] = shape.key.x;
  instance.key[1] = shape.key.y;
  instance.size[0] = shape.size.x;
  instance.size[1] = shape.size.y;
  instance.size[2] = shape.size.z;
}
} // namespace

Derivation derive(std::span<const uint32_t> grammar, std::span<const GpgpAxiom> axioms, const DeriveOptions& options) {
  const uint32_t* words = grammar.data();
  Derivation out;
  out.buckets.assign(words[kHeaderBuckets], 0);
  std::vector<Pending> stack;
  uint64_t shapes = 0;
  for (size_t a = 0; a < axioms.size() && out.complete; ++a) {
    const GpgpAxiom& axiom = axioms[a];
    if (!hasRule(words, axiom.rule)) ++out.droppedShapes;
    stack.push_back({axiomShape(words, vec3(axiom.size[0], axiom.size[1], axiom.size[2]), axiom.seed, axiom.id,
                                axiom.rule, axiom.attribute, static_cast<uint32_t>(a)),
                     0});
    while (!stack.empty()) {
      Pending pending = stack.back();
      stack.pop_back();
      if (pending.round >= options.maxDepth) {
        ++out.unfinishedShapes;
        continue;
      }
      if (pending.round >= out.shapesByRound.size()) out.shapesByRound.push_back(0);
      ++out.shapesByRound[pending.round];
      if (++shapes > options.maxShapes) {
        out.complete = false;
        break;
      }
      const ChainEnd end = runChain(words, pending.shape);
      if (end.kind == kEndTerminal) emit(out, words, pending.shape, axiom, options.keepInstances);
      if (end.kind == kEndFan) {
        if (shapes + stack.size() + end.count > options.maxShapes) {
          out.complete = false;
          break;
        }
        for (uint32_t i = end.count; i-- > 0;)
          stack.push_back({childOf(words, pending.shape, end.successors, i), pending.round + 1});
      }
    }
    stack.clear();
  }
  out.rounds = static_cast<uint32_t>(out.shapesByRound.size());
  uint64_t peak = out.unfinishedShapes;
  for (size_t round = 1; round < out.shapesByRound.size(); ++round) peak = std::max(peak, out.shapesByRound[round]);
  out.peakShapes = static_cast<uint32_t>(std::min<uint64_t>(peak, UINT32_MAX));
  return out;
}

GpgpAxiom makeAxiom(float x, float y, float z, uint32_t seed, uint32_t id) {
  GpgpAxiom axiom{};
  axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1;
  axiom.size[0] = x;
  axiom.size[1] = y;
  axiom.size[2] = z;
  axiom.seed = seed;
  axiom.id = id;
  axiom.rule = GPGP_AXIOM_DEFAULT_RULE;
  axiom.attribute = std::numeric_limits<float>::quiet_NaN();
  return axiom;
}

} // namespace gpgp::spawn
