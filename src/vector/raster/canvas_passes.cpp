// The passes of the canvas, and how much room their lists have.
#include "vector/raster/canvas_passes.h"

#include "shaders/vector_allocate.spv.h"
#include "shaders/vector_allocate_rows.spv.h"
#include "shaders/vector_allocate_software.spv.h"
#include "shaders/vector_allocate_subgroups.spv.h"
#include "shaders/vector_aside_rich.spv.h"
#include "shaders/vector_aside_rich_images.spv.h"
#include "shaders/vector_aside_rich_one.spv.h"
#include "shaders/vector_begin.spv.h"
#include "shaders/vector_begin_alone.spv.h"
#include "shaders/vector_begin_software.spv.h"
#include "shaders/vector_clear_entries.spv.h"
#include "shaders/vector_clear_words.spv.h"
#include "shaders/vector_crowded0.spv.h"
#include "shaders/vector_crowded1.spv.h"
#include "shaders/vector_crowded2.spv.h"
#include "shaders/vector_crowded_images0.spv.h"
#include "shaders/vector_crowded_images1.spv.h"
#include "shaders/vector_crowded_images2.spv.h"
#include "shaders/vector_crowded_paints0.spv.h"
#include "shaders/vector_crowded_paints1.spv.h"
#include "shaders/vector_crowded_paints2.spv.h"
#include "shaders/vector_crowded_paints_one0.spv.h"
#include "shaders/vector_crowded_paints_one1.spv.h"
#include "shaders/vector_crowded_paints_one2.spv.h"
#include "shaders/vector_crowded_rich0.spv.h"
#include "shaders/vector_crowded_rich1.spv.h"
#include "shaders/vector_crowded_rich2.spv.h"
#include "shaders/vector_crowded_rich_images0.spv.h"
#include "shaders/vector_crowded_rich_images1.spv.h"
#include "shaders/vector_crowded_rich_images2.spv.h"
#include "shaders/vector_fill.spv.h"
#include "shaders/vector_fill_backdrop.spv.h"
#include "shaders/vector_fill_one.spv.h"
#include "shaders/vector_fill_pieces.spv.h"
#include "shaders/vector_fill_pieces_one.spv.h"
#include "shaders/vector_fill_pieces_one_subgroups.spv.h"
#include "shaders/vector_fill_pieces_subgroups.spv.h"
#include "shaders/vector_fill_projective.spv.h"
#include "shaders/vector_fill_rows.spv.h"
#include "shaders/vector_fill_rows_one.spv.h"
#include "shaders/vector_fill_rows_sixteen.spv.h"
#include "shaders/vector_fill_software.spv.h"
#include "shaders/vector_fill_software_one.spv.h"
#include "shaders/vector_fill_software_projective.spv.h"
#include "shaders/vector_mark.spv.h"
#include "shaders/vector_mark_one.spv.h"
#include "shaders/vector_mark_pieces.spv.h"
#include "shaders/vector_mark_pieces_one.spv.h"
#include "shaders/vector_mark_pieces_one_subgroups.spv.h"
#include "shaders/vector_mark_pieces_projective.spv.h"
#include "shaders/vector_mark_pieces_projective_subgroups.spv.h"
#include "shaders/vector_mark_pieces_subgroups.spv.h"
#include "shaders/vector_mark_projective.spv.h"
#include "shaders/vector_mark_sixteen.spv.h"
#include "shaders/vector_pack.spv.h"
#include "shaders/vector_pack_subgroups.spv.h"
#include "shaders/vector_place.spv.h"
#include "shaders/vector_place_one.spv.h"
#include "shaders/vector_place_projective.spv.h"
#include "shaders/vector_raster0.spv.h"
#include "shaders/vector_raster1.spv.h"
#include "shaders/vector_raster2.spv.h"
#include "shaders/vector_raster_glyphs0.spv.h"
#include "shaders/vector_raster_glyphs1.spv.h"
#include "shaders/vector_raster_glyphs2.spv.h"
#include "shaders/vector_raster_images0.spv.h"
#include "shaders/vector_raster_images1.spv.h"
#include "shaders/vector_raster_images2.spv.h"
#include "shaders/vector_raster_paints0.spv.h"
#include "shaders/vector_raster_paints1.spv.h"
#include "shaders/vector_raster_paints2.spv.h"
#include "shaders/vector_raster_paints_one0.spv.h"
#include "shaders/vector_raster_paints_one1.spv.h"
#include "shaders/vector_raster_paints_one2.spv.h"
#include "shaders/vector_raster_rich0.spv.h"
#include "shaders/vector_raster_rich1.spv.h"
#include "shaders/vector_raster_rich2.spv.h"
#include "shaders/vector_raster_rich_images0.spv.h"
#include "shaders/vector_raster_rich_images1.spv.h"
#include "shaders/vector_raster_rich_images2.spv.h"
#include "shaders/vector_raster_rich_one0.spv.h"
#include "shaders/vector_raster_rich_one1.spv.h"
#include "shaders/vector_raster_rich_one2.spv.h"
#include "shaders/vector_sift.spv.h"
#include "shaders/vector_sift_split.spv.h"
#include "shaders/vector_split.spv.h"
#include "shaders/vector_split_one.spv.h"
#include "shaders/vector_small_glyphs.spv.h"
#include "shaders/vector_small_glyphs_alone.spv.h"
#include "shaders/vector_small_glyphs_alone_one.spv.h"
#include "shaders/vector_small_glyphs_alone_one_subgroups.spv.h"
#include "shaders/vector_small_glyphs_alone_sixteen.spv.h"
#include "shaders/vector_small_glyphs_alone_sixteen_subgroups.spv.h"
#include "shaders/vector_small_glyphs_alone_subgroups.spv.h"
#include "shaders/vector_small_glyphs_one.spv.h"
#include "shaders/vector_small_glyphs_one_subgroups.spv.h"
#include "shaders/vector_small_glyphs_subgroups.spv.h"
#include "shaders/vector_tiles0.spv.h"
#include "shaders/vector_tiles1.spv.h"
#include "shaders/vector_tiles2.spv.h"
#include "shaders/vector_tiles_images0.spv.h"
#include "shaders/vector_tiles_images1.spv.h"
#include "shaders/vector_tiles_images2.spv.h"
#include "shaders/vector_tiles_paints0.spv.h"
#include "shaders/vector_tiles_paints1.spv.h"
#include "shaders/vector_tiles_paints2.spv.h"
#include "shaders/vector_tiles_paints_one0.spv.h"
#include "shaders/vector_tiles_paints_one1.spv.h"
#include "shaders/vector_tiles_paints_one2.spv.h"
#include "shaders/vector_tiles_rich0.spv.h"
#include "shaders/vector_tiles_rich1.spv.h"
#include "shaders/vector_tiles_rich2.spv.h"
#include "shaders/vector_tiles_rich_images0.spv.h"
#include "shaders/vector_tiles_rich_images1.spv.h"
#include "shaders/vector_tiles_rich_images2.spv.h"
#include "shaders/vector_tiles_rows0.spv.h"
#include "shaders/vector_tiles_rows1.spv.h"
#include "shaders/vector_tiles_rows2.spv.h"
#include "shaders/vector_tiles_solid0.spv.h"
#include "shaders/vector_tiles_solid1.spv.h"
#include "shaders/vector_tiles_solid2.spv.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

