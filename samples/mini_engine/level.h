// The level: where houses stand, and the model on the square in their middle. Metres, y up.
#pragma once
#include "scene.h"

#include <gpgp/spawn.h>

namespace mini {

/// One building per block, low around the square in the middle, which stays free like the avenue, and taller towards
/// the edge of town. Of the grammar grammars/building.pga.
std::vector<GpgpAxiom> levelAxioms();

/// The fetched engine model, or one made here where it was not fetched; says so on standard error.
Model levelModel(const std::string& dataFolder);

} // namespace mini
