// The passes of the canvas, the checks of a record, and what a record fills in.
#include "vector/raster/canvas.h"

#include "shaders/vector_allot.spv.h"
#include "shaders/vector_allot_software.spv.h"
#include "shaders/vector_aside_rich.spv.h"
#include "shaders/vector_aside_rich_images.spv.h"
#include "shaders/vector_aside_rich_one.spv.h"
#include "shaders/vector_begin.spv.h"
#include "shaders/vector_begin_software.spv.h"
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
#include "shaders/vector_draw_frag.spv.h"
#include "shaders/vector_draw_frag_multiview.spv.h"
#include "shaders/vector_draw_vert.spv.h"
#include "shaders/vector_draw_vert_multiview.spv.h"
#include "shaders/vector_fill.spv.h"
#include "shaders/vector_fill_one.spv.h"
#include "shaders/vector_fill_projective.spv.h"
#include "shaders/vector_fill_rows.spv.h"
#include "shaders/vector_fill_rows_one.spv.h"
#include "shaders/vector_fill_software.spv.h"
#include "shaders/vector_fill_software_one.spv.h"
#include "shaders/vector_fill_software_projective.spv.h"
#include "shaders/vector_mark.spv.h"
#include "shaders/vector_mark_one.spv.h"
#include "shaders/vector_mark_projective.spv.h"
#include "shaders/vector_mark_software.spv.h"
#include "shaders/vector_mark_software_one.spv.h"
#include "shaders/vector_mark_software_projective.spv.h"
#include "shaders/vector_pack.spv.h"
#include "shaders/vector_place.spv.h"
#include "shaders/vector_place_one.spv.h"
#include "shaders/vector_place_projective.spv.h"
#include "shaders/vector_raster0.spv.h"
#include "shaders/vector_raster1.spv.h"
#include "shaders/vector_raster2.spv.h"
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
#include "shaders/vector_split.spv.h"
#include "shaders/vector_split_one.spv.h"
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
#include "shaders/vector_tiles_solid0.spv.h"
#include "shaders/vector_tiles_solid1.spv.h"
#include "shaders/vector_tiles_solid2.spv.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace gpgp::vector {
namespace {
using core::makeError;
using core::Result;
using shader::CanvasCounters;
using shader::CanvasHeader;
using shader::ItemRecord;
using shader::kMaxSlots;
using shader::PlacementRecord;
using shader::SlotRecord;

// Resources are numbered as the shaders bind them (canvas.glsl): 0 to 7 drawings, then these.
constexpr core::ResourceIndex kView = 8, kImage8 = 9, kImage16 = 10, kFirstImage = 18;
[[maybe_unused]] constexpr core::ResourceIndex kChordList = 26, kShapes = 28, kAsideTiles = 29;
// Workgroup counts and conditions of a record.
enum Groups : uint32_t { kBegin, kPaths, kSegments, kWords, kRaster, kTiles, kSift, kBins, kSplits };
constexpr uint32_t kNoImage = 0, kHasImage8 = 1, kHasImage16 = 2; // added to those that are multiples of three
enum Conditions : uint32_t {
  kPlain = 0,
  kPaints = 3,
  kPaintsOne = 6,
  kRich = 9,
  kRichOne = 12,
  kImages = 15,
  kRichImages = 18,
  kAny = 21,
  kOneDrawing = 24,
  kDrawings,
  kProjective,
  kSplit,
  kSplitOne,
  kAside,
  kAsideOne,
  kAsideImages
};
static_assert(kAsideImages < core::kMaxConditions);

uint32_t divide(uint64_t a, uint32_t b) { return static_cast<uint32_t>((a + b - 1) / b); }
/// As many workgroups, in rows (canvas.glsl, groupIndex).
std::array<uint32_t, 3> rows(uint32_t groups) { return {std::min(groups, 32768u), divide(groups, 32768), 1}; }
} // namespace

