/* gpgp vector: paths, SVG and fonts, rasterised on the GPU by chords of their outlines.
 *
 *   drawing (asset)    paths converted to CPatches (disjoint regions between curves) and uploaded as the outlines of
 *                      these; resolution-independent: chords are made for each record, within 1/32 of a pixel
 *   glyph set (asset)  many small drawings under the engine's keys, to which more are added; what text is drawn with
 *   canvas (recorder)    rasterises drawings and text; sized by budgets
 *   canvas history        keeps one rasterised canvas, to be drawn inside the engine's render pass
 *   list               shapes, images, text and drawings that the engine adds every frame (ui.h)
 *
 *   gpgpCompileSvg (libgpgp_compiler) -> blob -> gpgpCreateDrawing          baked, or
 *   GpgpPath[] -> gpgpCreateDrawing                                made live, or
 *   drawing + GpgpPathEdit[] -> gpgpCreateDrawing                  edited
 *   gpgpCreateGlyphSet, GpgpGlyph[] -> gpgpAddGlyphs               text, live, or
 *   gpgpCompileGlyphs (libgpgp_compiler) -> blob -> gpgpCreateGlyphSet     text, baked
 *   -> gpgpRecordUpload -> gpgpRecordPrepareCanvas [-> gpgpRecordDrawCanvas inside the engine's pass]
 *
 * Colours above 1 are brighter than white: targets and attachments of float formats show them, others show white. Where
 * colours mix as sRGB encodes them, its curve goes on.
 */
#ifndef GPGP_VECTOR_H
#define GPGP_VECTOR_H
#include <gpgp/core.h>
#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- paths */

typedef uint8_t GpgpPathVerb;
enum {
  GPGP_PATH_MOVE = 0,  /**< 1 point; starts a contour, an open one is closed by a line */
  GPGP_PATH_LINE = 1,  /**< 1 point */
  GPGP_PATH_QUAD = 2,  /**< 2 points: control, end */
  GPGP_PATH_CUBIC = 3, /**< 3 points: control, control, end */
  GPGP_PATH_CLOSE = 4, /**< 0 points */
  GPGP_PATH_ARC = 5    /**< 3 points: radii (x, y); turn of the x axis in degrees, GPGP_ARC_... flags; end. SVG's
                          elliptical arc: radii that are too small grow, a radius of 0 makes it a line */
};
enum {
  GPGP_ARC_LARGE = 1, /**< the longer of the two ways round */
  GPGP_ARC_SWEEP = 2  /**< the way on which angles grow (clockwise where y points down) */
};

typedef int32_t GpgpFillRule;
enum { GPGP_FILL_NON_ZERO = 0, GPGP_FILL_EVEN_ODD = 1 };

typedef int32_t GpgpGradientKind;
enum {
  GPGP_GRADIENT_LINEAR = 0, /**< along the line from `start` to `end` */
  GPGP_GRADIENT_RADIAL = 1 /**< from the circle (start, startRadius) to the circle (end, endRadius), and on beyond both,
                              growing or shrinking evenly: where several of these circles pass, the one furthest on
                              paints; where none does, or the two are equal or both points, nothing is painted */
};

typedef int32_t GpgpSpread; /**< what is painted beyond the first and last stop */
enum { GPGP_SPREAD_PAD = 0, GPGP_SPREAD_REPEAT = 1, GPGP_SPREAD_REFLECT = 2 };

typedef struct GpgpGradientStop {
  float offset;   /**< 0 to 1; one below its predecessor's counts as equal to it */
  float color[4]; /**< linear RGB, 0 to 10000, straight alpha, 0 to 1 */
} GpgpGradientStop;

typedef struct GpgpGradient {
  GpgpGradientKind kind;
  GpgpSpread spread;
  float transform[6]; /**< gradient space to drawing: x' = t0 x + t2 y + t4, y' = t1 x + t3 y + t5 */
  float start[2], end[2];
  float startRadius, endRadius; /**< radial only; not negative */
  const GpgpGradientStop* stops;
  uint32_t stopCount;       /**< 1 to 65536 */
  VkBool32 interpolateSrgb; /**< mix stops as sRGB encodes them, as SVG does; else linearly */
} GpgpGradient;

