#include "spawn/evaluator/evaluator.h"

#include "spawn/evaluator/context.h"
#include "spawn/evaluator/program.h"

#include <algorithm>
#include <limits>

namespace gpgp::spawn {
namespace {
using namespace shader;

/// All vertices of a terminal, quad after quad.
[[gnu::noinline]] void emitVertices(Derivation& out, const uint32_t* words, const Shape& shape,
                                    const GpgpInstance& instance, const VertexLayout& layout) {
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

/// A shape before the operator that step says; where that multiplies it, what it makes of it.
struct Frame {
  Shape shape;
  const Step* step;
  Fan fan;
  uint32_t made; // of its children
  uint32_t left; // successors that still get one
};

/// f(axis), with an axis that the compiler knows.
template <class F> void forAxis(uint32_t axis, F f) {
  if (axis == 0) return f(0);
  if (axis == 1) return f(1);
  f(2);
}

/// Depth first with a stack of shapes whose children are made one at a time, each when the one before it is done.
class Evaluator {
public:
  Evaluator(const uint32_t* words, std::span<const GpgpAxiom> axioms, const DeriveOptions& options, Derivation& out)
      : words_(words), axioms_(axioms), options_(options), maxDepth_(options.maxDepth), out_(out),
        program_(decode(words)), context_(axioms), frames_(64) {}

  void run() {
    for (size_t a = 0; a < axioms_.size() && out_.complete; ++a) {
      const GpgpAxiom& axiom = axioms_[a];
      if (!hasRule(words_, axiom.rule)) ++out_.droppedShapes;
      runFrom(axiomShape(words_, vec3(axiom.size[0], axiom.size[1], axiom.size[2]), axiom.seed, axiom.id, axiom.rule,
                         axiom.attribute, static_cast<uint32_t>(a)));
    }
    for (uint32_t phase = 1; phase < words_[kHeaderPhases] && out_.complete; ++phase)
      for (const Shape& shape : context_.begin(phase))
        if (out_.complete) runFrom(shape);
    out_.colliders = context_.colliders();
  }

private:
  // Everything becomes one function: what it calls is small, and called for each shape.
  [[gnu::flatten]] void runFrom(const Shape& start) {
    Frame *first = frames_.data(), *end = first + frames_.size(), *frame = first;
    frame->shape = start;
    frame->step = program_.at(frame->shape.node);
    const uint64_t maxShapes = options_.maxShapes;
    uint64_t shapes = out_.shapes;
    uint32_t depth = out_.depth;
    for (;;) {
      if (++shapes > maxShapes) {
        out_.complete = false;
        break;
      }
      const uint32_t result = runChain(*frame);
      depth = std::max(depth, frame->shape.depth);
      if (result == kEndTerminal) emit(*frame);
      if (result == kEndUnfinished) ++out_.unfinishedShapes;
      if (result == kEndWaits && ++frame == end) {
        const size_t top = frames_.size();
        frames_.resize(2 * top);
        first = frames_.data();
        frame = first + top;
        end = frame + top;
      }
      while (frame != first && frame[-1].made == frame[-1].fan.count) --frame;
      if (frame == first) break;
      frame->shape = frame[-1].shape;
      frame->step = toChild(frame[-1], frame->shape);
    }
    out_.shapes = shapes;
    out_.depth = depth;
  }

  /// One of the first three parameters.
  float value(const Step& step, const Shape& s, uint32_t i) const {
    if (!(step.variable >> i & 1)) return component(step.values, i);
    if (!step.terms[i]) return evaluateWords(s, step.parameters + i * kParameterSize);
    const Term* term = &program_.terms[step.terms[i]];
    float result = operand(*term, s);
    while ((++term)->code != kCodeEnd) result = combine(term->code, result, operand(*term, s), unitFloat(s.seed));
    return result;
  }
  static float operand(const Term& term, const Shape& s) {
    return term.operand == kCodeNumber ? term.number : attributeOf(s, term.operand);
  }
  [[gnu::noinline]] float evaluateWords(const Shape& s, uint32_t at) const { return evaluate(words_, s, at); }
  vec3 values(const Step& step, const Shape& s) const {
    if (!step.variable) return step.values;
    return {value(step, s, 0), value(step, s, 1), value(step, s, 2)};
  }
  static const Step* follow(Shape& s, const Way& way) {
    s.depth += way.recursive;
    return way.target;
  }

  /// Takes a shape from operator to operator while each passes on one shape, as runChain() of interpret.h.
  uint32_t runChain(Frame& frame) {
    Shape& s = frame.shape;
    for (uint32_t i = 0; i < kMaxChain; ++i) {
      const Step& step = *frame.step;
      if (s.depth > maxDepth_) return kEndUnfinished;
      uint32_t way = 0;
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
      case kOpCollider: context_.add(s, step.argument); break;
      case kOpIfCollides:
        if (step.argument2 > context_.phase()) {
          s.node = step.node;
          context_.wait(s, step.argument2);
          return kEndLater;
        }
        way = context_.collides(s, step.argument) ? 0 : 1;
        break;
      case kOpIf: way = value(step, s, 0) != 0 ? 0 : 1; break;
      case kOpIfSizeLess: way = component(s.size, step.argument) < value(step, s, 0) ? 0 : 1; break;
      case kOpRandomRule:
        s.node = step.node;
        way = chooseEdge(words_, s, kOpRandomRule);
        break;
      case kChoose: {
        const float chance = value(step, s, 0), x = multiply(subtract(chance, floor(chance)), step.total);
        for (uint32_t w = 1; w < step.wayCount; ++w)
          if (step.ways[w].from <= x) way = w;
        break;
      }
      default:
        wait(frame);
        if (!step.filter) return kEndWaits;
        if (frame.fan.count == 0) return kEndDiscarded;
        frame.step = toChild(frame, s);
        continue;
      }
      frame.step = follow(s, step.ways[way]);
    }
    wait(frame);
    return kEndWaits;
  }
  void wait(Frame& frame) const {
    frame.fan = fanOf(*frame.step, frame.shape);
    frame.made = 0;
    frame.left = frame.fan.successors;
  }

  Fan fanOf(const Step& step, Shape& s) const {
    Fan fan{1, step.successors, 0};
    switch (step.op) {
    case kDivide:
      fan.extent = remainderOf(component(s.size, step.argument), step.total);
      if (fan.extent > 0) fan.successors |= step.weighted;
      break;
    case kOpSubDiv: s.node = step.node; return divisionOf(words_, s, 0).fan;
    case kOpRepeat:
      fan = repetitionOf(component(s.size, step.argument), step.argument2, value(step, s, 0));
      if (!step.successors) fan.count = 0;
      return fan;
    case kOpCompSplit: {
      const Faces faces = facesOf(words_, s.geometry, step.successors);
      return {faces.count, faces.successors, 0};
    }
    case kOpReplicate: break;
    default: return fan; // the shape itself, after kMaxChain operators
    }
    fan.count = uint(bitCount(fan.successors));
    return fan;
  }

  /// The next child of a frame's shape, of which s is a copy. Returns where it goes.
  const Step* toChild(Frame& frame, Shape& s) const {
    const Step& step = *frame.step;
    const uint32_t index = frame.made++;
    uint32_t way = 0;
    const auto nextSuccessor = [&] {
      way = uint(findLSB(frame.left));
      frame.left &= frame.left - 1;
    };
    switch (step.op) {
    case kDivide:
      nextSuccessor();
      forAxis(step.argument, [&](uint32_t axis) { toPart(s, axis, frame.fan.extent, step.ways[way].part, way); });
      break;
    case kOpSubDiv:
      nextSuccessor();
      toPart(s, step.argument, frame.fan.extent, divisionOf(words_, s, way).part, way);
      break;
    case kOpRepeat:
      forAxis(step.argument,
              [&](uint32_t axis) { toRepeat(s, axis, step.argument2, frame.fan.successors, frame.fan.extent, index); });
      break;
    case kOpCompSplit: {
      const uint32_t number = faceNumber(frame.fan.successors, index);
      toFace(words_, s, number);
      way = min(number, 2u);
      break;
    }
    case kOpReplicate:
      nextSuccessor();
      toCopy(s, way);
      break;
    default: return &step;
    }
    return follow(s, step.ways[way]);
  }

  void emit(const Frame& frame) {
    const Shape& shape = frame.shape;
    const GpgpAxiom& axiom = axioms_[context_.axiomNumber(shape.axiom)];
    const uint32_t bucket = frame.step->argument2, type = shapeType(shape);
    const uvec2 hash = terminalHash(shape.key, bucket, type);
    out_.keyHash[0] += hash.x;
    out_.keyHash[1] += hash.y;
    ++out_.buckets[bucket];
    const size_t number = out_.terminals++;
    if (!options_.keepInstances) return;
    if (number == out_.instances.size()) out_.instances.resize(std::max<size_t>(64, 2 * number));
    GpgpInstance& instance = out_.instances[number];
    for (uint32_t r = 0; r < 3; ++r) {
      const float* t = axiom.transform + 4 * r;
      const vec4 row = instanceRow(shape, vec4(t[0], t[1], t[2], t[3]));
      for (int c = 0; c < 4; ++c) instance.transform[4 * r + uint32_t(c)] = row[c];
    }
    instance.bucket = bucket;
    instance.shape = type;
    instance.axiomId = axiom.id;
    instance.terminal = frame.step->argument;
    instance.seed = shape.seed;
    instance.attribute = shape.custom;
    instance.key[0] = shape.key.x;
    instance.key[1] = shape.key.y;
    instance.size[0] = shape.size.x;
    instance.size[1] = shape.size.y;
    instance.size[2] = shape.size.z;
    instance.reserved = 0;
    if (options_.vertices) emitVertices(out_, words_, shape, instance, *options_.vertices);
  }

  const uint32_t* const words_;
  const std::span<const GpgpAxiom> axioms_;
  const DeriveOptions& options_;
  const uint32_t maxDepth_;
  Derivation& out_;
  const Program program_;
  Context context_;
  std::vector<Frame> frames_;
};
} // namespace

Derivation derive(std::span<const uint32_t> grammar, std::span<const GpgpAxiom> axioms, const DeriveOptions& options,
                  Derivation&& memory) {
  Derivation out;
  out.instances = std::move(memory.instances);
  out.buckets.assign(grammar[kHeaderBuckets], 0);
  Evaluator(grammar.data(), axioms, options, out).run();
  out.instances.resize(options.keepInstances ? out.terminals : 0);
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
