// Axioms of `gpgp spawn --scatter`: points at a distance from each other, by pictures of density and terrain.
#pragma once
#include "cli/spawn/axioms.h"

namespace gpgp::cli {

struct ScatterOptions {
  float distance = 0;                  ///< metres; 0: nothing is scattered
  std::array<float, 2> area{100, 100}; ///< metres along x and z, around the origin
  std::string density, terrain;        ///< pictures over the area, first row at the least z
  float terrainHeight = 10;            ///< metres of white
};

/// Throws Usage where there is no point, or the area is too large.
std::vector<GpgpAxiom> scatterAxioms(const ScatterOptions& options, const AxiomDefaults& defaults);

} // namespace gpgp::cli
