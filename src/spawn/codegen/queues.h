// Queues of a kernel: which of them shapes are in that wait for a node (shaders/spawn/derive/queues.glsl).
#pragma once
#include "spawn/graph/graph.h"

#include <vector>

namespace gpgp::spawn {

struct QueueNumbers {
  uint32_t count = 0;            ///< at least 1, at most kMostQueues
  std::vector<uint32_t> ofNodes; ///< by node
};

/// Numbers the nodes that shapes wait at in the graph's order, targets behind sources but in cycles. stops: by node,
/// shapes wait there whether it multiplies or not. first: by node, the one whose code and queue it has. Where there are
/// too many, neighbours share a queue.
QueueNumbers numberQueues(const Graph& graph, const std::vector<bool>& stops, const std::vector<uint32_t>& first);

} // namespace gpgp::spawn
