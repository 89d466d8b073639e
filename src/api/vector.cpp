// The C functions of vector.h that belong to the run-time library.
#include "api/items.h"
#include "vector/raster/canvas.h"
#include "vector/raster/patch_recorder.h"

#include <algorithm>
#include <unordered_set>

using namespace gpgp;
using namespace gpgp::api;
using namespace gpgp::vector;

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
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    const DrawingAsset* base = nullptr;
    if (info->base) {
      const auto resolved = resolve<DrawingAsset>(call, info->base, Kind::drawing, "base", *context);
      if (!resolved) return resolved.error();
      base = *resolved;
    }
    auto made = DrawingAsset::create(**context, *info, base);
    if (!made) return made.error();
    *drawing = adopt<GpgpAsset>(**context, std::move(*made));
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
    if (auto ok = (*context)->checkAlive(); !ok) return ok;
    const auto given = givenBytes(**context, info->data, info->size, info->filePath);
    if (!given) return given.error();
    auto made = GlyphSet::create(**context, *info, given->bytes);
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
