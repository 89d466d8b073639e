// Method nearby: what follows standard sampling.
#include "visibility/sampling/passes.h"

#include "shaders/visibility_nearby.spv.h"
#include "shaders/visibility_tiles.spv.h"

#include <cstddef>

namespace gpgp::visibility {

void addNearby(core::PassList& list) {
  using namespace shader;
  using enum core::UseKind;
  list.dispatch("tiles", addShader(list, "tiles", visibility_tiles),
                {{kBindParams, read}, {kBindSamples, read}, {kBindTiles, write}}, kScreenTileGroups)
      .condition = kIfNearby;
  fetchesTriangles(list.dispatchIndirect("nearby", addShader(list, "nearby", visibility_nearby),
                                         {{kBindCounters, readWrite}, {kBindTiles, read}, {kBindBits, readWrite}},
                                         kBindCounters, offsetof(Counters, smallArgs)))
      .condition = kIfNearby;
}

} // namespace gpgp::visibility
