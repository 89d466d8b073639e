// What a module adds to sums over the string: depth, brackets that open, polygons around, axioms.
#include "spawn/lsystem/string.h"

uvec4 measured(uint symbol) {
  const uint turtle = lsysTurtleOf(symbol);
  return uvec4(uint(lsysDepthStep(symbol)), symbol == kSymbolOpen ? 1u : 0u,
               turtle == kTurtlePolygon ? 1u : (turtle == kTurtlePolygonEnd ? 0xffffffffu : 0u),
               symbol == kSymbolAxiom ? 1u : 0u);
}

/// Whether a step looks at contexts or cuts.
bool structured(uint step) {
  if (state.stoppedAt <= step) return false;
  const uint phase = phaseOf(step);
  return phase == kPhaseMain || phase == kPhaseCut;
}
