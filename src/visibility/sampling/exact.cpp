// Exact sampling: what follows standard sampling.
#include "visibility/sampling/passes.h"

#include "shaders/visibility_bin_allocate.spv.h"
#include "shaders/visibility_bin_large.spv.h"
#include "shaders/visibility_bin_place.spv.h"
#include "shaders/visibility_pixel_lists.spv.h"
#include "shaders/visibility_resolve.spv.h"
#include "shaders/visibility_resolve_alpha.spv.h"
#include "shaders/visibility_resolve_long.spv.h"
#include "shaders/visibility_resolve_long_alpha.spv.h"
#include "shaders/visibility_resolve_long_subgroups.spv.h"
#include "shaders/visibility_resolve_long_subgroups_alpha.spv.h"
#include "shaders/visibility_resolve_subgroups.spv.h"
#include "shaders/visibility_resolve_subgroups_alpha.spv.h"
#include "shaders/visibility_select.spv.h"
#include "shaders/visibility_select_large.spv.h"

#include <cstddef>

namespace gpgp::visibility {

void addExact(core::PassList& list, const Budgets& budgets, const core::Device& device) {
  using namespace shader;
  using enum core::UseKind;
  const uint32_t software = device.software ? 1 : 0, nonOpaque = budgets.maxNonOpaque ? 1 : 0;
  const auto addResolve = [&](const char* name, const core::ShaderCode& spirv, size_t arguments) -> core::Pass& {
    return list.dispatchIndirect(name, addShader(list, name, spirv, {software, 1, 1, nonOpaque}),
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
  // Those that are pieces or many pixels wide beside gather: whether they are seen is asked later.
  fetchesTriangles(list.dispatchIndirect("select large",
                                         addShader(list, "select large", visibility_select_large, {0, 1, 1, nonOpaque}),
                                         {{kBindQueue, read},
                                          {kBindCounters, readWrite},
                                          {kBindTextureCoordinates, read},
                                          {kBindBits, readWrite},
                                          {kBindCandidates, write},
                                          {kBindSlots, readWrite},
                                          {kBindView, readWrite}},
                                         kBindCounters, offsetof(Counters, selectLargeArgs)))
      .beside = true;
  addReuse(list);
  fetchesTriangles(list.dispatchIndirect("select", addShader(list, "select", visibility_select, {0, 1, 1, nonOpaque}),
                                         {{kBindQueue, read},
                                          {kBindSlots, readWrite},
                                          {kBindCounters, readWrite},
                                          {kBindBits, readWrite},
                                          {kBindTextureCoordinates, read},
                                          {kBindCandidates, write},
                                          {kBindPairs, write},
                                          {kBindView, readWrite}},
                                         kBindCounters, offsetof(Counters, onScreenArgs)));
  list.dispatchIndirect("bin large", addShader(list, "bin large", visibility_bin_large),
                        {{kBindParams, read},
                         {kBindSlots, readWrite},
                         {kBindCounters, readWrite},
                         {kBindBits, readWrite},
                         {kBindCandidates, read},
                         {kBindPairs, write},
                         {kBindView, readWrite}},
                        kBindCounters, offsetof(Counters, binLargeArgs));
  list.dispatch("bin allocate", addShader(list, "bin allocate", visibility_bin_allocate),
                {{kBindParams, read},
                 {kBindCounters, readWrite},
                 {kBindSlots, readWrite},
                 {kBindBits, readWrite},
                 {kBindView, readWrite}},
                kAllocateGroups);
  list.dispatchIndirect("bin place", addShader(list, "bin place", visibility_bin_place),
                        {{kBindParams, read}, {kBindCounters, read}, {kBindSlots, readWrite}, {kBindPairs, readWrite}},
                        kBindCounters, offsetof(Counters, placeArgs));
  list.dispatch("pixel lists", addShader(list, "pixel lists", visibility_pixel_lists, {software}),
                {{kBindParams, read},
                 {kBindCounters, readWrite},
                 {kBindSlots, readWrite},
                 {kBindBits, readWrite},
                 {kBindCandidates, read},
                 {kBindPairs, readWrite},
                 {kBindEntries, write},
                 {kBindOpen, write}},
                kTileGroups);
  const bool subgroups = device.subgroupArithmetic && device.subgroupSize == kBatch;
  const auto choose = [&](const core::ShaderCode& bySubgroups, const core::ShaderCode& others) {
    return subgroups ? bySubgroups : others;
  };
  // Lists do not ask each other. The long ones first: what takes longest is not what is waited for at the end.
  addResolve("resolve long", choose(visibility_resolve_long_subgroups, visibility_resolve_long),
             offsetof(Counters, longArgs))
      .condition = kIfResolve;
  core::Pass& shorter =
      addResolve("resolve", choose(visibility_resolve_subgroups, visibility_resolve), offsetof(Counters, openArgs));
  shorter.beside = true, shorter.condition = kIfResolve;
  if (budgets.maxNonOpaque) {
    core::Pass& longAlpha =
        addResolve("resolve long", choose(visibility_resolve_long_subgroups_alpha, visibility_resolve_long_alpha),
                   offsetof(Counters, longArgs));
    longAlpha.beside = true, longAlpha.condition = kIfResolveAlpha;
    core::Pass& alpha = addResolve("resolve", choose(visibility_resolve_subgroups_alpha, visibility_resolve_alpha),
                                   offsetof(Counters, openArgs));
    alpha.beside = true, alpha.condition = kIfResolveAlpha;
  }
  for (size_t i = first; i < list.passes.size(); ++i)
    if (list.passes[i].condition == UINT32_MAX) list.passes[i].condition = kIfExact;
}

} // namespace gpgp::visibility
