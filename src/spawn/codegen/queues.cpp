#include "spawn/codegen/queues.h"

#include "spawn/graph/partition.h"
#include "spawn/shared/layout.h"

#include <algorithm>

namespace gpgp::spawn {

QueueNumbers numberQueues(const Graph& graph, const std::vector<bool>& stops, const std::vector<uint32_t>& first) {
  const auto nodes = static_cast<uint32_t>(graph.nodes.size());
  const Flow flow = makeFlow(graph);
  std::vector<uint32_t> order = flow.order;
  for (uint32_t n = 0; n < nodes; ++n) // behind other starts
    if (flow.rank[n] == kNoNode) order.push_back(n);
  std::vector<uint32_t> numbers(nodes, kNoNode);
  uint32_t count = 0;
  for (const uint32_t n : order)
    if (uint32_t& own = numbers[first[n]]; own == kNoNode && (stops[n] || multiplies(graph.nodes[n]))) own = count++;
  QueueNumbers queues{std::clamp(count, 1u, shader::kMostQueues), {}};
  for (uint32_t n = 0; n < nodes; ++n) {
    const uint32_t own = numbers[first[n]]; // what nothing waits for in general is in the first one
    queues.ofNodes.push_back(own == kNoNode ? 0 : static_cast<uint32_t>(uint64_t{own} * queues.count / count));
  }
  return queues;
}

} // namespace gpgp::spawn