Canvas::Canvas(core::Context& owner, const GpgpCanvasCreateInfo& info)
    : Worker(owner, core::Kind::canvas, info.base, GPGP_SERVICE_VECTOR),
      maxWidth_(info.maxWidth ? info.maxWidth : 2048), maxHeight_(info.maxHeight ? info.maxHeight : 2048),
      maxEntries_(info.maxTileEntries ? info.maxTileEntries : 131072),
      maxWords_(std::max(maxEntries_, 65536u)), budgets_{info.maxDrawings ? info.maxDrawings : 64,
                                                         info.maxGlyphs ? info.maxGlyphs : 1024,
                                                         info.maxShapes ? info.maxShapes : 1024,
                                                         info.maxPatches ? info.maxPatches : 262144},
      software_(owner.device.software), assets_(budgets_.items, &owner.host()), tables_(budgets_, &owner.host()) {}

Result<core::Unique<Canvas>> Canvas::create(core::Context& context, const GpgpCanvasCreateInfo& info) {
  auto canvas = core::makeUnique<Canvas>(context.host(), context, info);
  const DrawShaders draw{{"draw.vert", vector_draw_vert},
                         {"draw.frag", vector_draw_frag},
                         {"draw.vert, multiview", vector_draw_vert_multiview},
                         {"draw.frag, multiview", vector_draw_frag_multiview}};
  if (auto ok = canvas->init(canvas->describe(), &draw); !ok) return ok.error();
  return canvas;
}

uint64_t Canvas::tiles() const {
  return uint64_t(divide(maxWidth_, shader::kTileSize)) * divide(maxHeight_, shader::kTileSize);
}
uint32_t Canvas::listWords() const { // 31 paths a tile, fewer where that would take more than 64 MiB
  return static_cast<uint32_t>(std::clamp<uint64_t>((uint64_t(16) << 20) / tiles(), 4, 63));
}

uint64_t Canvas::binWords() const { // enough for any record with the largest bins, or for most with the smallest
  constexpr uint32_t kLargest = shader::kTileSize << shader::kMaxBinShift;
  const uint64_t least = uint64_t(divide(maxWidth_, kLargest)) * divide(maxHeight_, kLargest) *
                         (divide(budgets_.patches, 32) + shader::kBinHead);
  return software_ ? least : std::max(least, std::min<uint64_t>(least * 6, 16 << 20));
}
// Paths in the lists of all bins: most paths are in one or two.
uint32_t Canvas::binLists() const { return software_ ? 0 : 2 * budgets_.patches + 65536; }

