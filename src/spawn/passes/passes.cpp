// The passes of the spawner, a stage a file.
#include "spawn/passes/builder.h"

namespace gpgp::spawn {

SpawnPasses describePasses(const SpawnerSizes& sizes, const core::Device& device, std::pmr::memory_resource* memory) {
  PassBuilder builder(sizes, device, memory);
  addClear(builder);
  addDerive(builder);
  if (sizes.vertices()) {
    if (sizes.ordered) addOrderedQuads(builder);
    addExpand(builder);
    addPlace(builder);
  } else {
    addPlace(builder);
    if (sizes.ordered) addOrder(builder);
    addEmit(builder);
  }
  addBounds(builder);
  if (sizes.maxMeasuredAxioms) addMeasures(builder);
  return {std::move(builder.list), builder.derive, builder.deriveColliding};
}

} // namespace gpgp::spawn
