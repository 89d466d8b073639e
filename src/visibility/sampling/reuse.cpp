// Exact sampling that takes over decisions of the camera's previous recording: what comes before its own passes.
#include "visibility/sampling/passes.h"

#include "shaders/visibility_count_fresh.spv.h"
#include "shaders/visibility_take_over.spv.h"

namespace gpgp::visibility {

void addReuse(core::PassList& list) {
  using namespace shader;
  using enum core::UseKind;
  list.dispatch("count fresh", addShader(list, "count fresh", visibility_count_fresh),
                {{kBindParams, read}, {kBindCounters, readWrite}, {kBindBits, read}, {kBindView, read}}, kListGroups)
      .condition = kIfReuse;
  list.dispatch("take over", addShader(list, "take over", visibility_take_over),
                {{kBindParams, read}, {kBindCounters, readWrite}, {kBindBits, readWrite}, {kBindView, read}},
                kListGroups)
      .condition = kIfReuse;
}

} // namespace gpgp::visibility