core::PassList Canvas::describe() const {
  using enum core::ResourceKind;
  using enum core::UseKind;
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
  const auto paths = list.add({"paths", scratch, VkDeviceSize(budgets_.patches) * sizeof(shader::PlacedPath)});
  const auto words = list.add({"tile words", scratch, VkDeviceSize(maxWords_) * sizeof(shader::TileWord)});
  const VkDeviceSize lists = tiles() * (software_ ? listWords() + 2 : 2) + binLists();
  const auto masks = list.add({"bins", scratch, (shader::kFirstBin + binWords() + lists) * 4});
  const auto entries = list.add({"entries", scratch, VkDeviceSize(maxEntries_) * shader::kEntryWords * 4});
  const auto counters = list.add({"counters", scratch, sizeof(CanvasCounters)});

  const auto params = list.add({"items", scratch, heads + placed * sizeof(ItemRecord)});
  core::ResourceIndex images = 0; // the first
  static constexpr const char* kImageNames[shader::kMaxImages] = {"images[0]", "images[1]", "images[2]", "images[3]",
                                                                  "images[4]", "images[5]", "images[6]", "images[7]"};
  for (uint32_t i = 0; i < shader::kMaxImages; ++i) {
    const auto added = list.add({kImageNames[i], texture, 0, true});
    if (i == 0) images = added;
  }
  const auto chords =
      list.add({"chords", scratch, software_ ? 4 : VkDeviceSize(maxRows()) * sizeof(shader::ChordRecord)});
  const auto rowList = list.add({"rows of chords", scratch, software_ ? 4 : VkDeviceSize(maxRows()) * 4});
  const auto shapes = list.add({"shapes", scratch, shapeBytes});
  const VkDeviceSize keptTiles = software_ ? 0 : std::min<VkDeviceSize>(tiles(), shader::kTilesAside);
  const auto aside = list.add({"tiles painted aside", scratch, std::max<VkDeviceSize>(keptTiles * 64 * 16, 16)});
  assert(images == kFirstImage && chords == kChordList && shapes == kShapes && aside == kAsideTiles);
  const auto useImages = [images](core::Pass& pass) {
    for (uint32_t i = 0; i < shader::kMaxImages; ++i) pass.uses[pass.useCount++] = {images + i, read};
  };

  if (software_) {
    list.fill("clear counters", counters, 0);
    list.fill("clear words", words, 0);
    list.dispatch("begin", list.add(core::ShaderDesc{"begin", vector_begin_software}),
                  {{fromHost, read}, {params, write}, {masks, write}, {shapes, write}}, kBegin);
  } else {
    list.dispatch(
        "begin", list.add(core::ShaderDesc{"begin", vector_begin}),
        {{fromHost, read}, {params, write}, {masks, write}, {shapes, write}, {words, write}, {counters, write}},
        kBegin);
  }
  const auto dispatch = [&](const char* name, const core::ShaderDesc& shader, std::initializer_list<core::Use> uses,
                            uint32_t groups) -> core::Pass& {
    core::Pass& pass = list.dispatch(name, list.add(shader), {{params, read}, {shapes, read}}, groups);
    for (core::ResourceIndex i = 0; i < kMaxSlots; ++i) pass.uses[pass.useCount++] = {i, read};
    for (const core::Use& use : uses) pass.uses[pass.useCount++] = use;
    return pass;
  };
  // Shaders that fetch from drawings come in three forms: one need not choose among drawings at each access, two know
  // no projective items.
  using Spirv = std::span<const uint32_t>;
  const auto either = [&](std::array<const char*, 3> names, std::array<Spirv, 3> spirv,
                          std::initializer_list<core::Use> uses, uint32_t groups) {
    for (uint32_t k = 0; k < 3; ++k) {
      core::Pass& pass = dispatch(names[k], {names[k], spirv[k]}, uses, groups);
      pass.condition = kOneDrawing + k;
      pass.beside = k > 0; // of the three one is recorded: the first one's barrier is all of theirs
    }
  };
  either({"place", "place, several drawings", "place, projective"},
         {vector_place_one, vector_place, vector_place_projective},
         {{paths, readWrite}, {words, readWrite}, {masks, readWrite}, {counters, readWrite}}, kPaths);
  const std::array<Spirv, 3> mark =
      software_ ? std::array<Spirv, 3>{vector_mark_software_one, vector_mark_software, vector_mark_software_projective}
                : std::array<Spirv, 3>{vector_mark_one, vector_mark, vector_mark_projective};
  either(
      {"mark", "mark, several drawings", "mark, projective"}, mark,
      {{paths, read}, {words, readWrite}, {counters, readWrite}, {chords, write}, {rowList, write}, {entries, write}},
      kSegments);
  if (!software_) {
    core::Pass& pack = list.dispatch("pack", list.add(core::ShaderDesc{"pack", vector_pack}),
                                     {{params, read}, {masks, readWrite}, {counters, readWrite}}, kBins);
    pack.beside = true;
  }
  dispatch("allot", {"allot", software_ ? Spirv(vector_allot_software) : Spirv(vector_allot)},
           {{paths, read}, {words, readWrite}, {entries, readWrite}, {counters, readWrite}}, kWords);
  if (software_) {
    either({"fill", "fill, several drawings", "fill, projective"},
           {vector_fill_software_one, vector_fill_software, vector_fill_software_projective},
           {{paths, read}, {words, read}, {entries, readWrite}, {counters, read}}, kSegments);
  } else { // from the lists, or, where these did not suffice, without them; allot says which
    const auto split = [&](const core::ShaderDesc& shader, uint32_t condition) -> core::Pass& {
      core::Pass& pass =
          dispatch(shader.name, shader, {{paths, read}, {words, read}, {masks, readWrite}, {counters, read}}, kSplits);
      pass.condition = condition;
      return pass;
    };
    split({"split, several drawings", vector_split}, kSplit);
    split({"split", vector_split_one}, kSplitOne).beside = true;
    static constexpr const char* kFills[] = {"fill",
                                             "fill, several drawings",
                                             "fill, projective",
                                             "fill without lists",
                                             "fill without lists, several drawings",
                                             "fill without lists, projective"};
    const std::array<Spirv, 6> spirv = {vector_fill_rows_one, vector_fill_rows, vector_fill_rows,
                                        vector_fill_one,      vector_fill,      vector_fill_projective};
    for (uint32_t k = 0; k < 6; ++k) {
      core::Pass& pass =
          list.dispatchIndirect(kFills[k], list.add(core::ShaderDesc{kFills[k], spirv[k]}),
                                {{params, read},
                                 {shapes, read},
                                 {paths, read},
                                 {words, read},
                                 {counters, read},
                                 {entries, readWrite},
                                 {chords, read},
                                 {rowList, read}},
                                counters, k < 3 ? offsetof(CanvasCounters, rowsX) : offsetof(CanvasCounters, fillX));
      for (core::ResourceIndex i = 0; i < kMaxSlots; ++i) pass.uses[pass.useCount++] = {i, read};
      pass.condition = kOneDrawing + k % 3;
      pass.beside = true; // split's barrier, which is owed where that is left out, is all of theirs
    }
  }
  // By target: the view alone, rgba8, rgba16f.
  const auto addTarget = [&](core::Pass& pass, uint32_t target, uint32_t condition) {
    if (target != kNoImage) pass.uses[pass.useCount++] = {target == kHasImage8 ? image8 : image16, write};
    pass.condition = condition + target;
  };
  const auto raster = [&](std::array<const char*, 3> names, std::array<Spirv, 3> spirv, uint32_t condition) {
    for (uint32_t t = 0; t < 3; ++t) {
      core::Pass& pass = dispatch(
          names[t], {names[t], spirv[t]},
          {{paths, read}, {words, read}, {masks, read}, {entries, read}, {counters, read}, {view, write}}, kRaster);
      if (condition == kImages || condition == kRichImages) useImages(pass);
      addTarget(pass, t, condition);
    }
  };
  // From lists that passes before have written.
  const auto tilesOf = [&](std::array<const char*, 3> names, std::array<Spirv, 3> spirv, uint32_t condition,
                           VkDeviceSize arguments) {
    for (uint32_t t = 0; t < 3; ++t) {
      core::Pass& pass = list.dispatchIndirect(names[t], list.add(core::ShaderDesc{names[t], spirv[t]}),
                                               {{params, read},
                                                {shapes, read},
                                                {paths, read},
                                                {words, read},
                                                {masks, read},
                                                {entries, read},
                                                {counters, read},
                                                {view, write}},
                                               masks, arguments * 4);
      const bool one = condition == kPlain || condition == kPaintsOne || condition == kRichOne;
      const uint32_t drawings = one ? 1 : kMaxSlots;
      for (core::ResourceIndex i = 0; i < drawings; ++i) pass.uses[pass.useCount++] = {i, read};
      if (condition == kImages || condition == kRichImages) useImages(pass);
      addTarget(pass, t, condition);
    }
  };
  if (software_) {
    dispatch("sift", {"sift", vector_sift}, {{paths, read}, {words, read}, {masks, readWrite}, {counters, read}},
             kSift);
    const std::array<const char*, 3> solid = {"solid tiles", "solid tiles rgba8", "solid tiles rgba16f"};
    const std::array<Spirv, 3> shaders = {vector_tiles_solid0, vector_tiles_solid1, vector_tiles_solid2};
    for (uint32_t t = 0; t < 3; ++t)
      addTarget(dispatch(solid[t], {solid[t], shaders[t]}, {{masks, read}, {view, write}}, kTiles), t, kAny);
    tilesOf({"raster", "raster rgba8", "raster rgba16f"}, {vector_tiles0, vector_tiles1, vector_tiles2}, kPlain,
            shader::kPaintedArguments);
    tilesOf({"raster gradients, several drawings", "raster gradients rgba8, several drawings",
             "raster gradients rgba16f, several drawings"},
            {vector_tiles_paints0, vector_tiles_paints1, vector_tiles_paints2}, kPaints, shader::kPaintedArguments);
    tilesOf({"raster gradients", "raster gradients rgba8", "raster gradients rgba16f"},
            {vector_tiles_paints_one0, vector_tiles_paints_one1, vector_tiles_paints_one2}, kPaintsOne,
            shader::kPaintedArguments);
    tilesOf({"crowded", "crowded rgba8", "crowded rgba16f"}, {vector_crowded0, vector_crowded1, vector_crowded2},
            kPlain, shader::kCrowdedArguments);
    tilesOf({"crowded gradients, several drawings", "crowded gradients rgba8, several drawings",
             "crowded gradients rgba16f, several drawings"},
            {vector_crowded_paints0, vector_crowded_paints1, vector_crowded_paints2}, kPaints,
            shader::kCrowdedArguments);
    tilesOf({"crowded gradients", "crowded gradients rgba8", "crowded gradients rgba16f"},
            {vector_crowded_paints_one0, vector_crowded_paints_one1, vector_crowded_paints_one2}, kPaintsOne,
            shader::kCrowdedArguments);
    tilesOf({"raster all", "raster all rgba8", "raster all rgba16f"},
            {vector_tiles_rich0, vector_tiles_rich1, vector_tiles_rich2}, kRich, shader::kRichArguments);
    tilesOf({"crowded all", "crowded all rgba8", "crowded all rgba16f"},
            {vector_crowded_rich0, vector_crowded_rich1, vector_crowded_rich2}, kRich, shader::kRichCrowdedArguments);
    tilesOf({"raster images", "raster images rgba8", "raster images rgba16f"},
            {vector_tiles_images0, vector_tiles_images1, vector_tiles_images2}, kImages, shader::kPaintedArguments);
    tilesOf({"crowded images", "crowded images rgba8", "crowded images rgba16f"},
            {vector_crowded_images0, vector_crowded_images1, vector_crowded_images2}, kImages,
            shader::kCrowdedArguments);
    tilesOf({"raster all, images", "raster all, images rgba8", "raster all, images rgba16f"},
            {vector_tiles_rich_images0, vector_tiles_rich_images1, vector_tiles_rich_images2}, kRichImages,
            shader::kRichArguments);
    tilesOf({"crowded all, images", "crowded all, images rgba8", "crowded all, images rgba16f"},
            {vector_crowded_rich_images0, vector_crowded_rich_images1, vector_crowded_rich_images2}, kRichImages,
            shader::kRichCrowdedArguments);
  } else {
    // The general shader's tiles are painted beside the others, and first, as there are few and each takes long. They
    // are put aside, as two passes that write one image must not run beside each other.
    const auto asideOf = [&](const core::ShaderDesc& shader, uint32_t condition) {
      core::Pass& pass = list.dispatchIndirect(shader.name, list.add(shader),
                                               {{params, read},
                                                {shapes, read},
                                                {paths, read},
                                                {words, read},
                                                {masks, read},
                                                {entries, read},
                                                {counters, read},
                                                {aside, write}},
                                               masks, shader::kRichArguments * 4);
      for (core::ResourceIndex i = 0; i < (condition == kAsideOne ? 1 : kMaxSlots); ++i)
        pass.uses[pass.useCount++] = {i, read};
      if (condition == kAsideImages) useImages(pass);
      pass.condition = condition;
    };
    asideOf({"aside, several drawings", vector_aside_rich}, kAside);
    const size_t first = list.passes.size(); // the pass before has the barrier of all up to `kept`
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
    for (size_t i = first; i < list.passes.size(); ++i) list.passes[i].beside = true;
    const auto kept = [&](std::array<const char*, 3> names, std::array<Spirv, 3> spirv, uint32_t condition) {
      tilesOf(names, spirv, condition, shader::kRichArguments);
      for (size_t i = list.passes.size() - 3; i < list.passes.size(); ++i) {
        core::Pass& pass = list.passes[i];
        pass.uses[pass.useCount++] = {aside, read};
      }
    };
    kept({"raster all, several drawings", "raster all rgba8, several drawings", "raster all rgba16f, several drawings"},
         {vector_raster_rich0, vector_raster_rich1, vector_raster_rich2}, kRich);
    kept({"raster all", "raster all rgba8", "raster all rgba16f"},
         {vector_raster_rich_one0, vector_raster_rich_one1, vector_raster_rich_one2}, kRichOne);
    kept({"raster all, images", "raster all, images rgba8", "raster all, images rgba16f"},
         {vector_raster_rich_images0, vector_raster_rich_images1, vector_raster_rich_images2}, kRichImages);
  }
  list.report = counters;
  list.reportBytes = sizeof(CanvasCounters);
  return list;
}

