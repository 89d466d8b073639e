#include "spawn/evaluator/evaluator.h"

#include "spawn/interpret.h"

#include <algorithm>
#include <limits>

namespace gpgp::spawn {
namespace {
using namespace shader;

/// A shape, and, where it waits for an operator that multiplies it, what that makes of it.
struct Frame {
  Shape shape;
  Fan fan;
  uint made; // of its children
};

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
  std::vector<Frame> frames(64);
  for (size_t a = 0; a < axioms.size() && out.complete; ++a) {
    const GpgpAxiom& axiom = axioms[a];
    if (!hasRule(words, axiom.rule)) ++out.droppedShapes;
    frames[0].shape = axiomShape(words, vec3(axiom.size[0], axiom.size[1], axiom.size[2]), axiom.seed, axiom.id,
                                 axiom.rule, axiom.attribute, static_cast<uint32_t>(a));
    ++out.shapes;
    for (size_t top = 0;;) {
      Frame& frame = frames[top];
      const uint end = runChain(words, frame.shape, false, options.maxDepth);
      out.depth = std::max(out.depth, frame.shape.depth);
      if (end == kEndTerminal) emit(out, words, frame.shape, axiom, options);
      if (end == kEndUnfinished) ++out.unfinishedShapes;
      if (end == kEndWaits) {
        frame.fan = fanOf(words, frame.shape);
        frame.made = 0;
        out.shapes += frame.fan.count;
        if (out.shapes > options.maxShapes) {
          out.complete = false;
          break;
        }
        if (++top == frames.size()) frames.resize(2 * top);
      }
      while (top > 0 && frames[top - 1].made == frames[top - 1].fan.count) --top;
      if (top == 0) break;
      Frame& parent = frames[top - 1];
      frames[top].shape = parent.shape;
      toChild(words, frames[top].shape, parent.fan, parent.made++);
    }
  }
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
