// What software devices do instead of fill.cpp's and raster.cpp's passes: without barriers within shaders, which are
// dear there, and with few turns of loops.
#include "vector/passes/builder.h"

#include <cstddef>

namespace gpgp::vector {
using enum core::UseKind;

void addSoftwareFill(PassBuilder& b) {
  b.allocate("allocate", vector_allocate_rows, kWords, true);
  b.allocate("allocate again", vector_allocate_software, kOnce, false);
  b.clear("clear entries", vector_clear_entries, b.entries);
  static constexpr const char* kFills[] = {"fill", "fill, several drawings", "fill, projective"};
  for (uint32_t k = 0; k < 3; ++k) {
    const Spirv spirv = k == 0 ? vector_fill_pieces_one[b.subgroups] : vector_fill_pieces[b.subgroups];
    core::Pass& pass = b.list.dispatch(kFills[k], b.list.add(core::ShaderDesc{kFills[k], spirv}),
                                       {{b.items, read},
                                        {b.paths, read},
                                        {b.words, read},
                                        {b.counters, readWrite},
                                        {b.segments, read},
                                        {b.rows, read},
                                        {b.entries, readWrite}},
                                       kFill);
    pass.condition = kMarkOne + k;
    pass.beside = k > 0;
  }
  b.list
      .dispatch("backdrop", b.list.add(core::ShaderDesc{"backdrop", vector_fill_backdrop}),
                {{b.items, read},
                 {b.paths, read},
                 {b.words, read},
                 {b.counters, read},
                 {b.rows, read},
                 {b.entries, readWrite}},
                kFill)
      .condition = kPlaced;
  b.fill("clear entries again", vector_clear_entries, false, kPlaced, false);
  static constexpr const char* kUnlisted[] = {"fill without lists", "fill without lists, several drawings",
                                              "fill without lists, projective"};
  for (uint32_t k = 0; k < 3; ++k) b.fill(kUnlisted[k], vector_fill_software[k], false, kMarkOne + k, k > 0);
}

void addSoftwareRaster(PassBuilder& b) {
  const auto sift = [&](const char* name, Spirv spirv, uint32_t condition) -> core::Pass& {
    return b.dispatch(name, spirv, {{b.paths, read}, {b.words, read}, {b.bins, readWrite}, {b.counters, readWrite}},
                      kSift, condition);
  };
  sift("sift", vector_sift, kSiftPlain);
  sift("sift, groups", vector_sift_split, kSplit).beside = true;
  static constexpr FormNames kSolid = {"solid tiles", "solid tiles rgba8", "solid tiles rgba16f"};
  for (uint32_t t = 0; t < 3; ++t)
    if (b.sizes.rasters(t))
      b.target(b.dispatch(kSolid[t], vector_tiles_solid[t], {{b.bins, read}, {b.history, write}}, kTiles, kAny), t,
               kAny);
  static constexpr FormNames kRows = {"raster rows", "raster rows rgba8", "raster rows rgba16f"};
  for (uint32_t t = 0; t < 3; ++t)
    if (b.sizes.rasters(t))
      b.target(b.list.dispatchIndirect(kRows[t], b.list.add(core::ShaderDesc{kRows[t], vector_tiles_rows[t]}),
                                       {{b.items, read},
                                        {b.paths, read},
                                        {b.bins, read},
                                        {b.entries, read},
                                        {b.counters, read},
                                        {b.history, write}},
                                       b.counters, offsetof(shader::CanvasCounters, tilesX)),
               t, kAny);
  b.painted({"raster", "raster rgba8", "raster rgba16f"}, vector_tiles_plain, kPlain, shader::kPaintedArguments);
  b.painted({"raster gradients, several drawings", "raster gradients rgba8, several drawings",
             "raster gradients rgba16f, several drawings"},
            vector_tiles_paints, kPaints, shader::kPaintedArguments);
  b.painted({"raster gradients", "raster gradients rgba8", "raster gradients rgba16f"}, vector_tiles_paints_one,
            kPaintsOne, shader::kPaintedArguments);
  b.painted({"crowded", "crowded rgba8", "crowded rgba16f"}, vector_crowded_plain, kPlain, shader::kCrowdedArguments);
  b.painted({"crowded gradients, several drawings", "crowded gradients rgba8, several drawings",
             "crowded gradients rgba16f, several drawings"},
            vector_crowded_paints, kPaints, shader::kCrowdedArguments);
  b.painted({"crowded gradients", "crowded gradients rgba8", "crowded gradients rgba16f"}, vector_crowded_paints_one,
            kPaintsOne, shader::kCrowdedArguments);
  b.painted({"raster all", "raster all rgba8", "raster all rgba16f"}, vector_tiles_rich, kRich, shader::kRichArguments);
  b.painted({"crowded all", "crowded all rgba8", "crowded all rgba16f"}, vector_crowded_rich, kRich,
            shader::kRichCrowdedArguments);
  b.painted({"raster images", "raster images rgba8", "raster images rgba16f"}, vector_tiles_images, kImages,
            shader::kPaintedArguments);
  b.painted({"crowded images", "crowded images rgba8", "crowded images rgba16f"}, vector_crowded_images, kImages,
            shader::kCrowdedArguments);
  b.painted({"raster all, images", "raster all, images rgba8", "raster all, images rgba16f"}, vector_tiles_rich_images,
            kRichImages, shader::kRichArguments);
  b.painted({"crowded all, images", "crowded all, images rgba8", "crowded all, images rgba16f"},
            vector_crowded_rich_images, kRichImages, shader::kRichCrowdedArguments);
}

} // namespace gpgp::vector
