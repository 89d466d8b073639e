// Conservative sampling: what follows standard sampling. Each sweep over the triangles is two passes.
#include "visibility/sampling/passes.h"

#include "shaders/visibility_overlap.spv.h"
#include "shaders/visibility_overlap_large.spv.h"

#include <cstddef>

namespace gpgp::visibility {

void addConservative(core::PassList& list, const Budgets& budgets) {
  using namespace shader;
  using enum core::UseKind;
  struct Sweep {
    uint32_t small, large, split; // shaders
    const char *smallName, *largeName, *splitName;
  };
  const auto makeSweep = [&](uint32_t phase, const char* smallName, const char* largeName, const char* splitName) {
    const uint32_t small = addShader(list, smallName, visibility_overlap, {phase});
    const uint32_t large = addShader(list, largeName, visibility_overlap_large, {phase, 0});
    return Sweep{small,     large,     addShader(list, splitName, visibility_overlap_large, {phase, 1}),
                 smallName, largeName, splitName};
  };
  const size_t first = list.passes.size();
  uint32_t level = 0;
  const auto addFill = [&](const char* name, core::ResourceIndex target, uint32_t value, VkDeviceSize offset,
                           VkDeviceSize size) { list.fill(name, target, value, offset, size).level = level; };
  const auto addSweep = [&](const Sweep& sweep) {
    const auto addPass = [&](const char* name, uint32_t shader, size_t arguments) -> core::Pass& {
      core::Pass& pass = fetchesTriangles(list.dispatchIndirect(name, shader,
                                                                {{kBindCounters, readWrite},
                                                                 {kBindQueue, readWrite},
                                                                 {kBindSamples, read},
                                                                 {kBindSurfaces, read},
                                                                 {kBindGaps, readWrite},
                                                                 {kBindBits, readWrite}},
                                                                kBindCounters, arguments));
      pass.level = level;
      return pass;
    };
    addFill("clear overlap", kBindCounters, 0, offsetof(Counters, overlapCount), 8);
    addFill("clear split", kBindCounters, 0, offsetof(Counters, splitCount), 8);
    addPass(sweep.smallName, sweep.small, offsetof(Counters, keptArgs));
    addPass(sweep.largeName, sweep.large, offsetof(Counters, overlapArgs));
    addPass(sweep.splitName, sweep.split, offsetof(Counters, splitArgs)).beside = true;
  };
  addSweep(makeSweep(0, "overlap", "overlap large", "overlap split"));
  const Sweep cover = makeSweep(1, "cover", "cover large", "cover split"),
              nearest = makeSweep(2, "nearest", "nearest large", "nearest split"),
              take = makeSweep(3, "take", "take large", "take split");
  const VkDeviceSize pixels = budgets.pixels();
  for (level = 1; level <= kMaxRefinements; ++level) {
    if (level == 1) addFill("clear gaps", kBindGaps, 0, 0, pixels * 8);
    addFill("clear nearest", kBindGaps, kFarthest, pixels * 8, pixels * kQuarters * 4);
    addSweep(cover);
    addSweep(nearest);
    addSweep(take);
  }
  for (size_t i = first; i < list.passes.size(); ++i) list.passes[i].condition = kIfConservative;
}

} // namespace gpgp::visibility
