#include "spawn/evaluator/program.h"

namespace gpgp::spawn {
namespace {
using namespace shader;

bool isConstant(const uint32_t* words, uint32_t parameter) { return words[parameter] == kParameterConstant; }

/// Terms of the parameter at a word. Returns where they are, or 0 where they do not go from left to right.
uint32_t addTerms(std::vector<Term>& terms, const uint32_t* words, uint32_t at) {
  const size_t first = terms.size();
  if (words[at] == kParameterAttribute) {
    terms.push_back({kCodeEnd, words[at + 1], 0});
  } else {
    const uint32_t* code = words + words[at + 1];
    const auto operand = [&] {
      if (*code != kCodeNumber && *code < kCodeAttributes) return false;
      terms.push_back({kCodeEnd, *code, *code == kCodeNumber ? uintBitsToFloat(code[1]) : 0});
      code += *code == kCodeNumber ? 2 : 1;
      return true;
    };
    bool plain = operand();
    while (plain && *code != kCodeEnd) {
      plain = operand() && *code != kCodeNumber && *code < kCodeAttributes && *code != kCodeEnd;
      if (plain) terms.back().code = *code++;
    }
    if (!plain) {
      terms.resize(first);
      return 0;
    }
  }
  terms.push_back({kCodeEnd, 0, 0});
  return static_cast<uint32_t>(first);
}

/// Rotations by constants and translations along one axis.
void simplify(Step& step) {
  if (step.op == kOpRotate && !step.variable) {
    step.op = kRotateBy;
    step.rotation = rotationOf(step.values);
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

Program decode(const uint32_t* words) {
  Program program;
  const uint32_t nodes = words[kHeaderSections + 2 * kSectionNodes];
  program.steps.resize(1 + nodes);
  program.terms.resize(1);
  size_t ways = 0; // steps point at them, so they must not move; nodes of a file may share edges
  for (uint32_t n = 0; n < nodes; ++n) ways += words[kHeaderSize + n * kNodeSize + kNodeEdgeCount];
  program.ways.reserve(ways);
  for (uint32_t n = 0; n < nodes; ++n) {
    Step& step = program.steps[1 + n];
    step.node = kHeaderSize + n * kNodeSize;
    const uint32_t* node = words + step.node;
    step.op = node[kNodeOperator] & kOperatorMask;
    step.filter = node[kNodeOperator] & kNodeFilter;
    step.argument = node[kNodeArgument];
    step.argument2 = node[kNodeArgument2];
    step.parameters = node[kNodeParameters];
    step.wayCount = node[kNodeEdgeCount];
    step.ways = program.ways.data() + program.ways.size();
    for (uint32_t e = 0; e < step.wayCount; ++e) {
      const uint32_t target = edgeTarget(words, step.node, e);
      program.ways.push_back({program.at(target & ~kEdgeRecursive), target >> 31, 0, {}});
      if (target) step.successors |= 1u << e;
    }
    for (uint32_t i = 0; i < min(node[kNodeParameterCount], 3u); ++i) {
      const uint32_t at = step.parameters + i * kParameterSize;
      if (isConstant(words, at)) {
        step.values = withComponent(step.values, i, graphFloat(words, at + 1));
      } else {
        step.variable |= 1u << i;
        step.terms[i] = addTerms(program.terms, words, at);
      }
    }
    simplify(step);
    if (step.op == kOpRandomRule) simplifyChoice(program, step, words);
    if (step.op == kOpSubDiv && step.argument2) simplifyDivision(program, step, words);
  }
  return program;
}

} // namespace gpgp::spawn
