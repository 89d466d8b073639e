// The CPU reference of layers: the operations of a recording, one pixel after another, with the shaders' own functions
// (shaders/vector/layers/operate.h). Pictures lie where the GPU has them, and are half floats as there.
#pragma once
#include "vector/layers/operation.h"
#include "vector/shared/color.h"

#include <span>

namespace gpgp::vector {

/// `pixels`: what the raster left in the buffer of pictures, two halves in each word; becomes what the operations
/// leave. `tables`: of each slot, what lies in its buffer. The first operation only says where the canvas lies.
void operateOnCpu(std::span<const shader::OperationRecord> operations, std::span<shader::uvec2> pixels,
                  std::span<const std::span<const shader::vec4>> tables);

} // namespace gpgp::vector
