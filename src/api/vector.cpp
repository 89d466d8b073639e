// The C functions of vector.h that belong to the run-time library.
#include "api/items.h"
#include "vector/raster/canvas.h"
#include "vector/raster/patch_recorder.h"

#include <algorithm>
#include <optional>
#include <unordered_set>

using namespace gpgp;
using namespace gpgp::api;
using namespace gpgp::vector;

namespace {
Result<void> checkMethods(GpgpDrawingMethods methods) {
  if (methods & ~(GPGP_DRAWING_FLATTENED | GPGP_DRAWING_IN_PASS | GPGP_DRAWING_PATCHES))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "methods has unknown bits");
  if ((methods & GPGP_DRAWING_PATCHES) && !(methods & GPGP_DRAWING_FLATTENED))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "methods has GPGP_DRAWING_PATCHES without GPGP_DRAWING_FLATTENED, which canvases need as well");
  return {};
}
} // namespace

GpgpResult GPGP_CALL gpgpCreateDrawing(GpgpContext handle, const GpgpDrawingCreateInfo* info, GpgpAsset* drawing) {
  return guarded("gpgpCreateDrawing", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_DRAWING_CREATE_INFO, "info"); !ok) return ok;
    if (!drawing) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "drawing is NULL");
    if ((info->data != nullptr) + (info->filePath != nullptr) + (info->paths != nullptr) + (info->base != nullptr) != 1)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "exactly one of data, filePath, paths and base must be given");
    if (info->editCount && (!info->edits || !info->base))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "editCount is %u without edits or without base", info->editCount);
    if (info->groupCount && (!info->groups || !info->paths))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "groupCount is %u without groups or without paths",
                       info->groupCount);
    if (auto ok = checkMethods(info->methods); !ok) return ok;
    if ((info->editable || info->hitTestable || info->base) && info->methods &&
        !(info->methods & GPGP_DRAWING_FLATTENED))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                       "methods has no GPGP_DRAWING_FLATTENED, which edits and hit tests need");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    std::pmr::memory_resource* memory = &(*context)->host();
    const DrawingAsset* base = nullptr;
    if (info->base) {
      const auto resolved = resolve<DrawingAsset>(call, info->base, Kind::drawing, "base", *context);
      if (!resolved) return resolved.error();
      base = *resolved;
      if (!base->kept()) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "base was not made editable");
    }
    const std::span edits(info->edits, info->editCount);
    const bool flattened = info->methods == 0 || (info->methods & GPGP_DRAWING_FLATTENED);
    const uint64_t mostBytes = flattened ? outlineBytes((*context)->device.limits.maxStorageBufferRange) : UINT64_MAX;
    const auto make = [&]() -> Result<Drawing> {
      if (base) return replacePaths(base->kept()->drawing, edits, memory, mostBytes);
      if (info->paths)
        return makeDrawing(std::span(info->paths, info->pathCount), std::span(info->groups, info->groupCount), memory,
                           &(*context)->jobSystem, nullptr, mostBytes);
      if (info->data) return loadBaked(std::span(static_cast<const std::byte*>(info->data), info->size), memory);
      const auto bytes = (*context)->readFile(info->filePath);
      if (!bytes) return bytes.error();
      return loadBaked(*bytes, memory);
    };
    auto made = make();
    if (!made) return made.error();
    const GpgpDrawingMethods held = methodsOf(*made), methods = info->methods ? info->methods : held;
    if ((held & GPGP_DRAWING_FLATTENED) == 0 &&
        (methods != GPGP_DRAWING_IN_PASS || info->editable || info->hitTestable))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                       "the drawing was baked without GPGP_DRAWING_FLATTENED; bake it with both methods");
    if (!made->plan.empty() && (info->editable || info->hitTestable || (methods & GPGP_DRAWING_IN_PASS)))
      return makeError(GPGP_ERROR_UNSUPPORTED, "the drawing has layers: it cannot be %s",
                       info->editable      ? "editable"
                       : info->hitTestable ? "hitTestable"
                                           : "drawn inside a render pass (GPGP_DRAWING_IN_PASS)");
    auto asset = DrawingAsset::create(**context, info->label, std::move(*made), info->editable != VK_FALSE,
                                      info->hitTestable != VK_FALSE, methods, base, edits);
    if (!asset) return asset.error();
    *drawing = adopt<GpgpAsset>(**context, std::move(*asset));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetDrawingInfo(GpgpAsset handle, GpgpDrawingInfo* info) {
  return guarded("gpgpGetDrawingInfo", [&](Call& call) -> Result<void> {
    const auto drawing = resolve<DrawingAsset>(call, handle, Kind::drawing, "drawing");
    if (!drawing) return drawing.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_DRAWING_INFO, "info"); !ok) return ok;
    std::copy_n((*drawing)->bounds(), 4, info->bounds);
    std::copy_n((*drawing)->viewport(), 4, info->viewport);
    info->paths = (*drawing)->paths();
    info->curves = (*drawing)->curves();
    info->patches = (*drawing)->patches();
    info->pathsLeftOut = (*drawing)->pathsLeftOut();
    return {};
  });
}

