// One step of rewriting, as one module sees it: which production applies, and the modules that it becomes.
//
// Of the productions of its symbol, the first whose contexts and condition hold decides. If it has a probability, all
// that hold and have one are drawn from; what their sum leaves below 1 keeps the module as it is. A module that no
// production applies to stays as it is, path key included.
#ifndef GPGP_SHADERS_SPAWN_LSYSTEM_REWRITE_H
#define GPGP_SHADERS_SPAWN_LSYSTEM_REWRITE_H
#include "spawn/lsystem/functions.h"
#include "spawn/lsystem/string.h"

GPGP_SHADER_BEGIN

/// Parameters of the predecessor, then of the contexts.
struct LsysVariables {
  float values[kMostVariables];
};

/// What random numbers depend on: the module and the step.
struct LsysDraws {
  uvec2 key;
  uint step;
};
/// Number index of a module in a step, in [0, 1).
GPGP_FN float lsysDraw(LsysDraws draws, uint index) {
  return unitFloat(mixBits(draws.key.y ^ mixBits(draws.key.x + mixBits(draws.step * 0x9e3779b9u + index))));
}
GPGP_CONST uint kLsysAlternativeDraw = 0x80000000u;

GPGP_FN float lsysTruth(bool value) { return value ? 1.0f : 0.0f; }

GPGP_FN float lsysUnary(uint code, float a) {
  if (code == kLsysNegate) return settle(-a);
  if (code == kLsysNot) return lsysTruth(a == 0.0f);
  if (code == kLsysSin) return sineCosineDegrees(a).x;
  if (code == kLsysCos) return sineCosineDegrees(a).y;
  if (code == kLsysTan) {
    const vec2 both = sineCosineDegrees(a);
    return divide(both.x, both.y);
  }
  if (code == kLsysAsin) return arcSineDegrees(a);
  if (code == kLsysAcos) return subtract(90.0f, arcSineDegrees(a));
  if (code == kLsysAtan) return arcTangentDegrees(a, 1.0f);
  if (code == kLsysSqrt) return squareRoot(a);
  if (code == kLsysExp) return exponential2(multiply(a, 1.4426950f));
  if (code == kLsysLog) return multiply(logarithm2(a), 0.69314718f);
  if (code == kLsysAbs) return abs(a);
  if (code == kLsysFloor) return settle(floor(a));
  if (code == kLsysCeil) return settle(-floor(-a));
  if (code == kLsysRound) return settle(floor(add(a, 0.5f)));
  if (code == kLsysTruncate) return settle(a < 0.0f ? -floor(-a) : floor(a));
  return a == 0.0f ? 0.0f : (a < 0.0f ? -1.0f : 1.0f); // kLsysSign
}

GPGP_FN float lsysBinary(uint code, float a, float b) {
  if (code == kLsysAdd) return add(a, b);
  if (code == kLsysSubtract) return subtract(a, b);
  if (code == kLsysMultiply) return multiply(a, b);
  if (code == kLsysDivide) return divide(a, b);
  if (code == kLsysModulo) return b == 0.0f ? 0.0f : subtract(a, multiply(b, settle(floor(divide(a, b)))));
  if (code == kLsysPower) return power(a, b);
  if (code == kLsysEqual) return lsysTruth(a == b);
  if (code == kLsysNotEqual) return lsysTruth(a != b);
  if (code == kLsysLess) return lsysTruth(a < b);
  if (code == kLsysLessEqual) return lsysTruth(a <= b);
  if (code == kLsysGreater) return lsysTruth(a > b);
  if (code == kLsysGreaterEqual) return lsysTruth(a >= b);
  if (code == kLsysAnd) return lsysTruth(a != 0.0f && b != 0.0f);
  if (code == kLsysOr) return lsysTruth(a != 0.0f || b != 0.0f);
  if (code == kLsysMin) return min(a, b);
  if (code == kLsysMax) return max(a, b);
  return arcTangentDegrees(a, b); // kLsysAtan2
}