namespace gpgp::vector {
using shader::CanvasCounters;
using shader::CanvasHeader;
using shader::ItemRecord;
using shader::kMaxSlots;
using shader::PlacementRecord;
using shader::SlotRecord;

uint64_t Canvas::tiles() const {
  return uint64_t(divide(maxWidth_, shader::kTileSize)) * divide(maxHeight_, shader::kTileSize);
}
uint32_t Canvas::listWords() const { // 31 paths a tile, fewer where that would take more than 64 MiB
  return static_cast<uint32_t>(std::clamp<uint64_t>((uint64_t(16) << 20) / tiles(), 12, 64) & ~uint64_t(3));
}

uint64_t Canvas::binWords() const { // enough for any record with the largest bins, or for most with the smallest
  constexpr uint32_t kLargest = shader::kTileSize << shader::kMaxBinShift;
  const uint64_t least = uint64_t(divide(maxWidth_, kLargest)) * divide(maxHeight_, kLargest) *
                         (divide(budgets_.paths, 32) + shader::kBinHead);
  return software_ ? least : std::max(least, std::min<uint64_t>(least * 6, 16 << 20));
}
// Paths in the lists of all bins: most paths are in one or two.
uint32_t Canvas::binLists() const { return software_ ? 0 : 2 * budgets_.paths + 65536; }

uint64_t Canvas::binsEnd() const {
  const uint64_t lists = tiles() * (software_ ? listWords() + 3 : 2) + binLists();
  // Of small glyphs alone the tiles have lists in place of bins and theirs, and some are left over.
  const uint64_t ofTiles = tiles() * shader::kTileListWords + uint64_t(smallGlyphRoom()) * 3;
  return shader::kFirstBin + std::max(binWords() + 3 + lists, software_ ? 0 : std::min<uint64_t>(ofTiles, 16 << 20));
}

core::PassList Canvas::describe() const {
  using enum core::ResourceKind;
  using enum core::UseKind;
  using Spirv = std::span<const uint32_t>;
  core::PassList list(&context.host());
  static constexpr const char* kNames[kMaxSlots] = {"drawing 0", "drawing 1", "drawing 2", "drawing 3",
                                                    "drawing 4", "drawing 5", "drawing 6", "drawing 7"};
  for (const char* name : kNames) list.add({name, buffer, 0, true});
  const auto view = list.add({"view", buffer, 0, true});
  const auto image8 = list.add({"target", image, 0, true});
  const auto image16 = list.add({"target", image, 0, true});
  const VkDeviceSize heads = sizeof(CanvasHeader) + shader::kSlots * sizeof(SlotRecord),
                     placed = VkDeviceSize(budgets_.items) + budgets_.glyphs + budgets_.shapes,
                     shapeBytes = budgets_.shapes * VkDeviceSize(sizeof(shader::ShapeRecord) + sizeof(PaintRecord) +
                                                                 2 * sizeof(StopRecord)) +
                                  budgets_.items * VkDeviceSize(sizeof(shader::ItemClipRecord) + sizeof(LayerRecord));
  const auto fromHost =
      list.add({"constants", core::ResourceKind::constants,
                heads + budgets_.items * sizeof(ItemRecord) + placed * sizeof(PlacementRecord) + shapeBytes});
  const auto paths = list.add({"paths", scratch, VkDeviceSize(budgets_.paths) * sizeof(shader::PlacedPath)});
  const auto words = list.add({"tile words", scratch, VkDeviceSize(maxWords_) * sizeof(shader::TileWord)});
  const auto masks = list.add({"bins", scratch, binsEnd() * 4});
  const auto entries = list.add({"entries", scratch, VkDeviceSize(maxEntries_) * shader::kEntryWords * 4});
  const auto counters = list.add({"counters", scratch, sizeof(CanvasCounters)});

  const auto params = list.add({"items", scratch, heads + shader::kFirstItems * 4 + placed * sizeof(ItemRecord)});
  core::ResourceIndex images = 0; // the first
  static constexpr const char* kImageNames[shader::kMaxImages] = {"images[0]", "images[1]", "images[2]", "images[3]",
                                                                  "images[4]", "images[5]", "images[6]", "images[7]"};
  for (uint32_t i = 0; i < shader::kMaxImages; ++i) {
    const auto added = list.add({kImageNames[i], texture, 0, true});
    if (i == 0) images = added;
  }
  // Software devices have lists of pieces and of rows of tiles there (pieces.glsl), and a flattened segment behind all, which
  // invocations write that have none.
  const VkDeviceSize flatSegmentBytes =
      software_ ? (VkDeviceSize(maxRows()) + 1) * 16 : VkDeviceSize(maxRows()) * sizeof(shader::FlatSegmentRecord);
  const auto flatSegments = list.add({"flatSegments", scratch, flatSegmentBytes});
  const auto rowList = list.add(
      {"rows of flatSegments", scratch, software_ ? VkDeviceSize(maxWords_ + maxRows()) * 16 : VkDeviceSize(maxRows()) * 4});
  const auto shapes = list.add({"shapes", scratch, shapeBytes});
  const VkDeviceSize keptTiles = software_ ? 0 : std::min<VkDeviceSize>(tiles(), shader::kTilesAside);
  const auto aside = list.add({"tiles painted aside", scratch, std::max<VkDeviceSize>(keptTiles * 64 * 16, 16)});
  assert(images == kFirstImage && flatSegments == kFlatSegmentList && shapes == kShapes && aside == kAsideTiles);
  const auto useImages = [images](core::Pass& pass) {
    for (uint32_t i = 0; i < shader::kMaxImages; ++i) pass.uses[pass.useCount++] = {images + i, read};
  };

  if (software_) {
    list.fill("clear counters", counters, 0);
    list.dispatch("begin", list.add(core::ShaderDesc{"begin", vector_begin_software}),
                  {{fromHost, read}, {params, write}, {masks, write}, {shapes, write}}, kBegin);
  } else {
    list.dispatch(
            "begin", list.add(core::ShaderDesc{"begin", vector_begin}),
            {{fromHost, read}, {params, write}, {masks, write}, {shapes, write}, {words, write}, {counters, write}},
            kBegin)
        .condition = kPlaced;
    core::Pass& alone =
        list.dispatch("begin, glyphs alone", list.add(core::ShaderDesc{"begin, glyphs alone", vector_begin_alone}),
                      {{fromHost, read}, {params, write}, {masks, write}, {counters, write}}, kBegin);
    alone.condition = kAlone;
    alone.beside = true;
  }
  const auto dispatch = [&](const char* name, const core::ShaderDesc& shader, std::initializer_list<core::Use> uses,
                            uint32_t groups) -> core::Pass& {
    core::Pass& pass = list.dispatch(name, list.add(shader), {{params, read}, {shapes, read}}, groups);
    for (core::ResourceIndex i = 0; i < kMaxSlots; ++i) pass.uses[pass.useCount++] = {i, read};
    for (const core::Use& use : uses) pass.uses[pass.useCount++] = use;
    return pass;
  };
  const bool subgroups = context.device.subgroupArithmetic && (software_ || context.device.subgroupSize >= 32);
  if (!software_) {
    const auto smallGlyph = [&](const core::ShaderDesc& shader, uint32_t condition) -> core::Pass& {
      core::Pass& pass = dispatch(
          shader.name, shader,
          {{fromHost, read}, {paths, write}, {masks, readWrite}, {counters, readWrite}, {entries, write}}, kSmallGlyphs);
      pass.condition = condition;
      return pass;
    };
    smallGlyph({"small glyphs, glyphs alone, 16 samples",
           subgroups ? Spirv(vector_small_glyphs_alone_sixteen_subgroups) : Spirv(vector_small_glyphs_alone_sixteen)},
          kAloneSixteen);
    smallGlyph({"small glyphs, glyphs alone", subgroups ? Spirv(vector_small_glyphs_alone_one_subgroups) : Spirv(vector_small_glyphs_alone_one)},
          kAloneOne)
        .beside = true;
    smallGlyph({"small glyphs, glyphs alone, several drawings",
           subgroups ? Spirv(vector_small_glyphs_alone_subgroups) : Spirv(vector_small_glyphs_alone)},
          kAloneDrawings)
        .beside = true;
  }
  // Shaders that fetch from drawings come in three forms: one need not choose among drawings at each access, two know
  // no projective items.
  const auto either = [&](std::array<const char*, 3> names, std::array<Spirv, 3> spirv,
                          std::initializer_list<core::Use> uses, uint32_t groups, uint32_t condition) {
    for (uint32_t k = 0; k < 3; ++k) {
      core::Pass& pass = dispatch(names[k], {names[k], spirv[k]}, uses, groups);
      pass.condition = condition + k;
      pass.beside = k > 0; // of the three one is recorded: the first one's barrier is all of theirs
    }
  };
  either({"place", "place, several drawings", "place, projective"},
         {vector_place_one, vector_place, vector_place_projective},
         {{paths, readWrite}, {words, readWrite}, {masks, readWrite}, {counters, readWrite}}, kPaths, kOneDrawing);
  const auto clear = [&](const core::ShaderDesc& shader, core::ResourceIndex what) {
    list.dispatch(shader.name, list.add(shader), {{params, read}, {counters, read}, {what, write}}, kClear).condition =
        kPlaced;
  };
  if (software_) clear({"clear words", vector_clear_words}, words);
  if (!software_) {
    const auto smallGlyph = [&](const core::ShaderDesc& shader, uint32_t condition) -> core::Pass& {
      core::Pass& pass = dispatch(shader.name, shader,
                                  {{paths, read}, {words, write}, {counters, readWrite}, {entries, write}}, kSmallGlyphs);
      pass.condition = condition;
      return pass;
    };
    smallGlyph({"small glyphs", subgroups ? Spirv(vector_small_glyphs_one_subgroups) : Spirv(vector_small_glyphs_one)}, kSmallGlyphOne);
    smallGlyph({"small glyphs, several drawings", subgroups ? Spirv(vector_small_glyphs_subgroups) : Spirv(vector_small_glyphs)}, kSmallGlyphDrawings)
        .beside = true;
  }
  const std::array<Spirv, 3> mark =
      !software_  ? std::array<Spirv, 3>{vector_mark_one, vector_mark, vector_mark_projective}
      : subgroups ? std::array<Spirv, 3>{vector_mark_pieces_one_subgroups, vector_mark_pieces_subgroups,
                                         vector_mark_pieces_projective_subgroups}
                  : std::array<Spirv, 3>{vector_mark_pieces_one, vector_mark_pieces, vector_mark_pieces_projective};
  const std::initializer_list<core::Use> markUses = {{paths, read},   {words, readWrite}, {counters, readWrite},
                                                     {flatSegments, write}, {rowList, write},   {entries, write}};
  either({"mark", "mark, several drawings", "mark, projective"}, mark, markUses, kSegments, kMarkOne);
  if (!software_) { // the usual samples, which the compiler knows
    core::Pass& pass = dispatch("mark, 16 samples", {"mark, 16 samples", vector_mark_sixteen}, markUses, kSegments);
    pass.condition = kMarkSixteen;
    pass.beside = true;
    core::Pass& pack = list.dispatch(
        "pack", list.add(core::ShaderDesc{"pack", subgroups ? Spirv(vector_pack_subgroups) : vector_pack}),
        {{params, read}, {masks, readWrite}, {counters, readWrite}}, kPacks);
    pack.condition = kPlaced;
    pack.beside = true;
  }
  const auto allocate = [&](const core::ShaderDesc& shader, uint32_t groups, bool listing) {
    core::Pass& pass = dispatch(
        shader.name, shader, {{paths, read}, {words, readWrite}, {entries, readWrite}, {counters, readWrite}}, groups);
    pass.condition = kPlaced;
    if (!listing) return;
    pass.uses[pass.useCount++] = {flatSegments, read};
    pass.uses[pass.useCount++] = {rowList, readWrite};
  };
  // From lists, or, where these did not suffice, without them; allocate says which.
  const auto fill = [&](const core::ShaderDesc& shader, bool fromLists, uint32_t condition, bool beside) {
    core::Pass& pass =
        list.dispatchIndirect(shader.name, list.add(shader),
                              {{params, read},
                               {shapes, read},
                               {paths, read},
                               {words, read},
                               {counters, read},
                               {entries, readWrite},
                               {flatSegments, read},
                               {rowList, read}},
                              counters, fromLists ? offsetof(CanvasCounters, rowsX) : offsetof(CanvasCounters, fillX));
    for (core::ResourceIndex i = 0; i < kMaxSlots; ++i) pass.uses[pass.useCount++] = {i, read};
    pass.condition = condition;
    pass.beside = beside;
  };
  static constexpr const char* kFills[] = {"fill", "fill, several drawings", "fill, projective"};
  static constexpr const char* kUnlisted[] = {"fill without lists", "fill without lists, several drawings",
                                              "fill without lists, projective"};
  if (software_) {
    allocate({"allocate", vector_allocate_rows}, kWords, true);
    allocate({"allocate again", vector_allocate_software}, kOnce, false);
    clear({"clear entries", vector_clear_entries}, entries);
    const Spirv listedOne = subgroups ? Spirv(vector_fill_pieces_one_subgroups) : Spirv(vector_fill_pieces_one),
                listedAll = subgroups ? Spirv(vector_fill_pieces_subgroups) : Spirv(vector_fill_pieces);
    const std::array<Spirv, 3> listed = {listedOne, listedAll, listedAll},
                               unlisted = {vector_fill_software_one, vector_fill_software,
                                           vector_fill_software_projective};
    for (uint32_t k = 0; k < 3; ++k) {
      core::Pass& pass = list.dispatch(kFills[k], list.add(core::ShaderDesc{kFills[k], listed[k]}),
                                       {{params, read},
                                        {paths, read},
                                        {words, read},
                                        {counters, readWrite},
                                        {flatSegments, read},
                                        {rowList, read},
                                        {entries, readWrite}},
                                       kFill);
      pass.condition = kMarkOne + k;
      pass.beside = k > 0;
    }
    list.dispatch(
            "backdrop", list.add(core::ShaderDesc{"backdrop", vector_fill_backdrop}),
            {{params, read}, {paths, read}, {words, read}, {counters, read}, {rowList, read}, {entries, readWrite}},
            kFill)
        .condition = kPlaced;
    fill({"clear entries again", vector_clear_entries}, false, kPlaced, false);
    for (uint32_t k = 0; k < 3; ++k) fill({kUnlisted[k], unlisted[k]}, false, kMarkOne + k, k > 0);
  } else {
    allocate({"allocate", subgroups ? Spirv(vector_allocate_subgroups) : vector_allocate}, kWords, false);
    const auto split = [&](const core::ShaderDesc& shader, uint32_t condition) -> core::Pass& {
      core::Pass& pass =
          dispatch(shader.name, shader, {{paths, read}, {words, read}, {masks, readWrite}, {counters, read}}, kSplits);
      pass.condition = condition;
      return pass;
    };
    split({"split, several drawings", vector_split}, kSplit);
    split({"split", vector_split_one}, kSplitOne).beside = true;
    const std::array<Spirv, 3> listed = {vector_fill_rows_one, vector_fill_rows, vector_fill_rows},
                               unlisted = {vector_fill_one, vector_fill, vector_fill_projective};
    // Split's barrier, which is owed where that is left out, is all of theirs.
    fill({"fill, 16 samples", vector_fill_rows_sixteen}, true, kMarkSixteen, true);
    for (uint32_t k = 0; k < 3; ++k) fill({kFills[k], listed[k]}, true, kMarkOne + k, true);
    for (uint32_t k = 0; k < 3; ++k) fill({kUnlisted[k], unlisted[k]}, false, kOneDrawing + k, true);
  }
  // By target: the view alone, rgba8, rgba16f; those alone that the canvas writes.
  const auto addTarget = [&](core::Pass& pass, uint32_t target, uint32_t condition) {
    if (target != kNoImage) pass.uses[pass.useCount++] = {target == kHasImage8 ? image8 : image16, write};
    pass.condition = condition + target;
  };
  const auto raster = [&](std::array<const char*, 3> names, std::array<Spirv, 3> spirv, uint32_t condition) {
    for (uint32_t t = 0; t < 3; ++t) {
      if (!writes(t)) continue;
      core::Pass& pass = dispatch(
          names[t], {names[t], spirv[t]},
          {{paths, read}, {words, read}, {masks, read}, {entries, read}, {counters, read}, {view, write}}, kRaster);
      if (condition == kImages || condition == kRichImages) useImages(pass);
      addTarget(pass, t, condition);
    }
  };
  // Tiles from lists that passes before have written.
  const auto tilesOf = [&](const core::ShaderDesc& shader, uint32_t condition, VkDeviceSize arguments) -> core::Pass& {
    const bool crowded = arguments == shader::kCrowdedArguments || arguments == shader::kRichCrowdedArguments;
    core::Pass& pass = list.dispatchIndirect(shader.name, list.add(shader),
                                             {{params, read},
                                              {shapes, read},
                                              {paths, read},
                                              {words, read},
                                              {masks, read},
                                              {entries, read},
                                              {counters, crowded ? readWrite : read}},
                                             masks, arguments * 4);
    const bool one = condition == kPlain || condition == kPaintsOne || condition == kRichOne || condition == kAsideOne;
    for (core::ResourceIndex i = 0; i < (one ? 1 : kMaxSlots); ++i) pass.uses[pass.useCount++] = {i, read};
    if (condition == kImages || condition == kRichImages || condition == kAsideImages) useImages(pass);
    return pass;
  };
  const auto painted = [&](std::array<const char*, 3> names, std::array<Spirv, 3> spirv, uint32_t condition,
                           VkDeviceSize arguments) {
    for (uint32_t t = 0; t < 3; ++t) {
      if (!writes(t)) continue;
      core::Pass& pass = tilesOf({names[t], spirv[t]}, condition, arguments);
      pass.uses[pass.useCount++] = {view, write};
      if (!software_) pass.uses[pass.useCount++] = {aside, read};
      addTarget(pass, t, condition);
    }
  };
  if (software_) {
    const auto sift = [&](const core::ShaderDesc& shader, uint32_t condition) -> core::Pass& {
      core::Pass& pass = dispatch(shader.name, shader,
                                  {{paths, read}, {words, read}, {masks, readWrite}, {counters, readWrite}}, kSift);
      pass.condition = condition;
      return pass;
    };
    sift({"sift", vector_sift}, kSiftPlain);
    sift({"sift, groups", vector_sift_split}, kSplit).beside = true;
    const std::array<const char*, 3> solid = {"solid tiles", "solid tiles rgba8", "solid tiles rgba16f"};
    const std::array<Spirv, 3> shaders = {vector_tiles_solid0, vector_tiles_solid1, vector_tiles_solid2};
    for (uint32_t t = 0; t < 3; ++t)
      if (writes(t))
        addTarget(dispatch(solid[t], {solid[t], shaders[t]}, {{masks, read}, {view, write}}, kTiles), t, kAny);
    const std::array<const char*, 3> byRows = {"raster rows", "raster rows rgba8", "raster rows rgba16f"};
    const std::array<Spirv, 3> rowShaders = {vector_tiles_rows0, vector_tiles_rows1, vector_tiles_rows2};
    for (uint32_t t = 0; t < 3; ++t)
      if (writes(t))
        addTarget(list.dispatchIndirect(
                      byRows[t], list.add(core::ShaderDesc{byRows[t], rowShaders[t]}),
                      {{params, read}, {paths, read}, {masks, read}, {entries, read}, {counters, read}, {view, write}},
                      counters, offsetof(CanvasCounters, tilesX)),
                  t, kAny);
    painted({"raster", "raster rgba8", "raster rgba16f"}, {vector_tiles0, vector_tiles1, vector_tiles2}, kPlain,
            shader::kPaintedArguments);
    painted({"raster gradients, several drawings", "raster gradients rgba8, several drawings",
             "raster gradients rgba16f, several drawings"},
            {vector_tiles_paints0, vector_tiles_paints1, vector_tiles_paints2}, kPaints, shader::kPaintedArguments);
    painted({"raster gradients", "raster gradients rgba8", "raster gradients rgba16f"},
            {vector_tiles_paints_one0, vector_tiles_paints_one1, vector_tiles_paints_one2}, kPaintsOne,
            shader::kPaintedArguments);
    painted({"crowded", "crowded rgba8", "crowded rgba16f"}, {vector_crowded0, vector_crowded1, vector_crowded2},
            kPlain, shader::kCrowdedArguments);
    painted({"crowded gradients, several drawings", "crowded gradients rgba8, several drawings",
             "crowded gradients rgba16f, several drawings"},
            {vector_crowded_paints0, vector_crowded_paints1, vector_crowded_paints2}, kPaints,
            shader::kCrowdedArguments);
    painted({"crowded gradients", "crowded gradients rgba8", "crowded gradients rgba16f"},
            {vector_crowded_paints_one0, vector_crowded_paints_one1, vector_crowded_paints_one2}, kPaintsOne,
            shader::kCrowdedArguments);
    painted({"raster all", "raster all rgba8", "raster all rgba16f"},
            {vector_tiles_rich0, vector_tiles_rich1, vector_tiles_rich2}, kRich, shader::kRichArguments);
    painted({"crowded all", "crowded all rgba8", "crowded all rgba16f"},
            {vector_crowded_rich0, vector_crowded_rich1, vector_crowded_rich2}, kRich, shader::kRichCrowdedArguments);
    painted({"raster images", "raster images rgba8", "raster images rgba16f"},
            {vector_tiles_images0, vector_tiles_images1, vector_tiles_images2}, kImages, shader::kPaintedArguments);
    painted({"crowded images", "crowded images rgba8", "crowded images rgba16f"},
            {vector_crowded_images0, vector_crowded_images1, vector_crowded_images2}, kImages,
            shader::kCrowdedArguments);
    painted({"raster all, images", "raster all, images rgba8", "raster all, images rgba16f"},
            {vector_tiles_rich_images0, vector_tiles_rich_images1, vector_tiles_rich_images2}, kRichImages,
            shader::kRichArguments);
    painted({"crowded all, images", "crowded all, images rgba8", "crowded all, images rgba16f"},
            {vector_crowded_rich_images0, vector_crowded_rich_images1, vector_crowded_rich_images2}, kRichImages,
            shader::kRichCrowdedArguments);
  } else {
    // The general shader's tiles are painted beside the others, and first, as there are few and each takes long. They
    // are put aside, as two passes that write one image must not run beside each other.
    const auto asideOf = [&](const core::ShaderDesc& shader, uint32_t condition) {
      core::Pass& pass = tilesOf(shader, condition, shader::kRichArguments);
      pass.uses[pass.useCount++] = {aside, write};
      pass.condition = condition;
    };
    asideOf({"aside, several drawings", vector_aside_rich}, kAside);
    const size_t first = list.passes.size(); // the pass before has the barrier of all up to the last raster pass
    asideOf({"aside", vector_aside_rich_one}, kAsideOne);
    asideOf({"aside, images", vector_aside_rich_images}, kAsideImages);
    raster({"raster", "raster rgba8", "raster rgba16f"}, {vector_raster0, vector_raster1, vector_raster2}, kPlain);
    raster({"raster gradients, several drawings", "raster gradients rgba8, several drawings",
            "raster gradients rgba16f, several drawings"},
           {vector_raster_paints0, vector_raster_paints1, vector_raster_paints2}, kPaints);
    raster({"raster gradients", "raster gradients rgba8", "raster gradients rgba16f"},
           {vector_raster_paints_one0, vector_raster_paints_one1, vector_raster_paints_one2}, kPaintsOne);
    raster({"raster images", "raster images rgba8", "raster images rgba16f"},
           {vector_raster_images0, vector_raster_images1, vector_raster_images2}, kImages);
    raster({"raster, glyphs alone", "raster rgba8, glyphs alone", "raster rgba16f, glyphs alone"},
           {vector_raster_glyphs0, vector_raster_glyphs1, vector_raster_glyphs2}, kGlyphs);
    for (size_t i = first; i < list.passes.size(); ++i) list.passes[i].beside = true;
    painted(
        {"raster all, several drawings", "raster all rgba8, several drawings", "raster all rgba16f, several drawings"},
        {vector_raster_rich0, vector_raster_rich1, vector_raster_rich2}, kRich, shader::kRichArguments);
    painted({"raster all", "raster all rgba8", "raster all rgba16f"},
            {vector_raster_rich_one0, vector_raster_rich_one1, vector_raster_rich_one2}, kRichOne,
            shader::kRichArguments);
    painted({"raster all, images", "raster all, images rgba8", "raster all, images rgba16f"},
            {vector_raster_rich_images0, vector_raster_rich_images1, vector_raster_rich_images2}, kRichImages,
            shader::kRichArguments);
  }
  list.report = counters;
  list.reportBytes = sizeof(CanvasCounters);
  return list;
}

} // namespace gpgp::vector
