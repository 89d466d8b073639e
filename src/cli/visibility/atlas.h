// `gpgp visibility --atlas`: allocates a shading atlas for what was seen, and shows it.
#pragma once
#include "cli/visibility/sampled_model.h"

namespace gpgp::cli {

struct AtlasFigures {
  GpgpAtlasReport report{};   ///< with all that is visible
  GpgpAtlasReport changing{}; ///< of the last repeat
  GpuTimes times;             ///< of the repeats
  double firstMilliseconds = 0;
  bool hasPairs = true;
  double psnr = 0;               ///< of the display against direct shading; 0: not asked for
  uint64_t shown = 0, holes = 0; ///< pixels
};

/// What the last sampling found. corners: of each triangle by number, for pictures.
AtlasFigures allocateAtlas(Session& session, const VisibilityOptions& options, SampledModel& scene, const Model& model,
                           const std::vector<glm::vec3>& corners, const View& view);

Json jsonOf(const VisibilityOptions& options, const AtlasFigures& atlas);
std::string textOf(const VisibilityOptions& options, const AtlasFigures& atlas);

} // namespace gpgp::cli