/** A texture of the engine's as paint. GpgpCanvasImage says what it holds, and its sampler what lies beyond 0 to 1. */
typedef struct GpgpImagePaint {
  uint32_t image;     /**< in GpgpCanvasInfo::images, counted from the item's firstImage; below GPGP_MAX_IMAGES */
  float transform[6]; /**< texture coordinates (0 to 1 over the image) to drawing: x' = t0 u + t2 v + t4,
                           y' = t1 u + t3 v + t5 */
} GpgpImagePaint;

typedef int32_t GpgpCap;
enum { GPGP_CAP_BUTT = 0, GPGP_CAP_ROUND = 1, GPGP_CAP_SQUARE = 2 };

typedef int32_t GpgpJoin;
enum { GPGP_JOIN_MITER = 0, GPGP_JOIN_ROUND = 1, GPGP_JOIN_BEVEL = 2 };

/** A line along a path, as SVG has it. Its outline is off by less than a twentieth of a pixel at `scale`. */
typedef struct GpgpStroke {
  float width; /**< drawing units, not negative; 0: a hairline, a pixel wide at `scale` */
  GpgpCap cap;
  GpgpJoin join;
  float miterLimit;    /**< miters longer than this many widths become bevels; at least 1, or 0: 4 */
  const float* dashes; /**< lengths on, off, on, ...; an odd number of them counts twice; NULL: none. A path of more
                            than 65536 dashes is UNSUPPORTED; SVG's are drawn without, and a message says so */
  uint32_t dashCount;
  float dashOffset; /**< where in the pattern the path begins */
  float scale;      /**< the largest at which the drawing is shown, pixels per drawing unit; 0: 1 */
} GpgpStroke;

/** A filled or stroked path in drawing space. */
typedef struct GpgpPath {
  const GpgpPathVerb* verbs;
  uint32_t verbCount;
  const float* points; /**< x, y pairs, as many as the verbs need; finite, within +-1e7 */
  uint32_t pointCount;
  GpgpFillRule fillRule;
  float color[4]; /**< linear RGB, 0 to 10000, straight alpha, 0 to 1; with a gradient, only alpha counts */
  const GpgpGradient* gradient; /**< NULL: the colour */
  const GpgpStroke* stroke;     /**< NULL: filled; otherwise the stroke is painted instead, and fillRule is not used */
  const GpgpImagePaint* image;  /**< NULL: none; else instead of the colour, whose alpha counts; without a gradient */
  float scale; /**< the largest at which the drawing is shown, pixels per drawing unit; 0: 1. There arcs are off by less
                    than 1e-4 of a pixel */
  uint32_t group; /**< 0: none; else 1 + its index in GpgpDrawingCreateInfo::groups */
} GpgpPath;

enum {
  GPGP_MAX_OPACITY_DEPTH = 4, /**< groups less than opaque in each other */
  GPGP_MAX_CLIP_DEPTH = 16    /**< groups with a clip in each other */
};

/** Paths that are clipped or faded as one. The paths of a group less than opaque, those of groups inside included,
 *  follow each other without others between them. */
typedef struct GpgpPathGroup {
  uint32_t parent; /**< 0: none; else 1 + the index of an earlier group, which holds this one */
  float opacity;   /**< 0 to 1, of the group as a whole: where its paths overlap, the lower ones do not shine through */
  const GpgpPath* clip; /**< what is shown of the group: the union of these, which paint nothing; NULL: all */
  uint32_t clipCount;   /**< 0 with a clip: nothing is shown */
} GpgpPathGroup;

/* ---------------------------------------------------------------- compiler (libgpgp_compiler) */

/** What an import held and took. */
typedef struct GpgpSvgReport {
  uint32_t paths, curves, patches;
  double parseMilliseconds;   /**< bytes to paths */
  double convertMilliseconds; /**< strokes to fills, and paths to CPatches */
} GpgpSvgReport;

/** Receives a stage of the conversion as a picture for people: SVG text, not terminated. @lifetime call */
typedef void(GPGP_CALL* GpgpStageFn)(void* userData, const char* stage, const char* svg, size_t size);

