// The types of shapes that come to each operator of a whole graph: whether it has an effect on them, and what is lost.
#pragma once
#include "spawn/language/build_graph.h"

namespace gpgp::spawn {

/// Warns of operators that make nothing of a type, or change nothing, and tells where instances lack corners. The graph
/// is analysed and without errors; places: by node. Baked parts have said it when they were compiled.
void checkShapes(const Graph& graph, std::span<const NodePlace> places, std::span<const GrammarPart> parts);

} // namespace gpgp::spawn
