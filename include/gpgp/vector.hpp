/* gpgp vector.hpp: C++17 wrapper of vector.h. The rules of the wrapper are in core.hpp. */
#ifndef GPGP_VECTOR_HPP
#define GPGP_VECTOR_HPP

#include <gpgp/core.hpp>
#include <gpgp/vector.h>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpSvgSource, GPGP_STRUCTURE_SVG_SOURCE);
GPGP_STRUCTURE_OF(GpgpDrawingCreateInfo, GPGP_STRUCTURE_DRAWING_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpDrawingInfo, GPGP_STRUCTURE_DRAWING_INFO);
GPGP_STRUCTURE_OF(GpgpGlyphSource, GPGP_STRUCTURE_GLYPH_SOURCE);
GPGP_STRUCTURE_OF(GpgpGlyphSetCreateInfo, GPGP_STRUCTURE_GLYPH_SET_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpGlyphSetInfo, GPGP_STRUCTURE_GLYPH_SET_INFO);
GPGP_STRUCTURE_OF(GpgpCanvasCreateInfo, GPGP_STRUCTURE_CANVAS_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpCanvasInfo, GPGP_STRUCTURE_CANVAS_INFO);
GPGP_STRUCTURE_OF(GpgpCanvasDrawInfo, GPGP_STRUCTURE_CANVAS_DRAW_INFO);
GPGP_STRUCTURE_OF(GpgpCanvasReport, GPGP_STRUCTURE_CANVAS_REPORT);
GPGP_STRUCTURE_OF(GpgpCanvasHistoryCreateInfo, GPGP_STRUCTURE_CANVAS_HISTORY_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpPatchRecorderCreateInfo, GPGP_STRUCTURE_PATCH_RECORDER_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpPatchDrawInfo, GPGP_STRUCTURE_PATCH_DRAW_INFO);

/// A vector drawing on the device (gpgpCreateDrawing).
class Drawing : public Asset {
public:
  using Asset::Asset;
  static Result<Drawing> create(GpgpContext context, const GpgpDrawingCreateInfo& info) noexcept {
    return detail::create<Drawing>(gpgpCreateDrawing, context, info);
  }
  /// gpgpGetDrawingInfo
  Result<GpgpDrawingInfo> info() const noexcept {
    GpgpDrawingInfo value = init<GpgpDrawingInfo>();
    const GpgpResult code = gpgpGetDrawingInfo(get(), &value);
    return Result<GpgpDrawingInfo>(code, value);
  }
};

/// A set of glyph outlines on the device (gpgpCreateGlyphSet).
class GlyphSet : public Asset {
public:
  using Asset::Asset;
  static Result<GlyphSet> create(GpgpContext context, const GpgpGlyphSetCreateInfo& info) noexcept {
    return detail::create<GlyphSet>(gpgpCreateGlyphSet, context, info);
  }
  /// gpgpAddGlyphs. GPGP_BUDGET_EXCEEDED means that some glyphs did not fit.
  [[nodiscard]] GpgpResult add(const GpgpGlyph* glyphs, uint32_t count, uint32_t* indices) noexcept {
    return gpgpAddGlyphs(get(), glyphs, count, indices);
  }
  /// gpgpFindGlyphs. GPGP_INCOMPLETE means that some glyphs are not in the set.
  [[nodiscard]] GpgpResult find(const uint64_t* keys, uint32_t count, uint32_t* indices) noexcept {
    return gpgpFindGlyphs(get(), keys, count, indices);
  }
  /// gpgpGetGlyphSetInfo
  Result<GpgpGlyphSetInfo> info() const noexcept {
    GpgpGlyphSetInfo value = init<GpgpGlyphSetInfo>();
    const GpgpResult code = gpgpGetGlyphSetInfo(get(), &value);
    return Result<GpgpGlyphSetInfo>(code, value);
  }
};

/// The result of a canvas, kept to be drawn again (gpgpCreateCanvasHistory).
class CanvasHistory : public History {
public:
  using History::History;
  static Result<CanvasHistory> create(GpgpContext context, const GpgpCanvasHistoryCreateInfo& info) noexcept {
    return detail::create<CanvasHistory>(gpgpCreateCanvasHistory, context, info);
  }
};

/// Rasterises drawings, lists and text (gpgpCreateCanvas).
class Canvas : public Recorder {
public:
  using Recorder::Recorder;
  static Result<Canvas> create(GpgpContext context, const GpgpCanvasCreateInfo& info) noexcept {
    return detail::create<Canvas>(gpgpCreateCanvas, context, info);
  }
  /// gpgpRecordPrepareCanvas: outside render passes.
  [[nodiscard]] GpgpResult recordPrepare(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                         const GpgpCanvasInfo& info) noexcept {
    return gpgpRecordPrepareCanvas(get(), commandBuffer, &frame, &info);
  }
  /// gpgpRecordDrawCanvas: inside a render pass of the engine.
  [[nodiscard]] GpgpResult recordDraw(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                      const GpgpCanvasDrawInfo& info) noexcept {
    return gpgpRecordDrawCanvas(get(), commandBuffer, &frame, &info);
  }
  /// gpgpGetCanvasReport: the oldest report that was not taken yet, or GPGP_NOT_READY.
  Result<GpgpCanvasReport> report() noexcept { return detail::report(gpgpGetCanvasReport, get()); }
};

/// Draws drawings and text as geometry inside the engine's render pass (gpgpCreatePatchRecorder).
class PatchRecorder : public Recorder {
public:
  using Recorder::Recorder;
  static Result<PatchRecorder> create(GpgpContext context, const GpgpPatchRecorderCreateInfo& info) noexcept {
    return detail::create<PatchRecorder>(gpgpCreatePatchRecorder, context, info);
  }
  /// gpgpRecordDrawPatches: inside a render pass of the engine.
  [[nodiscard]] GpgpResult recordDraw(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                      const GpgpPatchDrawInfo& info) noexcept {
    return gpgpRecordDrawPatches(get(), commandBuffer, &frame, &info);
  }
};

// ---------------------------------------------------------------- compiler (libgpgp_compiler)

/// gpgpCompileSvg: the drawing as bytes for GpgpDrawingCreateInfo.
inline Result<Blob> compileSvg(const GpgpSvgSource& source) noexcept {
  GpgpBlob blob = GpgpBlob();
  const GpgpResult code = gpgpCompileSvg(&source, &blob);
  return Result<Blob>(code, Blob(blob));
}

/// gpgpCompileGlyphs: the glyphs as bytes for GpgpGlyphSetCreateInfo.
inline Result<Blob> compileGlyphs(const GpgpGlyphSource& source) noexcept {
  GpgpBlob blob = GpgpBlob();
  const GpgpResult code = gpgpCompileGlyphs(&source, &blob);
  return Result<Blob>(code, Blob(blob));
}

} // namespace gpgp

#endif