Result<void> Canvas::checkInfo(const GpgpCanvasInfo& info, const CanvasView* view) const {
  if (info.width == 0 || info.height == 0 || info.width > maxWidth_ || info.height > maxHeight_)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the canvas is %u x %u; the worker was made for 1 x 1 to %u x %u",
                     info.width, info.height, maxWidth_, maxHeight_);
  if (info.samples != 0 && info.samples != 1 && info.samples != 4 && info.samples != 8 && info.samples != 16)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "samples is %u; expected 1, 4, 8 or 16", info.samples);
  for (const float v : info.background)
    if (!std::isfinite(v))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "background holds a number that is not finite");
  if (!view && !info.target.view)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "neither view nor target is given: nothing would be written");
  if (view && (view->width < info.width || view->height < info.height))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the view is %u x %u, the canvas %u x %u", view->width, view->height,
                     info.width, info.height);
  if (info.target.view) {
    if (info.target.format != VK_FORMAT_R8G8B8A8_UNORM && info.target.format != VK_FORMAT_R16G16B16A16_SFLOAT)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                       "target.format is %d; expected R8G8B8A8_UNORM or R16G16B16A16_SFLOAT", info.target.format);
    if (info.target.width < info.width || info.target.height < info.height)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the target is %u x %u, the canvas %u x %u", info.target.width,
                       info.target.height, info.width, info.height);
  }
  if (info.imageCount > shader::kMaxImages)
    return makeError(GPGP_ERROR_UNSUPPORTED, "imageCount is %u; a record paints with at most %u (GPGP_MAX_IMAGES)",
                     info.imageCount, shader::kMaxImages);
  if (info.imageCount && !info.images)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "images is NULL, but imageCount is %u", info.imageCount);
  for (uint32_t i = 0; i < info.imageCount; ++i) {
    if (!info.images[i].view) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "images[%u].view is NULL", i);
    if (!info.images[i].sampler) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "images[%u].sampler is NULL", i);
    if (info.images[i].layout == VK_IMAGE_LAYOUT_UNDEFINED)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "images[%u].layout is UNDEFINED: nothing could be found there", i);
  }
  for (uint32_t i = 0; i < info.itemCount; ++i) {
    for (const float v : info.items[i].transform)
      if (!std::isfinite(v))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].transform holds a number that is not finite", i);
    for (const float v : info.items[i].perspective)
      if (!std::isfinite(v))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].perspective holds a number that is not finite", i);
    for (const float v : info.items[i].scissor)
      if (!std::isfinite(v))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].scissor holds a number that is not finite", i);
    if (!(info.items[i].opacity >= 0 && info.items[i].opacity <= 1))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].opacity is %g; it must be 0 to 1", i,
                       static_cast<double>(info.items[i].opacity));
    if (info.items[i].glyphCount && !info.items[i].glyphs)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].glyphs is NULL, but glyphCount is %u", i,
                       info.items[i].glyphCount);
  }
  return {};
}

