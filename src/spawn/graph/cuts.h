// The pieces that SubDiv cuts of polygons and prisms: polygons of their own, worked out with the graph.
#pragma once
#include "spawn/graph/graph.h"

namespace gpgp::spawn {

/// Adds all pieces of the polygons that can come to a SubDiv, behind the graph's own ones, and where each SubDiv finds
/// them among its division. Node::uncut where one cannot be made: a polygon that would fall into several pieces, or one
/// of more than kMostCuts at a SubDiv, as of a rule that cuts its own pieces without end; that others are linked with
/// it makes no difference. kMostPieces, with mirror images, bounds them all.
void cutPolygons(Graph& graph);
constexpr uint32_t kMostCuts = 128, kMostPieces = 65536;

} // namespace gpgp::spawn
