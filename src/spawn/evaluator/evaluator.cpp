#include "spawn/evaluator/evaluator.h"

#include "spawn/evaluator/context.h"
#include "spawn/evaluator/program.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace gpgp::spawn {
namespace {
using namespace shader;

/// All vertices of a terminal, quad after quad.
[[gnu::noinline]] void emitVertices(Derivation& out, const uint32_t* words, const Shape& shape,
                                    const GpgpInstance& instance, const VertexLayout& layout) {
  const float* t = instance.transform;
  const vec4 rows[3] = {{t[0], t[1], t[2], t[3]}, {t[4], t[5], t[6], t[7]}, {t[8], t[9], t[10], t[11]}};
  const uint32_t numbers[5] = {instance.bucket, instance.axiomId, instance.terminal, instance.seed, instance.rule};
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
  // SubDiv whose parts are not constant: the sum of its weights; of parts before one, its number and their lengths.
  float weights, fixedBefore, weightBefore;
  uint32_t summed;
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
      if (!startWords(words_, axiom.start)) ++out_.droppedShapes;
      runFrom(axiomShape(words_, vec3(axiom.size[0], axiom.size[1], axiom.size[2]), axiom.seed, axiom.start,
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
    for (;;) {
      if (++shapes > maxShapes) {
        out_.complete = false;
        out_.lastAxiom = frame->shape.axiom;
        break;
      }
      const uint32_t result = runChain(*frame);
      if (result == kEndTerminal) emit(*frame);
      if (result == kEndUnfinished) ++out_.unfinishedShapes;
      if (result == kEndWaits && ++frame == end) {
        const size_t top = frames_.size();
        frames_.resize(2 * top);
        first = frames_.data();
        frame = first + top;
        end = frame + top;
      }
      if (frame == first) break;
      Frame& parent = frame[-1];
      if (parent.made + 1 == parent.fan.count)
        --frame; // the last child takes its parent's place
      else
        frame->shape = parent.shape;
      frame->step = toChild(parent, frame->shape);
    }
    out_.shapes = shapes;
  }

  /// One of the first three parameters.
  float value(const Step& step, const Shape& s, uint32_t i) const {
    if (!(step.variable >> i & 1)) return component(step.values, i);
    return expression(s, step, step.terms[i], i);
  }
  /// A parameter that is not constant. terms: as Step::terms
  float expression(const Shape& s, const Step& step, uint32_t terms, uint32_t index) const {
    if (terms == kNoTerms) return evaluateWords(s, step.parameters + index * kParameterSize, index);
    const Term* term = &program_.terms[terms];
    float result = operand(*term, s);
    while ((++term)->code != kCodeEnd) {
      const float drawn = term->code == kCodeRandom ? drawnNumber(s.key, term->draw) : 0;
      result = combine(term->code, result, operand(*term, s), drawn);
    }
    return result;
  }
  static float operand(const Term& term, const Shape& s) {
    if (term.source == kNumber) return term.number;
    if (term.source == kDrawn) return add(term.number, multiply(term.range, drawnNumber(s.key, term.draw)));
    if (term.source == kSeed) return unitFloat(s.seed);
    float attribute;
    std::memcpy(&attribute, reinterpret_cast<const char*>(&s) + term.source, sizeof attribute);
    return attribute;
  }
  [[gnu::noinline]] float evaluateWords(const Shape& s, uint32_t at, uint32_t index) const {
    return evaluate(words_, s, at, index);
  }
  vec2 angle(const Step& step, const Shape& s, uint32_t i) const {
    return step.variable >> i & 1 ? sineCosineDegrees(value(step, s, i)) : step.angles[i];
  }
  vec3 values(const Step& step, const Shape& s) const {
    if (!step.variable) return step.values;
    return {value(step, s, 0), value(step, s, 1), value(step, s, 2)};
  }
  const Step* follow(Shape& s, const Way& way) {
    if (!way.recursive) return way.target;
    out_.depth = std::max(out_.depth, ++s.depth);
    return s.depth > maxDepth_ ? &unfinished_ : way.target;
  }

  /// Takes a shape from operator to operator while each passes on one shape, as runChain() of interpret.h.
  uint32_t runChain(Frame& frame) {
    Shape& s = frame.shape;
    for (uint32_t i = 0; i < kMaxChain; ++i) {
      const Step& step = *frame.step;
      uint32_t way = 0;
      switch (step.op) {
      case kUnfinished: return kEndUnfinished;
      case kDiscard: return kEndDiscarded;
      case kOpTerminal: return kEndTerminal;
      case kTranslateAlong: s.position = axisPoint(s, step.argument, value(step, s, step.argument)); break;
      case kRotateBy: rotate(s, step.rotation); break;
      case kRotateAngles: rotate(s, rotationOfAngles(angle(step, s, 0), angle(step, s, 1), angle(step, s, 2))); break;
#define GPGP_VALUES values(step, s)
#define GPGP_VALUE value(step, s, 0)
#define GPGP_ARGUMENT step.argument
#define GPGP_ARGUMENT2 step.argument2
        // clang-format off
#define GPGP_CASE(name, number, relation, arguments, successors, multiplicity, shapes, kind, call) \
  case kOp##name: call; break;
        // clang-format on
        GPGP_PASSING_OPERATORS(GPGP_CASE, GPGP_CASE)
#undef GPGP_CASE
      case kOpCollider:
      case kOpIfCollides:
        if (step.argument2 > context_.phase()) {
          s.node = step.node;
          context_.wait(s, step.argument2);
          return kEndLater;
        }
        if (step.op == kOpCollider)
          context_.add(s, step.argument);
        else
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
        if (const uint32_t end = wait(frame); !step.filter || end == kEndDiscarded) return end;
        frame.step = toChild(frame, s);
        continue;
      }
      if (step.draws) s.key = drawnKey(s.key);
      frame.step = follow(s, step.ways[way]);
    }
    return wait(frame);
  }
  /// For its children to be made, if it has any.
  uint32_t wait(Frame& frame) {
    frame.fan = fanOf(frame);
    if (frame.fan.extent < 0) {
      ++out_.droppedShapes;
      if (frame.step->op != kOpRepeat) ++out_.uncutShapes;
    }
    frame.made = 0;
    frame.left = frame.fan.successors;
    return frame.fan.count ? kEndWaits : kEndDiscarded;
  }

  Fan fanOf(Frame& frame) const {
    const Step& step = *frame.step;
    const Shape& s = frame.shape;
    Fan fan{step.count, step.successors, 0};
    if (step.cuts && isUncut(words_, s, step.node, step.argument)) return {0, 0, -1};
    switch (step.op) {
    case kDivide:
      fan.extent = remainderOf(component(s.size, step.argument), step.total);
      if (fan.extent > 0) return {step.allCount, step.successors | step.weighted, fan.extent};
      return fan;
    case kOpSubDiv: return divide(frame);
    case kOpRepeat:
      fan = repetitionOf(component(s.size, step.argument), step.argument2, value(step, s, 0));
      if (!step.successors) return {0, 0, 0};
      return fan;
    case kOpCompSplit: {
      const Faces faces = facesOf(words_, s.geometry, step.successors);
      return {faces.count, faces.successors, 0};
    }
    case kOpReplicate: return fan;
    default: return {1, step.successors, 0}; // the shape itself, after kMaxChain operators
    }
  }

  /// A part's length, or negative weight.
  float length(const Step& step, const Shape& s, uint32_t part) const {
    const Way& way = step.ways[part];
    return way.terms ? expression(s, step, way.terms, part) : way.length;
  }
  /// The fan of divisionOf(), and what its parts need.
  Fan divide(Frame& frame) const {
    const Step& step = *frame.step;
    float fixedLength = frame.weights = frame.fixedBefore = frame.weightBefore = 0;
    frame.summed = 0;
    Fan fan{0, 0, 0};
    uint32_t weighted = 0;
    for (uint32_t i = 0; i < step.wayCount; ++i) {
      const float v = length(step, frame.shape, i);
      addLength(v, fixedLength, frame.weights);
      if (v > 0) fan.successors |= step.successors & (1u << i);
      if (v < 0) weighted |= step.successors & (1u << i);
    }
    fan.extent = remainderOf(component(frame.shape.size, step.argument), fixedLength);
    if (fan.extent > 0) fan.successors |= weighted;
    fan.count = uint(bitCount(fan.successors));
    return fan;
  }
  static void addLength(float v, float& fixedLength, float& weights) {
    if (v > 0) fixedLength = add(fixedLength, v);
    if (v < 0) weights = subtract(weights, v);
  }
  /// Its parts in their order.
  Part nextPart(Frame& frame, const Shape& s, uint32_t number) const {
    for (; frame.summed < number; ++frame.summed)
      addLength(length(*frame.step, s, frame.summed), frame.fixedBefore, frame.weightBefore);
    const float own = length(*frame.step, s, number);
    Part part;
    part.fixedBefore = frame.fixedBefore;
    part.fixedLength = max(0.0f, own);
    part.share = own < 0 ? shader::divide(-own, frame.weights) : 0;
    part.shareBefore = frame.weightBefore > 0 ? shader::divide(frame.weightBefore, frame.weights) : 0;
    return part;
  }

  /// The next child of a frame's shape, of which s is a copy, or which it is. Returns where it goes.
  const Step* toChild(Frame& frame, Shape& s) {
    const Step& step = *frame.step;
    const uint32_t index = frame.made++;
    uint32_t way = 0;
    bool there = true;
    const auto nextSuccessor = [&] {
      way = uint(findLSB(frame.left));
      frame.left &= frame.left - 1;
    };
    switch (step.op) {
    case kDivide:
      nextSuccessor();
      forAxis(step.argument,
              [&](uint32_t axis) { there = toPart(s, axis, frame.fan.extent, step.ways[way].part, way); });
      if (step.cuts) there = there && cutTo(words_, s, step.node, step.argument, way);
      break;
    case kOpSubDiv:
      nextSuccessor();
      there = toPart(s, step.argument, frame.fan.extent, nextPart(frame, s, way), way);
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
    return there ? follow(s, step.ways[way]) : program_.at(0);
  }

  void emit(const Frame& frame) {
    const Shape& shape = frame.shape;
    const GpgpAxiom& axiom = axioms_[context_.axiomNumber(shape.axiom)];
    const uint32_t bucket = frame.step->argument2, type = shapeType(shape);
    const uint32_t rule = words_[frame.step->node + kNodeRule];
    const uvec2 key = instanceKey(shape.key, axiom.id);
    const uvec2 hash = terminalHash(key, frame.step->argument, rule, type);
    out_.keyHash[0] += hash.x;
    out_.keyHash[1] += hash.y;
    ++out_.buckets[bucket];
    ++out_.terminals;
    if (!options_.keepInstances) return;
    if (next_ == end_) makeRoom();
    GpgpInstance& instance = *next_++;
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
    instance.key[0] = key.x;
    instance.key[1] = key.y;
    instance.size[0] = shape.size.x;
    instance.size[1] = shape.size.y;
    instance.size[2] = shape.size.z;
    instance.rule = rule;
    if (options_.vertices) emitVertices(out_, words_, shape, instance, *options_.vertices);
  }

  [[gnu::noinline]] void makeRoom() {
    const size_t used = out_.terminals - 1;
    out_.instances.resize(std::max({out_.instances.size(), 2 * used, size_t{64}}));
    next_ = out_.instances.data() + used;
    end_ = out_.instances.data() + out_.instances.size();
  }

  const uint32_t* const words_;
  const std::span<const GpgpAxiom> axioms_;
  const DeriveOptions& options_;
  const uint32_t maxDepth_;
  Derivation& out_;
  const Program program_;
  const Step unfinished_{.op = kUnfinished};
  Context context_;
  std::vector<Frame> frames_;
  GpgpInstance *next_ = nullptr, *end_ = nullptr; // room among out_.instances
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
  axiom.start = GPGP_AXIOM_DEFAULT_START;
  axiom.attribute = std::numeric_limits<float>::quiet_NaN();
  return axiom;
}

} // namespace gpgp::spawn