GpgpResult GPGP_CALL gpgpCreateGlyphSet(GpgpContext handle, const GpgpGlyphSetCreateInfo* info, GpgpAsset* glyphSet) {
  return guarded("gpgpCreateGlyphSet", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_GLYPH_SET_CREATE_INFO, "info"); !ok) return ok;
    if (!glyphSet) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "glyphSet is NULL");
    if (info->data && info->filePath) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "both data and filePath are given");
    if (info->methods & GPGP_DRAWING_PATCHES)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "glyph sets have no GPGP_DRAWING_PATCHES: canvases flatten text");
    if (auto ok = checkMethods(info->methods); !ok) return ok;
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    std::pmr::memory_resource* memory = &(*context)->host();
    std::optional<Glyphs> baked;
    if (info->data || info->filePath) {
      const auto given = givenBytes(**context, info->data, info->size, info->filePath);
      if (!given) return given.error();
      auto loaded = loadBakedGlyphs(given->bytes, memory);
      if (!loaded) return loaded.error();
      baked.emplace(std::move(*loaded));
    }
    auto made = GlyphSet::create(**context, *info, baked ? &*baked : nullptr);
    if (!made) return made.error();
    *glyphSet = adopt<GpgpAsset>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpAddGlyphs(GpgpAsset handle, const GpgpGlyph* glyphs, uint32_t count, uint32_t* indices) {
  return guarded("gpgpAddGlyphs", [&](Call& call) -> Result<void> {
    const auto set = resolve<GlyphSet>(call, handle, Kind::glyphSet, "glyphSet");
    if (!set) return set.error();
    if (count && (!glyphs || !indices))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "glyphs or indices is NULL, but count is %u", count);
    core::Context& context = (*set)->context;
    if (auto ok = context.checkAlive(); !ok) return ok;
    // Converted before anything changes; those that are there already stay, as they are used now.
    std::pmr::vector<GpgpGlyph> wanted(&context.host());
    std::pmr::unordered_set<uint64_t> keys(&context.host());
    for (uint32_t i = 0; i < count; ++i)
      if ((*set)->indexOf(glyphs[i].key) == GPGP_GLYPH_NONE && keys.insert(glyphs[i].key).second)
        wanted.push_back(glyphs[i]);
    const auto made = makeGlyphs(wanted, &context.host(), &context.jobSystem);
    if (!made) return made.error();
    const bool all = (*set)->add(*made, context.current());
    for (uint32_t i = 0; i < count; ++i) indices[i] = (*set)->indexOf(glyphs[i].key);
    if (!all) return makeError(GPGP_BUDGET_EXCEEDED, "not all glyphs found room");
    return {};
  });
}

