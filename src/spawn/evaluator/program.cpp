#include "spawn/evaluator/program.h"

#include "spawn/graph/operator_info.h"

#include <cstddef>

namespace gpgp::spawn {
namespace {
using namespace shader;

bool isConstant(const uint32_t* words, uint32_t parameter) { return words[parameter] == kParameterConstant; }

/// Where a Shape has an attribute, as attributeOf() says.
uint32_t sourceOf(uint32_t code) {
  if (code == kCodeSeed) return kSeed;
  if (code >= kCodeView) return kSeen + code - kCodeView;
#define GPGP_OFFSET(name, number, spelling, axes, value, member)                                                       \
  if (attributeAt(code).code == kCode##name) return uint32_t(offsetof(Shape, member)) + 4 * (code - kCode##name);
  GPGP_ATTRIBUTE_TABLE(GPGP_OFFSET)
#undef GPGP_OFFSET
  return 0;
}
static_assert(offsetof(Shape, axisY) == offsetof(Shape, axisX) + 12 &&
              offsetof(Shape, axisZ) == offsetof(Shape, axisX) + 24);

/// Terms of the parameter at a word; index: its place among the operator's. Returns where they are, or kNoTerms where
/// they do not go from left to right.
uint32_t addTerms(std::pmr::vector<Term>& terms, const uint32_t* words, uint32_t at, uint32_t index) {
  const size_t first = terms.size();
  uint32_t draws = index << kDrawsOfParameter;
  if (words[at] == kParameterAttribute) {
    terms.push_back({kCodeEnd, sourceOf(words[at + 1]), 0, 0, 0});
  } else {
    const uint32_t* code = words + words[at + 1];
    const auto operand = [&] {
      if (*code != kCodeNumber && *code < kCodeAttributes) return false;
      if (*code != kCodeNumber) {
        terms.push_back({kCodeEnd, sourceOf(*code++), 0, 0, 0});
        return true;
      }
      const float number = uintBitsToFloat(code[1]);
      code += 2;
      if (*code == kCodeNumber && code[2] == kCodeRandom) { // as combine() draws, with its difference worked out
        terms.push_back({kCodeEnd, kDrawn, number, subtract(uintBitsToFloat(code[1]), number), draws++});
        code += 3;
      } else {
        terms.push_back({kCodeEnd, kNumber, number, 0, 0});
      }
      return true;
    };
    bool plain = operand();
    while (plain && *code != kCodeEnd) {
      plain = operand() && *code != kCodeNumber && *code < kCodeField && *code != kCodeEnd;
      if (!plain) break;
      terms.back().code = *code++;
      if (terms.back().code == kCodeRandom) terms.back().draw = draws++;
    }
    if (!plain) {
      terms.resize(first);
      return kNoTerms;
    }
  }
  terms.push_back({kCodeEnd, 0, 0, 0, 0});
  return static_cast<uint32_t>(first);
}

/// Rotations by constants and translations along one axis.
void simplify(Step& step) {
  if (step.op == kOpRotate) {
    for (uint32_t i = 0; i < 3; ++i) step.angles[i] = sineCosineDegrees(component(step.values, i));
    step.op = step.variable ? kRotateAngles : kRotateBy;
    if (!step.variable) step.rotation = rotationOf(step.values);
  }
  if (step.op != kOpTranslate) return;
  uint32_t used = step.variable;
  for (uint32_t i = 0; i < 3; ++i)
    if (component(step.values, i) != 0) used |= 1u << i;
  if (used & (used - 1)) return;
  step.op = kTranslateAlong;
  step.argument = used / 2;
}

/// RandomRule with constant probabilities: of its ways those that can be taken.
void simplifyChoice(Program& program, Step& step, const uint32_t* words) {
  const auto probability = [&](uint32_t way) { return step.parameters + (way + 1) * kParameterSize; };
  for (uint32_t i = 0; i < step.wayCount; ++i)
    if (!isConstant(words, probability(i))) return;
  step.op = kChoose;
  Way* const ways = program.ways.data() + program.ways.size() - step.wayCount;
  uint32_t kept = 0;
  for (uint32_t i = 0; i < step.wayCount; ++i) {
    const float p = max(0.0f, graphFloat(words, probability(i) + 1));
    ways[i].from = step.total;
    if (p > 0 || i == 0) ways[kept++] = ways[i];
    step.total = add(step.total, p);
  }
  step.wayCount = kept;
}

/// SubDiv some of whose parts are not constant.
void addLengths(Program& program, const Step& step, const uint32_t* words) {
  Way* const ways = program.ways.data() + program.ways.size() - step.wayCount;
  for (uint32_t i = 0; i < step.wayCount; ++i) {
    const uint32_t at = step.parameters + i * kParameterSize;
    if (isConstant(words, at))
      ways[i].length = graphFloat(words, at + 1);
    else
      ways[i].terms = addTerms(program.terms, words, at, i);
  }
}

/// SubDiv with constant parts.
void simplifyDivision(Program& program, Step& step, const uint32_t* words) {
  const uint32_t division = step.argument2;
  step.op = kDivide;
  step.total = graphFloat(words, division);
  step.successors = words[division + kDivisionFixedParts];
  step.weighted = words[division + kDivisionWeightedParts];
  Way* const ways = program.ways.data() + program.ways.size() - step.wayCount;
  for (uint32_t i = 0; i < step.wayCount; ++i) ways[i].part = partAt(words, division + kDivisionParts + i * kPartSize);
}
} // namespace

Program decode(const uint32_t* words, std::pmr::memory_resource* memory) {
  Program program(memory);
  const uint32_t nodes = words[kHeaderSections + 2 * kSectionNodes];
  program.steps.resize(1 + nodes);
  program.terms.resize(1); // 0 is none
  size_t ways = 0;         // steps point at them, so they must not move; nodes of a file may share edges
  for (uint32_t n = 0; n < nodes; ++n) ways += words[kHeaderSize + n * kNodeSize + kNodeEdgeCount];
  program.ways.reserve(ways);
  for (uint32_t n = 0; n < nodes; ++n) {
    Step& step = program.steps[1 + n];
    step.node = kHeaderSize + n * kNodeSize;
    const uint32_t* node = words + step.node;
    step.op = node[kNodeOperator] & kOperatorMask;
    step.filter = node[kNodeOperator] & kNodeFilter;
    step.draws = node[kNodeOperator] & kNodeDraws;
    step.argument = node[kNodeArgument];
    step.argument2 = node[kNodeArgument2];
    for (uint32_t shape = 0; step.op == kOpSubDiv && shape < kShapeCount; ++shape)
      step.cuts = step.cuts || ((node[kNodeShapes] >> shape & 1) && isCut(shape, step.argument));
    step.parameters = node[kNodeParameters];
    step.sees = node[kNodeOperator] & kNodeSees;
    step.wayCount = node[kNodeEdgeCount];
    step.ways = program.ways.data() + program.ways.size();
    for (uint32_t e = 0; e < step.wayCount; ++e) {
      const uint32_t target = edgeTarget(words, step.node, e);
      program.ways.push_back({program.at(target & ~kEdgeRecursive), target >> 31, 0, {}, 0, 0});
      if (target) step.successors |= 1u << e;
    }
    for (uint32_t i = 0; i < min(node[kNodeParameterCount], 3u); ++i) {
      const uint32_t at = step.parameters + i * kParameterSize;
      if (isConstant(words, at)) {
        step.values = withComponent(step.values, i, graphFloat(words, at + 1));
      } else {
        step.variable |= 1u << i;
        step.terms[i] = addTerms(program.terms, words, at, i);
      }
    }
    simplify(step);
    if (step.op == kOpRandomRule) simplifyChoice(program, step, words);
    if (step.op == kOpSubDiv && !step.argument2) addLengths(program, step, words);
    if (step.op == kOpSubDiv && step.argument2) simplifyDivision(program, step, words);
    step.count = uint(bitCount(step.successors));
    step.allCount = uint(bitCount(step.successors | step.weighted));
  }
  return program;
}

} // namespace gpgp::spawn
