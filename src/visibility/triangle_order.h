// An order of a mesh's triangles in which those that follow one another face one way and lie near each other.
#pragma once
#include <cstdint>
#include <span>

namespace gpgp::visibility {

/// What gpgpOrderTriangles promises. positions: of `stride` bytes; indices are checked.
void orderTriangles(const float* positions, uint32_t stride, std::span<const uint32_t> indices,
                    std::span<uint32_t> order);

} // namespace gpgp::visibility