/// A value of the table of steps; a step beyond it has the values of the last.
GPGP_FN float lsysOfStep(LSYS_STRING uint row, uint step) {
  const uint code = lsysWord(LSYS_S kLsysHeadSections + 2u * kLsysSectionCode + 1u);
  const uint steps = lsysWord(LSYS_S code);
  return uintBitsToFloat(lsysWord(LSYS_S code + 1u + row * steps + min(step, steps - 1u)));
}

/// The value of the program at word `at`, which becomes the word behind it.
GPGP_FN float lsysEvaluate(LSYS_STRING GPGP_INOUT(uint) at, GPGP_INOUT(LsysVariables) variables, LsysDraws draws) {
  float stack[kMostStackDepth];
  uint depth = 0u;
  for (uint code = lsysWord(LSYS_S at); code != kLsysEnd; code = lsysWord(LSYS_S at)) {
    at += 1u;
    if (code < kLsysNegate) {
      const uint word = lsysWord(LSYS_S at);
      at += 1u;
      float value;
      if (code == kLsysNumber)
        value = uintBitsToFloat(word);
      else if (code == kLsysVariable)
        value = variables.values[word];
      else if (code == kLsysByStep)
        value = lsysOfStep(LSYS_S word, draws.step);
      else if (code == kLsysRandom)
        value = lsysDraw(draws, word);
      else {
        const float radius = squareRoot(multiply(-1.3862944f, logarithm2(subtract(1.0f, lsysDraw(draws, word)))));
        value = multiply(radius, sineCosineDegrees(multiply(360.0f, lsysDraw(draws, word ^ 0x40000000u))).y);
      }
      stack[depth] = value;
      depth += 1u;
    } else if (code < kLsysAdd) {
      stack[depth - 1u] = lsysUnary(code, stack[depth - 1u]); // NOLINT(clang-analyzer-*): checked when it was loaded
    } else if (code < kLsysSelect) {
      depth -= 1u;
      stack[depth - 1u] = lsysBinary(code, stack[depth - 1u], stack[depth]); // NOLINT(clang-analyzer-*)
    } else {
      depth -= 2u;
      stack[depth - 1u] = stack[depth - 1u] != 0.0f ? stack[depth] : stack[depth + 1u]; // NOLINT(clang-analyzer-*)
    }
  }
  at += 1u;
  return stack[0]; // NOLINT(clang-analyzer-*)
}

GPGP_FN void lsysTake(LSYS_STRING GPGP_INOUT(LsysVariables) variables, uint variable, uvec4 module) {
  const uint arity = lsysWord(LSYS_S lsysSymbolAt(LSYS_S module.x) + kSymbolArity);
  for (uint i = 0u; i < arity; ++i) variables.values[variable + i] = lsysParameter(LSYS_S module.y + i);
}

/// Whether the contexts of a production, by its word, hold for the module at a place; takes their parameters.
GPGP_FN bool lsysHasContexts(LSYS_STRING uint production, uint at, GPGP_INOUT(LsysVariables) variables) {
  const uint leftCount = lsysWord(LSYS_S production + kProductionLeft + 1u);
  const uint rightCount = lsysWord(LSYS_S production + kProductionRight + 1u);
  if (leftCount + rightCount == 0u) return true;
  const uint depthHere = lsysNode(LSYS_S lsysLeaves(LSYS_S_ONLY) + at).x;
  uint element = lsysWord(LSYS_S production + kProductionLeft);
  uint place = at;
  uint depth = depthHere;
  for (uint i = 0u; i < leftCount; ++i) {
    place = lsysBefore(LSYS_S place, depth);
    if (place == kLsysNowhere) return false;
    const uvec4 module = lsysModule(LSYS_S place);
    if (module.x != lsysWord(LSYS_S element + kContextSymbol)) return false;
    lsysTake(LSYS_S variables, lsysWord(LSYS_S element + kContextVariable), module);
    element += kContextSize;
  }
  element = lsysWord(LSYS_S production + kProductionRight);
  place = at;
  depth = depthHere;
  for (uint i = 0u; i < rightCount; ++i) {
    const uint symbol = lsysWord(LSYS_S element + kContextSymbol);
    if (symbol == kContextOpen) { // the branch must be what comes next
      place = lsysBehind(LSYS_S place, kLsysInfinite - 1u);
      if (place == kLsysNowhere || lsysModule(LSYS_S place).x != kSymbolOpen) return false;
      depth += 1u;
    } else if (symbol == kContextClose) { // whatever is left of it does not matter
      place = lsysBehind(LSYS_S place, 2u * depth - 1u);
      depth -= 1u;
      if (place == kLsysNowhere) return false;
    } else { // other branches do not matter
      place = lsysBehind(LSYS_S place, 2u * depth);
      if (place == kLsysNowhere) return false;
      const uvec4 module = lsysModule(LSYS_S place);
      if (module.x != symbol) return false;
      lsysTake(LSYS_S variables, lsysWord(LSYS_S element + kContextVariable), module);
    }
    element += kContextSize;
  }
  return true;
}

