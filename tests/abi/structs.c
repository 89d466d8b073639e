/* Compiled, never run, as C99, C11, C++11 and C++20: every _INIT macro makes its struct, and structs that also lie in
 * GPU buffers have the size that their comments state. */
#include <gpgp/gpgp.h>

#define GPGP_SIZE_IS(Type, bytes) typedef char sizeOf##Type[sizeof(Type) == (bytes) ? 1 : -1]
GPGP_SIZE_IS(GpgpAxiom, 96);
GPGP_SIZE_IS(GpgpInstance, 96);
GPGP_SIZE_IS(GpgpCompactInstance, 32);
GPGP_SIZE_IS(GpgpAxiomMeasures, 72);
GPGP_SIZE_IS(GpgpDetail, 44);
GPGP_SIZE_IS(GpgpVisibilityDraw, 64);
GPGP_SIZE_IS(GpgpTriangleSize, 12);
GPGP_SIZE_IS(GpgpResult, 4);
GPGP_SIZE_IS(GpgpFeatures, 8);
GPGP_SIZE_IS(GpgpAccessMode, 8);

GpgpStructureType useEveryStruct(void);

GpgpStructureType useEveryStruct(void) {
  GpgpStructureType sum = 0;
#define GPGP_USE(Type, init)                                                                                           \
  do {                                                                                                                 \
    Type value = init;                                                                                                 \
    sum += value.sType + (value.pNext != 0);                                                                           \
  } while (0)
  GPGP_USE(GpgpRequirementsInfo, GPGP_REQUIREMENTS_INFO_INIT);
  GPGP_USE(GpgpRequirements, GPGP_REQUIREMENTS_INIT);
  GPGP_USE(GpgpContextCreateInfo, GPGP_CONTEXT_CREATE_INFO_INIT);
  GPGP_USE(GpgpTargetInfo, GPGP_TARGET_INFO_INIT);
  GPGP_USE(GpgpPrewarmInfo, GPGP_PREWARM_INFO_INIT);
  GPGP_USE(GpgpMemoryReport, GPGP_MEMORY_REPORT_INIT);
  GPGP_USE(GpgpGrammarSource, GPGP_GRAMMAR_SOURCE_INIT);
  GPGP_USE(GpgpGrammarCreateInfo, GPGP_GRAMMAR_CREATE_INFO_INIT);
  GPGP_USE(GpgpSpawnerCreateInfo, GPGP_SPAWNER_CREATE_INFO_INIT);
  GPGP_USE(GpgpSpawnInfo, GPGP_SPAWN_INFO_INIT);
  GPGP_USE(GpgpSpawnReport, GPGP_SPAWN_REPORT_INIT);
  GPGP_USE(GpgpEvaluatorCreateInfo, GPGP_EVALUATOR_CREATE_INFO_INIT);
  GPGP_USE(GpgpEvaluationInfo, GPGP_EVALUATION_INFO_INIT);
  GPGP_USE(GpgpEvaluationResult, GPGP_EVALUATION_RESULT_INIT);
  GPGP_USE(GpgpDetailBudget, GPGP_DETAIL_BUDGET_INIT);
  GPGP_USE(GpgpFit, GPGP_FIT_INIT);
  GPGP_USE(GpgpFitTarget, GPGP_FIT_TARGET_INIT);
  GPGP_USE(GpgpScatterInfo, GPGP_SCATTER_INFO_INIT);
  GPGP_USE(GpgpCgaProgramCreateInfo, GPGP_CGA_PROGRAM_CREATE_INFO_INIT);
  GPGP_USE(GpgpCgaGraph, GPGP_CGA_GRAPH_INIT);
  GPGP_USE(GpgpCgaDerivationInfo, GPGP_CGA_DERIVATION_INFO_INIT);
  GPGP_USE(GpgpCgaDerivationResult, GPGP_CGA_DERIVATION_RESULT_INIT);
  GPGP_USE(GpgpTileSetCreateInfo, GPGP_TILE_SET_CREATE_INFO_INIT);
  GPGP_USE(GpgpTileInfo, GPGP_TILE_INFO_INIT);
  GPGP_USE(GpgpTileSetReport, GPGP_TILE_SET_REPORT_INIT);
  GPGP_USE(GpgpLsystemSource, GPGP_LSYSTEM_SOURCE_INIT);
  GPGP_USE(GpgpLsystemCreateInfo, GPGP_LSYSTEM_CREATE_INFO_INIT);
  GPGP_USE(GpgpLsystemRecorderCreateInfo, GPGP_LSYSTEM_RECORDER_CREATE_INFO_INIT);
  GPGP_USE(GpgpLsystemInfo, GPGP_LSYSTEM_INFO_INIT);
  GPGP_USE(GpgpLsystemReport, GPGP_LSYSTEM_REPORT_INIT);
  GPGP_USE(GpgpSvgSource, GPGP_SVG_SOURCE_INIT);
  GPGP_USE(GpgpLottieSource, GPGP_LOTTIE_SOURCE_INIT);
  GPGP_USE(GpgpLottieInfo, GPGP_LOTTIE_INFO_INIT);
  GPGP_USE(GpgpLottieFrame, GPGP_LOTTIE_FRAME_INIT);
  GPGP_USE(GpgpDrawingCreateInfo, GPGP_DRAWING_CREATE_INFO_INIT);
  GPGP_USE(GpgpDrawingInfo, GPGP_DRAWING_INFO_INIT);
  GPGP_USE(GpgpGlyphSource, GPGP_GLYPH_SOURCE_INIT);
  GPGP_USE(GpgpGlyphSetCreateInfo, GPGP_GLYPH_SET_CREATE_INFO_INIT);
  GPGP_USE(GpgpGlyphSetInfo, GPGP_GLYPH_SET_INFO_INIT);
  GPGP_USE(GpgpListCreateInfo, GPGP_LIST_CREATE_INFO_INIT);
  GPGP_USE(GpgpHitTestInfo, GPGP_HIT_TEST_INFO_INIT);
  GPGP_USE(GpgpCanvasCreateInfo, GPGP_CANVAS_CREATE_INFO_INIT);
  GPGP_USE(GpgpPatchRecorderCreateInfo, GPGP_PATCH_RECORDER_CREATE_INFO_INIT);
  GPGP_USE(GpgpPatchDrawInfo, GPGP_PATCH_DRAW_INFO_INIT);
  GPGP_USE(GpgpCanvasHistoryCreateInfo, GPGP_CANVAS_HISTORY_CREATE_INFO_INIT);
  GPGP_USE(GpgpCanvasInfo, GPGP_CANVAS_INFO_INIT);
  GPGP_USE(GpgpCanvasDrawInfo, GPGP_CANVAS_DRAW_INFO_INIT);
  GPGP_USE(GpgpCanvasReport, GPGP_CANVAS_REPORT_INIT);
  GPGP_USE(GpgpGeometrySetCreateInfo, GPGP_GEOMETRY_SET_CREATE_INFO_INIT);
  GPGP_USE(GpgpVisibilityRecorderCreateInfo, GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT);
  GPGP_USE(GpgpCameraHistoryCreateInfo, GPGP_CAMERA_HISTORY_CREATE_INFO_INIT);
  GPGP_USE(GpgpVisibilityInfo, GPGP_VISIBILITY_INFO_INIT);
  GPGP_USE(GpgpVisibilityReport, GPGP_VISIBILITY_REPORT_INIT);
  GPGP_USE(GpgpViewCellInfo, GPGP_VIEW_CELL_INFO_INIT);
  GPGP_USE(GpgpViewMotionInfo, GPGP_VIEW_MOTION_INFO_INIT);
  GPGP_USE(GpgpVisibilityMetricsInfo, GPGP_VISIBILITY_METRICS_INFO_INIT);
  GPGP_USE(GpgpAtlasCreateInfo, GPGP_ATLAS_CREATE_INFO_INIT);
  GPGP_USE(GpgpAtlasRecorderCreateInfo, GPGP_ATLAS_RECORDER_CREATE_INFO_INIT);
  GPGP_USE(GpgpAtlasInfo, GPGP_ATLAS_INFO_INIT);
  GPGP_USE(GpgpAtlasReport, GPGP_ATLAS_REPORT_INIT);
  GPGP_USE(GpgpFontCreateInfo, GPGP_FONT_CREATE_INFO_INIT);
  GPGP_USE(GpgpFontInfo, GPGP_FONT_INFO_INIT);
  GPGP_USE(GpgpGlyphOutlineInfo, GPGP_GLYPH_OUTLINE_INFO_INIT);
  GPGP_USE(GpgpShaperCreateInfo, GPGP_SHAPER_CREATE_INFO_INIT);
  GPGP_USE(GpgpShaperReport, GPGP_SHAPER_REPORT_INIT);
  GPGP_USE(GpgpTextInfo, GPGP_TEXT_INFO_INIT);
  GPGP_USE(GpgpLayoutInfo, GPGP_LAYOUT_INFO_INIT);
  return sum;
}
