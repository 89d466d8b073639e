// Which chains of operators a kernel has code for. Chains are inlined wherever one begins, and compilers take more than
// linear time: with code for all of them, a chain of n rules would take n^2 operators, and choices that meet again 2^n.
#pragma once
#include "spawn/graph/graph.h"
#include "spawn/graph/kernel.h"

#include <vector>

namespace gpgp::spawn {

/// Where kRoom does not suffice: the room for chains beside the loop that runs the others.
constexpr uint32_t kRoomBesideWords = 96;

/// What code and expressions of an operator by itself are worth.
uint32_t weightOf(const Graph& graph, const Node& node);

/// Passes on one shape, and is no terminal.
inline bool isChain(const Node& node) {
  return node.op != shader::kOpTerminal && !isContext(node.op) && !multiplies(node);
}

struct Room {
  bool words = false;      ///< some chains, and all expressions of what multiplies, are run by the graph's words
  uint32_t byWords = 0;    ///< operators of such chains
  std::vector<bool> named; ///< by node: its chain is code, and runChain() goes there
  std::vector<bool> coded; ///< by node: its chain is code
};

/// waits: by node, the schedule. first: by node, the one whose code it has. entered: by node, a shape can come there
/// that no chain has brought. chooses: by node, families go through this choice, for which there is code in any case.
Room findRoom(const Graph& graph, const std::vector<bool>& waits, const std::vector<uint32_t>& first,
              const std::vector<bool>& entered, const std::vector<bool>& chooses);

} // namespace gpgp::spawn