/** Receives an image that an <image> element holds in a data: URI, as it was before base64 (PNG, JPEG, ...). It gives
 *  the size in pixels and returns VK_TRUE: the drawing then paints with its image number `index`
 *  (GpgpImagePaint::image), and the engine hands a texture of it to records. VK_FALSE: it cannot decode that, and the
 *  element is reported as unsupported. An image that elements share comes once. @lifetime call */
typedef VkBool32(GPGP_CALL* GpgpSvgImageFn)(void* userData, uint32_t index, const void* data, size_t size,
                                            uint32_t* width, uint32_t* height);

typedef struct GpgpSvgSource {
  GpgpStructureType sType;
  const void* pNext;
  const char* name; /**< file name for messages */
  const void* data; /**< SVG or gzip-compressed SVG (.svgz) */
  size_t size;
  GpgpMessageFn messageFn; /**< errors, and as warnings what is unsupported (code UNSUPPORTED) or not valid
                                (INVALID_DATA), with the element. The label is the place, "name:line:column",
                                or of a style sheet's file, or only the name */
  void* messageUserData;
  const GpgpJobSystem* jobSystem; /**< optional: converts paths side by side */
  GpgpSvgReport* report;          /**< optional, written where the import succeeds */
  GpgpStageFn stageFn;            /**< optional: "paths", "pieces", "crossings", "patches", in that order */
  void* stageUserData;
  GpgpSvgImageFn imageFn; /**< optional: takes embedded images, at most GPGP_MAX_IMAGES; NULL: they are unsupported */
  void* imageUserData;
  float scale; /**< the largest at which the drawing is shown, pixels per pixel of its page; 0: 1. There strokes are off
                    by less than a twentieth of a pixel and arcs by less than 1e-4, and strokes that do not scale have
                    their width */
  const GpgpFileSystem* fileSystem; /**< optional: reads style sheets that are files of their own. Paths are relative to
                                         the SVG's folder and lead to files in it or below, never to a host; at most 64
                                         files, of 16 MiB together. NULL: such style sheets are named as unsupported */
} GpgpSvgSource;
#define GPGP_SVG_SOURCE_INIT GPGP_INIT(GpgpSvgSource, GPGP_STRUCTURE_SVG_SOURCE)

/** Converts an SVG to a baked drawing (.gpgpv). In libgpgp_compiler; free the blob with gpgpFreeBlob.
 *  Errors: INVALID_DATA (not SVG), INVALID_ARGUMENT, OUT_OF_HOST_MEMORY. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCompileSvg(const GpgpSvgSource* source, GpgpBlob* blob);

/** A small drawing under a key. */
typedef struct GpgpGlyph {
  uint64_t key;               /**< the engine's: font, glyph, stroke, ... `gpgp bake FONT` gives each glyph's number,
                                 and 2^32 more to its outline */
  const GpgpPath* paths;      /**< in em units, +Y down, 0, 0 on the baseline where the glyph begins; painted in order;
                                 filled or stroked, in colours and gradients: without images and groups */
  uint32_t pathCount;         /**< 0: a blank */
  const VkBool32* foreground; /**< of each path: takes the text's RGB instead of its own, and of alpha both; NULL: all
                                 do */
} GpgpGlyph;

typedef struct GpgpGlyphSource {
  GpgpStructureType sType;
  const void* pNext;
  const char* name; /**< for messages */
  const GpgpGlyph* glyphs;
  uint32_t glyphCount; /**< no key twice */
  GpgpMessageFn messageFn;
  void* messageUserData;
  const GpgpJobSystem* jobSystem; /**< optional: converts paths side by side */
} GpgpGlyphSource;
#define GPGP_GLYPH_SOURCE_INIT GPGP_INIT(GpgpGlyphSource, GPGP_STRUCTURE_GLYPH_SOURCE)

/** Converts glyphs to their baked form (.gpgpf), from which glyph sets are made. In libgpgp_compiler; free the blob
 *  with gpgpFreeBlob. Errors: INVALID_ARGUMENT (glyph and path in the message), INVALID_STRUCT, UNSUPPORTED,
 *  OUT_OF_HOST_MEMORY. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCompileGlyphs(const GpgpGlyphSource* source, GpgpBlob* blob);

/* ---------------------------------------------------------------- drawing */

