// View points of a cell that lie behind a wall, seen from its middle.
#pragma once
#include "cli/model/model.h"
#include "cli/visibility/views.h"

namespace gpgp::cli {

/// Leaves out the views, but for the first, whose eye cannot be reached straight from the first one's, because a
/// triangle lies between. Parallel cameras have no eye: all of theirs stay. Returns how many were left out.
uint32_t leaveOutBehindWalls(std::vector<View>& views, const Model& model);

} // namespace gpgp::cli