Result<void> Canvas::prepare(VkCommandBuffer commandBuffer, const GpgpCanvasInfo& info,
                             std::span<const ItemAsset> assets, CanvasView* view) {
  if (auto ok = checkInfo(info, view); !ok) return ok;
  core::Record r;
  r.commandBuffer = commandBuffer;
  r.info = &info.base;
  Gather gather(context, budgets_, tables_, info);
  for (uint32_t i = 0; i < info.itemCount; ++i)
    if (auto ok = gather.add(i, assets[i]); !ok) return ok;
  CanvasHeader header{};
  gather.finish(header);
  for (uint32_t slot = 0; slot < gather.slotCount; ++slot) {
    r.bindings[slot].ownBuffer = gather.bound[slot]->buffer();
    r.bindings[slot].ownSize = gather.bound[slot]->size();
  }
  const bool gradients = gather.gradients, projective = gather.projective, images = gather.images;
  const bool several = gather.slotCount > 1 || gather.lists;

  header.width = info.width;
  header.height = info.height;
  header.tilesX = divide(info.width, shader::kTileSize);
  header.tilesY = divide(info.height, shader::kTileSize);
  header.pathWords = divide(header.pathCount, 32);
  // Small bins where there are many paths, if there is room for them.
  constexpr uint32_t kPathsOfBin = 64;
  for (uint32_t shift = shader::kMaxBinShift; shift >= shader::kMinBinShift; --shift) {
    const uint32_t across = divide(info.width, shader::kTileSize << shift),
                   count = across * divide(info.height, shader::kTileSize << shift);
    if (shift != shader::kMaxBinShift && uint64_t(count) * (header.pathWords + shader::kBinHead) > binWords()) break;
    header.binShift = shift;
    header.binsX = across;
    header.binCount = count;
    if (software_ || header.pathCount <= count * kPathsOfBin) break;
  }
  header.binWords = header.pathWords + shader::kBinHead;
  header.binListLimit = binLists();
  header.wordLimit = maxWords_;
  header.entryLimit = maxEntries_;
  header.rowLimit = maxRows();
  header.samples = info.samples ? info.samples : 16;
  header.flags = (view ? shader::kWriteView : 0) | (info.encodeSrgb ? shader::kEncodeSrgb : 0) |
                 (info.exactArea ? shader::kExactArea : 0) | (info.blendSrgb ? shader::kBlendSrgb : 0);
  // Only what is in a group or has a projective gradient or image takes the general shader, beside the others'.
  const bool rich = gather.groups || ((gradients || images) && projective);
  if (rich) header.flags |= shader::kSplitRich;
  // Few segments are dealt out to many workgroups, which then each wait for less; many are better taken together.
  const uint32_t perGroup = software_ ? 64 : header.segmentCount < 16384 ? 4 : shader::kMostSegments;
  header.groupSegments = perGroup;
  header.listWords = listWords();
  for (uint32_t i = 0; i < info.imageCount && images; ++i)
    header.premultiplied |= info.images[i].premultiplied ? 1u << i : 0;
  header.background = {info.background[0], info.background[1], info.background[2], info.background[3]};
  const auto bytes = [](const auto& records, uint32_t count) { return std::as_bytes(std::span(records).first(count)); };
  r.constants = {bytes(std::span(&header, 1), 1),        bytes(gather.slots, shader::kSlots),
                 bytes(tables_.sources, gather.sources), bytes(tables_.placements, gather.placements),
                 bytes(tables_.shapes, gather.shapes),   bytes(tables_.paints, gather.paints),
                 bytes(tables_.stops, gather.stops),     bytes(tables_.clips, gather.clips),
                 bytes(tables_.layers, gather.layers)};

  if (view) {
    r.bindings[kView].ownBuffer = view->buffer();
    r.bindings[kView].ownSize = view->size();
  }
  const bool wide = info.target.format == VK_FORMAT_R16G16B16A16_SFLOAT;
  if (info.target.view) r.bindings[wide ? kImage16 : kImage8].image = &info.target;
  r.conditions[projective ? kProjective : several ? kDrawings : kOneDrawing] = true;
  const uint32_t image = !info.target.view ? kNoImage : wide ? kHasImage16 : kHasImage8;
  r.conditions[(images ? kImages
                // The plain shader fetches from one drawing only, and on hardware leaves no squares to the general one.
                : !gradients && !(rich && (several || !software_)) ? kPlain
                : several                                          ? kPaints
                                                                   : kPaintsOne) +
               image] = true;
  const bool one = !several && !software_; // software devices have one general shader
  if (rich) {
    r.conditions[(images ? kRichImages : one ? kRichOne : kRich) + image] = true;
    r.conditions[images ? kAsideImages : one ? kAsideOne : kAside] = true;
    r.conditions[one ? kSplitOne : kSplit] = true;
  }
  r.conditions[kAny + image] = true;
  // Shaders name all images, so those that are not there are bound to the first one.
  for (uint32_t i = 0; i < shader::kMaxImages && images; ++i) {
    const GpgpCanvasImage& from = info.images[i < info.imageCount ? i : 0];
    r.bindings[kFirstImage + i].texture = {from.sampler, from.view, from.layout};
  }
  r.groups[kPaths] = rows(divide(std::max(header.pathCount, 1u), 64)); // it also counts what was left out
  const uint64_t bins = uint64_t(header.binCount) * header.binWords;
  r.groups[kBegin] = {software_
                          ? divide(std::max<uint64_t>({header.itemCount, header.shapeTables / 16, bins / 16, 1}), 64)
                          : divide(maxWords_, 64 * 8),
                      1, 1};
  r.groups[kSegments] = rows((software_ ? 0 : shader::kClearGroups) + divide(header.segmentCount, perGroup));
  // On software devices an invocation takes part of a segment's chords, few enough turns for lavapipe's loops.
  if (software_) r.groups[kSegments][2] = divide(info.height, 1024);
  r.groups[kWords] = {std::min(std::max(256u, header.segmentCount / 256), divide(maxWords_, 64)), 1, 1};
  r.groups[kTiles] = rows(divide(uint64_t(header.tilesX) * header.tilesY, 8));
  r.groups[kBins] = rows(header.binCount);
  r.groups[kSift] = {divide(uint64_t(header.binCount) << header.binShift, 64), 1, 1};
  r.groups[kRaster] = {header.tilesX, header.tilesY, 1};
  constexpr uint32_t kSplitSide = 1u << shader::kMinBinShift;
  r.groups[kSplits] = {divide(header.tilesX, kSplitSide), divide(header.tilesY, kSplitSide), 1};
  if (auto ok = check(r); !ok) return ok;
  if (auto ok = record(r); !ok) return ok;
  if (view) {
    view->preparedWidth = info.width;
    view->preparedHeight = info.height;
  }
  return {};
}

