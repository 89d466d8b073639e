// Collider and IfCollides of a whole graph, which grammars may share: whether they have an order, and an effect.
#pragma once
#include "spawn/language/build_graph.h"

namespace gpgp::spawn {

/// Reports, where it was written, each IfCollides that must wait for what comes after it. The graph is analysed, and
/// may be one with errors; places: by node.
void checkOrder(const Graph& graph, std::span<const NodePlace> places, std::span<const GrammarPart> parts);
/// Warns of operators with a tag that no other one has.
void checkEffect(const Graph& graph, std::span<const NodePlace> places, std::span<const GrammarPart> parts);

} // namespace gpgp::spawn
