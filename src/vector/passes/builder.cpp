#include "vector/passes/builder.h"

#include "vector/layers/operation.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace gpgp::vector {
using enum core::ResourceKind;
using enum core::UseKind;
using shader::CanvasCounters;
using shader::CanvasHeader;
using shader::ItemRecord;
using shader::kMaxBuffers;
using shader::PlacementRecord;
using shader::SlotRecord;

PassBuilder::PassBuilder(const CanvasSizes& canvas, const core::Device& device, std::pmr::memory_resource* memory)
    : list(memory), sizes(canvas),
      subgroups(device.subgroupArithmetic && (canvas.software || device.subgroupSize >= 32)) {
  static constexpr const char* kNames[kMaxBuffers] = {"drawing 0", "drawing 1", "drawing 2", "drawing 3",
                                                      "drawing 4", "drawing 5", "drawing 6", "drawing 7"};
  for (const char* name : kNames) list.add({name, buffer, 0, true});
  history = list.add({"history", buffer, 0, true});
  image8 = list.add({"target", image, 0, true});
  image16 = list.add({"target", image, 0, true});
  const ItemBudgets& room = sizes.items;
  const VkDeviceSize heads = sizeof(CanvasHeader) + shader::kSlots * sizeof(SlotRecord), placed = maxPlacements(room),
                     shapeBytes = room.shapes * VkDeviceSize(sizeof(shader::ShapeRecord) + sizeof(PaintRecord) +
                                                             2 * sizeof(StopRecord)) +
                                  room.items * VkDeviceSize(sizeof(shader::ItemClipRecord) + sizeof(LayerRecord)) +
                                  (maxAssets(room) + 1) * VkDeviceSize(sizeof(SlotRecord)) +
                                  (sizes.maxTilePatches ? sizeof(shader::PatchTableRecord) +
                                                              room.items * VkDeviceSize(sizeof(shader::PatchItemRecord))
                                                        : 0);
  fromHost = list.add({"constants", core::ResourceKind::constants,
                       heads + room.items * sizeof(ItemRecord) + placed * sizeof(PlacementRecord) + shapeBytes +
                           sizes.damageWords() * 4});
  paths = list.add({"paths", scratch, VkDeviceSize(room.paths) * sizeof(shader::PlacedPath)});
  words = list.add({"tile words", scratch, VkDeviceSize(sizes.maxWords) * sizeof(shader::TileWord)});
  bins = list.add({"bins", scratch, (sizes.binsEnd() + sizes.damageWords()) * 4});
  entries = list.add({"entries", scratch, VkDeviceSize(sizes.maxEntries) * shader::kEntryWords * 4});
  counters = list.add({"counters", scratch, sizeof(CanvasCounters)});
  items = list.add({"items", scratch, heads + shader::kFirstItems * 4 + placed * sizeof(ItemRecord)});
  static constexpr const char* kImageNames[shader::kPageImages] = {"images[0]", "images[1]", "images[2]", "images[3]",
                                                                   "images[4]", "images[5]", "images[6]", "images[7]"};
  list.texturePages = sizes.imagePages;
  for (uint32_t i = 0; i < shader::kPageImages; ++i) {
    const auto added = list.add({kImageNames[i], texture, 0, true});
    if (i == 0) images = added;
  }
  // Software devices have lists of pieces and of rows of tiles there (pieces.glsl), and a segment behind all, which
  // invocations write that have none.
  const VkDeviceSize rowCount = sizes.maxRows();
  segments = list.add(
      {"flat segments", scratch, sizes.software ? (rowCount + 1) * 16 : rowCount * sizeof(shader::FlatSegmentRecord)});
  rows = list.add({"segment rows", scratch, sizes.software ? (sizes.maxWords + rowCount) * 16 : rowCount * 4});
  shapes = list.add({"shapes", scratch, shapeBytes});
  const VkDeviceSize keptTiles = sizes.software ? 0 : std::min<VkDeviceSize>(sizes.tiles(), shader::kTilesAside);
  aside = list.add({"tiles aside", scratch, std::max<VkDeviceSize>(keptTiles * 64 * 16, 16)});
  pictures = list.add({"pictures", scratch, std::max<VkDeviceSize>(VkDeviceSize(sizes.layers.pixels) * 8, 16)});
  operations =
      list.add({"operations", buffer, VkDeviceSize(sizes.layers.operations) * sizeof(shader::OperationRecord), true});
  layeredHistory = list.add({"layered history", buffer, 0, true});
  imageColors =
      list.add({"images[colors]", scratch, std::max<VkDeviceSize>(sizes.imageTiles * VkDeviceSize(16 + 64 * 8), 16)});
  assert(imageColors == shader::kBindImageColors);
  if (sizes.maxTilePatches) {
    constexpr VkDeviceSize kRecord = sizeof(shader::PatchPlaceRecord);
    patchBlocks = list.add({"patch blocks", scratch, shader::kPatchBlocks * kRecord});
    tilePatches = list.add({"tile patches", scratch, sizes.maxTilePatches * kRecord});
    assert(patchBlocks == shader::kBindPatchBlocks && tilePatches == shader::kBindTilePatches);
  }
  assert(pictures == shader::kBindPictures && operations == shader::kBindOperations &&
         layeredHistory == shader::kBindLayeredHistory);
  assert(history == shader::kBindHistory && fromHost == shader::kBindConstants && items == shader::kBindItems &&
         images == shader::kBindImages && segments == shader::kBindFlatSegments && aside == shader::kBindAside);
  list.report = counters;
  list.reportBytes = sizeof(CanvasCounters);
}

