#include "spawn/evaluator/program.h"

namespace gpgp::spawn {
namespace {
using namespace shader;

bool isConstant(const uint32_t* words, uint32_t parameter) { return words[parameter] == kParameterConstant; }

/// Translations along one axis and rotations by constants.
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
  step.argument = used == 4 ? 2 : used / 2;
}

/// RandomRule whose probabilities are constant.
void addChances(Program& program, Step& step, const uint32_t* words, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i)
    if (!isConstant(words, step.parameters + (i + 1) * kParameterSize)) return;
  step.op = kChoose;
  step.firstChance = static_cast<uint32_t>(program.chances.size());
  for (uint32_t i = 0; i < count; ++i) {
    const float p = max(0.0f, graphFloat(words, step.parameters + (i + 1) * kParameterSize + 1));
    if (p > 0 || i == 0) program.chances.push_back({i == 0 ? 0 : step.total, step.target(i)});
    step.total = add(step.total, p);
  }
  step.chanceCount = static_cast<uint32_t>(program.chances.size()) - step.firstChance;
}
} // namespace

Program decode(const uint32_t* words) {
  Program program;
  const uint32_t nodes = words[kHeaderSections + 2 * kSectionNodes];
  program.steps.resize(kHeaderSize / kNodeSize + nodes);
  for (uint32_t n = 0; n < nodes; ++n) {
    Step& step = program.steps[kHeaderSize / kNodeSize + n];
    const uint32_t* node = words + kHeaderSize + n * kNodeSize;
    step.op = node[kNodeOperator] & kOperatorMask;
    step.filter = node[kNodeOperator] & kNodeFilter;
    step.argument = node[kNodeArgument];
    step.argument2 = node[kNodeArgument2];
    step.edges = words + node[kNodeEdges];
    step.parameters = node[kNodeParameters];
    for (uint32_t e = 0; e < node[kNodeEdgeCount]; ++e)
      if (step.target(e)) step.successors |= 1u << e;
    for (uint32_t i = 0; i < min(node[kNodeParameterCount], 3u); ++i) {
      const uint32_t at = step.parameters + i * kParameterSize;
      if (isConstant(words, at))
        step.values = withComponent(step.values, i, graphFloat(words, at + 1));
      else
        step.variable |= 1u << i;
    }
    simplify(step);
    if (step.op == kOpRandomRule) addChances(program, step, words, node[kNodeEdgeCount]);
  }
  return program;
}

} // namespace gpgp::spawn
