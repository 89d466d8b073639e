// Operators that pass on one shape, by the graph's words: what the interpreter does with all of them, and a generated
// kernel with those that it has no code for. What it needs is parameter() and what includes fans.h.
#ifndef GPGP_SHADERS_SPAWN_CHAIN_H
#define GPGP_SHADERS_SPAWN_CHAIN_H
#include "spawn/shared/operators.h"

// Operators that one shape passes before others get their turn. Where the device counts turns of loops, the host says
// how many there is room for, and they are counted (src/spawn/schedule/turns.h).
#ifdef GPGP_SOFTWARE
#define GPGP_OPERATOR_PASSED ++operatorsPassed
#else
#define GPGP_OPERATOR_PASSED
#endif
#ifdef __cplusplus
#define GPGP_CHAIN_LENGTH kMaxChain
#else
#include "spawn/derive/turns_count.glsl"
#define GPGP_CHAIN_LENGTH (turnsCount ? record.chainLength : kMaxChain)
#endif

GPGP_SHADER_BEGIN

/// The edge that a conditional or random operator takes.
GPGP_FN uint chooseEdge(GPGP_GRAPH Shape s, uint op GPGP_SEEN_PARAMETER) {
  // Values are worked out at one place: a GPU has all of evaluate() again wherever it is called. The first parameter,
  // then the probabilities twice: for their sum, and for the one that the number falls into.
  const uint count = op == kOpRandomRule ? graphWords[s.node + kNodeEdgeCount] : 0u;
  float first = 0.0f;
  float total = 0.0f;
  float x = 0.0f;
  float sum = 0.0f;
  uint chosen = 0u;
  for (uint turn = 0u; turn <= 2u * count; ++turn) {
    const uint index = turn > count ? turn - count : turn;
    const float value = parameter(GPGP_G s, index GPGP_SEEN_ARGUMENT);
    const float p = max(0.0f, value);
    if (turn == 0u) {
      first = value;
    } else if (turn <= count) {
      total = add(total, p);
    } else {
      if (turn == count + 1u) x = multiply(subtract(first, floor(first)), total);
      if (p > 0.0f && sum <= x) chosen = index - 1u;
      sum = add(sum, p);
    }
  }
  if (op == kOpIf) return first != 0.0f ? 0u : 1u;
  if (op == kOpIfSizeLess) return component(s.size, graphWords[s.node + kNodeArgument]) < first ? 0u : 1u;
  return chosen;
}

/// One of the operators that pass on exactly one shape; its node stays.
GPGP_FN void transform(GPGP_GRAPH GPGP_INOUT(Shape) s, uint op) {
  vec3 value = vec3(0.0f);
  const uint count = min(graphWords[s.node + kNodeParameterCount], 3u);
  for (uint i = 0u; i < count; ++i) {
    value = withComponent(value, i, parameter(GPGP_G s, i));
  }
#define GPGP_VALUES value
#define GPGP_VALUE value.x
#define GPGP_ARGUMENT graphWords[s.node + kNodeArgument]
#define GPGP_ARGUMENT2 graphWords[s.node + kNodeArgument2]
  // clang-format off
  // NOLINTBEGIN(bugprone-macro-parentheses): `call` is a statement
#define GPGP_CASE(name, number, relation, arguments, successors, multiplicity, shapes, kind, call) \
  case kOp##name: call; break;
#define GPGP_DEFAULT(name, number, relation, arguments, successors, multiplicity, shapes, kind, call) default: call;
  // NOLINTEND(bugprone-macro-parentheses)
  // clang-format on
  switch (op) { GPGP_PASSING_OPERATORS(GPGP_CASE, GPGP_DEFAULT) }
#undef GPGP_CASE
#undef GPGP_DEFAULT
#undef GPGP_VALUES
#undef GPGP_VALUE
#undef GPGP_ARGUMENT
#undef GPGP_ARGUMENT2
}

/// Takes a shape from operator to operator while each passes on one shape. Returns a kEnd value.
GPGP_FN uint runWords(GPGP_GRAPH GPGP_INOUT(Shape) s, uint maxDepth) {
  for (uint step = 0u; step < GPGP_CHAIN_LENGTH; ++step) {
    GPGP_OPERATOR_PASSED;
    if (s.node == 0u) return kEndDiscarded;
    if (s.depth > maxDepth) return kEndUnfinished;
    const uint operatorWord = graphWords[s.node + kNodeOperator];
    const uint op = operatorWord & kOperatorMask;
    if (op == kOpTerminal) return kEndTerminal;
    GPGP_LOOK(s);
    if (op <= kLastPassing) {
      const uint target = edgeTarget(GPGP_G s.node, 0u);
      transform(GPGP_G s, op);
      if ((operatorWord & kNodeDraws) != 0u) s.key = drawnKey(s.key);
      follow(s, target);
    } else if (op <= kLastChoosing) {
      follow(s, edgeTarget(GPGP_G s.node, chooseEdge(GPGP_G s, op)));
      if ((operatorWord & kNodeDraws) != 0u) s.key = drawnKey(s.key);
#if defined(__cplusplus) || defined(GPGP_COLLIDERS) // without, no grammar that has them is run
    } else if (op < kFirstMultiplying) {
      return kEndContext;
#endif
    } else {
      if ((operatorWord & kNodeFilter) == 0u) return kEndWaits;
      const Fan fan = fanOf(GPGP_G s);
      if (fan.count == 0u) return kEndDiscarded;
      toChild(GPGP_G s, fan, 0u);
    }
  }
  return s.node == 0u ? kEndDiscarded : kEndWaits;
}

GPGP_SHADER_END
#endif
