// Which tiles each path's boundary meets and which lie inside, and bins as lists of their paths.
#include "vector/passes/builder.h"

namespace gpgp::vector {
using enum core::UseKind;

void addMark(PassBuilder& b) {
  const std::initializer_list<core::Use> uses = {{b.paths, read},     {b.words, readWrite}, {b.counters, readWrite},
                                                 {b.segments, write}, {b.rows, write},      {b.entries, write}};
  b.forms({"mark", "mark, several drawings", "mark, projective"},
          b.sizes.software ? vector_mark_pieces[b.subgroups] : vector_mark, uses, kSegments, kMarkOne);
  if (b.sizes.software) return;
  // The usual number of samples, which the compiler knows.
  b.dispatch("mark, 16 samples", vector_mark_sixteen, uses, kSegments, kMarkSixteen).beside = true;
  core::Pass& pack = b.list.dispatch("pack", b.list.add(core::ShaderDesc{"pack", vector_pack[b.subgroups]}),
                                     {{b.items, read}, {b.bins, readWrite}, {b.counters, readWrite}}, kPacks);
  pack.condition = kPlaced;
  pack.beside = true;
}

} // namespace gpgp::vector
