// A viewer who walks and turns steadily: what recordings cost that take over decisions of the previous one, and how
// many triangles they find late or keep too long.
#pragma once
#include "visibility_runner.h"

#include <string>

namespace gpgp::test {

struct SteadyWalk {
  uint32_t frames = 0; ///< 0: none
  float step = 0;      ///< along the view, world units in each frame
  float turn = 0;      ///< degrees in each frame, to the right
  float maxLate = 0;
};

/// A line a frame, and the means over the frames from the third on: GPU milliseconds of standard sampling, of exact
/// sampling without and with reuse; what was decided with reuse and without.
void printSteadyWalk(Runner& runner, const std::string& scene, const SteadyWalk& walk);

} // namespace gpgp::test
