#include "spawn/evaluator/walker.h"

#include <algorithm>
#include <cstring>

namespace gpgp::spawn {
using namespace shader;

namespace {
/// f(axis), with an axis that the compiler knows.
template <class F> void forAxis(uint32_t axis, F f) {
  if (axis == 0) return f(0);
  if (axis == 1) return f(1);
  f(2);
}

void addLength(float v, float& fixedLength, float& weights) {
  if (v > 0) fixedLength = add(fixedLength, v);
  if (v < 0) weights = subtract(weights, v);
}
} // namespace

/// All vertices of a terminal, quad after quad.
[[gnu::noinline]] void Walker::emitVertices(const Shape& shape, const GpgpInstance& instance) {
  const VertexLayout& layout = *options_.vertices;
  const uint32_t* words = words_;
  const float* t = instance.transform;
  const vec4 rows[3] = {{t[0], t[1], t[2], t[3]}, {t[4], t[5], t[6], t[7]}, {t[8], t[9], t[10], t[11]}};
  const uint32_t numbers[5] = {instance.bucket, instance.axiomId, instance.terminal, instance.seed, instance.rule};
  const bool mirrored = isMirrored(rows[0], rows[1], rows[2]);
  const uint32_t quads = meshQuads(words, shape.geometry);
  uint32_t* to = store_.addVertices(quads, size_t(4) * quads * layout.strideWords);
  for (uint32_t i = 0; i < 4 * quads; ++i, to += layout.strideWords) {
    std::fill_n(to, layout.strideWords, 0u);
    const MeshVertex vertex = meshVertex(words, shape.geometry, i / 4, mirrored ? mirroredCorner(i % 4) : i % 4);
    for (uint32_t a = 0; a < layout.attributeCount; ++a) {
      const uint32_t semantic = attributeSemantic(layout.attributes[a]), format = attributeFormat(layout.attributes[a]);
      vec4 value(vertex.uv.x, vertex.uv.y, 0, 0);
      if (semantic == kVertexPosition) value = vec4(meshPosition(rows[0], rows[1], rows[2], vertex.position), 1);
      if (semantic == kVertexNormal) value = vec4(meshNormal(rows[0], rows[1], rows[2], vertex, mirrored), 0);
      if (semantic == kVertexNormal && format == kVertexUnorm4) value = withoutSign(value);
      const uvec4 encoded =
          attributeValue(format, value, semantic >= kVertexBucket ? numbers[semantic - kVertexBucket] : 0);
      for (uint32_t w = 0; w < attributeWords(format); ++w)
        to[attributeOffset(layout.attributes[a]) + w] = encoded[static_cast<int>(w)];
    }
  }
}

void Walker::deriveAxiom(uint32_t number) {
  const GpgpAxiom& axiom = axioms_[number];
  if (!startWords(words_, axiom.start)) ++counts.droppedShapes;
  deriveShape(axiomShape(words_, vec3(axiom.size[0], axiom.size[1], axiom.size[2]), axiom.seed, axiom.start,
                         axiom.attribute, number));
}

// Everything becomes one function: what it calls is small, and called for each shape.
[[gnu::flatten]] void Walker::deriveShape(const Shape& start) {
  Frame *first = frames_.data(), *top = first + frames_.size(), *frame = first;
  frame->shape = start;
  frame->step = program_.at(frame->shape.node);
  uint64_t shapes = counts.shapes;
  for (;;) {
    if (++shapes > limit) {
      limit = store_.goesOn(shapes - 1, context.axiomNumber(frame->shape.axiom));
      if (shapes > limit) {
        --shapes;
        break;
      }
    }
    const uint32_t result = runChain(*frame);
    if (result == kEndTerminal) emit(*frame);
    if (result == kEndUnfinished) ++counts.unfinishedShapes;
    if (result == kEndWaits && ++frame == top) {
      const size_t used = frames_.size();
      frames_.resize(2 * used);
      first = frames_.data();
      frame = first + used;
      top = frame + used;
    }
    if (frame == first) break;
    Frame& parent = frame[-1];
    if (parent.made + 1 == parent.fan.count)
      --frame; // the last child takes its parent's place
    else
      frame->shape = parent.shape;
    frame->step = toChild(parent, frame->shape);
  }
  counts.shapes = shapes;
}

/// One of the first three parameters.
float Walker::value(const Step& step, const Shape& s, uint32_t i) const {
  if (!(step.variable >> i & 1)) return component(step.values, i);
  return expression(s, step, step.terms[i], i);
}
/// A parameter that is not constant. terms: as Step::terms
float Walker::expression(const Shape& s, const Step& step, uint32_t terms, uint32_t index) const {
  if (terms == kNoTerms) return evaluateWords(s, step.parameters + index * kParameterSize, index);
  const Term* term = &program_.terms[terms];
  float result = operand(*term, s);
  while ((++term)->code != kCodeEnd) {
    const float drawn = term->code == kCodeRandom ? drawnNumber(s.key, term->draw) : 0;
    result = combine(term->code, result, operand(*term, s), drawn);
  }
  return result;
}
float Walker::operand(const Term& term, const Shape& s) const {
  if (term.source == kNumber) return term.number;
  if (term.source == kDrawn) return add(term.number, multiply(term.range, drawnNumber(s.key, term.draw)));
  if (term.source == kSeed) return unitFloat(s.seed);
  if (term.source >= kSeen) return seenValue(seen(s), kCodeView + (term.source - kSeen));
  float attribute;
  std::memcpy(&attribute, reinterpret_cast<const char*>(&s) + term.source, sizeof attribute);
  return attribute;
}
[[gnu::noinline]] float Walker::evaluateWords(const Shape& s, uint32_t at, uint32_t index) const {
  return evaluate(words_, s, at, index, words_[at] == kParameterView ? seen(s) : Seen{}, fieldReader());
}
[[gnu::noinline]] Seen Walker::seen(const Shape& s) const {
  const GpgpAxiom& axiom = axioms_[context.axiomNumber(s.axiom)];
  const float* t = axiom.transform;
  const Seen seen = options_.view ? seenBy(*options_.view, s, vec4(t[0], t[1], t[2], t[3]),
                                           vec4(t[4], t[5], t[6], t[7]), vec4(t[8], t[9], t[10], t[11]))
                                  : seenFromNowhere();
  return hiddenFrom(seen, axiom.hidden);
}
float Walker::read(const Shape& s, uint32_t field, float x, float z) const {
  const float* t = axioms_[context.axiomNumber(s.axiom)].transform;
  const vec3 point = framePoint(s, vec3(x, 0, z));
  const FieldPlace at =
      placeInField(options_.fields->grids[field], worldCoordinate(point, vec4(t[0], t[1], t[2], t[3])),
                   worldCoordinate(point, vec4(t[8], t[9], t[10], t[11])));
  const float* value = options_.fields->values[field] + at.near;
  return fieldBetween(at, value[0], value[at.right], value[at.far], value[at.far + at.right]);
}
vec2 Walker::angle(const Step& step, const Shape& s, uint32_t i) const {
  return step.variable >> i & 1 ? sineCosineDegrees(value(step, s, i)) : step.angles[i];
}
vec3 Walker::values(const Step& step, const Shape& s) const {
  if (!step.variable) return step.values;
  return {value(step, s, 0), value(step, s, 1), value(step, s, 2)};
}
const Step* Walker::follow(Shape& s, const Way& way) {
  if (!way.recursive) return way.target;
  counts.depth = std::max(counts.depth, ++s.depth);
  return s.depth > options_.maxDepth ? &unfinished_ : way.target;
}

/// Takes a shape from operator to operator while each passes on one shape, as runChain() of interpret.h.
uint32_t Walker::runChain(Frame& frame) {
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
      if (step.argument2 > context.phase()) {
        s.node = step.node;
        context.wait(s, step.argument2);
        return kEndLater;
      }
      if (step.op == kOpCollider)
        context.add(s, step.argument);
      else
        way = context.collides(s, step.argument) ? 0 : 1;
      break;
    case kOpIf: way = value(step, s, 0) != 0 ? 0 : 1; break;
    case kOpIfSizeLess: way = component(s.size, step.argument) < value(step, s, 0) ? 0 : 1; break;
    case kOpRandomRule:
      s.node = step.node;
      way = chooseEdge(words_, s, kOpRandomRule, step.sees ? seen(s) : Seen{}, fieldReader());
      break;
    case kChoose: {
      const float chance = value(step, s, 0), x = multiply(subtract(chance, floor(chance)), step.total);
      for (uint32_t w = 1; w < step.wayCount; ++w)
        if (step.ways[w].from <= x) way = w;
      break;
    }
    default:
      if (const uint32_t result = wait(frame); !step.filter || result == kEndDiscarded) return result;
      frame.step = toChild(frame, s);
      continue;
    }
    if (step.draws) s.key = drawnKey(s.key);
    frame.step = follow(s, step.ways[way]);
  }
  return wait(frame);
}
/// For its children to be made, if it has any.
uint32_t Walker::wait(Frame& frame) {
  frame.fan = fanOf(frame);
  if (frame.fan.extent < 0) {
    ++counts.droppedShapes;
    if (frame.step->op != kOpRepeat) ++counts.uncutShapes;
  }
  frame.made = 0;
  frame.left = frame.fan.successors;
  return frame.fan.count ? kEndWaits : kEndDiscarded;
}

