// The passes of the canvas, the checks of a record, and what a record fills in.
#include "vector/raster/canvas.h"

#include "shaders/vector_bin.spv.h"
#include "shaders/vector_boxes.spv.h"
#include "shaders/vector_coarse.spv.h"
#include "shaders/vector_draw_frag.spv.h"
#include "shaders/vector_draw_vert.spv.h"
#include "shaders/vector_gather.spv.h"
#include "shaders/vector_raster.spv.h"
#include "shaders/vector_raster_rgba16.spv.h"
#include "shaders/vector_raster_rgba8.spv.h"
#include "shaders/vector_scan.spv.h"
#include "vector/raster/place.h"

#include <algorithm>
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
using shader::SlotRecord;

// Resources are numbered as the shaders bind them (canvas.glsl): 0 to 7 drawings, then these.
constexpr core::ResourceIndex kView = 8, kImage8 = 9, kImage16 = 10;
// Workgroup counts and conditions of a record.
enum Groups : uint32_t { kPatches, kCurves, kPaths, kGroups, kCoarse, kTiles, kOne, kRaster };
enum Conditions : uint32_t { kNoImage, kHasImage8, kHasImage16 };

uint32_t divide(uint64_t a, uint32_t b) { return static_cast<uint32_t>((a + b - 1) / b); }
} // namespace

Canvas::Canvas(core::Context& owner, const GpgpCanvasCreateInfo& info)
    : Worker(owner, core::Kind::canvas, info.base, GPGP_SERVICE_VECTOR),
      maxWidth_(info.maxWidth ? info.maxWidth : 2048), maxHeight_(info.maxHeight ? info.maxHeight : 2048),
      maxPatches_(info.maxPatches ? info.maxPatches : 262144),
      maxEntries_(info.maxTileEntries ? info.maxTileEntries : 1048576),
      maxDrawings_(info.maxDrawings ? info.maxDrawings : 64), constants_(&owner.host()), drawings_(&owner.host()) {}

Result<core::Unique<Canvas>> Canvas::create(core::Context& context, const GpgpCanvasCreateInfo& info) {
  auto canvas = core::makeUnique<Canvas>(context.host(), context, info);
  const core::ShaderDesc vertex{"draw.vert", vector_draw_vert}, fragment{"draw.frag", vector_draw_frag};
  if (auto ok = canvas->init(canvas->describe(), &vertex, &fragment); !ok) return ok.error();
  canvas->constants_.resize(canvas->passes().constantsBytes);
  canvas->drawings_.resize(canvas->maxDrawings_);
  return canvas;
}