/** A path in place of another. */
typedef struct GpgpPathEdit {
  uint32_t index; /**< of the path in its drawing, counted as the paths were when it was made */
  GpgpPath path;  /**< belongs to the group that the other belonged to, whatever it says */
} GpgpPathEdit;

typedef struct GpgpDrawingCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  /* exactly one of data, filePath, paths and base: */
  const void* data; /**< a baked drawing, anywhere (in a mapped file, say); read during the call only */
  size_t size;
  const char* filePath;  /**< of a baked drawing, read through the file callbacks */
  const GpgpPath* paths; /**< painted in order, the first at the bottom */
  uint32_t pathCount;
  const GpgpPathGroup* groups; /**< that paths belong to; only with paths */
  uint32_t groupCount;
  /** An editable drawing of the same context, which stays as it is and may be destroyed: the new one is like it but for
   *  its edits, and only these are converted. The result equals that of making the drawing from all paths. */
  GpgpAsset base;
  const GpgpPathEdit* edits; /**< only with base; of two with the same index the later counts */
  uint32_t editCount;
  VkBool32 editable;    /**< can be a base: keeps its tables in host memory, about twice its size on the device */
  VkBool32 hitTestable; /**< gpgpHitTest finds its paths: keeps its outlines in host memory, about its size on the
                             device; editable ones have them */
} GpgpDrawingCreateInfo;
#define GPGP_DRAWING_CREATE_INFO_INIT GPGP_INIT(GpgpDrawingCreateInfo, GPGP_STRUCTURE_DRAWING_CREATE_INFO)

/** Checks a baked drawing, or converts paths to CPatches, and queues the result for upload. For paths that change from
 *  frame to frame, make each frame's drawing from the last one's, draw the last one until the new one is resident, and
 *  destroy it then.
 *  Errors: INVALID_DATA, INVALID_ARGUMENT (path index in the message), INVALID_HANDLE, IO, UNSUPPORTED (more patches
 *  than a drawing holds, 2^29; more than 2^21 points or 65536 dashes in a stroke; a path that crosses itself millions
 * of times), OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateDrawing(GpgpContext context, const GpgpDrawingCreateInfo* info,
                                                GpgpAsset* drawing);

typedef struct GpgpDrawingInfo {
  GpgpStructureType sType;
  void* pNext;
  float bounds[4];   /**< of the ink: left, top, right, bottom, drawing space */
  float viewport[4]; /**< of the page: x, y, width, height; equals the bounds where the source has none */
  uint32_t paths, curves, patches;
} GpgpDrawingInfo;
#define GPGP_DRAWING_INFO_INIT GPGP_INIT(GpgpDrawingInfo, GPGP_STRUCTURE_DRAWING_INFO)

/** Sizes and counts of a drawing, before and after it is resident. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetDrawingInfo(GpgpAsset drawing, GpgpDrawingInfo* info);

/* ---------------------------------------------------------------- glyph set */

typedef struct GpgpGlyphSetCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  const void* data; /**< optional: baked glyphs that are there from the beginning, anywhere; read during the call
                         only; or */
  size_t size;
  const char* filePath;  /**< of baked glyphs, read through the file callbacks */
  uint32_t maxGlyphs;    /**< at a time, at most 262144; 0: as many as are baked, or 4096 */
  VkDeviceSize maxBytes; /**< of their outlines, on the device and once more on the host: 64 a segment, of which a curve
                              is two or three, and 48 a path; for a gradient 64, and 32 a stop, and for a glyph that has
                              any 48; 0: as many as baked ones take, or 8 MiB */
} GpgpGlyphSetCreateInfo;
#define GPGP_GLYPH_SET_CREATE_INFO_INIT GPGP_INIT(GpgpGlyphSetCreateInfo, GPGP_STRUCTURE_GLYPH_SET_CREATE_INFO)