GpgpResult GPGP_CALL gpgpFindGlyphs(GpgpAsset handle, const uint64_t* keys, uint32_t count, uint32_t* indices) {
  return guarded("gpgpFindGlyphs", [&](Call& call) -> Result<void> {
    const auto set = resolve<GlyphSet>(call, handle, Kind::glyphSet, "glyphSet");
    if (!set) return set.error();
    if (count && (!keys || !indices))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "keys or indices is NULL, but count is %u", count);
    bool all = true;
    for (uint32_t i = 0; i < count; ++i) {
      indices[i] = (*set)->indexOf(keys[i]);
      all = all && indices[i] != GPGP_GLYPH_NONE;
    }
    if (!all) return makeError(GPGP_INCOMPLETE, "not all glyphs are in the set");
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetGlyphSetInfo(GpgpAsset handle, GpgpGlyphSetInfo* info) {
  return guarded("gpgpGetGlyphSetInfo", [&](Call& call) -> Result<void> {
    const auto set = resolve<GlyphSet>(call, handle, Kind::glyphSet, "glyphSet");
    if (!set) return set.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_GLYPH_SET_INFO, "info"); !ok) return ok;
    (*set)->getInfo(*info);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpCreateCanvas(GpgpContext handle, const GpgpCanvasCreateInfo* info, GpgpRecorder* canvas) {
  return guarded("gpgpCreateCanvas", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_CANVAS_CREATE_INFO, "info"); !ok) return ok;
    if (!canvas) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "canvas is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    if (info->maxWidth > 16384 || info->maxHeight > 16384)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxWidth x maxHeight is %u x %u; at most 16384 x 16384",
                       info->maxWidth, info->maxHeight);
    if (info->maxPaths > 1u << 22)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxPaths is %u; at most 4194304", info->maxPaths);
    if (info->maxTileEntries > 1u << 28)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxTileEntries is %u; at most 268435456", info->maxTileEntries);
    if (info->maxTileWords > 1u << 28)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxTileWords is %u; at most 268435456", info->maxTileWords);
    if (info->maxDrawings > 65536)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxDrawings is %u; at most 65536", info->maxDrawings);
    if (info->maxGlyphs > 1u << 20)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxGlyphs is %u; at most 1048576", info->maxGlyphs);
    if (info->maxShapes > 1u << 20)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxShapes is %u; at most 1048576", info->maxShapes);
    if (info->targets & ~(GPGP_CANVAS_TARGET_HISTORY | GPGP_CANVAS_TARGET_RGBA8 | GPGP_CANVAS_TARGET_RGBA16F))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "targets has unknown bits");
    if (info->maxLayerPixels > 1u << 28)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxLayerPixels is %u; at most 268435456", info->maxLayerPixels);
    if (info->maxLayerOperations > 65536)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxLayerOperations is %u; at most 65536",
                       info->maxLayerOperations);
    if (info->method < GPGP_CANVAS_FLATTENED || info->method > GPGP_CANVAS_PATCHES)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "method is %d", info->method);
    if (info->maxTilePatches > 1u << 28)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxTilePatches is %u; at most 268435456", info->maxTilePatches);
    if (info->maxImages > GPGP_MAX_IMAGES)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxImages is %u; at most %u (GPGP_MAX_IMAGES)", info->maxImages,
                       GPGP_MAX_IMAGES);
    if (info->maxImagePixels > 1u << 28)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxImagePixels is %u; at most 268435456", info->maxImagePixels);
    auto made = Canvas::create(**context, *info);
    if (!made) return made.error();
    *canvas = adopt<GpgpRecorder>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpCreateCanvasHistory(GpgpContext handle, const GpgpCanvasHistoryCreateInfo* info,
                                             GpgpHistory* history) {
  return guarded("gpgpCreateCanvasHistory", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_CANVAS_HISTORY_CREATE_INFO, "info"); !ok) return ok;
    if (!history) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "history is NULL");
    const bool pictured = info->width || info->height || info->maxKept == 0;
    if (pictured && (info->width == 0 || info->height == 0 || info->width > 16384 || info->height > 16384))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "width x height is %u x %u; expected 1 x 1 to 16384 x 16384",
                       info->width, info->height);
    if (info->maxKept > 1u << 22)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxKept is %u; at most 4194304", info->maxKept);
    const uint64_t bytes = uint64_t(info->width) * info->height * 8;
    if (bytes > (*context)->device.limits.maxStorageBufferRange)
      return makeError(GPGP_ERROR_UNSUPPORTED, "%u x %u pixels need %llu bytes, but this device binds at most %u",
                       info->width, info->height, static_cast<unsigned long long>(bytes),
                       (*context)->device.limits.maxStorageBufferRange);
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    auto made = CanvasHistory::create(**context, *info);
    if (!made) return made.error();
    *history = adopt<GpgpHistory>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpRecordPrepareCanvas(GpgpRecorder handle, VkCommandBuffer commandBuffer, const GpgpFrame* frame,
                                             const GpgpCanvasInfo* info) {
  return guarded("gpgpRecordPrepareCanvas", [&](Call& call) -> Result<void> {
    const auto canvas = resolve<Canvas>(call, handle, Kind::canvas, "canvas");
    if (!canvas) return canvas.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_CANVAS_INFO, "info"); !ok) return ok;
    const core::Context& context = (*canvas)->context;
    if (info->itemCount && !info->items)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items is NULL, but itemCount is %u", info->itemCount);
    if (info->itemCount > (*canvas)->maxDrawings())
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "itemCount is %u; the canvas was made for %u (maxDrawings)",
                       info->itemCount, (*canvas)->maxDrawings());
    CanvasHistory* history = nullptr;
    if (info->history) {
      const auto resolved = resolve<CanvasHistory>(call, info->history, Kind::canvasHistory, "history", &context);
      if (!resolved) return resolved.error();
      history = *resolved;
    }
    const std::span<ItemAsset> assets = (*canvas)->assets(info->itemCount);
    for (uint32_t i = 0; i < info->itemCount; ++i) {
      const auto asset = resolveItem(call, info->items[i], i, context);
      if (!asset) return asset.error();
      assets[i] = *asset;
    }
    const core::RecorderUse use(**canvas);
    if (!use) return core::RecorderUse::error();
    if (auto ok = checkRecord(**canvas, frame); !ok) return ok;
    for (const ItemAsset& asset : assets)
      if (asset.drawing && !asset.drawing->resident()) return makeError(GPGP_NOT_READY, "a drawing is not resident");
    if (history && !history->resident()) return makeError(GPGP_NOT_READY, "history is not resident");
    return (*canvas)->prepare(commandBuffer, *info, assets, history);
  });
}