core::PassList Canvas::describe() const {
  using enum core::ResourceKind;
  using enum core::UseKind;
  core::PassList list(&context.host());
  const uint32_t groups = divide(maxPatches_, shader::kPatchGroup), words = divide(groups, 32);
  const VkDeviceSize coarse =
      VkDeviceSize(divide(maxWidth_, shader::kCoarseSize)) * divide(maxHeight_, shader::kCoarseSize);
  const VkDeviceSize fine = VkDeviceSize(divide(maxWidth_, shader::kTileSize)) * divide(maxHeight_, shader::kTileSize);
  static constexpr const char* kNames[kMaxSlots] = {"drawing 0", "drawing 1", "drawing 2", "drawing 3",
                                                    "drawing 4", "drawing 5", "drawing 6", "drawing 7"};
  for (const char* name : kNames) list.add({name, buffer, 0, true});
  const auto view = list.add({"view", buffer, 0, true});
  const auto image8 = list.add({"target", image, 0, true});
  const auto image16 = list.add({"target", image, 0, true});
  const auto params = list.add(
      {"items", core::ResourceKind::constants,
       sizeof(CanvasHeader) + kMaxSlots * sizeof(SlotRecord) + VkDeviceSize(maxDrawings_) * sizeof(ItemRecord)});
  const auto patches = list.add({"patches", scratch, VkDeviceSize(maxPatches_) * sizeof(PatchRecord)});
  // A patch has two curves, so that many always suffice.
  const auto curves = list.add({"curves", scratch, VkDeviceSize(maxPatches_) * 2 * sizeof(CurveRecord)});
  const auto paths = list.add({"paths", scratch, VkDeviceSize(maxPatches_) * sizeof(PathRecord)});
  const auto boxes = list.add({"group boxes", scratch, VkDeviceSize(groups) * 16});
  const auto masks = list.add({"coarse masks", scratch, coarse * words * 4});
  const auto tiles = list.add({"tiles", scratch, fine * 16});
  const auto pathCounts = list.add({"path counts", scratch, VkDeviceSize(maxPatches_) * 4});
  const auto entries = list.add({"entries", scratch, VkDeviceSize(maxEntries_) * 4});
  const auto counters = list.add({"counters", scratch, sizeof(CanvasCounters)});

  const auto gather = list.add(core::ShaderDesc{"gather", vector_gather});
  const auto bin = list.add(core::ShaderDesc{"bin", vector_bin});
  const auto scan = list.add(core::ShaderDesc{"scan", vector_scan});
  list.fill("clear path counts", pathCounts, 0);
  const char* const gatherNames[] = {"gather patches", "gather curves", "gather paths"};
  for (uint32_t mode = 0; mode < 3; ++mode) {
    core::Pass& pass = list.dispatch(gatherNames[mode], gather, {{params, read}}, kPatches + mode, {mode});
    for (core::ResourceIndex i = 0; i < kMaxSlots; ++i) pass.uses[pass.useCount++] = {i, read};
    for (const auto table : {patches, curves, paths}) pass.uses[pass.useCount++] = {table, write};
  }
  list.dispatch("boxes", list.add(core::ShaderDesc{"boxes", vector_boxes}),
                {{params, read}, {patches, read}, {boxes, write}}, kGroups);
  list.dispatch("coarse", list.add(core::ShaderDesc{"coarse", vector_coarse}),
                {{params, read}, {boxes, read}, {masks, write}}, kCoarse);
  const std::initializer_list<core::Use> binUses = {{params, read},     {patches, read},         {curves, read},
                                                    {paths, read},      {masks, read},           {counters, read},
                                                    {tiles, readWrite}, {pathCounts, readWrite}, {entries, write}};
  const std::initializer_list<core::Use> scanUses = {
      {params, read}, {tiles, readWrite}, {pathCounts, read}, {counters, readWrite}};
  const auto recount = VkDeviceSize(offsetof(CanvasCounters, recountX));
  list.dispatch("count", bin, binUses, kTiles, {0});
  list.dispatch("place", scan, scanUses, kOne, {0});
  list.dispatchIndirect("count by path", bin, binUses, counters, recount, {1});
  list.dispatch("cut", scan, scanUses, kOne, {1});
  list.dispatchIndirect("recount", bin, binUses, counters, recount, {2});
  list.dispatch("place again", scan, scanUses, kOne, {2});
  list.dispatch("emit", bin, binUses, kTiles, {3});
  const auto raster = [&](const char* name, std::span<const uint32_t> spirv, uint32_t condition,
                          core::ResourceIndex target) {
    core::Pass& pass = list.dispatch(
        name, list.add(core::ShaderDesc{name, spirv}),
        {{params, read}, {patches, read}, {curves, read}, {paths, read}, {tiles, read}, {entries, read}, {view, write}},
        kRaster);
    if (target != view) pass.uses[pass.useCount++] = {target, write};
    pass.condition = condition;
  };
  raster("raster", vector_raster, kNoImage, view);
  raster("raster rgba8", vector_raster_rgba8, kHasImage8, image8);
  raster("raster rgba16f", vector_raster_rgba16, kHasImage16, image16);
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
  for (uint32_t i = 0; i < info.itemCount; ++i) {
    for (const float v : info.items[i].transform)
      if (!std::isfinite(v))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].transform holds a number that is not finite", i);
    if (!(info.items[i].opacity >= 0 && info.items[i].opacity <= 1))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].opacity is %g; it must be 0 to 1", i,
                       static_cast<double>(info.items[i].opacity));
  }
  return {};
}

