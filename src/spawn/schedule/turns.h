// How many turns of loops a derivation takes on a device that gives a shader a number of them (shaders/core/turns.h):
// bounds from the graph, from which follows how long a workgroup may go on.
#pragma once
#include "spawn/graph/kernel.h"
#include "spawn/shared/layout.h"

namespace gpgp::spawn {

/// Of loops of shaders/spawn/ that depend on the graph, at most, those included that are run for nobody.
struct Turns {
  uint32_t passed = 0; ///< an operator by the graph's words, in runWords() of chain.h
  uint32_t fan = 0;    ///< how many children there are
  uint32_t child = 0;  ///< one of them
  uint32_t family = 0; ///< and more of them, by a kernel's table
  uint32_t code = 0;   ///< code for chains in a kernel that derives by steps
  uint32_t chain = 0;  ///< operators that one shape passes at most before it waits or ends, and at most kMaxChain
  bool phases = false; ///< there are Collider or IfCollides
  uint32_t quads = 0;  ///< of a terminal's vertices
};
Turns turnsOf(const Graph& graph);

/// What one operator, or a workgroup after its last look at the count, may take; false where that is too much.
struct TurnsLimit {
  uint32_t needed = 0, most = 0;
  explicit operator bool() const { return needed <= most; }
};
/// Says in a recording's constants how long workgroups of a software device go on. subgroup: invocations of one, for a
/// kernel that derives by batches; 0: it derives by steps. queues: of a kernel.
TurnsLimit limitTurns(shader::SpawnConstants& constants, const Turns& turns, const Fit& fit, uint32_t subgroup,
                      bool isKernel, Queues queues = Queues::mixed);
/// Records that a workgroup makes vertices of at once, and how often.
struct Expansion {
  uint32_t records, times;
};
Expansion expansionOf(const Turns& turns);

} // namespace gpgp::spawn