/** Makes a set of glyphs, empty or with baked ones, in one device buffer of the budget's size. Glyphs are there once,
 *  not once a size: canvases draw them at any size, turned and in perspective.
 *  Errors: INVALID_DATA, INVALID_ARGUMENT (a budget that the baked glyphs exceed: the message says what they need),
 *  INVALID_STRUCT, UNSUPPORTED (a budget beyond what the device binds), IO, OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateGlyphSet(GpgpContext context, const GpgpGlyphSetCreateInfo* info,
                                                 GpgpAsset* glyphSet);

enum { GPGP_GLYPH_NONE = 0 }; /**< the index of no glyph: drawn as nothing */

/** Converts glyphs whose keys are new and queues them for upload; only they are uploaded. Glyphs that have been used
 *  longest ago make room for them: used is what a record drew, and what was added or found. What an unfinished frame
 *  uses stays. BUDGET_EXCEEDED: some did not find room, their indices are GPGP_GLYPH_NONE; gpgpGetGlyphSetInfo says
 *  what all would have needed. Errors, after which nothing is added: INVALID_ARGUMENT (glyph and path in the message),
 *  UNSUPPORTED, OUT_OF_HOST_MEMORY. Not beside records that draw the set.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpAddGlyphs(GpgpAsset glyphSet, const GpgpGlyph* glyphs, uint32_t count,
                                            uint32_t* indices);

/** The indices of glyphs by their keys, GPGP_GLYPH_NONE where there is none. What is found stays at least until the
 *  frame is safe; as long as GpgpGlyphSetInfo::evicted does not change, all indices stay as they are.
 *  INCOMPLETE: not all are there. @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpFindGlyphs(GpgpAsset glyphSet, const uint64_t* keys, uint32_t count,
                                             uint32_t* indices);

typedef struct GpgpGlyphSetInfo {
  GpgpStructureType sType;
  void* pNext;
  uint32_t glyphs, maxGlyphs;
  VkDeviceSize bytes, maxBytes;
  uint64_t evicted; /**< glyphs so far, and with them their indices */
  /** For all that the last gpgpAddGlyphs was given beside what unfinished frames use. Bytes lie in a row for each
   *  glyph, so that somewhat more may be needed. */
  uint32_t glyphsNeeded;
  VkDeviceSize bytesNeeded;
} GpgpGlyphSetInfo;
#define GPGP_GLYPH_SET_INFO_INIT GPGP_INIT(GpgpGlyphSetInfo, GPGP_STRUCTURE_GLYPH_SET_INFO)

/** What is in the set and what its budgets are. @threads context */
GPGP_API GpgpResult GPGP_CALL gpgpGetGlyphSetInfo(GpgpAsset glyphSet, GpgpGlyphSetInfo* info);

/* ---------------------------------------------------------------- canvas */

/** Bits: what a canvas's records write. */
typedef uint64_t GpgpCanvasTargets;
/** A view, alone or with a target. */
#define GPGP_CANVAS_TARGET_HISTORY ((GpgpCanvasTargets)1)
/** A target in R8G8B8A8_UNORM. */
#define GPGP_CANVAS_TARGET_RGBA8 ((GpgpCanvasTargets)2)
/** A target in R16G16B16A16_SFLOAT. */
#define GPGP_CANVAS_TARGET_RGBA16F ((GpgpCanvasTargets)4)

typedef struct GpgpCanvasCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecorderCreateInfo base;
  uint32_t maxWidth, maxHeight; /**< of a canvas in pixels; 0: 2048 x 2048 */
  /** Paths in one record; 48 bytes each, 8 more on hardware, and a bit for each square of 128 pixels; 0: 262144, at
   *  most 4194304. A drawing counts GpgpDrawingInfo::paths for each item that shows it, a glyph its own each
   *  time it is placed, a shape of a list, and a clip that is not a scissor, 1. How many curves and patches they
   *  have is not limited: these are in the drawing's own buffer. */
  uint32_t maxPaths;
  uint32_t maxTileEntries; /**< tiles of 8 pixels that a path's boundary passes through, summed over paths; 256 bytes
                                each, with their lists 480; 0: 131072 */
  uint32_t maxTileWords; /**< for each path that meets the canvas, the rows of tiles of its box times how many times 32
                              tiles its box is wide, begun ones whole; 16 bytes each; 0: maxTileEntries, or 65536 where
                              that is less */
  uint32_t maxDrawings;  /**< items in one record, and what lists have of drawings, clips, and changes of transform
                              and clip (ui.h); 0: 64, at most 65536. They may show at most 8 different drawings and
                              glyph sets */
  uint32_t maxGlyphs;    /**< of all texts in one record, blanks not counted; 176 bytes each, 48 of them once more for
                              every record in flight; 0: 1024, at most 1048576 */
  uint32_t maxShapes;    /**< of all lists in one record, their clips that are not scissors included (ui.h); as many
                              of them with an image or gradient, and twice as many stops; 592 bytes each, 240 of them
                              once more for every record in flight; 0: 1024, at most 1048576 */
  GpgpCanvasTargets targets; /**< what records will write; 0: any. Pipelines are made for these alone: with one, half
                                as many, in half the time */
} GpgpCanvasCreateInfo;
#define GPGP_CANVAS_CREATE_INFO_INIT GPGP_INIT(GpgpCanvasCreateInfo, GPGP_STRUCTURE_CANVAS_CREATE_INFO)

