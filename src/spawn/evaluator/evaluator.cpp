#include "spawn/evaluator/evaluator.h"

#include "spawn/evaluator/program.h"

#include <algorithm>
#include <limits>

namespace gpgp::spawn {
namespace {
using namespace shader;

/// All vertices of a terminal, quad after quad.
[[gnu::noinline]] void emitVertices(Derivation& out, const uint32_t* words, const Shape& shape, const GpgpInstance& instance,
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

/// A shape, and, where it waits for an operator that multiplies it, what that makes of it.
struct Frame {
  Shape shape;
  const Step* step;
  Fan fan;
  uint32_t made; // of its children
  uint32_t left; // successors that still get one
};

class Evaluator {
public:
  Evaluator(const uint32_t* words, const DeriveOptions& options, Derivation& out)
      : words_(words), options_(options), out_(out), program_(decode(words)), frames_(64) {}

  [[gnu::flatten]] void run(const GpgpAxiom& axiom, uint32_t index) {
    if (!hasRule(words_, axiom.rule)) ++out_.droppedShapes;
    frames_[0].shape = axiomShape(words_, vec3(axiom.size[0], axiom.size[1], axiom.size[2]), axiom.seed, axiom.id,
                                  axiom.rule, axiom.attribute, index);
    for (size_t top = 0;;) {
      Frame& frame = frames_[top];
      if (++out_.shapes > options_.maxShapes) {
        out_.complete = false;
        return;
      }
      const uint32_t end = runChain(frame);
      out_.depth = std::max(out_.depth, frame.shape.depth);
      if (end == kEndTerminal) emit(out_, words_, frame.shape, axiom, options_);
      if (end == kEndUnfinished) ++out_.unfinishedShapes;
      if (end == kEndWaits && ++top == frames_.size()) frames_.resize(2 * top);
      while (top > 0 && frames_[top - 1].made == frames_[top - 1].fan.count) --top;
      if (top == 0) return;
      Frame& parent = frames_[top - 1];
      frames_[top].shape = parent.shape;
      toChild(*parent.step, parent, frames_[top].shape);
    }
  }

private:
  /// One of the first three parameters.
  float value(const Step& step, const Shape& s, uint32_t i) const {
    if (step.variable >> i & 1) return evaluate(words_, s, step.parameters + i * kParameterSize);
    return component(step.values, i);
  }
  vec3 values(const Step& step, const Shape& s) const {
    if (!step.variable) return step.values;
    return {value(step, s, 0), value(step, s, 1), value(step, s, 2)};
  }

  /// Takes a shape from operator to operator while each passes on one shape, as runChain() of interpret.h.
  uint32_t runChain(Frame& frame) const {
    Shape& s = frame.shape;
    for (uint32_t i = 0; i < kMaxChain; ++i) {
      const Step& step = program_.steps[s.node / kNodeSize];
      if (s.depth > options_.maxDepth) return kEndUnfinished;
      uint32_t edge = 0;
      switch (step.op) {
      case kDiscard: return kEndDiscarded;
      case kOpTerminal: return kEndTerminal;
      case kTranslateAlong: s.position = axisPoint(s, step.argument, value(step, s, step.argument)); break;
      case kOpTranslate: translate(s, values(step, s)); break;
      case kRotateBy: rotate(s, step.rotation); break;
      case kOpRotate: rotate(s, rotationOf(values(step, s))); break;
      case kOpScale: resize(s, values(step, s)); break;
      case kOpExtrude: extrude(s, value(step, s, 0)); break;
      case kOpSwapSize: swapSizes(s, step.argument); break;
      case kOpSetGeometry: setGeometry(s, step.argument, step.argument2); break;
      case kOpIf: edge = value(step, s, 0) != 0 ? 0 : 1; break;
      case kOpIfSizeLess: edge = component(s.size, step.argument) < value(step, s, 0) ? 0 : 1; break;
      case kOpRandomRule: edge = chooseEdge(words_, s, kOpRandomRule); break;
      case kChoose: {
        const float chance = value(step, s, 0), x = multiply(subtract(chance, floor(chance)), step.total);
        const Chance* const chances = program_.chances.data() + step.firstChance;
        uint32_t chosen = 0;
        for (uint32_t c = 1; c < step.chanceCount; ++c)
          if (chances[c].from <= x) chosen = c;
        follow(s, chances[chosen].target);
        continue;
      }
      default: {
        frame.step = &step;
        frame.fan = fanOf(step, s);
        frame.made = 0;
        frame.left = frame.fan.successors;
        if (!step.filter) return kEndWaits;
        if (frame.fan.count == 0) return kEndDiscarded;
        toChild(step, frame, s);
        continue;
      }
      }
      follow(s, step.target(edge));
    }
    frame.step = &program_.steps[0];
    frame.fan.count = 1;
    frame.made = 0;
    return kEndWaits;
  }

  Fan fanOf(const Step& step, const Shape& s) const {
    if (step.op == kOpRepeat) {
      Fan fan = repetitionOf(component(s.size, step.argument), step.argument2, value(step, s, 0));
      if (!step.successors) fan.count = 0;
      return fan;
    }
    if (step.op == kOpSubDiv && step.argument2 == 0) return divisionOf(words_, s, 0).fan;
    Fan fan{0, step.successors, 0};
    if (step.op == kOpSubDiv) {
      fan.extent = remainderOf(component(s.size, step.argument), graphFloat(words_, step.argument2));
      if (!(fan.extent > 0)) fan.successors = words_[step.argument2 + kDivisionFixedParts];
    } else if (step.op == kOpCompSplit) {
      const Faces faces = facesOf(words_, s.geometry, step.successors);
      return {faces.count, faces.successors, 0};
    }
    fan.count = uint(bitCount(fan.successors));
    return fan;
  }

  /// The next child of a frame's shape.
  void toChild(const Step& step, Frame& frame, Shape& s) const {
    const uint32_t index = frame.made++;
    uint32_t successor = uint(findLSB(frame.left));
    frame.left &= frame.left - 1;
    switch (step.op) {
    case kOpSubDiv:
      toPart(s, step.argument, frame.fan.extent,
             step.argument2 ? partAt(words_, step.argument2 + kDivisionParts + successor * kPartSize)
                            : divisionOf(words_, s, successor).part,
             successor);
      break;
    case kOpRepeat:
      toRepeat(s, step.argument, step.argument2, frame.fan.successors, frame.fan.extent, index);
      successor = 0;
      break;
    case kOpCompSplit: {
      const uint32_t number = faceNumber(frame.fan.successors, index);
      toFace(words_, s, number);
      successor = min(number, 2u);
      break;
    }
    case kOpReplicate: toCopy(s, successor); break;
    default: return; // the shape itself, after kMaxChain operators
    }
    follow(s, step.target(successor));
  }

  const uint32_t* const words_;
  const DeriveOptions& options_;
  Derivation& out_;
  const Program program_;
  std::vector<Frame> frames_;
};
} // namespace

Derivation derive(std::span<const uint32_t> grammar, std::span<const GpgpAxiom> axioms, const DeriveOptions& options,
                  Derivation&& memory) {
  Derivation out;
  out.instances = std::move(memory.instances);
  out.instances.clear();
  out.buckets.assign(grammar[kHeaderBuckets], 0);
  Evaluator evaluator(grammar.data(), options, out);
  for (size_t a = 0; a < axioms.size() && out.complete; ++a) evaluator.run(axioms[a], static_cast<uint32_t>(a));
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
