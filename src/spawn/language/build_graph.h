// Syntax tree to operator graph: names are resolved, operators checked, expressions compiled.
#pragma once
#include "spawn/graph/graph.h"
#include "spawn/language/syntax.h"

#include <span>

namespace gpgp::spawn {

/// A graph for a tree without errors. Problems are reported; the graph is usable only where none was.
Graph buildGraph(const SyntaxTree& tree, std::span<const GpgpVariable> overrides, Diagnostics& diagnostics,
                 std::pmr::memory_resource* memory);

/// Text to graph: parse and build.
Graph compile(std::string_view text, std::span<const GpgpVariable> overrides, Diagnostics& diagnostics,
              std::pmr::memory_resource* memory);

} // namespace gpgp::spawn
