// Grammars as GpgpGrammarSource gives them, to one graph: texts, stack programs, printed graphs, baked grammars,
// builders.
#pragma once
#include "spawn/graph/graph.h"
#include "spawn/language/syntax.h"

#include <gpgp/spawn.h>

#include <span>

namespace gpgp::spawn {

/// What a builder holds, as a tree. Null where there are no builders.
using TreeOfBuilder = SyntaxTree (*)(const GpgpGrammarBuilder_T& builder, Diagnostics& diagnostics);

/// The checked graph of one source, or of several that are linked. Sends all messages. Returns as gpgpCompileGrammar
/// does, but throws where memory is out.
GpgpResult graphOf(std::span<const GpgpGrammarSource> sources, bool linked, TreeOfBuilder treeOf, Graph& graph);

/// Sends a message of a source.
void report(const GpgpGrammarSource& source, Place place, GpgpSeverity severity, const char* text,
            uint32_t omitted = 0);
/// Sends an error that has no place. Returns result.
GpgpResult fail(const GpgpGrammarSource& source, GpgpResult result, const char* text);

} // namespace gpgp::spawn
