// The interpreter: operators by switch, parameters from the graph's words. It runs any graph at once, without a
// compiler.
//
// runChain takes a shape through operators that pass on one shape until it ends, becomes a terminal or waits for an
// operator that multiplies; those are in fans.h. All are pure functions of a shape and the graph. That a child can be
// made alone, by its number, lets a workgroup spread the children of its shapes evenly over its invocations.
// Collider and IfCollides end a chain; whoever calls does what they ask for, and goes on.
#ifndef GPGP_SHADERS_SPAWN_INTERPRET_H
#define GPGP_SHADERS_SPAWN_INTERPRET_H
#include "spawn/operators.h"

GPGP_SHADER_BEGIN

GPGP_FN float parameter(GPGP_GRAPH Shape s, uint index) {
  return evaluate(GPGP_G s, graphWords[s.node + kNodeParameters] + index * kParameterSize, index);
}

GPGP_SHADER_END
#include "spawn/fans.h"
GPGP_SHADER_BEGIN

/// The edge that a conditional or random operator takes.
GPGP_FN uint chooseEdge(GPGP_GRAPH Shape s, uint op) {
  const float first = parameter(GPGP_G s, 0u);
  if (op == kOpIf) return first != 0.0f ? 0u : 1u;
  if (op == kOpIfSizeLess) return component(s.size, graphWords[s.node + kNodeArgument]) < first ? 0u : 1u;
  const uint count = graphWords[s.node + kNodeEdgeCount];
  float total = 0.0f;
  for (uint i = 0u; i < count; ++i) {
    GPGP_TURN;
    total = add(total, max(0.0f, parameter(GPGP_G s, i + 1u)));
  }
  const float x = multiply(subtract(first, floor(first)), total);
  float sum = 0.0f;
  uint chosen = 0u;
  for (uint i = 0u; i < count; ++i) {
    GPGP_TURN;
    const float p = max(0.0f, parameter(GPGP_G s, i + 1u));
    if (p > 0.0f && (sum <= x)) chosen = i;
    sum = add(sum, p);
  }
  return chosen;
}

/// One of the operators that pass on exactly one shape; its node stays.
GPGP_FN void transform(GPGP_GRAPH GPGP_INOUT(Shape) s, uint op) {
  // Values are worked out at one place: a GPU has all of evaluate() again wherever it is called.
  vec3 value = vec3(0.0f);
  const uint count = min(graphWords[s.node + kNodeParameterCount], 3u);
  for (uint i = 0u; i < count; ++i) {
    GPGP_TURN;
    value = withComponent(value, i, parameter(GPGP_G s, i));
  }
  switch (op) {
  case kOpTranslate: translate(s, value); break;
  case kOpRotate: rotate(s, rotationOf(value)); break;
  case kOpScale: resize(s, value); break;
  case kOpExtrude: extrude(s, value.x); break;
  case kOpSwapSize: swapSizes(s, graphWords[s.node + kNodeArgument]); break;
  default: setGeometry(s, graphWords[s.node + kNodeArgument], graphWords[s.node + kNodeArgument2]);
  }
}

/// Takes a shape from operator to operator while each passes on one shape. Returns a kEnd value. Whether the shape
/// arrives from an operator that multiplies or has waited makes no difference here; some generated kernels let it wait
/// first.
GPGP_FN uint runChain(GPGP_GRAPH GPGP_INOUT(Shape) s, bool /* arrives */, uint maxDepth) {
  for (uint step = 0u; step < kMaxChain; ++step) {
    GPGP_TURN;
    if (s.node == 0u) return kEndDiscarded;
    if (s.depth > maxDepth) return kEndUnfinished;
    const uint operatorWord = graphWords[s.node + kNodeOperator];
    const uint op = operatorWord & kOperatorMask;
    if (op == kOpTerminal) return kEndTerminal;
    if (op <= kOpSetGeometry) {
      const uint target = edgeTarget(GPGP_G s.node, 0u);
      transform(GPGP_G s, op);
      if ((operatorWord & kNodeDraws) != 0u) s.key = drawnKey(s.key);
      follow(s, target);
    } else if (op <= kOpRandomRule) {
      follow(s, edgeTarget(GPGP_G s.node, chooseEdge(GPGP_G s, op)));
      if ((operatorWord & kNodeDraws) != 0u) s.key = drawnKey(s.key);
#if defined(__cplusplus) || defined(GPGP_COLLIDERS) // without, no grammar that has them is run
    } else if (op < kOpCompSplit) {
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