/** Makes a recorder that rasterises drawings, with scratch for the budgets. Prewarm it before the first record.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, UNSUPPORTED (budgets beyond the device), OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateCanvas(GpgpContext context, const GpgpCanvasCreateInfo* info,
                                               GpgpRecorder* canvas);

typedef struct GpgpCanvasHistoryCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  uint32_t width, height; /**< pixels; 8 bytes each are allocated */
} GpgpCanvasHistoryCreateInfo;
#define GPGP_CANVAS_HISTORY_CREATE_INFO_INIT                                                                           \
  GPGP_INIT(GpgpCanvasHistoryCreateInfo, GPGP_STRUCTURE_CANVAS_HISTORY_CREATE_INFO)

/** Makes a place where a canvas keeps its result between gpgpRecordPrepareCanvas and gpgpRecordDrawCanvas. It is ready
 *  once a gpgpRecordUpload has cleared it.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, OUT_OF_..._MEMORY. @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateCanvasHistory(GpgpContext context, const GpgpCanvasHistoryCreateInfo* info,
                                                      GpgpHistory* history);

/** A glyph in a text. */
typedef struct GpgpGlyphInstance {
  uint32_t glyph; /**< its index in the glyph set */
  float x, y;     /**< where its 0, 0 lies, units of the text, within +-1e7 */
  float size;     /**< units of the text per em, 0 to 1e7 */
  float color[4]; /**< linear RGB, 0 to 10000, straight alpha, 0 to 1, of the paths that take the text's colour,
                       gradients aside; alpha multiplies every path's */
} GpgpGlyphInstance;

/** Shapes, images, text and drawings in painting order (ui.h). */
typedef struct GpgpList_T* GpgpList;

typedef struct GpgpCanvasItem {
  GpgpAsset drawing;  /**< NULL: a text, of the glyphs below, or a list */
  float transform[6]; /**< drawing to pixel: x' = t0 x + t2 y + t4, y' = t1 x + t3 y + t5 */
  float opacity;      /**< 0 to 1, multiplies each path's alpha */
  /** The third row of a projective map: w = p0 x + p1 y + p2, and the pixel is (x', y') / w. All 0: affine, w = 1.
   *  What lies at w <= 0 is behind the eye and not drawn. For a panel in a 3D world with corner o and sides u, v (units
   *  of the drawing), let o', u', v' be o (as a point), u and v (as directions) times the view-projection matrix, so
   *  that clip space has x_c = u'.x x + v'.x y + o'.x, likewise y_c and w_c; then t = (W (u'.x + u'.w) / 2,
   *  H (u'.y + u'.w) / 2, the same of v', the same of o') and p = (u'.w, v'.w, o'.w) for a canvas of W x H pixels. */
  float perspective[3];
  uint32_t firstImage; /**< where in GpgpCanvasInfo::images those of the drawing begin */
  GpgpAsset glyphSet;  /**< of a text; what is `drawing` above is the text then, whose units the instances have */
  const GpgpGlyphInstance* glyphs; /**< in painting order, the first at the bottom */
  uint32_t glyphCount;
  float scissor[4]; /**< left, top, right, bottom in canvas pixels, whatever the transform: nothing shows outside;
                         all 0: none */
  GpgpList list;    /**< instead of drawing and glyphSet: all that is in it, with its own transforms before this one */
} GpgpCanvasItem;