Result<void> Canvas::prepare(VkCommandBuffer commandBuffer, const GpgpCanvasInfo& info,
                             std::span<DrawingAsset* const> drawings, CanvasView* view) {
  if (auto ok = checkInfo(info, view); !ok) return ok;
  core::Record r;
  r.commandBuffer = commandBuffer;
  r.info = &info.base;
  CanvasHeader header{};
  SlotRecord slots[kMaxSlots] = {};
  std::byte* itemBytes = constants_.data() + sizeof header + sizeof slots;
  const DrawingAsset* bound[kMaxSlots] = {};
  uint32_t usedPaths[kMaxSlots] = {}; // of each drawing, by any item
  uint32_t slotCount = 0;

  // Items in painting order, each with as many of its first paths as there is room for; after one that did not fit
  // whole, nothing more is drawn, so that what is there is what lies below.
  bool full = false;
  for (uint32_t i = 0; i < info.itemCount; ++i) {
    const DrawingAsset& drawing = *drawings[i];
    ItemRecord item{};
    if (!placeItem(info.items[i].transform, item)) continue; // squeezed to a line: covers nothing
    uint32_t slot = 0;
    while (slot < slotCount && bound[slot] != &drawing) ++slot;
    if (slot == kMaxSlots)
      return makeError(GPGP_ERROR_UNSUPPORTED, "items[%u]: a record draws at most %u different drawings", i, kMaxSlots);
    const uint32_t room = maxPatches_ - header.patchCount, pathRoom = maxPatches_ - header.pathCount;
    uint32_t paths = full ? 0 : std::min(drawing.paths(), pathRoom);
    if (drawing.first(paths).patches > room) { // the largest number of first paths that fits
      uint32_t low = 0, high = paths;
      while (low + 1 < high) {
        const uint32_t middle = low + (high - low) / 2;
        (drawing.first(middle).patches <= room ? low : high) = middle;
      }
      paths = low;
    }
    header.pathsDropped += drawing.paths() - paths;
    full = full || paths < drawing.paths();
    if (paths == 0) continue;
    if (slot == slotCount) {
      bound[slotCount++] = &drawing;
      r.bindings[slot].ownBuffer = drawing.buffer();
      r.bindings[slot].ownSize = drawing.size();
    }
    usedPaths[slot] = std::max(usedPaths[slot], paths);
    item.opacity = info.items[i].opacity;
    item.slot = slot;
    item.firstPatch = header.patchCount;
    item.firstPath = header.pathCount;
    header.patchCount += drawing.first(paths).patches;
    header.pathCount += paths;
    std::memcpy(itemBytes + header.itemCount * sizeof item, &item, sizeof item);
    ++header.itemCount;
  }
  for (uint32_t slot = 0; slot < slotCount; ++slot) {
    const uint32_t count = bound[slot]->first(usedPaths[slot]).curves;
    slots[slot] = {header.curveCount, header.curveCount + count, bound[slot]->patchWords(), bound[slot]->pathWords()};
    header.curveCount += count;
  }

  header.width = info.width;
  header.height = info.height;
  header.tilesX = divide(info.width, shader::kTileSize);
  header.tilesY = divide(info.height, shader::kTileSize);
  header.coarseX = divide(info.width, shader::kCoarseSize);
  header.coarseCount = header.coarseX * divide(info.height, shader::kCoarseSize);
  header.groupCount = divide(header.patchCount, shader::kPatchGroup);
  header.groupWords = divide(header.groupCount, 32);
  header.entryLimit = maxEntries_;
  header.samples = info.samples ? info.samples : 16;
  header.flags = (view ? shader::kWriteView : 0) | (info.encodeSrgb ? shader::kEncodeSrgb : 0);
  header.background = {info.background[0], info.background[1], info.background[2], info.background[3]};
  std::memcpy(constants_.data(), &header, sizeof header);
  std::memcpy(constants_.data() + sizeof header, slots, sizeof slots);
  r.constants = std::span<const std::byte>(constants_)
                    .first(sizeof header + sizeof slots + header.itemCount * sizeof(ItemRecord));

  if (view) {
    r.bindings[kView].ownBuffer = view->buffer();
    r.bindings[kView].ownSize = view->size();
  }
  const bool wide = info.target.format == VK_FORMAT_R16G16B16A16_SFLOAT;
  if (info.target.view) r.bindings[wide ? kImage16 : kImage8].image = &info.target;
  r.conditions[kNoImage] = !info.target.view;
  r.conditions[kHasImage8] = info.target.view && !wide;
  r.conditions[kHasImage16] = info.target.view && wide;
  r.groups[kPatches] = {divide(header.patchCount, 64), 1, 1};
  r.groups[kCurves] = {divide(header.curveCount, 64), 1, 1};
  r.groups[kPaths] = {divide(header.pathCount, 64), 1, 1};
  r.groups[kGroups] = {header.groupCount, 1, 1};
  r.groups[kCoarse] = {divide(uint64_t(header.coarseCount) * header.groupWords, 64), 1, 1};
  r.groups[kTiles] = {header.tilesX, header.tilesY, 1};
  r.groups[kOne] = {1, 1, 1};
  r.groups[kRaster] = {header.tilesX, header.tilesY, std::max(header.samples / 4, 1u)};
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
  if (info.width == 0 || info.height == 0 || info.width > view.preparedWidth || info.height > view.preparedHeight)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%u x %u pixels are to be drawn; the view holds %u x %u", info.width,
                     info.height, view.preparedWidth, view.preparedHeight);
  struct {
    float clip[16];
    uint32_t size[4];
  } constants{};
  std::copy_n(info.clip, 16, constants.clip);
  constants.size[0] = info.width;
  constants.size[1] = info.height;
  constants.size[2] = view.preparedWidth;
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
  report.tileEntries = counters.needed;
  report.tileEntriesGiven = counters.given;
  report.pathsDropped = counters.pathsDropped;
  if (counters.pathsDropped) report.base.status = GPGP_BUDGET_EXCEEDED;
  return true;
}

} // namespace gpgp::vector
