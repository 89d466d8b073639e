#include "pass_lists.h"
#include "visibility/atlas/passes.h"
#include "visibility/sampling/passes.h"

namespace gpgp::test {

core::PassList visibilityPasses() {
  GpgpVisibilityRecorderCreateInfo info = GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT;
  info.methods = GPGP_SAMPLING_STANDARD_BIT | GPGP_SAMPLING_EXACT_BIT | GPGP_SAMPLING_CONSERVATIVE_BIT |
                 GPGP_SAMPLING_NEARBY_BIT | GPGP_SAMPLING_REFERENCE_BIT;
  info.maxNonOpaque = 1;
  const core::Device device = deviceOf(false);
  return visibility::describePasses(visibility::Budgets(info, device.limits), device, std::pmr::get_default_resource());
}

core::PassList atlasPasses() {
  const GpgpAtlasRecorderCreateInfo info = GPGP_ATLAS_RECORDER_CREATE_INFO_INIT;
  return visibility::describeAtlasPasses(visibility::AtlasBudgets(info), std::pmr::get_default_resource());
}

} // namespace gpgp::test
