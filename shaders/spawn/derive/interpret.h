// The interpreter: operators by switch, parameters from the graph's words. It runs any graph at once, without a
// compiler.
//
// runChain takes a shape through operators that pass on one shape (chain.h) until it ends, becomes a terminal or waits
// for an operator that multiplies; those are in fans.h. All are pure functions of a shape and the graph. That a child
// can be made alone, by its number, lets a workgroup spread the children of its shapes evenly over its invocations.
// Collider and IfCollides end a chain; whoever calls does what they ask for, and goes on.
#ifndef GPGP_SHADERS_SPAWN_INTERPRET_H
#define GPGP_SHADERS_SPAWN_INTERPRET_H
#include "spawn/shared/operators.h"

GPGP_SHADER_BEGIN

GPGP_FN float parameter(GPGP_GRAPH Shape s, uint index GPGP_SEEN_PARAMETER) {
  return evaluate(GPGP_G s, graphWords[s.node + kNodeParameters] + index * kParameterSize, index GPGP_SEEN_ARGUMENT);
}

GPGP_SHADER_END
#include "spawn/shared/fans.h"

#include "spawn/shared/chain.h"
GPGP_SHADER_BEGIN

/// runWords. Whether the shape arrives from an operator that multiplies or has waited makes no difference here; some
/// generated kernels let it wait first.
GPGP_FN uint runChain(GPGP_GRAPH GPGP_INOUT(Shape) s, bool /* arrives */, uint maxDepth) {
  return runWords(GPGP_G s, maxDepth);
}

GPGP_SHADER_END
#endif