GpgpResult GPGP_CALL gpgpRecordDrawCanvas(GpgpRecorder handle, VkCommandBuffer commandBuffer, const GpgpFrame* frame,
                                          const GpgpCanvasDrawInfo* info) {
  return guarded("gpgpRecordDrawCanvas", [&](Call& call) -> Result<void> {
    const auto canvas = resolve<Canvas>(call, handle, Kind::canvas, "canvas");
    if (!canvas) return canvas.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_CANVAS_DRAW_INFO, "info"); !ok) return ok;
    const auto history =
        resolve<CanvasHistory>(call, info->history, Kind::canvasHistory, "history", &(*canvas)->context);
    if (!history) return history.error();
    if (auto ok = checkStruct(info->target, GPGP_STRUCTURE_TARGET_INFO, "target"); !ok) return ok;
    if (!allFinite(info->clip)) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "clip holds a number that is not finite");
    const core::RecorderUse use(**canvas);
    if (!use) return core::RecorderUse::error();
    if (auto ok = checkRecord(**canvas, frame); !ok) return ok;
    return (*canvas)->draw(commandBuffer, *info, **history);
  });
}

GpgpResult GPGP_CALL gpgpCreatePatchRecorder(GpgpContext handle, const GpgpPatchRecorderCreateInfo* info,
                                             GpgpRecorder* recorder) {
  return guarded("gpgpCreatePatchRecorder", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_PATCH_RECORDER_CREATE_INFO, "info"); !ok) return ok;
    if (!recorder) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "recorder is NULL");
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    if (info->maxItems > 65536)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxItems is %u; at most 65536", info->maxItems);
    if (info->maxGlyphs > 1u << 20)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxGlyphs is %u; at most 1048576", info->maxGlyphs);
    auto made = PatchRecorder::create(**context, *info);
    if (!made) return made.error();
    *recorder = adopt<GpgpRecorder>(**context, std::move(*made));
    return {};
  });
}

GpgpResult GPGP_CALL gpgpRecordDrawPatches(GpgpRecorder handle, VkCommandBuffer commandBuffer, const GpgpFrame* frame,
                                           const GpgpPatchDrawInfo* info) {
  return guarded("gpgpRecordDrawPatches", [&](Call& call) -> Result<void> {
    const auto recorder = resolve<PatchRecorder>(call, handle, Kind::patchRecorder, "recorder");
    if (!recorder) return recorder.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_PATCH_DRAW_INFO, "info"); !ok) return ok;
    if (auto ok = checkStruct(info->target, GPGP_STRUCTURE_TARGET_INFO, "target"); !ok) return ok;
    if (info->itemCount && !info->items)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items is NULL, but itemCount is %u", info->itemCount);
    const core::RecorderUse use(**recorder);
    if (!use) return core::RecorderUse::error();
    if (auto ok = checkRecord(**recorder, frame); !ok) return ok;
    const core::Context& context = (*recorder)->context;
    const auto assetOf = [&](uint32_t i) -> Result<ItemAsset> {
      const GpgpPatchItem& item = info->items[i];
      ItemAsset asset;
      if (item.drawing && item.glyphSet)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u]: both drawing and glyphSet are given", i);
      if (item.glyphSet) {
        const auto set = resolve<GlyphSet>(call, item.glyphSet, Kind::glyphSet, "items[].glyphSet", &context);
        if (!set) return set.error();
        asset.glyphSet = *set;
      } else {
        const auto drawing = resolve<DrawingAsset>(call, item.drawing, Kind::drawing, "items[].drawing", &context);
        if (!drawing) return drawing.error();
        asset.drawing = *drawing;
      }
      return asset;
    };
    return (*recorder)->draw(commandBuffer, *info, assetOf);
  });
}

GpgpResult GPGP_CALL gpgpGetCanvasReport(GpgpRecorder handle, GpgpCanvasReport* report) {
  return guarded("gpgpGetCanvasReport", [&](Call& call) -> Result<void> {
    const auto canvas = resolve<Canvas>(call, handle, Kind::canvas, "canvas");
    if (!canvas) return canvas.error();
    if (auto ok = checkStruct(report, GPGP_STRUCTURE_CANVAS_REPORT, "report"); !ok) return ok;
    const core::RecorderUse use(**canvas);
    if (!use) return core::RecorderUse::error();
    if (!(*canvas)->takeCanvasReport(*report)) return noReport();
    return {};
  });
}
