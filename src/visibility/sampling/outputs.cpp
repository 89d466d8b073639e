// What follows the bits: triangles' sizes, lists and commands by draw, the list of all, the count.
#include "visibility/sampling/passes.h"

#include "shaders/visibility_draw_count.spv.h"
#include "shaders/visibility_draw_list.spv.h"
#include "shaders/visibility_draw_place.spv.h"
#include "shaders/visibility_extents.spv.h"
#include "shaders/visibility_finish.spv.h"
#include "shaders/visibility_list.spv.h"
#include "shaders/visibility_list_count.spv.h"

#include <cstddef>

namespace gpgp::visibility {

void addOutputs(core::PassList& list) {
  using namespace shader;
  using enum core::UseKind;
  // Goes once over all triangles of the draws.
  const auto addSweep = [&](const char* name, const core::ShaderCode& spirv, std::initializer_list<core::Use> uses,
                            uint32_t condition) {
    fetchesTriangles(
        list.dispatchIndirect(name, addShader(list, name, spirv), uses, kBindCounters, offsetof(Counters, smallArgs)))
        .condition = condition;
  };
  addSweep("extents", visibility_extents, {{kBindCounters, readWrite}, {kBindBits, read}, {kBindExtents, readWrite}},
           kIfExtents);
  addSweep("draw count", visibility_draw_count,
           {{kBindTable, readWrite}, {kBindCounters, readWrite}, {kBindBits, read}}, kIfDraws);
  list.dispatch("draw place", addShader(list, "draw place", visibility_draw_place),
                {{kBindParams, read}, {kBindCounters, readWrite}, {kBindTable, readWrite}, {kBindDrawCommands, write}},
                kOneGroup)
      .condition = kIfDraws;
  addSweep("draw list", visibility_draw_list,
           {{kBindTable, readWrite},
            {kBindCounters, readWrite},
            {kBindBits, read},
            {kBindDrawIndices, write},
            {kBindDrawTriangles, write}},
           kIfDraws);
  list.dispatch("list count", addShader(list, "list count", visibility_list_count),
                {{kBindParams, read}, {kBindCounters, readWrite}, {kBindBits, read}, {kBindView, read}}, kListGroups);
  list.dispatch("list", addShader(list, "list", visibility_list),
                {{kBindParams, read},
                 {kBindCounters, read},
                 {kBindBits, read},
                 {kBindList, write},
                 {kBindChanged, write},
                 {kBindView, readWrite}},
                kListGroups);
  list.dispatch("finish", addShader(list, "finish", visibility_finish),
                {{kBindParams, read},
                 {kBindCounters, readWrite},
                 {kBindChanged, write},
                 {kBindCount, write},
                 {kBindView, readWrite}},
                kOneGroup);
}

} // namespace gpgp::visibility
