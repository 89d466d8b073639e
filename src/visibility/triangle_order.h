// An order of a mesh's triangles in which those that follow one another face one way and lie near each other.
#pragma once
#include "core/result.h"

#include <span>

namespace gpgp::visibility {

/// What gpgpOrderTriangles promises. positions: of `stride` bytes. order: a number for each triangle. INVALID_ARGUMENT:
/// strides and indices that cannot be.
core::Result<void> orderTriangles(const float* positions, uint32_t stride, uint32_t vertexCount,
                                  std::span<const uint32_t> indices, uint32_t* order);

} // namespace gpgp::visibility
