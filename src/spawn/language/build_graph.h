// Syntax tree to operator graph: names are resolved, operators checked, expressions compiled.
#pragma once
#include "spawn/graph/graph.h"
#include "spawn/language/syntax.h"

#include <span>
#include <string>
#include <string_view>

namespace gpgp::spawn {

/// A grammar that becomes part of a graph.
struct GrammarPart {
  const SyntaxTree* tree = nullptr;
  const Graph* baked = nullptr; ///< instead of a tree
  std::span<const GpgpVariable> overrides;
  Diagnostics* diagnostics = nullptr;
  std::string name; ///< a linked grammar's: its rules and terminals are name.Rule, its first axiom is name; else empty
  std::string file; ///< for messages of other parts
  const std::vector<Place>* places = nullptr; ///< of the nodes of baked, where it was made of a text just now
};

/// Where a node was written.
struct NodePlace {
  uint32_t part = 0; ///< of the grammars
  Place place;
};

/// What a linked grammar is called: its file's name without folders and without what follows the first point, in
/// characters that names have. Digits alone would look like a number: they get a _ before them.
std::string linkedName(std::string_view file);

/// One graph of grammars without errors, in their order. They have no names in common but those of tags, so that shapes
/// of one can stop at shapes of another. Problems are reported; the graph is usable only where none was.
Graph buildGraph(std::span<const GrammarPart> parts, std::pmr::memory_resource* memory);

/// Of one grammar.
Graph buildGraph(const SyntaxTree& tree, std::span<const GpgpVariable> overrides, Diagnostics& diagnostics,
                 std::pmr::memory_resource* memory);

/// Text to graph: parse and build.
Graph compile(std::string_view text, std::span<const GpgpVariable> overrides, Diagnostics& diagnostics,
              std::pmr::memory_resource* memory);

} // namespace gpgp::spawn
