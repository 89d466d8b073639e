// From the host's constants to paths on the canvas: begin, place, and small glyphs, whose tiles are made whole.
#include "vector/passes/builder.h"

namespace gpgp::vector {
using enum core::UseKind;

void addBegin(PassBuilder& b) {
  if (b.sizes.software) {
    b.list.fill("clear counters", b.counters, 0);
    b.list.dispatch("begin", b.list.add(core::ShaderDesc{"begin", vector_begin_software}),
                    {{b.fromHost, read}, {b.items, write}, {b.bins, write}, {b.shapes, write}}, kBegin);
    return;
  }
  b.list
      .dispatch("begin", b.list.add(core::ShaderDesc{"begin", vector_begin}),
                {{b.fromHost, read},
                 {b.items, write},
                 {b.bins, write},
                 {b.shapes, write},
                 {b.words, write},
                 {b.counters, write}},
                kBegin)
      .condition = kPlaced;
  core::Pass& alone =
      b.list.dispatch("begin, glyphs alone", b.list.add(core::ShaderDesc{"begin, glyphs alone", vector_begin_alone}),
                      {{b.fromHost, read}, {b.items, write}, {b.bins, write}, {b.counters, write}}, kBegin);
  alone.condition = kAlone;
  alone.beside = true;
  const auto glyphs = [&](const char* name, Spirv spirv, uint32_t condition) -> core::Pass& {
    return b.dispatch(
        name, spirv,
        {{b.fromHost, read}, {b.paths, write}, {b.bins, readWrite}, {b.counters, readWrite}, {b.entries, write}},
        kSmallGlyphs, condition);
  };
  glyphs("small glyphs alone, 16 samples", vector_small_glyphs_alone_sixteen[b.subgroups], kAloneSixteen);
  glyphs("small glyphs alone", vector_small_glyphs_alone_one[b.subgroups], kAloneOne).beside = true;
  glyphs("small glyphs alone, several drawings", vector_small_glyphs_alone[b.subgroups], kAloneDrawings).beside = true;
}

void addPlace(PassBuilder& b) {
  b.forms({"place", "place, several drawings", "place, projective"}, vector_place,
          {{b.paths, readWrite},
           {b.words, readWrite},
           {b.bins, readWrite},
           {b.counters, readWrite},
           {b.imageColors, write}},
          kPaths, kOneDrawing);
  if (b.sizes.software) return b.clear("clear words", vector_clear_words, b.words);
  const auto glyphs = [&](const char* name, Spirv spirv, uint32_t condition) -> core::Pass& {
    return b.dispatch(name, spirv, {{b.paths, read}, {b.words, write}, {b.counters, readWrite}, {b.entries, write}},
                      kSmallGlyphs, condition);
  };
  glyphs("small glyphs", vector_small_glyphs_one[b.subgroups], kSmallGlyphOne);
  glyphs("small glyphs, several drawings", vector_small_glyphs[b.subgroups], kSmallGlyphDrawings).beside = true;
}

} // namespace gpgp::vector
