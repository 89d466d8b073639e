// From tiles to pixels, front to back.
#include "vector/passes/builder.h"

namespace gpgp::vector {
using enum core::UseKind;

void addImages(PassBuilder& b) {
  if (b.sizes.imagePages < 2) return;
  core::Pass& pass =
      b.dispatch("images", b.sizes.software ? vector_images_software : vector_images,
                 {{b.paths, read}, {b.words, read}, {b.entries, read}, {b.counters, read}, {b.imageColors, readWrite}},
                 kImageTiles, kImagePages);
  pass.paged = true;
  b.useImages(pass);
}

void addRaster(PassBuilder& b) {
  // The general shader's tiles are painted beside the others, and first, as there are few and each takes long. They
  // are put aside, as two passes that write one image must not run beside each other.
  const auto asideOf = [&](const char* name, Spirv spirv, uint32_t condition) {
    core::Pass& pass = b.listedTiles(name, spirv, condition, shader::kRichArguments);
    pass.uses[pass.useCount++] = {b.aside, write};
    pass.condition = condition;
    return &pass;
  };
  core::Pass& barrier = *asideOf("aside, several drawings", vector_aside_rich, kAside);
  if (b.sizes.imagePages > 1) barrier.uses[barrier.useCount++] = {b.imageColors, read}; // as passes beside it do
  const size_t first = b.list.passes.size(); // the pass before has the barrier of all up to the last raster pass
  asideOf("aside", vector_aside_rich_one, kAsideOne);
  asideOf("aside, images", vector_aside_rich_images, kAsideImages);

  struct Raster {
    FormNames names; // by target, as the shaders
    const Forms& spirv;
    uint32_t condition;
  };
  for (const Raster& raster : std::initializer_list<Raster>{
           {{"raster", "raster rgba8", "raster rgba16f"}, vector_raster_plain, kPlain},
           {{"raster gradients, several drawings", "raster gradients rgba8, several drawings",
             "raster gradients rgba16f, several drawings"},
            vector_raster_paints,
            kPaints},
           {{"raster gradients", "raster gradients rgba8", "raster gradients rgba16f"},
            vector_raster_paints_one,
            kPaintsOne},
           {{"raster images", "raster images rgba8", "raster images rgba16f"}, vector_raster_images, kImages},
           {{"raster, glyphs alone", "raster rgba8, glyphs alone", "raster rgba16f, glyphs alone"},
            vector_raster_glyphs,
            kGlyphs}})
    for (uint32_t t = 0; t < 3; ++t) {
      if (!b.sizes.rasters(t)) continue;
      core::Pass& pass = b.dispatch(
          raster.names[t], raster.spirv[t],
          {{b.paths, read}, {b.words, read}, {b.bins, read}, {b.entries, read}, {b.counters, read}, {b.history, write}},
          kRaster, raster.condition);
      if (raster.condition == kImages) b.useImages(pass);
      b.target(pass, t, raster.condition);
    }
  for (size_t i = first; i < b.list.passes.size(); ++i) b.list.passes[i].beside = true;

  b.painted(
      {"raster all, several drawings", "raster all rgba8, several drawings", "raster all rgba16f, several drawings"},
      vector_raster_rich, kRich, shader::kRichArguments);
  b.painted({"raster all", "raster all rgba8", "raster all rgba16f"}, vector_raster_rich_one, kRichOne,
            shader::kRichArguments);
  b.painted({"raster all, images", "raster all, images rgba8", "raster all, images rgba16f"}, vector_raster_rich_images,
            kRichImages, shader::kRichArguments);
}

} // namespace gpgp::vector
