#version 460
#extension GL_GOOGLE_include_directive : require
// Writes what each module of a step becomes.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysTile
layout(push_constant) uniform Push { uint step; };
#include "spawn/lsystem/rewrite.h"
#include "spawn/lsystem/scan.glsl"

void main() {
  if (state.stoppedAt <= step) return;
  sourceHalf = step & 1u;
  const uint at = gl_GlobalInvocationID.x;
  const bool isThere = at < modulesOf(sourceHalf);
  const uint production = isThere ? chosen[at] : kLsysNowhere;
  uvec4 module = uvec4(0u);
  uvec4 made = uvec4(0u);
  if (production != kLsysNowhere) {
    module = lsysModule(at);
    made.xy = lsysCount(module, production);
  }
  const uvec4 upTo = sumUpTo(made, false) + tiles[gl_WorkGroupID.x];
  if (production == kLsysNowhere) return;
  const uint to = (1u - sourceHalf) * record.maxModules + upTo.x - made.x;
  const uint toParameters = (1u - sourceHalf) * record.maxParameters;
  uint parameter = upTo.y - made.y;
  if (production == 0u) {
    modules[to] = uvec4(module.x, parameter, module.z, module.w);
    for (uint i = 0u; i < made.y; ++i)
      parameters[toParameters + parameter + i] = parameters[sourceHalf * record.maxParameters + module.y + i];
    return;
  }
  LsysVariables variables;
  lsysTake(variables, 0u, module);
  lsysHasContexts(production, at, variables);
  LsysDraws draws;
  draws.key = module.zw;
  draws.step = step;
  uint entry = lsysWord(production + kProductionSuccessor);
  for (uint m = 0u; m < made.x; ++m) {
    const uint symbol = lsysWord(entry + kModuleSymbol);
    const uvec2 key = lsysChildKey(module, m);
    modules[to + m] = uvec4(symbol, parameter, key.x, key.y);
    uint program = lsysWord(entry + kModuleCode);
    const uint arity = lsysWord(lsysSymbolAt(symbol) + kSymbolArity);
    for (uint i = 0u; i < arity; ++i) {
      parameters[toParameters + parameter] = floatBitsToUint(lsysEvaluate(program, variables, draws));
      parameter += 1u;
    }
    entry += kModuleSize;
  }
}