#ifdef __cplusplus
} /* extern "C" */
inline GpgpCanvasItem gpgpInitCanvasItem() {
  GpgpCanvasItem item = GpgpCanvasItem();
  item.transform[0] = item.transform[3] = item.opacity = 1.0f;
  return item;
}
extern "C" {
/** An opaque item without a transform; a zeroed one is transparent and has no extent. */
#define GPGP_CANVAS_ITEM_INIT gpgpInitCanvasItem()
#else
/** An opaque item without a transform; a zeroed one is transparent and has no extent. */
#define GPGP_CANVAS_ITEM_INIT                                                                                          \
  { .transform = {1, 0, 0, 1, 0, 0}, .opacity = 1 }
#endif

enum { GPGP_MAX_IMAGES = 8 }; /**< that a record's items paint with */

typedef int32_t GpgpImageEncoding; /**< what an image's colours are where shaders sample it */
enum {
  GPGP_IMAGE_LINEAR = 0, /**< linear light: sRGB formats, which decode themselves, and float formats as a rule */
  GPGP_IMAGE_SRGB = 1    /**< as sRGB encodes light: the texels of a picture file in a UNORM format */
};

typedef int32_t GpgpImageFilter; /**< how an image is filtered between its texels */
enum { GPGP_IMAGE_FILTER_LINEAR = 0, GPGP_IMAGE_FILTER_NEAREST = 1 };

/** An image that items paint with. The engine has made its contents visible to sampling in compute shaders.
 *
 *  Colours between texels are mixed premultiplied, and as the canvas mixes colours: in linear light, or with blendSrgb
 *  as sRGB encodes them. An image whose texels are just that (premultiplied, its encoding the canvas's) is sampled
 *  once a pixel, and the sampler decides everything. Of any other image the texels are converted one by one: four are
 *  sampled a pixel, eight between two levels. The sampler then decides what lies beyond the edges; anisotropy and a
 *  bias of levels do not count, and all levels of the view are used. */
typedef struct GpgpCanvasImage {
  VkImageView view; /**< 2D, a float or normalised format that the sampler may filter */
  VkSampler sampler;
  VkImageLayout layout;       /**< it is in: SHADER_READ_ONLY_OPTIMAL, GENERAL, ... */
  VkBool32 premultiplied;     /**< its colours have been multiplied by its alpha, as they are encoded (an sRGB format's
                                   as they are decoded); also true of opaque images */
  GpgpImageEncoding encoding; /**< of its colours, where they are sampled */
  GpgpImageFilter filter;     /**< NEAREST: the sampler filters so as well, and each pixel takes what it gives */
} GpgpCanvasImage;

typedef struct GpgpCanvasInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;
  uint32_t width, height;      /**< pixels */
  const GpgpCanvasItem* items; /**< in painting order, the first at the bottom */
  uint32_t itemCount;
  uint32_t samples;    /**< 1, 4, 8 or 16 per pixel; 0: 16 */
  float background[4]; /**< linear, premultiplied */
  GpgpHistory history; /**< optional: keeps the result for gpgpRecordDrawCanvas; at least width x height */
  GpgpImage target;    /**< optional (view NULL: none): STORAGE usage, R8G8B8A8_UNORM or R16G16B16A16_SFLOAT.
                            Receives premultiplied linear colour */
  VkBool32 encodeSrgb; /**< the target receives what sRGB encodes of the straight colour, times alpha, as PNG files and
                            2D compositors mix it */
  VkBool32 exactArea; /**< the first edge that a pixel meets, from the front, counts by its area instead of its samples:
                           fewer steps where only one edge passes, still nothing shows through where two meet */
  VkBool32 blendSrgb; /**< colours mix as sRGB encodes them, as SVG renderers do; background is then encoded too */
  const GpgpCanvasImage* images; /**< that items paint with */
  uint32_t imageCount;           /**< at most GPGP_MAX_IMAGES */
} GpgpCanvasInfo;
#define GPGP_CANVAS_INFO_INIT GPGP_INIT(GpgpCanvasInfo, GPGP_STRUCTURE_CANVAS_INFO)

