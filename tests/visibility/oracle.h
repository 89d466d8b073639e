// An independent judge of sampled ids: each pixel centre as a ray, each triangle tested against it in homogeneous
// coordinates with double precision. No snapping, no clipping, no fill rule; what it calls certain must be so.
#pragma once
#include "visibility/cpu_reference/cpu_reference.h"

#include <string>

namespace gpgp::test {

struct Verdict {
  uint64_t pixels = 0;    ///< judged
  uint64_t covered = 0;   ///< by the sampled ids
  uint64_t wrong = 0;     ///< no tolerance explains them
  std::string firstWrong; ///< where, in words
};

/// Judges a sampled id per pixel. A pixel is wrong if its id's triangle is not within 1/64 pixel of the centre, if a
/// triangle that surely covers the centre is surely nearer, or if nothing was sampled where a triangle surely covers.
Verdict judge(const visibility::CpuInput& input, const std::vector<uint32_t>& ids);

} // namespace gpgp::test
