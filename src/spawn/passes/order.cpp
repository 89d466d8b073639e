// Ordered output: terminal records by bucket and path key, and of vertices where the quads of each begin.
#include "spawn/passes/builder.h"

#include "shaders/spawn_order.spv.h"

namespace gpgp::spawn {
using enum core::UseKind;

namespace {
void order(PassBuilder& b, const char* name, uint32_t number) {
  const uint32_t shader = b.list.add(core::ShaderDesc{name, spawn_order, {number}, 1});
  const auto orderUses = {core::Use{shader::kBindGraph, read}, {shader::kBindRecords, read},
                          {shader::kBindCounters, readWrite},  {shader::kBindBuckets, readWrite},
                          {shader::kBindConstants, read},      {shader::kBindOrder, readWrite}};
  const bool perPart = number == shader::kOrderSum || number == shader::kOrderStarts ||
                       number == shader::kOrderQuadSum || number == shader::kOrderQuadStarts;
  core::Pass& pass = number == shader::kOrderBuckets ? b.list.dispatch(name, shader, orderUses, kOneGroup)
                     : perPart                       ? b.list.dispatch(name, shader, orderUses, kPartGroups)
                               : b.list.dispatchIndirect(name, shader, orderUses, shader::kBindCounters, b.perRecord());
  pass.condition = kOrdered;
}
} // namespace

void addOrder(PassBuilder& b) {
  b.list.fill("clear bins", shader::kBindOrder, 0, 0, sizeof(uint32_t) * b.sizes.maxTerminals).condition = kOrdered;
  order(b, "count bins", shader::kOrderCount);
  order(b, "sum bins", shader::kOrderSum);
  order(b, "place bins", shader::kOrderStarts);
  order(b, "fill bins", shader::kOrderFill);
  order(b, "rank", shader::kOrderRank);
}

void addOrderedQuads(PassBuilder& b) {
  order(b, "place buckets", shader::kOrderBuckets);
  addOrder(b);
  order(b, "sum quads", shader::kOrderQuadSum);
  order(b, "place quads", shader::kOrderQuadStarts);
}

} // namespace gpgp::spawn
