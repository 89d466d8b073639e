// What must be visible below the pixel, by rays in double precision: textures are sampled here, clip coordinates are
// interpolated, nothing is snapped. For scenes of few triangles.
#pragma once
#include <optional>

#include "scenes.h"

namespace gpgp::test {

/// By triangle number, how many of samples x samples rays a pixel and camera see it: it is there by its texture, and
/// nothing that hides lies nearer. What is see-through hides nothing.
struct SeenByRays {
  std::vector<uint32_t> sure;     ///< nearer than all else by more than rounding, and well inside its outline
  std::vector<uint32_t> possible; ///< nearer give or take rounding, or within `slack` units of it
};
/// Of `only` one triangle: the others' counts stay 0.
SeenByRays seenByRays(Scene& scene, uint32_t samples, std::optional<uint32_t> only = {});

/// Compares a set of triangles with it: all that `least` rays surely see are there, and none that no ray may see,
/// of these or of the 64 x 64 of a pixel.
/// What is wrong, in words; empty: nothing.
std::string compareWithRays(Scene& scene, const std::vector<uint32_t>& bits, uint32_t samples, uint32_t least);

} // namespace gpgp::test