Result<void> Canvas::draw(VkCommandBuffer commandBuffer, const GpgpCanvasDrawInfo& info, CanvasView& view) {
  if (view.preparedWidth == 0) return makeError(GPGP_NOT_READY, "nothing was prepared into the view");
  const uint32_t last = std::max(info.x, info.target->viewMask ? info.secondX : 0);
  if (info.width == 0 || info.height == 0 || last > view.preparedWidth || info.width > view.preparedWidth - last ||
      info.height > view.preparedHeight)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "%u x %u pixels from column %u on are to be drawn; the view holds %u x %u", info.width,
                     info.height, last, view.preparedWidth, view.preparedHeight);
  struct {
    float columns[2][12];
    uint32_t size[4], begins[2];
  } constants{};
  for (int k = 0; k < 2; ++k) {
    const float* clip = k && info.secondClip ? info.secondClip : info.clip;
    std::copy_n(clip, 8, constants.columns[k]);
    std::copy_n(clip + 12, 4, constants.columns[k] + 8);
  }
  constants.size[0] = info.width;
  constants.size[1] = info.height;
  constants.size[2] = view.preparedWidth;
  constants.begins[0] = info.x;
  constants.begins[1] = info.secondX;
  core::DrawRecord r;
  r.commandBuffer = commandBuffer;
  r.bindings[kView].ownBuffer = view.buffer();
  r.bindings[kView].ownSize = view.size();
  r.target = info.target;
  r.pushConstants = std::as_bytes(std::span(&constants, 1));
  r.vertexCount = 4;
  return recordDraw(r);
}

bool Canvas::takeCanvasReport(GpgpCanvasReport& report) {
  core::RawReport raw;
  if (!takeReport(raw)) return false;
  CanvasCounters counters{};
  if (raw.header.status == GPGP_SUCCESS) std::memcpy(&counters, raw.words.data(), sizeof counters);
  report.base = raw.header;
  report.patches = counters.patches;
  // Room for tile words is by maxTileEntries as well; entries were counted behind that.
  report.tileEntries = std::max(counters.entries, counters.words > counters.wordsGiven ? counters.words : 0);
  report.tileEntriesGiven = counters.entriesGiven;
  report.pathsDropped = counters.pathsDropped;
  report.glyphs = counters.glyphs;
  report.glyphsGiven = counters.glyphsGiven;
  report.shapes = counters.shapes;
  report.shapesGiven = counters.shapesGiven;
  report.items = counters.items;
  report.itemsGiven = counters.itemsGiven;
  if (counters.pathsDropped) report.base.status = GPGP_BUDGET_EXCEEDED;
  return true;
}

} // namespace gpgp::vector
