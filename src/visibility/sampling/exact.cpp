// Exact sampling: what follows standard sampling.
#include "visibility/sampling/passes.h"

#include "shaders/visibility_allot.spv.h"
#include "shaders/visibility_big.spv.h"
#include "shaders/visibility_hide.spv.h"
#include "shaders/visibility_pick.spv.h"
#include "shaders/visibility_pick_unfold.spv.h"
#include "shaders/visibility_place.spv.h"
#include "shaders/visibility_resolve.spv.h"
#include "shaders/visibility_resolve_long.spv.h"
#include "shaders/visibility_resolve_long_subgroups.spv.h"
#include "shaders/visibility_resolve_subgroups.spv.h"

#include <cstddef>

namespace gpgp::visibility {

void addExact(core::PassList& list, const Budgets& budgets, const core::Device& device) {
  using namespace shader;
  using enum core::UseKind;
  // Candidates of the triangles that a queue names: picked where they can be seen, or where something hides them.
  const auto addCandidates = [&](const char* name, std::span<const uint32_t> spirv, core::UseKind queue,
                                 size_t arguments) {
    fetchesTriangles(list.dispatchIndirect(name, addShader(list, name, spirv),
                                           {{kBindQueue, queue},
                                            {kBindSlots, readWrite},
                                            {kBindCounters, readWrite},
                                            {kBindBits, readWrite},
                                            {kBindCandidates, readWrite},
                                            {kBindPairs, write}},
                                           kBindCounters, arguments));
  };
  const auto addBig = [&](const char* name, uint32_t phase) {
    list.dispatchIndirect(name, addShader(list, "big", visibility_big, phase),
                          {{kBindParams, read},
                           {kBindSlots, readWrite},
                           {kBindCounters, readWrite},
                           {kBindBits, readWrite},
                           {kBindCandidates, readWrite},
                           {kBindPairs, write}},
                          kBindCounters, offsetof(Counters, bigArgs));
  };
  const auto addResolve = [&](const char* name, std::span<const uint32_t> spirv, size_t arguments) -> core::Pass& {
    return list.dispatchIndirect(name, addShader(list, name, spirv),
                                 {{kBindParams, read},
                                  {kBindSlots, readWrite},
                                  {kBindCounters, readWrite},
                                  {kBindBits, readWrite},
                                  {kBindOpen, read},
                                  {kBindCandidates, read},
                                  {kBindEntries, read},
                                  {kBindKeys, readWrite}},
                                 kBindCounters, arguments);
  };
  const size_t first = list.passes.size();
  list.fill("clear lists", kBindSlots, 0, budgets.slots() * 4, budgets.slots() * 4);
  addCandidates("pick", visibility_pick, readWrite, offsetof(Counters, onScreenArgs));
  fetchesTriangles(list.dispatchIndirect("pick unfold", addShader(list, "pick unfold", visibility_pick_unfold),
                                         {{kBindQueue, read},
                                          {kBindCounters, readWrite},
                                          {kBindBits, readWrite},
                                          {kBindCandidates, write},
                                          {kBindSlots, readWrite}},
                                         kBindCounters, offsetof(Counters, bigUnfoldArgs)));
  addBig("pick big", 0);
  addCandidates("hide", visibility_hide, read, offsetof(Counters, seenArgs));
  addBig("hide big", 1);
  list.dispatch("allot", addShader(list, "allot", visibility_allot),
                {{kBindParams, read}, {kBindCounters, readWrite}, {kBindSlots, readWrite}, {kBindOpen, write}},
                kTileGroups);
  list.dispatchIndirect(
      "place", addShader(list, "place", visibility_place),
      {{kBindParams, read}, {kBindCounters, read}, {kBindSlots, readWrite}, {kBindPairs, read}, {kBindEntries, write}},
      kBindCounters, offsetof(Counters, placeArgs));
  const bool subgroups = device.subgroupArithmetic && device.subgroupSize == kBatch;
  const auto choose = [&](std::span<const uint32_t> bySubgroups, std::span<const uint32_t> others) {
    return subgroups ? bySubgroups : others;
  };
  // Lists do not ask each other. The long ones first: what takes longest is not what is waited for at the end.
  addResolve("resolve long", choose(visibility_resolve_long_subgroups, visibility_resolve_long),
             offsetof(Counters, longArgs));
  addResolve("resolve", choose(visibility_resolve_subgroups, visibility_resolve), offsetof(Counters, openArgs)).beside =
      true;
  for (size_t i = first; i < list.passes.size(); ++i) list.passes[i].condition = kIfExact;
}

} // namespace gpgp::visibility
