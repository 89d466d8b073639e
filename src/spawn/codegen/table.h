// A generated kernel's table (shaders/spawn/kernel/table_format.h): operators that differ in parameters only share
// their code, and families unite operators that multiply with those behind them on static edges.
#pragma once
#include "spawn/graph/graph.h"

#include <array>

namespace gpgp::spawn {

struct KernelTable {
  /// Of each of a family's steps operator and flags, and its frame's flags: children with the same are made by the same
  /// code, with other numbers.
  using Program = std::vector<std::array<uint32_t, 2>>;

  std::vector<uint32_t> words;
  std::vector<Program> programs;
  std::vector<bool> family;   ///< by node: its children are a family
  std::vector<bool> chooses;  ///< by node: families go through this choice
  std::vector<bool> entered;  ///< by node: children of families go on there, at once or when they have waited
  uint32_t stepOperators = 0; ///< bits by kOp: of families' steps
  uint32_t frameFlags = 0;    ///< of the frames behind them, all together
  bool repeats = false;       ///< some families are of Repeat
};

/// Whether frames are made of an operator (kernel/table_format.h).
inline bool isOfFrames(uint32_t op) { return op >= shader::kOpTranslate && op <= shader::kOpScale; }

/// Programs that a kernel has code for. More are slower than a loop over the steps of all.
constexpr size_t kMostPrograms = 8;

/// Whether an operator multiplies every shape by the same number, but for parts without a length.
bool multipliesByKnown(const Node& node);

/// waits: by node, the schedule (generate.h). Shapes do not pass a node where they wait within a row. throughChoices:
/// whether families may go through choices, for each of which a kernel has code.
KernelTable makeTable(const Graph& graph, const std::vector<bool>& waits, bool throughChoices = true);

} // namespace gpgp::spawn
