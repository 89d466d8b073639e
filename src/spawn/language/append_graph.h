// A finished graph becomes part of another one: what linking baked grammars does.
#pragma once
#include "spawn/graph/graph.h"
#include "spawn/language/diagnostics.h"

#include <map>
#include <string>

namespace gpgp::spawn {

/// Tags by name, as nodes have them; common to all parts of a graph.
using Tags = std::map<std::string, uint32_t>;

/// Adds a zero-ended name; returns its offset in Graph::names.
uint32_t addName(Graph& graph, std::string_view name);

/// Adds all of a valid graph but what analyse() finds. name: its rules and terminals become name.Rule, its first axiom
/// name; empty: they stay. Fields of the same name are the same field; an error where they are too many, and the graph
/// is not valid. The same graph comes of it as of the text that the part was made from.
void appendGraph(const Graph& part, const std::string& name, Graph& graph, Tags& tags, Diagnostics& diagnostics);

} // namespace gpgp::spawn
