// Pictures of operator graphs and their partitions. As in the thesis: the start is blue, terminals are orange, static
// edges green, dynamic ones blue; each execution group is a coloured cluster. Discard is a cross where an edge ends.
#pragma once
#include "spawn/graph/partition.h"

#include <string>

namespace gpgp::spawn {

/// For Graphviz. Without a partition: the graph alone.
std::string exportDot(const Graph& graph, const Partition* partition = nullptr);
/// A drawing with a layered layout of our own.
std::string exportSvg(const Graph& graph, const Partition* partition = nullptr);

/// A light colour, as #rrggbb; neighbouring numbers get colours that are far apart.
std::string groupColour(uint32_t group);

} // namespace gpgp::spawn
