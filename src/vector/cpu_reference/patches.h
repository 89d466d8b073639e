// Items that patches draw, on the CPU.
#pragma once
#include "vector/cpu_reference/cpu_reference.h"

namespace gpgp::vector {

/// Masks and areas of an item's paths, and their tile words, by its patches; false where it has none.
bool coverByPatches(const CpuInput& input, uint32_t item, CpuPlaces& places);

} // namespace gpgp::vector
