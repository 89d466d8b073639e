// The canvas: the checks of a recording, and what a recording fills in.
#include "vector/raster/canvas.h"

#include "shaders/vector_draw_frag.spv.h"
#include "shaders/vector_draw_frag_multiview.spv.h"
#include "shaders/vector_draw_vert.spv.h"
#include "shaders/vector_draw_vert_multiview.spv.h"
#include "vector/passes/builder.h"
#include "vector/passes/names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

namespace gpgp::vector {
namespace {
using core::makeError;
using core::Result;
using shader::CanvasCounters;
using shader::CanvasHeader;

/// As many workgroups, in rows (canvas.glsl, groupIndex).
std::array<uint32_t, 3> rows(uint32_t groups) { return {std::min(groups, 32768u), divide(groups, 32768), 1}; }
std::array<uint32_t, 3> spread(uint32_t groups) { return {divide(groups, 8), 8, 1}; } // for software devices
uint32_t targetOf(const GpgpCanvasInfo& info) {
  if (!info.target.view) return kNoImage;
  return info.target.format == VK_FORMAT_R16G16B16A16_SFLOAT ? kHasImage16 : kHasImage8;
}
/// kImage...: what an image holds, and whether its texels are what the canvas mixes, as the sampler then may.
uint32_t heldBy(const GpgpCanvasImage& image, bool blendSrgb) {
  const bool encoded = image.encoding == GPGP_IMAGE_SRGB, mixes = image.premultiplied && encoded == blendSrgb;
  return (image.premultiplied ? shader::kImagePremultiplied : 0) | (encoded ? shader::kImageEncoded : 0) |
         (image.filter == GPGP_IMAGE_FILTER_LINEAR && !mixes ? shader::kImageByTexel : 0);
}

CanvasSizes sizesOf(const GpgpCanvasCreateInfo& info, bool software) {
  const uint32_t entries = info.maxTileEntries ? info.maxTileEntries : 131072;
  const uint32_t width = info.maxWidth ? info.maxWidth : 2048, height = info.maxHeight ? info.maxHeight : 2048,
                 pages = std::max(divide(info.maxImages, shader::kPageImages), 1u);
  const uint64_t pixels = info.maxImagePixels ? info.maxImagePixels : uint64_t(width) * height;
  return {.maxWidth = width,
          .maxHeight = height,
          .maxEntries = entries,
          .maxWords = info.maxTileWords ? info.maxTileWords : std::max(entries, 65536u),
          .targets = info.targets ? info.targets : ~GpgpCanvasTargets(0),
          .items = {info.maxDrawings ? info.maxDrawings : 64, info.maxGlyphs ? info.maxGlyphs : 1024,
                    info.maxShapes ? info.maxShapes : 1024, info.maxPaths ? info.maxPaths : 262144},
          .software = software && info.method == GPGP_CANVAS_FLATTENED,
          .layers = {info.maxLayerPixels, !info.maxLayerPixels      ? 0
                                          : info.maxLayerOperations ? info.maxLayerOperations
                                                                    : 1024},
          .maxTilePatches = info.method == GPGP_CANVAS_FLATTENED ? 0
                            : info.maxTilePatches                ? info.maxTilePatches
                                                                 : 2 * entries,
          .imagePages = pages,
          .imageTiles = pages > 1 ? divide(pixels, shader::kTileSize * shader::kTileSize) : 0};
}
/// Which of the shaders paint a recording.
struct Look {
  bool gradients, projective, images, groups, several;
  bool rich;  ///< what is in a group or has a projective gradient or image takes the general shader, beside the others'
  bool alone; ///< small glyphs of one colour each are all there is
  bool pages; ///< of images
  uint64_t bits() const {
    uint64_t all = 0;
    for (const bool bit : {gradients, projective, images, groups, several, rich, alone, pages}) all = all * 2 + bit;
    return all;
  }
};
Look lookOf(const Gather& gather, const GpgpCanvasInfo& info, const CanvasSizes& sizes, uint32_t tiles) {
  Look look{};
  look.gradients = gather.gradients;
  look.projective = gather.projective;
  look.images = gather.images;
  look.groups = gather.groups;
  look.several = gather.assetCount > 1 || gather.lists || gather.shapes > 0;
  look.rich = look.groups || ((look.gradients || look.images) && look.projective);
  const uint64_t lists = uint64_t(tiles) * shader::kTileListWords + uint64_t(gather.smallGlyphEntries()) * 3;
  look.alone = gather.smallGlyphs() > 0 && gather.smallGlyphs() == gather.placements() && !look.gradients &&
               !look.rich && shader::kFirstBin + lists <= sizes.binsEnd();
  look.pages = look.images && info.imageCount > shader::kPageImages;
  return look;
}

/// Of what composites a recording with layers; never 0.
uint64_t layersOf(const LayerPlanner& planner, const Gather& gather) {
  if (!planner.composites()) return 1;
  StateHash hash;
  hash.add(planner.width()).add(planner.height());
  const std::span<const shader::OperationRecord> operations = planner.operations();
  hash.add(operations[0].a).add(operations[0].result); // the rest of it is not the plan's
  hash.addBytes(operations.data() + 1, (operations.size() - 1) * sizeof operations[0]);
  for (const core::Step& step : planner.steps()) hash.add(step);
  for (const core::Resident* asset : gather.assets())
    if (asset->handle) hash.add(asset->handle).add(asset->handle->generation); // else it is a page of one that has
  return hash.value() | 1;
}

/// Whether the target's contents are given up.
bool losesTarget(const GpgpCanvasInfo& info) {
  return info.target.view && info.target.before.layout == VK_IMAGE_LAYOUT_UNDEFINED &&
         !(info.base.accessMode & GPGP_ACCESS_EXTERNAL_BARRIERS);
}
} // namespace

uint64_t Canvas::settingsOf(const GpgpCanvasInfo& info, bool pictured) const {
  const GpgpImage& t = info.target;
  StateHash hash;
  hash.add(handle).add(handle->generation).add(info.width).add(info.height).add(info.samples ? info.samples : 16);
  hash.add(info.background).add(info.encodeSrgb).add(info.exactArea).add(info.blendSrgb).add(pictured);
  hash.add(t.view);
  if (t.view) hash.add(t.image).add(t.format).add(t.mipLevel).add(t.arrayLayer);
  return hash.value();
}

Canvas::Canvas(core::Context& owner, const GpgpCanvasCreateInfo& info)
    : Recorder(owner, core::Kind::canvas, info.base, GPGP_SERVICE_VECTOR), sizes_(sizesOf(info, owner.device.software)),
      assets_(sizes_.items.items, &owner.host()), tables_(sizes_.items, &owner.host()),
      layers_(sizes_.layers, sizes_.layers.pixels ? sizes_.items.items : 0, &owner.host()),
      images_(sizes_.imagePages > 1 ? sizes_.imagePages * shader::kPageImages : 0, &owner.host()),
      imagesHold_(sizes_.imagePages, &owner.host()), damage_(sizes_.damageWords(), &owner.host()) {}

namespace {
Result<void> checkBudgets(const GpgpCanvasCreateInfo& info) {
  if (info.maxWidth > 16384 || info.maxHeight > 16384)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxWidth x maxHeight is %u x %u; at most 16384 x 16384",
                     info.maxWidth, info.maxHeight);
  if (info.maxPaths > 1u << 22)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxPaths is %u; at most 4194304", info.maxPaths);
  if (info.maxTileEntries > 1u << 28)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxTileEntries is %u; at most 268435456", info.maxTileEntries);
  if (info.maxTileWords > 1u << 28)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxTileWords is %u; at most 268435456", info.maxTileWords);
  if (info.maxDrawings > 65536)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxDrawings is %u; at most 65536", info.maxDrawings);
  if (info.maxGlyphs > 1u << 20)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxGlyphs is %u; at most 1048576", info.maxGlyphs);
  if (info.maxShapes > 1u << 20)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxShapes is %u; at most 1048576", info.maxShapes);
  if (info.targets & ~(GPGP_CANVAS_TARGET_HISTORY | GPGP_CANVAS_TARGET_RGBA8 | GPGP_CANVAS_TARGET_RGBA16F))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "targets has unknown bits");
  if (info.maxLayerPixels > 1u << 28)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxLayerPixels is %u; at most 268435456", info.maxLayerPixels);
  if (info.maxLayerOperations > 65536)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxLayerOperations is %u; at most 65536", info.maxLayerOperations);
  if (info.method < GPGP_CANVAS_FLATTENED || info.method > GPGP_CANVAS_PATCHES)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "method is %d", info.method);
  if (info.maxTilePatches > 1u << 28)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxTilePatches is %u; at most 268435456", info.maxTilePatches);
  if (info.maxImages > GPGP_MAX_IMAGES)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxImages is %u; at most %u (GPGP_MAX_IMAGES)", info.maxImages,
                     GPGP_MAX_IMAGES);
  if (info.maxImagePixels > 1u << 28)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxImagePixels is %u; at most 268435456", info.maxImagePixels);
  return {};
}
} // namespace