/** Rasterises the items into the view, the target, or both with the same pixels: what gpgpRecordDrawCanvas leaves of
 *  the view over 0 (transparent black) is within one unit of a half's last place of a target of the same format
 *  where that is R16G16B16A16_SFLOAT, and within 1/255 where it is R8G8B8A8_UNORM (the view holds halves, and image
 *  stores and attachments round in their own ways). An sRGB attachment encodes premultiplied colour: it is within
 *  1/255 of a target with encodeSrgb only where the canvas is opaque.
 *  NOT_READY: a drawing or a glyph that is drawn is not resident, or the canvas not prewarmed.
 *  @threads handle @lifetime call; image: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0 (and 1 where items paint with images), push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordPrepareCanvas(GpgpRecorder canvas, VkCommandBuffer commandBuffer,
                                                      const GpgpFrame* frame, const GpgpCanvasInfo* info);

typedef struct GpgpCanvasDrawInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpHistory history;
  const GpgpTargetInfo* target; /**< equal to one of those given to gpgpPrewarm */
  float clip[16];               /**< column-major; canvas pixels (x, y, 0, 1) to clip space */
  uint32_t width, height;       /**< of the part of the canvas that is drawn, pixels */
  uint32_t x;                   /**< column of the canvas at which the part begins; to clip it is 0 */
  uint32_t secondX;             /**< of a multiview target: the same for view 1 */
  const float* secondClip;      /**< of a multiview target: 16 numbers for view 1, as clip; NULL: the same */
} GpgpCanvasDrawInfo;
#define GPGP_CANVAS_DRAW_INFO_INIT GPGP_INIT(GpgpCanvasDrawInfo, GPGP_STRUCTURE_CANVAS_DRAW_INFO)

/** Draws what the last gpgpRecordPrepareCanvas into this view left, as a rectangle blended premultiplied
 *  (ONE, ONE_MINUS_SRC_ALPHA), without filtering at one canvas pixel per pixel. The engine has set viewport and
 *  scissor. Any number of times per prepare. Views 0 and 1 of a multiview target (GpgpTargetInfo::viewMask,
 *  GPGP_FEATURE_MULTIVIEW) may show different parts, so that one record holds both eyes. NOT_READY: nothing was
 *  prepared, or the target was not prewarmed.
 *  @threads handle @lifetime call @pass inside
 *  @state graphics pipeline, graphics descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordDrawCanvas(GpgpRecorder canvas, VkCommandBuffer commandBuffer,
                                                   const GpgpFrame* frame, const GpgpCanvasDrawInfo* info);

typedef struct GpgpCanvasReport {
  GpgpStructureType sType;
  void* pNext;
  GpgpReportHeader base;
  uint32_t paths;            /**< needed */
  uint32_t pathsGiven;       /**< maxPaths */
  uint32_t tileWords;        /**< needed by the paths that maxPaths and the other budgets left */
  uint32_t tileWordsGiven;   /**< maxTileWords */
  uint32_t tileEntries;      /**< needed by the paths that have tile words: where these did not suffice, a record with
                                  as many as are needed may turn out to need more entries */
  uint32_t tileEntriesGiven; /**< maxTileEntries */
  uint32_t pathsDropped;     /**< whole paths, and of texts whole glyphs, left out where the budget did not suffice */
  uint32_t glyphs;           /**< needed */
  uint32_t glyphsGiven;      /**< maxGlyphs */
  uint32_t shapes;           /**< needed */
  uint32_t shapesGiven;      /**< maxShapes */
  uint32_t items;            /**< needed */
  uint32_t itemsGiven;       /**< maxDrawings */
} GpgpCanvasReport;
#define GPGP_CANVAS_REPORT_INIT GPGP_INIT(GpgpCanvasReport, GPGP_STRUCTURE_CANVAS_REPORT)

/** The oldest report not yet taken. NOT_READY: none. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetCanvasReport(GpgpRecorder canvas, GpgpCanvasReport* report);

#ifdef __cplusplus
}
#endif
#endif
