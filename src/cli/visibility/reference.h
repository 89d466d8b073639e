// What `gpgp visibility` measures against.
#pragma once
#include "cli/visibility/sampled_model.h"

namespace gpgp::cli {

struct Reference {
  std::vector<uint32_t> bits, areas; ///< of each triangle whether it is seen, and by how many samples
};

/// What the views see together, at samples x samples points a pixel and at its centre: of the device, which snaps as
/// the methods do, or by rays on the processor, as --reference-device says. Standard error shows how far
/// it is, and where it takes long says so as soon as that is known.
Reference referenceOf(SampledModel& scene, const VisibilityOptions& options, const Model& model,
                      const std::vector<View>& views, uint32_t samples);

} // namespace gpgp::cli