/// Whether a production applies, its probability aside.
GPGP_FN bool lsysApplies(LSYS_STRING uint production, uint at, LsysDraws draws, GPGP_INOUT(LsysVariables) variables) {
  if (!lsysHasContexts(LSYS_S production, at, variables)) return false;
  uint program = lsysWord(LSYS_S production + kProductionCondition);
  return program == 0u || lsysEvaluate(LSYS_S program, variables, draws) != 0.0f;
}

/// The word of the production that rewrites the module at a place, or 0.
GPGP_FN uint lsysChoose(LSYS_STRING uint at, uvec4 module, uint phase, uint step) {
  const uint symbol = lsysSymbolAt(LSYS_S module.x);
  if (phase >= kPhases3) return 0u;
  const uint first = lsysWord(LSYS_S symbol + kSymbolPhases + 2u * phase);
  const uint count = lsysWord(LSYS_S symbol + kSymbolPhases + 2u * phase + 1u);
  if (count == 0u) return 0u;
  LsysDraws draws;
  draws.key = uvec2(module.z, module.w);
  draws.step = step;
  LsysVariables variables;
  lsysTake(LSYS_S variables, 0u, module);
  float sum = 0.0f;
  bool drawing = false;
  for (uint i = 0u; i < count; ++i) {
    const uint production = first + i * kProductionSize;
    uint program = lsysWord(LSYS_S production + kProductionProbability);
    if ((drawing && program == 0u) || !lsysApplies(LSYS_S production, at, draws, variables)) continue;
    if (program == 0u) return production;
    drawing = true;
    sum = add(sum, max(lsysEvaluate(LSYS_S program, variables, draws), 0.0f));
  }
  if (!drawing) return 0u;
  const float drawn = multiply(lsysDraw(draws, kLsysAlternativeDraw), max(sum, 1.0f));
  sum = 0.0f;
  for (uint i = 0u; i < count; ++i) {
    const uint production = first + i * kProductionSize;
    uint program = lsysWord(LSYS_S production + kProductionProbability);
    if (program == 0u || !lsysApplies(LSYS_S production, at, draws, variables)) continue;
    sum = add(sum, max(lsysEvaluate(LSYS_S program, variables, draws), 0.0f));
    if (drawn < sum) return production;
  }
  return 0u;
}

/// Modules and parameters that take a module's place, for what lsysChoose found.
GPGP_FN uvec2 lsysCount(LSYS_STRING uvec4 module, uint production) {
  if (production == 0u) return uvec2(1u, lsysWord(LSYS_S lsysSymbolAt(LSYS_S module.x) + kSymbolArity));
  return uvec2(lsysWord(LSYS_S production + kProductionSuccessor + 1u),
               lsysWord(LSYS_S production + kProductionParameters));
}

/// The key of an axiom's string, and of module number index of what a module becomes.
GPGP_FN uvec2 lsysAxiomKey(LSYS_STRING uint seed) {
  return childKey(uvec2(seed + lsysWord(LSYS_S kLsysHeadSeed), 0x6c737973u), 0u);
}
GPGP_FN uvec2 lsysChildKey(uvec4 module, uint index) { return childKey(uvec2(module.z, module.w), index); }

GPGP_SHADER_END
#endif
