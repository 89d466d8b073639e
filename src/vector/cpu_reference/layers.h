// The CPU reference of layers: the operations of a recording, one pixel after another, with the shaders' own functions
// (shaders/vector/layers/operate.h). Pictures lie where the GPU has them, and are half floats as there.
#pragma once
#include "vector/cpu_reference/asset_table.h"
#include "vector/layers/operation.h"
#include "vector/shared/color.h"

#include <span>

namespace gpgp::vector {

/// `pixels`: what the raster left in the buffer of pictures, two halves in each word; becomes what the operations
/// leave. `assets`: the recording's. The first operation only says where the canvas lies.
void operateOnCpu(std::span<const shader::OperationRecord> operations, std::span<shader::uvec2> pixels,
                  std::span<const AssetTable> assets);

} // namespace gpgp::vector
