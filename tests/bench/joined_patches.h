// How many patches there would be if they were joined: up to four or eight curves each, as in the thesis.
#pragma once
#include "vector/patch/drawing.h"

namespace gpgp::bench {

/// What a curve's half-plane is above and below its ends.
enum class Beyond {
  Tangent, ///< bounded by the tangent at the end, as a curve's implicit form goes on
  Free     ///< everything: a curve counts in its own rows only
};

/// Joins patches that lie above each other where they share all of their level side and the intersection of all their
/// curves' half-planes is still what both cover: asked at the ends and at five heights of each. Sides count as curves,
/// at most `most` in a patch; level sides are the box's. Returns, for each patch, the one below that goes on with it
/// (kNoPatch: none).
constexpr uint32_t kNoPatch = UINT32_MAX;
std::vector<uint32_t> joinPatches(const vector::Drawing& drawing, uint32_t most, Beyond beyond);

} // namespace gpgp::bench
