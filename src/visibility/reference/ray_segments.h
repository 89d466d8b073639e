// Straight ways through a scene: which of them geometry blocks.
#pragma once
#include "visibility/reference/ray_scene.h"

namespace gpgp::visibility {

/// For each end whether a triangle, whichever way it faces, lies between `begin` and it: what a point is that cannot be
/// walked to straight. Double precision; triangles have their outlines, so that nothing leads through a shared edge.
std::vector<bool> blockedWays(const RayScene& scene, const glm::dvec3& begin, std::span<const glm::dvec3> ends);

} // namespace gpgp::visibility
