// What boundaries do to the pixels of the tiles they pass through: allocate, split, fill.
#include "vector/passes/builder.h"

namespace gpgp::vector {
using enum core::UseKind;

void addFill(PassBuilder& b) {
  b.allocate("allocate", vector_allocate[b.subgroups], kWords, false);
  const auto split = [&](const char* name, Spirv spirv, uint32_t condition) -> core::Pass& {
    return b.dispatch(name, spirv, {{b.paths, read}, {b.words, read}, {b.bins, readWrite}, {b.counters, read}}, kSplits,
                      condition);
  };
  split("split, several drawings", vector_split, kSplit);
  split("split", vector_split_one, kSplitOne).beside = true;
  // Split's barrier, which is owed where that is left out, is all of theirs.
  b.fill("fill, 16 samples", vector_fill_rows_sixteen, true, kMarkSixteen, true);
  b.fill("fill", vector_fill_rows_one, true, kMarkOne, true);
  b.fill("fill, several drawings", vector_fill_rows, true, kMarkDrawings, true);
  b.fill("fill, projective", vector_fill_rows, true, kMarkProjective, true);
  static constexpr const char* kUnlisted[] = {"fill without lists", "fill without lists, several drawings",
                                              "fill without lists, projective"};
  for (uint32_t k = 0; k < 3; ++k) b.fill(kUnlisted[k], vector_fill[k], false, kOneDrawing + k, true);
}

} // namespace gpgp::vector