core::Pass& PassBuilder::dispatch(const char* name, Spirv spirv, std::initializer_list<core::Use> uses, uint32_t groups,
                                  uint32_t condition) {
  core::Pass& pass =
      list.dispatch(name, list.add(core::ShaderDesc{name, spirv}), {{items, read}, {shapes, read}}, groups);
  for (core::ResourceIndex i = 0; i < kMaxBuffers; ++i) pass.uses[pass.useCount++] = {i, read};
  for (const core::Use& use : uses) pass.uses[pass.useCount++] = use;
  pass.condition = condition;
  return pass;
}

void PassBuilder::forms(const FormNames& names, const Forms& spirv, std::initializer_list<core::Use> uses,
                        uint32_t groups, uint32_t condition) {
  for (uint32_t k = 0; k < 3; ++k)
    dispatch(names[k], spirv[k], uses, groups, condition + k).beside =
        k > 0; // the first one's barrier is all of theirs
}

void PassBuilder::clear(const char* name, Spirv spirv, core::ResourceIndex what) {
  list.dispatch(name, list.add(core::ShaderDesc{name, spirv}), {{items, read}, {counters, read}, {what, write}}, kClear)
      .condition = kPlaced;
}

void PassBuilder::allocate(const char* name, Spirv spirv, uint32_t groups, bool withRows) {
  core::Pass& pass = dispatch(
      name, spirv, {{paths, read}, {words, readWrite}, {entries, readWrite}, {counters, readWrite}}, groups, kPlaced);
  if (!withRows) return;
  pass.uses[pass.useCount++] = {segments, read};
  pass.uses[pass.useCount++] = {rows, readWrite};
}

void PassBuilder::fill(const char* name, Spirv spirv, bool fromLists, uint32_t condition, bool beside) {
  core::Pass& pass =
      list.dispatchIndirect(name, list.add(core::ShaderDesc{name, spirv}),
                            {{items, read},
                             {shapes, read},
                             {paths, read},
                             {words, read},
                             {counters, read},
                             {entries, readWrite},
                             {segments, read},
                             {rows, read}},
                            counters, fromLists ? offsetof(CanvasCounters, rowsX) : offsetof(CanvasCounters, fillX));
  for (core::ResourceIndex i = 0; i < kMaxBuffers; ++i) pass.uses[pass.useCount++] = {i, read};
  pass.condition = condition;
  pass.beside = beside;
}

core::Pass& PassBuilder::listedTiles(const char* name, Spirv spirv, uint32_t condition, VkDeviceSize arguments) {
  const bool crowded = arguments == shader::kCrowdedArguments || arguments == shader::kRichCrowdedArguments;
  core::Pass& pass = list.dispatchIndirect(name, list.add(core::ShaderDesc{name, spirv}),
                                           {{items, read},
                                            {shapes, read},
                                            {paths, read},
                                            {words, read},
                                            {bins, read},
                                            {entries, read},
                                            {counters, crowded ? readWrite : read}},
                                           bins, arguments * 4);
  const bool one = condition == kPlain || condition == kPaintsOne || condition == kRichOne || condition == kAsideOne;
  for (core::ResourceIndex i = 0; i < (one ? 1 : kMaxBuffers); ++i) pass.uses[pass.useCount++] = {i, read};
  if (condition == kImages || condition == kRichImages || condition == kAsideImages) useImages(pass);
  return pass;
}

void PassBuilder::painted(const FormNames& names, const Forms& byTarget, uint32_t condition, VkDeviceSize arguments) {
  for (uint32_t t = 0; t < 3; ++t) {
    if (!sizes.rasters(t)) continue;
    core::Pass& pass = listedTiles(names[t], byTarget[t], condition, arguments);
    pass.uses[pass.useCount++] = {history, write};
    if (!sizes.software) pass.uses[pass.useCount++] = {aside, read};
    target(pass, t, condition);
  }
}

void PassBuilder::target(core::Pass& pass, uint32_t target, uint32_t condition) const {
  if (target != kNoImage) pass.uses[pass.useCount++] = {target == kHasImage8 ? image8 : image16, write};
  pass.condition = condition + target;
}

void PassBuilder::useImages(core::Pass& pass) const {
  for (uint32_t i = 0; i < shader::kPageImages; ++i) pass.uses[pass.useCount++] = {images + i, read};
  if (!pass.paged) pass.uses[pass.useCount++] = {imageColors, read};
}

} // namespace gpgp::vector
