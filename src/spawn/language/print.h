// The printed form of operator graphs: text that people read and edit, and that gives the same graph back.
//
//   axiom Box -> 0                          the start shape and the node where it goes; a polygon's number in ( )
//   axiom house: Box -> 0                   with its name, where there are several (the first is the default) or it is
//                                           not that of the first rule that leads to this node
//   terminal Wall (1, 4) bucket 2           kind, index, bucket
//   polygon 12 { (0,0.5) (-0.5,0) (0.5,0) } corners of Dynamic... shapes; 13 is its mirror image
//   rule A -> 0                             or Discard
//   rule B(1) -> 2                          starts with the shape of axiom 1, counted from 0
//   0 SubDiv(X) { -1: / -> 1 | 2: / -> 2 }  a node with its edges: value, multiplicity (1, 0, n, / or *), target
//   1 Wall
//   2 Translate(0,(ShapeSize(Y) * 1.5),0) { 1 -> 0 }
//   3 Collider(w) priority 2 { 1 -> 1 }     of a rule with a priority
//   group { 0 2 }                           execution groups, all or none of them; the root first
//   group { 1 }
//
// Names may be digits alone, as in the language, but not where a line begins: nodes' numbers begin it. A terminal may
// have an operator's name, as no ( follows it there. Comments are those of the language. Multiplicities follow from
// operators; ones that do not fit are errors.
#pragma once
#include "spawn/graph/partition.h"
#include "spawn/language/diagnostics.h"

#include <memory_resource>
#include <optional>
#include <string>
#include <string_view>

namespace gpgp::spawn {

std::string printGraph(const Graph& graph);
std::string printGroups(const Partition& partition);

struct PrintedGraph {
  Graph graph;
  std::optional<Partition> partition; ///< valid
};

/// Whether text begins as the printed form does, with an axiom line, its arrow and a node's number or Discard, which no
/// PGA-shape text has.
bool isPrinted(std::string_view text);

/// Nothing where there was an error; all are reported with their places.
std::optional<PrintedGraph> parseGraph(std::string_view text, Diagnostics& diagnostics,
                                       std::pmr::memory_resource* memory);

/// The groups alone, for a graph that is known. Text that has the graph as well must have the same one.
std::optional<Partition> parseGroups(std::string_view text, const Graph& graph, Diagnostics& diagnostics);

} // namespace gpgp::spawn