Result<core::Unique<Canvas>> Canvas::create(core::Context& context, const GpgpCanvasCreateInfo& info) {
  if (auto ok = checkBudgets(info); !ok) return ok.error();
  auto canvas = core::makeUnique<Canvas>(context.host(), context, info);
  const DrawShaders draw{{"draw.vert", vector_draw_vert},
                         {"draw.frag", vector_draw_frag},
                         {"draw.vert, multiview", vector_draw_vert_multiview},
                         {"draw.frag, multiview", vector_draw_frag_multiview}};
  if (auto ok = canvas->init(describePasses(canvas->sizes_, context.device, &context.host()), std::span(&draw, 1)); !ok)
    return ok.error();
  uint32_t count = 0;
  const auto& passes = canvas->passes().passes;
  for (uint32_t p = 0; p < passes.size(); ++p)
    if (passes[p].stepped) canvas->operationPasses_[count++] = p;
  return canvas;
}

Result<void> Canvas::checkInfo(const GpgpCanvasInfo& info, const CanvasHistory* history) const {
  if (info.width == 0 || info.height == 0 || info.width > sizes_.maxWidth || info.height > sizes_.maxHeight)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the canvas is %u x %u; the recorder was made for 1 x 1 to %u x %u",
                     info.width, info.height, sizes_.maxWidth, sizes_.maxHeight);
  if (info.samples != 0 && info.samples != 1 && info.samples != 4 && info.samples != 8 && info.samples != 16)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "samples is %u; expected 1, 4, 8 or 16", info.samples);
  for (const float v : info.background)
    if (!std::isfinite(v))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "background holds a number that is not finite");
  const bool pictured = history && history->width;
  if (!pictured && !info.target.view)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "neither history nor target is given: nothing would be written");
  if (info.keep && (!history || !history->kept))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "keep is set, but %s (GpgpCanvasHistoryCreateInfo::maxKept)",
                     history ? "the history remembers nothing" : "there is no history");
  if (pictured && (history->width < info.width || history->height < info.height))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the history is %u x %u, the canvas %u x %u", history->width,
                     history->height, info.width, info.height);
  if (info.target.view) {
    if (info.target.format != VK_FORMAT_R8G8B8A8_UNORM && info.target.format != VK_FORMAT_R16G16B16A16_SFLOAT)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                       "target.format is %d; expected R8G8B8A8_UNORM or R16G16B16A16_SFLOAT", info.target.format);
    if (info.target.width < info.width || info.target.height < info.height)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the target is %u x %u, the canvas %u x %u", info.target.width,
                       info.target.height, info.width, info.height);
  }
  const uint32_t target = targetOf(info);
  if ((pictured && !sizes_.writes(kNoImage)) || !sizes_.writes(target))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "the canvas was made without targets for recordings that write %s (GpgpCanvasCreateInfo::targets)",
                     pictured && !sizes_.writes(kNoImage) ? "a history"
                     : target == kHasImage8               ? "R8G8B8A8_UNORM"
                                                          : "R16G16B16A16_SFLOAT");
  if (info.imageCount > sizes_.imagePages * shader::kPageImages)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "imageCount is %u; the canvas was made for %u (GpgpCanvasCreateInfo::maxImages)", info.imageCount,
                     sizes_.imagePages * shader::kPageImages);
  if (info.imageCount && !info.images)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "images is NULL, but imageCount is %u", info.imageCount);
  for (uint32_t i = 0; i < info.imageCount; ++i) {
    if (!info.images[i].view) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "images[%u].view is NULL", i);
    if (!info.images[i].sampler) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "images[%u].sampler is NULL", i);
    if (info.images[i].layout == VK_IMAGE_LAYOUT_UNDEFINED)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "images[%u].layout is UNDEFINED: nothing could be found there", i);
    if (info.images[i].encoding < GPGP_IMAGE_LINEAR || info.images[i].encoding > GPGP_IMAGE_SRGB)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "images[%u].encoding is %d", i, info.images[i].encoding);
    if (info.images[i].filter < GPGP_IMAGE_FILTER_LINEAR || info.images[i].filter > GPGP_IMAGE_FILTER_NEAREST)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "images[%u].filter is %d", i, info.images[i].filter);
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
                             std::span<const ItemAsset> assets, CanvasHistory* history) {
  if (auto ok = checkInfo(info, history); !ok) return ok;
  core::Record r;
  r.commandBuffer = commandBuffer;
  r.info = &info.base;
  // Placements, of which texts have many, are written where they will lie.
  std::byte* const place = constants();
  auto* const placements = reinterpret_cast<shader::PlacementRecord*>(
      place ? place + sizeof(CanvasHeader) + shader::kSlots * sizeof(shader::SlotRecord) : nullptr);
  if (!placements) return record(r); // which says why
  // Recordings that show layers are planned first.
  const bool layered =
      std::any_of(assets.begin(), assets.end(), [](const ItemAsset& asset) { return asset.layered(); });
  const bool pictured = history && history->width;
  KeptRecording* const kept = history && history->kept ? &*history->kept : nullptr;
  if (kept) kept->begin(divide(info.width, shader::kTileSize), divide(info.height, shader::kTileSize), damage_);
  LayerPlanner planner(layers_, sizes_.layers, operationPasses_, sizes_.maxBins(), info);
  const uint32_t smallGlyphRoom = layered ? 0 : sizes_.smallGlyphRoom();
  std::optional<Gather> gathered;
  gathered.emplace(context, sizes_.items, tables_, placements, info, smallGlyphRoom, sizes_.maxTilePatches != 0,
                   layered ? &planner : nullptr, kept);
  for (uint32_t i = 0; i < info.itemCount && layered; ++i)
    if (auto ok = gathered->plan(i, assets[i]); !ok) return ok;
  planner.finish();
  const bool composites = layered && planner.composites();
  operationCount_ = composites ? planner.operations().size() : 0;
  const uint32_t width = composites ? planner.width() : info.width,
                 height = composites ? planner.height() : info.height; // of what is rasterised
  for (uint32_t i = 0; i < info.itemCount; ++i)
    if (auto ok = gathered->add(i, assets[i]); !ok) return ok;
  const uint32_t tilesX = divide(width, shader::kTileSize), tilesY = divide(height, shader::kTileSize),
                 tiles = tilesX * tilesY;
  const Look look = lookOf(*gathered, info, sizes_, tiles);
  KeptRecording::Whole whole;
  whole.number = recordings_ + 1;
  if (kept) {
    whole.settings = settingsOf(info, pictured);
    whole.shaders = look.bits();
    whole.layers = layered ? layersOf(planner, *gathered) : 0;
    whole.complete = gathered->complete();
  }
  GpgpCanvasRedraw redraw = GPGP_CANVAS_REDRAW_NOT_ASKED;
  if (info.keep) redraw = kept->compare(whole, broken_);
  if (redraw == GPGP_CANVAS_REDRAW_NONE && losesTarget(info)) redraw = GPGP_CANVAS_REDRAW_SETTINGS;
  const uint32_t shown = divide(info.width, shader::kTileSize) * divide(info.height, shader::kTileSize);
  const bool partly = redraw == GPGP_CANVAS_REDRAW_NONE;
  r.note = {whole.number, shown, partly ? kept->damagedTiles() : shown, static_cast<uint32_t>(redraw)};
  const auto recorded = [&] {
    recordings_ = whole.number;
    if (kept) kept->commit(whole, !partly);
    if (!pictured) return;
    history->preparedWidth = info.width;
    history->preparedHeight = info.height;
  };
  if (partly && kept->damagedTiles() == 0) {
    if (auto ok = recordNothing(r, info); !ok) return ok;
    recorded();
    return {};
  }
  if (partly) { // once more, without what lies elsewhere
    gathered.emplace(context, sizes_.items, tables_, placements, info, smallGlyphRoom, sizes_.maxTilePatches != 0,
                     nullptr, kept, true);
    for (uint32_t i = 0; i < info.itemCount; ++i)
      if (auto ok = gathered->add(i, assets[i]); !ok) return ok;
  }
  Gather& gather = *gathered;
  CanvasHeader header{};
  gather.finish(header);
  for (uint32_t i = 0; const Gather::BoundBuffer& bound : gather.buffers()) {
    r.bindings[i].ownBuffer = bound.buffer;
    r.bindings[i++].ownSize = bound.size;
  }
  const bool gradients = look.gradients, projective = look.projective, images = look.images, several = look.several;
  const bool rich = look.rich, alone = look.alone;

  header.width = width;
  header.height = height;
  header.tilesX = tilesX;
  header.tilesY = tilesY;
  header.pathWords = divide(header.pathCount, 32);
  // Small bins where there are many paths, if there is room for them.
  constexpr uint32_t kPathsOfBin = 64;
  for (uint32_t shift = shader::kMaxBinShift; shift >= shader::kMinBinShift; --shift) {
    const uint32_t across = divide(width, shader::kTileSize << shift),
                   count = across * divide(height, shader::kTileSize << shift);
    if (shift != shader::kMaxBinShift && uint64_t(count) * (header.pathWords + shader::kBinHead) > sizes_.binWords())
      break;
    header.binShift = shift;
    header.binsX = across;
    header.binCount = count;
    if (sizes_.software || header.pathCount <= count * kPathsOfBin) break;
  }
  header.binWords = header.pathWords + shader::kBinHead;
  header.binListLimit = sizes_.binLists();
  header.wordLimit = sizes_.maxWords;
  header.entryLimit = sizes_.maxEntries - gather.smallGlyphEntries();
  header.rowLimit = sizes_.maxRows();
  header.samples = info.samples ? info.samples : 16;
  header.flags = (pictured ? shader::kWriteView : 0) | (info.encodeSrgb ? shader::kEncodeSrgb : 0) |
                 (info.exactArea ? shader::kExactArea : 0) | (info.blendSrgb ? shader::kBlendSrgb : 0);
  if (composites) header.flags |= shader::kWriteView | shader::kKeepEncoding;
  if (layered) header.sources = std::max(header.sources, planner.runsNeeded());
  header.layerPixels = layered ? planner.pixelsNeeded() : 0;
  header.layerOperations = layered ? planner.operationsNeeded() : 0;
  if (rich) header.flags |= shader::kSplitRich;
  // Few segments are dealt out to many workgroups, which then each wait for less; many are better taken together.
  const uint32_t perGroup = sizes_.software ? 64 : header.segmentCount < 16384 ? 4 : shader::kMostSegments;
  header.groupSegments = perGroup;
  header.listWords = sizes_.listWords();
  // More images than a shader can name paint in pages, before the raster.
  const uint32_t pages = images ? divide(info.imageCount, shader::kPageImages) : 0;
  std::fill(imagesHold_.begin(), imagesHold_.end(), 0);
  for (uint32_t i = 0; i < info.imageCount && images; ++i)
    imagesHold_[i / shader::kPageImages] |= heldBy(info.images[i], info.blendSrgb)
                                            << i % shader::kPageImages * shader::kImageBits;
  header.images = imagesHold_[0];
  header.imageTiles = pages > 1 ? sizes_.imageTiles : 0;
  if (partly) header.damage = static_cast<uint32_t>(sizes_.binsEnd());
  const shader::vec4 background{info.background[0], info.background[1], info.background[2], info.background[3]};
  if (!composites) header.background = background; // else what layers make lies on it
  const auto bytes = [](const auto& records, uint32_t count) { return std::as_bytes(std::span(records).first(count)); };
  struct Heads {
    CanvasHeader header;
    shader::SlotRecord slots[shader::kSlots];
  } heads{header, {}};
  std::copy_n(gather.firstSlots().begin(), shader::kSlots, heads.slots);
  gather.placePatchTable(sizes_.maxTilePatches);
  r.constants = {bytes(std::span(&heads, 1), 1),
                 std::as_bytes(std::span(placements, gather.placements())),
                 bytes(tables_.sources, gather.sources),
                 bytes(tables_.shapes, gather.shapes),
                 bytes(tables_.paints, gather.paints),
                 bytes(tables_.stops, gather.stops),
                 bytes(tables_.clips, gather.clips),
                 bytes(tables_.layers, gather.layers),
                 bytes(tables_.slots, gather.slots()),
                 bytes(tables_.patchItems, gather.patchItems),
                 partly ? std::as_bytes(kept->damage()) : std::span<const std::byte>{}};

  if (pictured) {
    core::Binding& binding = r.bindings[composites ? shader::kBindLayeredHistory : shader::kBindHistory];
    binding.ownBuffer = history->buffer();
    binding.ownSize = history->bufferSize();
  }
  const uint32_t target = targetOf(info), image = composites ? kNoImage : target; // image: of the raster
  if (target != kNoImage)
    r.bindings[target == kHasImage8 ? shader::kBindImage8 : shader::kBindImage16].image = &info.target;
  if (composites) {
    r.bindings[shader::kBindHistory].scratch = shader::kBindPictures;
    shader::OperationRecord& present = layers_.operations[0];
    present.values[0] = background;
    present.mode = pictured;
    r.bindings[shader::kBindOperations].hostData = std::as_bytes(planner.operations());
    r.steps = planner.steps();
    r.conditions[kPresent + target] = true;
  }
  // Small glyphs have passes of their own; recordings of nothing else, in one colour each, need little more than that.
  const uint32_t form = projective ? 2 : several ? 1 : 0;
  const bool sixteen = header.samples == 16 && !sizes_.software;
  if (alone) {
    r.conditions[kAlone] = r.conditions[several ? kAloneDrawings : sixteen ? kAloneSixteen : kAloneOne] = true;
  } else {
    r.conditions[kPlaced] = r.conditions[kOneDrawing + form] = true;
    r.conditions[sixteen && form == 0 ? kMarkSixteen : kMarkOne + form] = true;
    if (gather.smallGlyphs() > 0) r.conditions[several ? kSmallGlyphDrawings : kSmallGlyphOne] = true;
  }
  const bool one = !several && !sizes_.software; // software devices have one general shader
  const shader::PatchTableRecord& patches = gather.patchTable;
  if (patches.items) r.conditions[several ? kPatchesDrawings : kPatchesOne] = true;
  const uint32_t kinds[] = {alone    ? kGlyphs
                            : images ? kImages
                            // The plain shader fetches from one drawing only, and on hardware leaves no squares to the
                            // general one.
                            : !gradients && !(rich && (several || !sizes_.software)) ? kPlain
                            : several                                                ? kPaints
                                                                                     : kPaintsOne,
                            kAny,
                            images ? kRichImages
                            : one  ? kRichOne
                                   : kRich};
  for (const uint32_t painted : std::span(kinds).first(rich ? 3 : 2)) {
    r.conditions[painted + image] = true;
    if (sizes_.software && pictured && !composites)
      r.conditions[painted + kNoImage] = true; // there no pass writes both
  }
  if (rich) r.conditions[images ? kAsideImages : one ? kAsideOne : kAside] = true;
  if (rich || sizes_.software) r.conditions[!rich ? kSiftPlain : one ? kSplitOne : kSplit] = true;
  // Shaders name all images, so those that are not there are bound to the first one.
  for (uint32_t i = 0; i < pages * shader::kPageImages; ++i) {
    const GpgpCanvasImage& from = info.images[i < info.imageCount ? i : 0];
    const VkDescriptorImageInfo texture{from.sampler, from.view, from.layout};
    if (pages > 1)
      images_[i] = texture;
    else
      r.bindings[shader::kBindImages + i].texture = texture;
  }
  if (pages > 1) {
    r.pages = std::span(images_).first(size_t(pages) * shader::kPageImages);
    r.pageConstants = std::span(imagesHold_).first(pages);
    r.conditions[kImagePages] = true;
  }
  r.groups[kPaths] = rows(divide(std::max(header.pathCount, 1u), 64)); // it also counts what was left out
  const uint64_t bins = uint64_t(header.binCount) * header.binWords;
  r.groups[kBegin] = {alone ? divide(std::max(tiles, gather.sources), 64)
                      : sizes_.software
                          ? divide(std::max<uint64_t>({header.itemCount, header.shapeTables / 16, bins / 16, 1}), 64)
                          : divide(sizes_.maxWords, 64 * 8),
                      1, 1};
  const uint32_t segmentGroups = divide(header.segmentCount, perGroup);
  r.groups[kSegments] = sizes_.software ? spread(segmentGroups) : rows(shader::kClearGroups + segmentGroups);
  // On software devices an invocation takes part of a segment's flattened segments, few enough turns for lavapipe's
  // loops.
  if (sizes_.software) r.groups[kSegments][2] = divide(height, 1024);
  r.groups[kOnce] = {1, 1, 1};
  r.groups[kPatches] = rows(divide(patches.patches, std::max(patches.groupPatches, 1u)));
  r.groups[kPatchBlocks] = {512, 1, 1};
  // On software devices workgroups that have nothing to do cost as much as others. There a workgroup takes at most
  // 32768 tiles, which ends before their loops do.
  r.groups[kImageTiles] = sizes_.software
                              ? std::array<uint32_t, 3>{std::max(divide(sizes_.imageTiles, 32768), 2u), 16, 1}
                              : std::array<uint32_t, 3>{16, 64, 1};
  r.groups[kClear] = {64, 1, 1};
  r.groups[kFill] = {std::min(std::max(header.segmentCount / 160, divide(height, 64)), 4096u), 1, 1};
  r.groups[kSmallGlyphs] = rows(std::max(header.itemCount, 1u));
  const uint32_t wordGroups = std::min(std::max(256u, header.segmentCount / 256), divide(sizes_.maxWords, 64));
  r.groups[kWords] = sizes_.software ? spread(wordGroups) : std::array<uint32_t, 3>{wordGroups, 1, 1};
  r.groups[kTiles] = {divide(header.tilesX, 8), divide(header.tilesY, 8), 8};
  r.groups[kPacks] = rows(header.binCount);
  r.groups[kSift] = spread(divide(uint64_t(header.binCount) << header.binShift, 64));
  r.groups[kPresents] = {divide(info.width, 8), divide(info.height, 8), 1};
  r.groups[kRaster] = {header.tilesX, header.tilesY, 1};
  constexpr uint32_t kSplitSide = 1u << shader::kMinBinShift;
  r.groups[kSplits] = {divide(header.tilesX, kSplitSide), divide(header.tilesY, kSplitSide), 1};
  if (auto ok = check(r); !ok) return ok;
  if (auto ok = record(r); !ok) return ok;
  recorded();
  return {};
}

