#version 460
#extension GL_GOOGLE_include_directive : require
// The strings that derivation begins with: for each axiom, in brackets, its number and the axiom's string.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 64) in;
#include "spawn/lsystem/rewrite.h"

void setArguments(uint slot, uint x) {
  arguments[4u * slot] = x;
  arguments[4u * slot + 1u] = 1u;
  arguments[4u * slot + 2u] = 1u;
}

void main() {
  const uint production = lsysWord(kLsysHeadAxiom);
  const uint count = lsysWord(production + kProductionSuccessor + 1u);
  const uint own = count + 3u;
  const uint ownParameters = lsysWord(production + kProductionParameters) + 1u;
  const uint all = record.axiomCount;
  const bool fits = all <= record.maxModules / own && all <= record.maxParameters / ownParameters;
  const uint axiomsKept = fits ? all : 0u;
  if (gl_GlobalInvocationID.x == 0u) {
    state.modulesA = axiomsKept * own;
    state.parametersA = axiomsKept * ownParameters;
    state.modulesNeeded = all > 0xffffffffu / own ? 0xffffffffu : all * own;
    state.parametersNeeded = all > 0xffffffffu / ownParameters ? 0xffffffffu : all * ownParameters;
    state.stoppedAt = fits ? 0xffffffffu : 0u;
    setArguments(kLsysArgsString, (axiomsKept * own + kLsysTile - 1u) / kLsysTile);
    setArguments(kLsysArgsString + 1u, 0u);
    for (uint round = 0u; round <= record.rounds; ++round) setArguments(kLsysArgsWalks + round, 0u);
  }
  const uint axiom = gl_GlobalInvocationID.x;
  if (axiom >= axiomsKept) return;
  uint at = axiom * own;
  uint parameter = axiom * ownParameters;
  const uvec2 key = lsysAxiomKey(axioms[axiom * 6u + 3u].w);
  const uvec4 root = uvec4(kSymbolAxiom, parameter, key.x, key.y);
  modules[at] = uvec4(kSymbolOpen, parameter, key.x, key.y);
  modules[at + 1u] = root;
  parameters[parameter] = axiom;
  at += 2u;
  parameter += 1u;
  LsysDraws draws;
  draws.key = key;
  draws.step = 0xffffffffu;
  LsysVariables variables;
  variables.values[0] = 0.0;
  uint entry = lsysWord(production + kProductionSuccessor);
  for (uint m = 0u; m < count; ++m) {
    const uint symbol = lsysWord(entry + kModuleSymbol);
    const uvec2 child = lsysChildKey(root, m);
    modules[at + m] = uvec4(symbol, parameter, child.x, child.y);
    uint program = lsysWord(entry + kModuleCode);
    const uint arity = lsysWord(lsysSymbolAt(symbol) + kSymbolArity);
    for (uint i = 0u; i < arity; ++i) {
      parameters[parameter] = floatBitsToUint(lsysEvaluate(program, variables, draws));
      parameter += 1u;
    }
    entry += kModuleSize;
  }
  modules[at + count] = uvec4(kSymbolClose, parameter, key.x, key.y);
}