Fan Walker::fanOf(Frame& frame) const {
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
float Walker::length(const Step& step, const Shape& s, uint32_t part) const {
  const Way& way = step.ways[part];
  return way.terms ? expression(s, step, way.terms, part) : way.length;
}
/// The fan of divisionOf(), and what its parts need.
Fan Walker::divide(Frame& frame) const {
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
/// Its parts in their order.
Part Walker::nextPart(Frame& frame, const Shape& s, uint32_t number) const {
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
const Step* Walker::toChild(Frame& frame, Shape& s) {
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
    forAxis(step.argument, [&](uint32_t axis) { there = toPart(s, axis, frame.fan.extent, step.ways[way].part, way); });
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

void Walker::emit(const Frame& frame) {
  const Shape& shape = frame.shape;
  const GpgpAxiom& axiom = axioms_[context.axiomNumber(shape.axiom)];
  const uint32_t bucket = frame.step->argument2, type = shapeType(shape);
  const uint32_t rule = words_[frame.step->node + kNodeRule];
  const uvec2 key = instanceKey(shape.key, axiom.id);
  const uvec2 hash = terminalHash(key, frame.step->argument, rule, type);
  counts.keyHash[0] += hash.x;
  counts.keyHash[1] += hash.y;
  if (buckets_) ++buckets_[bucket];
  ++counts.terminals;
  if (!options_.keeps) return;
  if (next == end) store_.makeRoom(next, end);
  GpgpInstance& instance = *next;
  for (uint32_t r = 0; r < 3; ++r) {
    const float* t = axiom.transform + 4 * r;
    const vec4 row = instanceRow(shape, vec4(t[0], t[1], t[2], t[3]));
    for (int c = 0; c < 4; ++c) instance.transform[4 * r + uint32_t(c)] = row[c];
  }
  instance.bucket = bucket;
  instance.shape = instanceShape(shape);
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
  if (options_.filter && !options_.filter->keeps(instance)) return;
  ++next;
  if (options_.vertices) emitVertices(shape, instance);
}

} // namespace gpgp::spawn
