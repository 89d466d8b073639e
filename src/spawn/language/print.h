// Operator graphs for people: a text form that reads like a rule set, and Graphviz.
#pragma once
#include "spawn/graph/graph.h"

#include <string>

namespace gpgp::spawn {

/// One line a node: number, operator with parameters, then an arrow with multiplicity and target for each edge.
std::string printText(const Graph& graph);
/// For `dot`: the start is blue, terminals are orange, edges carry their multiplicity.
std::string printDot(const Graph& graph);

} // namespace gpgp::spawn