Result<void> Canvas::recordNothing(core::Record& r, const GpgpCanvasInfo& info) {
  const uint32_t target = targetOf(info);
  if (target != kNoImage)
    r.bindings[target == kHasImage8 ? shader::kBindImage8 : shader::kBindImage16].image = &info.target;
  r.nothing = true;
  if (auto ok = check(r); !ok) return ok;
  return record(r);
}

void Canvas::harvested(const core::RawReport& report) {
  CanvasCounters counters{};
  if (report.header.status == GPGP_SUCCESS) std::memcpy(&counters, report.words.data(), sizeof counters);
  if (report.header.status != GPGP_SUCCESS || counters.pathsDropped || counters.ended) broken_ = report.note[0];
}

Result<void> Canvas::draw(VkCommandBuffer commandBuffer, const GpgpCanvasDrawInfo& info, CanvasHistory& history) {
  if (history.preparedWidth == 0) return makeError(GPGP_NOT_READY, "nothing was prepared into the history");
  const uint32_t last = std::max(info.x, info.target->viewMask ? info.secondX : 0);
  if (info.width == 0 || info.height == 0 || last > history.preparedWidth ||
      info.width > history.preparedWidth - last || info.height > history.preparedHeight)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "%u x %u pixels from column %u on are to be drawn; the history holds %u x %u", info.width,
                     info.height, last, history.preparedWidth, history.preparedHeight);
  struct {
    float columns[2][12];
    uint32_t size[4], begins[2], encode;
  } constants{};
  for (int k = 0; k < 2; ++k) {
    const float* clip = k && info.secondClip ? info.secondClip : info.clip;
    std::copy_n(clip, 8, constants.columns[k]);
    std::copy_n(clip + 12, 4, constants.columns[k] + 8);
  }
  constants.size[0] = info.width;
  constants.size[1] = info.height;
  constants.size[2] = history.preparedWidth;
  constants.begins[0] = info.x;
  constants.begins[1] = info.secondX;
  constants.encode = info.encodeSrgb ? 1 : 0;
  core::DrawRecord r;
  r.commandBuffer = commandBuffer;
  r.bindings[shader::kBindHistory].ownBuffer = history.buffer();
  r.bindings[shader::kBindHistory].ownSize = history.size();
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
  const bool executed = raw.header.status == GPGP_SUCCESS;
  report.paths = counters.paths;
  report.pathsGiven = executed ? sizes_.items.paths : 0;
  report.tileWords = counters.words;
  report.tileWordsGiven = counters.wordsGiven;
  // Where the others do not fit, small glyphs count as what was put aside for them.
  const uint32_t aside = executed ? sizes_.maxEntries - counters.entriesGiven : 0;
  report.tileEntries = counters.entries + (counters.entries > counters.entriesGiven ? aside : counters.smallGlyph);
  report.tileEntriesGiven = executed ? sizes_.maxEntries : 0;
  report.pathsDropped = counters.pathsDropped;
  report.glyphs = counters.glyphs;
  report.glyphsGiven = counters.glyphsGiven;
  report.shapes = counters.shapes;
  report.shapesGiven = counters.shapesGiven;
  report.items = counters.items;
  report.itemsGiven = counters.itemsGiven;
  report.layerPixels = counters.layerPixels;
  report.layerPixelsGiven = executed ? sizes_.layers.pixels : 0;
  report.layerOperations = counters.layerOperations;
  report.layerOperationsGiven = executed ? sizes_.layers.operations : 0;
  report.tilePatches = counters.tilePatches;
  report.tilePatchesGiven = executed ? sizes_.maxTilePatches : 0;
  constexpr uint32_t kTilePixels = shader::kTileSize * shader::kTileSize;
  report.imagePixels =
      static_cast<uint32_t>(std::min<uint64_t>(uint64_t(counters.imageTiles) * kTilePixels, UINT32_MAX));
  report.imagePixelsGiven = executed ? sizes_.imageTiles * kTilePixels : 0;
  report.tiles = raw.note[1];
  report.tilesDrawn = executed ? raw.note[2] : 0;
  report.redraw = static_cast<GpgpCanvasRedraw>(raw.note[3]);
  if (counters.pathsDropped) report.base.status = GPGP_BUDGET_EXCEEDED;
  if (counters.ended) report.base.status = GPGP_ERROR_UNSUPPORTED;
  return true;
}

} // namespace gpgp::vector
