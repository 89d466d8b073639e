// Named schedules of thesis 4.5.2 and the heuristics of 4.4.3 to 4.4.5: each gives a valid partition of any graph.
#pragma once
#include "spawn/graph/partition.h"

#include <random>

namespace gpgp::spawn {

/// SGL: the coarsest valid partition. Without dependencies every valid partition splits its groups further; with them
/// (colliders) none has fewer groups where the graph is small, and else the fewest that a bounded search finds, of
/// which none can join another (coarsest.cpp).
Roots coarsestPartition(const Flow& flow);

/// DGN: a group for each rule as written: the nodes that its node leads to without passing another rule's node. What
/// several rules lead to (a terminal's node) is a group of its own.
Roots rulePartition(const Graph& graph, const Flow& flow);

/// All edges into a node are static where isStatic (by edge, as Graph::edges) is true for each and a group can be made
/// of it; else dynamic.
Roots realise(const Flow& flow, const std::vector<bool>& isStatic);

/// A fair coin for the edges into each node, repaired to validity. Every valid partition can come out.
Roots randomPartition(const Flow& flow, std::mt19937& random);

/// How often shapes take an edge, as heuristics see it: parts of a SubDiv with a constant extent count as one, although
/// a part is skipped when nothing is left for it.
uint32_t usualMultiplicity(const Graph& graph, const Link& link);

/// H1, sequence fusion: edges of multiplicity 1 that are their source's only ones should be static.
std::vector<Link> sequenceEdges(const Graph& graph, const Flow& flow);
/// H2, divergence avoidance: edges of multiplicity / should be dynamic.
std::vector<Link> divergentEdges(const Graph& graph, const Flow& flow);
/// H3, execution group size: edges of any constant multiplicity should be static while a group has less than t nodes.
std::vector<Link> constantEdges(const Graph& graph, const Flow& flow);

struct Heuristics {
  bool fuseSequences = true;     ///< H1
  bool avoidDivergence = true;   ///< H2
  uint32_t minimumGroupSize = 5; ///< t of H3; 0 switches it off
};

/// H1 over H2 over H3, edge by edge in the flow's order; an edge that cannot become static stays dynamic, and is tried
/// again once others are. Edges that no heuristic decides are dynamic; where a generator is given, a coin is thrown.
Roots heuristicPartition(const Graph& graph, const Flow& flow, const Heuristics& heuristics = {},
                         std::mt19937* leftOver = nullptr);

} // namespace gpgp::spawn
