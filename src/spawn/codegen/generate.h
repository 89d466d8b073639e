// Operator graph to GLSL: the three functions of the interpreter (shaders/spawn/derive/interpret.h) for one graph, with
// operators in straight lines and parameters folded.
//
// What a node is decides little: operators that pass on one shape become functions that call the next one, operators
// that multiply become cases of fanOf and toChild. `waits` is the schedule: a shape on its way to such a node goes
// through a queue, to any other it goes on in the same invocation. The result equals the interpreter's to the last bit,
// as both call shaders/spawn/shared/operators.h and constants are folded with the same arithmetic.
#pragma once
#include "spawn/graph/kernel.h"
#include "spawn/graph/partition.h"

#include <string>
#include <vector>

namespace gpgp::spawn {

struct KernelSource {
  std::string functions;       ///< GLSL
  std::vector<uint32_t> table; ///< that they read (shaders/spawn/kernel/table_format.h)
  uint32_t operators = 0;      ///< of the graph
  uint32_t byWords = 0;        ///< those that there is no room for as code: they are run by the graph's words
};

/// The source of a valid graph's kernel. waits: by node, where shapes go through a queue. An operator that multiplies
/// by a known number and does not wait joins the family of the one before it (table.h); others that multiply wait in
/// any case. matched: the roots of a valid partition; chains of execution groups that differ in parameters only then
/// share their code (thesis 4.2.3). Without it each node has code of its own. queues: where shapes wait in a workgroup;
/// groups that share code share a queue.
KernelSource generate(const Graph& graph, const std::vector<bool>& waits, const Roots& matched = {},
                      Queues queues = Queues::mixed);

} // namespace gpgp::spawn
