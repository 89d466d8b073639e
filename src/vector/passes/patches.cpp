// What CPatches do to tiles and their pixels, in place of mark and fill: patch tiles, patch blocks, patch fill.
#include "vector/passes/builder.h"

#include <cstddef>

namespace gpgp::vector {
using enum core::UseKind;

void addPatchTiles(PassBuilder& b) {
  const auto tiles = [&](const char* name, Spirv spirv, uint32_t groups, uint32_t condition) -> core::Pass& {
    return b.dispatch(name, spirv,
                      {{b.paths, read},
                       {b.words, readWrite},
                       {b.counters, readWrite},
                       {b.patchBlocks, readWrite},
                       {b.tilePatches, write}},
                      groups, condition);
  };
  tiles("patch tiles", vector_patch_tiles_one, kPatches, kPatchesOne);
  tiles("patch tiles, several drawings", vector_patch_tiles, kPatches, kPatchesDrawings).beside = true;
  tiles("patch blocks", vector_patch_blocks_one, kPatchBlocks, kPatchesOne);
  tiles("patch blocks, several drawings", vector_patch_blocks, kPatchBlocks, kPatchesDrawings).beside = true;
}

void addPatchFill(PassBuilder& b) {
  const auto fill = [&](const char* name, Spirv spirv, uint32_t condition) {
    core::Pass& pass = b.list.dispatchIndirect(name, b.list.add(core::ShaderDesc{name, spirv}),
                                               {{b.items, read},
                                                {b.shapes, read},
                                                {b.paths, read},
                                                {b.words, read},
                                                {b.counters, read},
                                                {b.tilePatches, read},
                                                {b.entries, readWrite}},
                                               b.counters, offsetof(shader::CanvasCounters, patchesX));
    for (core::ResourceIndex i = 0; i < shader::kMaxBuffers; ++i) pass.uses[pass.useCount++] = {i, read};
    pass.condition = condition;
    pass.beside = true;
  };
  fill("patch fill", vector_patch_fill_one, kPatchesOne);
  fill("patch fill, several drawings", vector_patch_fill, kPatchesDrawings);
}

} // namespace gpgp::vector
