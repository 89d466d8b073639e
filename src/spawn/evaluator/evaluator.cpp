#include "spawn/evaluator/evaluator.h"

#include "spawn/evaluator/context.h"
#include "spawn/interpret.h"

#include <algorithm>
#include <limits>

namespace gpgp::spawn {
namespace {
using namespace shader;

/// All vertices of a terminal, quad after quad.
void emitVertices(Derivation& out, const uint32_t* words, const Shape& shape, const GpgpInstance& instance,
                  const VertexLayout& layout) {
  const float* t = instance.transform;
  const vec4 rows[3] = {{t[0], t[1], t[2], t[3]}, {t[4], t[5], t[6], t[7]}, {t[8], t[9], t[10], t[11]}};
  const uint32_t numbers[4] = {instance.bucket, instance.axiomId, instance.terminal, instance.seed};
  const bool mirrored = isMirrored(rows[0], rows[1], rows[2]);
  const uint32_t quads = meshQuads(words, shape.geometry);
  out.quads.push_back(quads);
  for (uint32_t i = 0; i < 4 * quads; ++i) {
    const MeshVertex vertex = meshVertex(words, shape.geometry, i / 4, mirrored ? mirroredCorner(i % 4) : i % 4);
    const size_t start = out.vertexWords.size();
    out.vertexWords.resize(start + layout.strideWords);
    for (uint32_t a = 0; a < layout.attributeCount; ++a) {
      const uint32_t semantic = attributeSemantic(layout.attributes[a]), format = attributeFormat(layout.attributes[a]);
      vec4 value(vertex.uv.x, vertex.uv.y, 0, 0);
      if (semantic == kVertexPosition) value = vec4(meshPosition(rows[0], rows[1], rows[2], vertex.position), 1);
      if (semantic == kVertexNormal) value = vec4(meshNormal(rows[0], rows[1], rows[2], vertex, mirrored), 0);
      if (semantic == kVertexNormal && format == kVertexUnorm4) value = withoutSign(value);
      const uvec4 encoded =
          attributeValue(format, value, semantic >= kVertexBucket ? numbers[semantic - kVertexBucket] : 0);
      for (uint32_t w = 0; w < attributeWords(format); ++w)
        out.vertexWords[start + attributeOffset(layout.attributes[a]) + w] = encoded[static_cast<int>(w)];
    }
  }
}

void emit(Derivation& out, const uint32_t* words, const Shape& shape, const GpgpAxiom& axiom,
          const DeriveOptions& options) {
  const uint32_t bucket = words[shape.node + kNodeArgument2];
  const uint32_t type = shapeType(shape);
  const uvec2 hash = terminalHash(shape.key, bucket, type);
  out.keyHash[0] += hash.x;
  out.keyHash[1] += hash.y;
  ++out.terminals;
  ++out.buckets[bucket];
  if (!options.keepInstances) return;
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
  if (options.vertices) emitVertices(out, words, shape, instance, *options.vertices);
}
} // namespace

Derivation derive(std::span<const uint32_t> grammar, std::span<const GpgpAxiom> axioms, const DeriveOptions& options) {
  const uint32_t* words = grammar.data();
  Derivation out;
  out.buckets.assign(words[kHeaderBuckets], 0);
  std::vector<Shape> stack;
  Context context(words, axioms);
  const auto deriveFrom = [&](const Shape& start) {
    stack.push_back(start);
    while (!stack.empty()) {
      Shape shape = stack.back();
      stack.pop_back();
      ++out.shapes;
      uint end = runChain(words, shape, false, options.maxDepth);
      if (end == kEndContext) end = context.resume(shape, options.maxDepth);
      out.depth = std::max(out.depth, shape.depth);
      if (end == kEndTerminal) emit(out, words, shape, axioms[context.axiomNumber(shape.axiom)], options);
      if (end == kEndUnfinished) ++out.unfinishedShapes;
      if (end != kEndWaits) continue;
      const Fan fan = fanOf(words, shape);
      if (out.shapes + stack.size() + fan.count > options.maxShapes) {
        out.complete = false;
        break;
      }
      for (uint32_t i = fan.count; i-- > 0;) stack.push_back(childOf(words, shape, fan, i));
    }
    stack.clear();
  };
  for (size_t a = 0; a < axioms.size() && out.complete; ++a) {
    const GpgpAxiom& axiom = axioms[a];
    if (!hasRule(words, axiom.rule)) ++out.droppedShapes;
    deriveFrom(axiomShape(words, vec3(axiom.size[0], axiom.size[1], axiom.size[2]), axiom.seed, axiom.id, axiom.rule,
                          axiom.attribute, static_cast<uint32_t>(a)));
  }
  for (uint32_t phase = 1; phase < words[kHeaderPhases] && out.complete; ++phase)
    for (const Shape& shape : context.begin(phase))
      if (out.complete) deriveFrom(shape);
  out.colliders = context.colliders();
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
