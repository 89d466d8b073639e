// A polygon in space as triangles, by ear clipping: a convex one as a fan from its first corner, a concave one without
// leaving its outline. One that crosses itself becomes as many triangles, whichever they are.
#pragma once
#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace gpgp::cli {

/// Three of the outline's corners a triangle, each turning as the outline does. Time grows with the square of the
/// corners' number, seldom with its cube.
std::vector<size_t> clipEars(std::span<const glm::dvec3> outline);

} // namespace gpgp::cli
