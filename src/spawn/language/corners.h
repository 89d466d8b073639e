// The polygon of corners as a text says them.
#pragma once
#include "spawn/graph/graph.h"

#include <array>
#include <string>
#include <vector>

namespace gpgp::spawn {

/// Adds the polygon of 3 to kMaxCorners corners, in either direction; the graph keeps them counter-clockwise. Returns
/// its number. problem says what is wrong where the result is of no use.
uint32_t addCorners(Graph& graph, std::vector<std::array<float, 2>> corners, bool convex, std::string& problem);

} // namespace gpgp::spawn
