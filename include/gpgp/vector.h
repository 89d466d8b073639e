/* gpgp vector: paths, SVG and text, rasterised on the GPU from the flattened segments of their outlines.
 *
 *   drawing (asset)     Paths, converted to CPatches (disjoint regions between curves) and uploaded as the outlines of
 *                       these regions. Independent of resolution: each recording flattens curves to within 1/32 pixel.
 *   glyph set (asset)   Many small drawings under keys that the engine chooses. Glyphs can be added at any time.
 *   canvas (recorder)   Rasterises drawings, text and lists. Its budgets set its size.
 *   canvas history      Keeps one rasterised canvas, to be drawn inside the engine's render pass.
 *   list                Shapes, images, text and drawings that the engine adds every frame (ui.h).
 *   patch recorder      Draws drawings and text as geometry inside the engine's render pass, with no pass before.
 *
 * From input to pixels:
 *   gpgpCompileSvg (libgpgp_compiler) -> blob -> gpgpCreateDrawing            a baked drawing
 *   GpgpPath[] -> gpgpCreateDrawing                                           a live drawing
 *   drawing + GpgpPathEdit[] -> gpgpCreateDrawing                             an edited drawing
 *   gpgpCreateGlyphSet, GpgpGlyph[] -> gpgpAddGlyphs                          live text
 *   gpgpCompileGlyphs (libgpgp_compiler) -> blob -> gpgpCreateGlyphSet        baked text
 *   then gpgpRecordUpload -> gpgpRecordPrepareCanvas [-> gpgpRecordDrawCanvas inside the engine's render pass]
 *
 * Colour components above 1 are brighter than white. Targets and attachments of float formats keep them, other formats
 * clamp them to white. Where colours are mixed as sRGB encodes them, the sRGB curve is extended beyond 1.
 */
#ifndef GPGP_VECTOR_H
#define GPGP_VECTOR_H
#include <gpgp/core.h>
#include <gpgp/layers.h>
#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- paths */

/** One step of a path. Each verb takes points from GpgpPath::points. */
typedef uint8_t GpgpPathVerb;
enum {
  GPGP_PATH_MOVE = 0,  /**< 1 point: begins a contour. When filled, an open contour is closed by a line. */
  GPGP_PATH_LINE = 1,  /**< 1 point: end */
  GPGP_PATH_QUAD = 2,  /**< 2 points: control, end */
  GPGP_PATH_CUBIC = 3, /**< 3 points: control, control, end */
  GPGP_PATH_CLOSE = 4, /**< 0 points */
  /** SVG's elliptical arc. 3 points: (radius x, radius y), (rotation of the x axis in degrees, GPGP_ARC_... flags),
   *  end. Radii that are too small to reach the end grow until they do. A radius of 0 makes the arc a line. */
  GPGP_PATH_ARC = 5
};
enum {
  GPGP_ARC_LARGE = 1, /**< Takes the longer of the two ways round. */
  GPGP_ARC_SWEEP = 2  /**< Takes the way along which angles grow: clockwise, as y points down. */
};

/** Which winding numbers are inside a filled path. */
typedef int32_t GpgpFillRule;
enum { GPGP_FILL_NON_ZERO = 0, GPGP_FILL_EVEN_ODD = 1 };

typedef int32_t GpgpGradientKind;
enum {
  GPGP_GRADIENT_LINEAR = 0, /**< along the line from `start` to `end` */
  /** Between the circles (start, startRadius) and (end, endRadius), as in HTML's canvas. The circle moves and changes
   *  its radius evenly from one to the other, and on beyond both. Where several of these circles pass through a point,
   *  the one furthest along paints it. Nothing is painted where no circle passes, where both circles are equal, or
   *  where both are points. */
  GPGP_GRADIENT_RADIAL = 1
};

/** What a gradient paints before its first stop and after its last one. */
typedef int32_t GpgpSpread;
enum {
  GPGP_SPREAD_PAD = 0,    /**< the colour of the nearest stop */
  GPGP_SPREAD_REPEAT = 1, /**< the gradient again, from its start */
  GPGP_SPREAD_REFLECT = 2 /**< the gradient again, alternately backwards and forwards */
};

typedef struct GpgpGradientStop {
  float offset;   /**< 0 to 1. An offset below the previous stop's counts as equal to it. */
  float color[4]; /**< linear RGB, 0 to 10000; straight alpha, 0 to 1 */
} GpgpGradientStop;

typedef struct GpgpGradient {
  GpgpGradientKind kind;
  GpgpSpread spread;
  float transform[6];           /**< gradient space to drawing space: x' = t0 x + t2 y + t4, y' = t1 x + t3 y + t5 */
  float start[2], end[2];       /**< gradient space */
  float startRadius, endRadius; /**< gradient space; radial gradients only; not negative */
  const GpgpGradientStop* stops;
  uint32_t stopCount; /**< 1 to 65536 */
  /** VK_TRUE: stops are mixed as sRGB encodes them, as SVG does. VK_FALSE: stops are mixed in linear light. */
  VkBool32 interpolateSrgb;
} GpgpGradient;

/** Paints a path with one of the engine's images. GpgpCanvasImage says what the image holds. Its sampler's address
 *  modes decide what lies beyond texture coordinates 0 to 1. */
typedef struct GpgpImagePaint {
  /** Index into GpgpCanvasInfo::images, counted from the item's firstImage; below GPGP_MAX_IMAGES. */
  uint32_t image;
  /** Texture coordinates (0 to 1 across the image) to drawing space: x' = t0 u + t2 v + t4, y' = t1 u + t3 v + t5. */
  float transform[6];
} GpgpImagePaint;

/** How an open stroke or a dash ends. */
typedef int32_t GpgpCap;
enum { GPGP_CAP_BUTT = 0, GPGP_CAP_ROUND = 1, GPGP_CAP_SQUARE = 2 };

/** How a stroke goes round a corner. */
typedef int32_t GpgpJoin;
enum { GPGP_JOIN_MITER = 0, GPGP_JOIN_ROUND = 1, GPGP_JOIN_BEVEL = 2 };

/** A line along a path, with SVG's rules. Its outline is accurate to a twentieth of a pixel up to `scale`. */
typedef struct GpgpStroke {
  float width; /**< drawing units, not negative; 0: a hairline, one pixel wide at `scale` */
  GpgpCap cap;
  GpgpJoin join;
  /** Longest miter, in stroke widths; at least 1, or 0 for the default of 4. Longer miters become bevels. */
  float miterLimit;
  /** Lengths of dashes and gaps in turn, in drawing units. An odd number of lengths is used twice over. NULL: a solid
   *  line. A path of more than 65536 dashes is UNSUPPORTED. In an SVG such a path is drawn solid, with a message. */
  const float* dashes;
  uint32_t dashCount;
  float dashOffset; /**< where in the dash pattern the path begins, drawing units */
  float scale;      /**< largest scale at which the drawing is shown, pixels per drawing unit; 0: 1 */
} GpgpStroke;

/** A filled or stroked path in drawing space. */
typedef struct GpgpPath {
  const GpgpPathVerb* verbs;
  uint32_t verbCount;
  const float* points; /**< x, y pairs, as many as the verbs need; finite, within +-1e7 */
  uint32_t pointCount;
  GpgpFillRule fillRule;
  /** Linear RGB, 0 to 10000; straight alpha, 0 to 1. With a gradient or an image, only alpha is used. */
  float color[4];
  const GpgpGradient* gradient; /**< NULL: the path is painted in its colour. */
  const GpgpStroke* stroke;    /**< NULL: the path is filled. Otherwise only its stroke is painted, without fillRule. */
  const GpgpImagePaint* image; /**< NULL: no image. Not together with a gradient. */
  /** Largest scale at which the drawing is shown, pixels per drawing unit; 0: 1. Arcs are accurate to 1e-4 of a pixel
   *  up to this scale. */
  float scale;
  uint32_t group; /**< 0: none; otherwise 1 + the index of its group in GpgpDrawingCreateInfo::groups */
} GpgpPath;

enum {
  /** Maximum nesting depth of a list's groups (ui.h), and of groups of paths that are less than opaque and no layers:
   *  deeper ones become layers (layers.h). */
  GPGP_MAX_OPACITY_DEPTH = 4,
  GPGP_MAX_CLIP_DEPTH = 16 /**< Maximum nesting depth of groups with a clip. */
};

/** Paths that are clipped or faded together. The paths of a group that is less than opaque must follow one another in
 *  the drawing. Paths of groups inside it count as its own; no other path may lie between them. */
typedef struct GpgpPathGroup {
  uint32_t parent; /**< 0: none; otherwise 1 + the index of an earlier group, which contains this one */
  /** 0 to 1. Applies to the group as a whole: where its paths overlap, the lower ones do not show through. */
  float opacity;
  /** The group shows only inside the union of these paths, which themselves paint nothing. NULL: no clip. */
  const GpgpPath* clip;
  uint32_t clipCount; /**< 0 while `clip` is not NULL: the group is hidden. */
  /** Blend mode, mask, filter (layers.h). NULL: none. Then the group is a layer all the same if a layer lies inside it
   *  and it has a clip or is less than opaque. The paths of a layer must follow one another, as above; a layer without
   *  paths shows nothing. */
  const GpgpLayer* layer;
} GpgpPathGroup;

/** What a drawing or a glyph set keeps on the device, by who draws it. A combination of flags. */
typedef uint64_t GpgpDrawingMethods;
#define GPGP_DRAWING_FLATTENED ((GpgpDrawingMethods)1) /**< outlines, which canvases flatten and rasterise */
#define GPGP_DRAWING_IN_PASS ((GpgpDrawingMethods)2)   /**< CPatches in cells, for gpgpRecordDrawPatches */
/** CPatches for canvases whose method is GPGP_CANVAS_PATCHES; with GPGP_DRAWING_FLATTENED, and for drawings alone. They
 *  are made with the drawing, not baked. */
#define GPGP_DRAWING_PATCHES ((GpgpDrawingMethods)4)

/* ---------------------------------------------------------------- compiler (libgpgp_compiler) */

/** What gpgpCompileSvg found in an SVG, and how long it took. */
typedef struct GpgpSvgReport {
  uint32_t paths, curves, patches;
  double parseMilliseconds;   /**< from bytes to paths */
  double convertMilliseconds; /**< from paths to CPatches, strokes included */
} GpgpSvgReport;

/** Receives a stage of the conversion as SVG text, to be looked at. The text is not null-terminated. @lifetime call */
typedef void(GPGP_CALL* GpgpStageFn)(void* userData, const char* stage, const char* svg, size_t size);

/** Receives an image of an `image` or `feImage` element: a PNG, JPEG or other file that the element embeds as a data:
 *  URI, or that `fileSystem` reads. An image that several elements share is passed once.
 *
 *  To accept the image, the callback writes its size in pixels and returns VK_TRUE. The drawing then paints with image
 *  number `index` (GpgpImagePaint::image), and the engine passes a texture of it to recordings. If the callback
 *  returns VK_FALSE, the element is reported as unsupported. @lifetime call */
typedef VkBool32(GPGP_CALL* GpgpSvgImageFn)(void* userData, uint32_t index, const void* data, size_t size,
                                            uint32_t* width, uint32_t* height);

/** A stretch of an SVG's text in one style. */
typedef struct GpgpSvgTextSpan {
  uint32_t begin, end;  /**< bytes of the text */
  const char* families; /**< as font-family lists them, for example "Arial, 'DejaVu Sans', serif"; may be empty */
  const char* language; /**< BCP 47; may be empty */
  float size;           /**< units per em, above 0 */
  float weight;         /**< 1 to 1000; 400 is regular */
  float letterSpacing;  /**< units after each grapheme */
  VkBool32 italic, smallCaps, unkerned; /**< unkerned: pairs of glyphs keep their distance */
} GpgpSvgTextSpan;

/** A line of an SVG's text. Spans cover it without gaps, in order. */
typedef struct GpgpSvgText {
  const char* text; /**< UTF-8, not terminated */
  uint32_t size;    /**< bytes */
  const GpgpSvgTextSpan* spans;
  uint32_t spanCount;
  VkBool32 rightToLeft; /**< the direction of the whole line */
} GpgpSvgText;

/** A placed glyph of such a line. */
typedef struct GpgpSvgGlyph {
  uint32_t cluster;      /**< offset of the first byte that the glyph stands for */
  float x, y;            /**< origin in units, from where the line begins on the left, +Y down */
  float advance;         /**< units to where the next cluster begins; 0 for all glyphs of a cluster but the first */
  float size;            /**< units per em */
  const GpgpPath* paths; /**< in em, +Y down, as gpgpGetGlyphOutline returns them */
  uint32_t pathCount;
  const VkBool32* foreground; /**< one for each path: painted as the SVG says, not in its own colour. NULL: all are. */
  /** Of the glyph's font, in em, as in GpgpFontInfo. */
  float ascent, descent, xHeight, underlinePosition, underlineThickness, strikePosition, strikeThickness;
  VkBool32 incomplete; /**< VK_TRUE: a part of the glyph, such as an image, is not among the paths */
} GpgpSvgGlyph;
typedef void(GPGP_CALL* GpgpSvgGlyphFn)(void* glyphUserData, const GpgpSvgGlyph* glyph);
/** Shapes a line, and calls glyphFn for each of its glyphs from left to right. Any other result than SUCCESS leaves
 *  the line out, and a warning says so. */
typedef GpgpResult(GPGP_CALL* GpgpSvgTextFn)(void* userData, const GpgpSvgText* text, GpgpSvgGlyphFn glyphFn,
                                             void* glyphUserData);

typedef struct GpgpSvgSource {
  GpgpStructureType sType;
  const void* pNext;
  const char* name; /**< file name, for messages */
  const void* data; /**< an SVG file, plain or gzip-compressed (.svgz) */
  size_t size;
  /** Receives errors. Receives as warnings what is unsupported (code UNSUPPORTED) and what is invalid (INVALID_DATA),
   *  with the element's name. The message's label is the place, "file:line:column". The file may be a style sheet.
   *  Where no line is known, the label is the name alone. */
  GpgpMessageFn messageFn;
  void* messageUserData;
  const GpgpJobSystem* jobSystem; /**< optional: converts paths in parallel */
  GpgpSvgReport* report;          /**< optional: written when the import succeeds */
  GpgpStageFn stageFn;            /**< optional: called for "paths", "pieces", "crossings", "patches", in this order */
  void* stageUserData;
  /** Optional: accepts images, at most GPGP_MAX_IMAGES. NULL: images are reported as unsupported. */
  GpgpSvgImageFn imageFn;
  void* imageUserData;
  /** Largest scale at which the drawing is shown, pixels per pixel of its page; 0: 1. Up to this scale, strokes are
   *  accurate to a twentieth of a pixel and arcs to 1e-4. Non-scaling strokes have their stated width at this scale. */
  float scale;
  /** Optional: reads external style sheets and images. Paths are relative to the SVG's folder. They may lead only to
   *  files in that folder or below it, never to a host. At most 64 style sheets of 16 MiB together and images of 64 MiB
   *  together are read. NULL: other files are reported as unsupported. */
  const GpgpFileSystem* fileSystem;
  /** Who draws the drawing; 0: GPGP_DRAWING_FLATTENED. The file holds what is asked for, and nothing else. Elements
   *  that patches do not draw are named in warnings (GpgpDrawingCreateInfo::methods). With GPGP_DRAWING_IN_PASS masks,
   *  filters and blend modes are left out and named. */
  GpgpDrawingMethods methods;
  /** Optional: shapes text in the engine's fonts, for example with libgpgp_text. NULL: text is reported as
   *  unsupported. */
  GpgpSvgTextFn textFn;
  void* textUserData;
  /** VkPhysicalDeviceLimits::maxStorageBufferRange of the devices that the drawing is for; 0: 2^32 - 1. A drawing whose
   *  outlines need more bytes is refused (UNSUPPORTED) as soon as that is known, not when all of it is converted. */
  uint32_t maxStorageBufferRange;
} GpgpSvgSource;
#define GPGP_SVG_SOURCE_INIT GPGP_INIT(GpgpSvgSource, GPGP_STRUCTURE_SVG_SOURCE)

/** Converts an SVG to a baked drawing (.gpgpv). In libgpgp_compiler. Free the blob with gpgpFreeBlob.
 *  Errors: INVALID_DATA (not an SVG), INVALID_ARGUMENT, UNSUPPORTED (too many outlines), OUT_OF_HOST_MEMORY.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCompileSvg(const GpgpSvgSource* source, GpgpBlob* blob);

/** A small drawing under a key. */
typedef struct GpgpGlyph {
  /** Chosen by the engine; stands for font, glyph, stroke and so on. `gpgp bake FONT` uses the glyph's number in the
   *  font as its key, and that number + 2^32 for its stroked outline. */
  uint64_t key;
  /** In em, +Y down; (0, 0) lies on the baseline where the glyph begins. Painted in order. Filled or stroked, in
   *  colours and gradients. Images and groups are not allowed. */
  const GpgpPath* paths;
  uint32_t pathCount; /**< 0: a blank */
  /** One for each path. VK_TRUE: the path takes its RGB from the text's colour, and its alpha is multiplied by the
   *  text's alpha. VK_FALSE: the path keeps its own RGB; its alpha is multiplied all the same. NULL: VK_TRUE for all
   *  paths. */
  const VkBool32* foreground;
} GpgpGlyph;

typedef struct GpgpGlyphSource {
  GpgpStructureType sType;
  const void* pNext;
  const char* name; /**< for messages */
  const GpgpGlyph* glyphs;
  uint32_t glyphCount; /**< Keys must differ. */
  GpgpMessageFn messageFn;
  void* messageUserData;
  const GpgpJobSystem* jobSystem; /**< optional: converts paths in parallel */
} GpgpGlyphSource;
#define GPGP_GLYPH_SOURCE_INIT GPGP_INIT(GpgpGlyphSource, GPGP_STRUCTURE_GLYPH_SOURCE)

/** Converts glyphs to their baked form (.gpgpf), from which gpgpCreateGlyphSet makes a glyph set. In libgpgp_compiler.
 *  Free the blob with gpgpFreeBlob.
 *  Errors: INVALID_ARGUMENT (the message names glyph and path), INVALID_STRUCT, UNSUPPORTED, OUT_OF_HOST_MEMORY.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCompileGlyphs(const GpgpGlyphSource* source, GpgpBlob* blob);

/* ---------------------------------------------------------------- drawing */

/** Replaces one path of a drawing. */
typedef struct GpgpPathEdit {
  uint32_t index; /**< index of the replaced path in the array from which the original drawing was made */
  GpgpPath path;  /**< Stays in the replaced path's group; GpgpPath::group is ignored. */
} GpgpPathEdit;

typedef struct GpgpDrawingCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  /* Give exactly one of data, filePath, paths and base. */
  const void* data; /**< A baked drawing in any memory, for example a mapped file. Read during the call only. */
  size_t size;
  const char* filePath;  /**< a baked drawing's file, read through the context's file callbacks */
  const GpgpPath* paths; /**< painted in order, the first at the bottom */
  uint32_t pathCount;
  const GpgpPathGroup* groups; /**< the groups that `paths` refer to; only with paths */
  uint32_t groupCount;
  /** An editable drawing of the same context. The new drawing equals it except for the edits, and only the edited
   *  paths are converted. The result equals a drawing made from all paths. The base does not change and may be
   *  destroyed. */
  GpgpAsset base;
  const GpgpPathEdit* edits; /**< only with base; of two edits with the same index the later one counts */
  uint32_t editCount;
  /** VK_TRUE: the drawing can be a base. Keeps its tables in host memory, about twice its size on the device. */
  VkBool32 editable;
  /** VK_TRUE: gpgpHitTest can find the drawing's paths. Keeps its outlines in host memory, about its size on the
   *  device. Editable drawings can be hit-tested too, at no further cost. */
  VkBool32 hitTestable;
  /** 0: what the baked data holds; GPGP_DRAWING_FLATTENED for paths and edits. Canvases, lists and hit tests need
   *  GPGP_DRAWING_FLATTENED. Only what is asked for takes memory.
   *
   *  Patches do not draw clips, images, and groups that are less than opaque and hold more than one path. Each path
   *  that needs one of these is named in a warning (code UNSUPPORTED) and left out of the patches;
   *  GpgpDrawingInfo::pathsLeftOut counts them. */
  GpgpDrawingMethods methods;
} GpgpDrawingCreateInfo;
#define GPGP_DRAWING_CREATE_INFO_INIT GPGP_INIT(GpgpDrawingCreateInfo, GPGP_STRUCTURE_DRAWING_CREATE_INFO)

/** Makes a drawing from baked data, from paths or from another drawing, and queues it for upload. Baked data is
 *  checked; paths are converted to CPatches.
 *
 *  For paths that change from frame to frame, make each frame's drawing from the previous one. Draw the previous one
 *  until the new one is resident, then destroy it.
 *  Errors: INVALID_DATA, INVALID_ARGUMENT (the message gives the path's index), INVALID_HANDLE, IO, OUT_OF_..._MEMORY,
 *  UNSUPPORTED (more than 2^29 patches in the drawing; more than 2^21 points or 65536 dashes in a stroke; a path that
 *  crosses itself millions of times). @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateDrawing(GpgpContext context, const GpgpDrawingCreateInfo* info,
                                                GpgpAsset* drawing);

typedef struct GpgpDrawingInfo {
  GpgpStructureType sType;
  void* pNext;
  float bounds[4]; /**< box of everything that is painted: left, top, right, bottom, in drawing space */
  /** The page: x, y, width, height, in drawing space. Equals the bounds if the source has no page. */
  float viewport[4];
  uint32_t paths, curves, patches;
  uint32_t pathsLeftOut; /**< paths that gpgpRecordDrawPatches does not draw; 0 without GPGP_DRAWING_IN_PASS */
} GpgpDrawingInfo;
#define GPGP_DRAWING_INFO_INIT GPGP_INIT(GpgpDrawingInfo, GPGP_STRUCTURE_DRAWING_INFO)

/** Returns a drawing's bounds and counts. The drawing need not be resident. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetDrawingInfo(GpgpAsset drawing, GpgpDrawingInfo* info);

/* ---------------------------------------------------------------- glyph set */

typedef struct GpgpGlyphSetCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  /** Optional: baked glyphs to begin with, in any memory. Read during the call only. Not together with filePath. */
  const void* data;
  size_t size;
  const char* filePath; /**< optional: the file of baked glyphs, read through the context's file callbacks */
  uint32_t maxGlyphs;   /**< glyphs held at one time, at most 262144; 0: the number of baked glyphs, or 4096 */
  /** Bytes for outlines, allocated on the device and once more on the host; 0: what the baked glyphs take, or 8 MiB. A
   *  segment takes 64 bytes (a curve has two or three) and a path 48. A gradient takes 64 bytes, each of its stops 32.
   *  A glyph with any gradient takes 48 more. */
  VkDeviceSize maxBytes;
  GpgpDrawingMethods methods; /**< who draws the glyphs; 0: GPGP_DRAWING_FLATTENED */
} GpgpGlyphSetCreateInfo;
#define GPGP_GLYPH_SET_CREATE_INFO_INIT GPGP_INIT(GpgpGlyphSetCreateInfo, GPGP_STRUCTURE_GLYPH_SET_CREATE_INFO)

/** Makes a glyph set, empty or with baked glyphs, in one device buffer of the budget's size. A glyph is stored once,
 *  not once for each size: canvases draw it at any size, rotated and in perspective.
 *  Errors: INVALID_DATA, INVALID_ARGUMENT (the baked glyphs exceed a budget; the message says what they need),
 *  INVALID_STRUCT, UNSUPPORTED (a budget beyond what the device can bind), IO, OUT_OF_..._MEMORY.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateGlyphSet(GpgpContext context, const GpgpGlyphSetCreateInfo* info,
                                                 GpgpAsset* glyphSet);

enum { GPGP_GLYPH_NONE = 0 }; /**< The index of no glyph. Instances with this index draw nothing. */

/** Converts the glyphs whose keys are not in the set yet, and queues only these for upload. indices receives the index
 *  of every glyph that was passed.
 *
 *  If there is no room, the least recently used glyphs are evicted. A glyph is used when a recording draws it, and
 *  when it is added or found. Glyphs that an unfinished frame uses are never evicted.
 *  BUDGET_EXCEEDED: some glyphs did not fit, and their indices are GPGP_GLYPH_NONE. gpgpGetGlyphSetInfo returns what
 *  all of them would have needed.
 *  Errors: INVALID_ARGUMENT (the message names glyph and path), UNSUPPORTED, OUT_OF_HOST_MEMORY. After an error
 *  nothing has been added. Must not run at the same time as a recording that draws the set.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpAddGlyphs(GpgpAsset glyphSet, const GpgpGlyph* glyphs, uint32_t count,
                                            uint32_t* indices);

/** Looks up glyphs by key. indices receives GPGP_GLYPH_NONE for a key that is not in the set. A glyph that was found
 *  stays at least until the current frame is safe. All indices stay valid while GpgpGlyphSetInfo::evicted does not
 *  change.
 *  INCOMPLETE: some keys are not in the set. @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpFindGlyphs(GpgpAsset glyphSet, const uint64_t* keys, uint32_t count,
                                             uint32_t* indices);

typedef struct GpgpGlyphSetInfo {
  GpgpStructureType sType;
  void* pNext;
  uint32_t glyphs, maxGlyphs;
  VkDeviceSize bytes, maxBytes;
  uint64_t evicted; /**< Glyphs evicted so far. When it changes, some indices have become invalid. */
  /** Budgets that the last gpgpAddGlyphs needed: all glyphs passed to it, plus those that unfinished frames use. The
   *  bytes of a glyph must be contiguous, so somewhat more than bytesNeeded may be required. */
  uint32_t glyphsNeeded;
  VkDeviceSize bytesNeeded;
} GpgpGlyphSetInfo;
#define GPGP_GLYPH_SET_INFO_INIT GPGP_INIT(GpgpGlyphSetInfo, GPGP_STRUCTURE_GLYPH_SET_INFO)

/** Returns what a glyph set holds and what its budgets are. @threads context */
GPGP_API GpgpResult GPGP_CALL gpgpGetGlyphSetInfo(GpgpAsset glyphSet, GpgpGlyphSetInfo* info);

/* ---------------------------------------------------------------- canvas */

/** Bits: what the recordings of a canvas write. */
typedef uint64_t GpgpCanvasTargets;
/** A canvas history, alone or beside a target. */
#define GPGP_CANVAS_TARGET_HISTORY ((GpgpCanvasTargets)1)
/** A target in R8G8B8A8_UNORM. */
#define GPGP_CANVAS_TARGET_RGBA8 ((GpgpCanvasTargets)2)
/** A target in R16G16B16A16_SFLOAT. */
#define GPGP_CANVAS_TARGET_RGBA16F ((GpgpCanvasTargets)4)

/** How a canvas finds which samples a drawing's paths cover. */
typedef int32_t GpgpCanvasMethod;
enum {
  /** Outlines are flattened to lines within 1/32 of a pixel. */
  GPGP_CANVAS_FLATTENED = 0,
  /** Drawings made with GPGP_DRAWING_PATCHES are drawn by their CPatches: the implicit forms of the curves decide every
   *  sample, without approximation. Other drawings, text and shapes are flattened, in the same painting order. With
   *  GpgpCanvasInfo::exactArea a pixel's area is that of 256 samples. */
  GPGP_CANVAS_PATCHES = 1
};

/** Budgets of a canvas. Its scratch memory follows from them. When a budget is exceeded, the first thing in painting
 *  order that does not fit and everything painted after it are left out. The report says what everything would have
 *  needed. */
typedef struct GpgpCanvasCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecorderCreateInfo base;
  uint32_t maxWidth, maxHeight; /**< largest canvas in pixels, at most 16384 x 16384; 0: 2048 */
  /** Paths in one recording, at most 4194304; 0: 262144. An item that shows a drawing counts GpgpDrawingInfo::paths. A
   *  placed glyph counts its own paths each time. A shape of a list counts 1, and so does a clip that is not a
   *  scissor. The numbers of curves and patches are not limited, as these lie in the drawing's own buffer. A path
   *  takes 48 bytes, 8 more on hardware devices, and one bit for each square of 128 pixels of the canvas. */
  uint32_t maxPaths;
  /** Tiles of 8 x 8 pixels that a path's edges pass through, summed over all paths, at most 2^28; 0: 131072. Each pair
   *  of a path and such a tile is an entry. It takes 480 bytes, 224 of them for lists; on software devices 384. */
  uint32_t maxTileEntries;
  /** Words of tile flags, at most 2^28; 0: maxTileEntries, or 65536 if that is more. A word covers 32 tiles of one row
   *  of tiles. A path that meets the canvas takes, for each row of its box, the box's width in tiles divided by 32,
   *  rounded up. A word takes 16 bytes, on software devices 32. */
  uint32_t maxTileWords;
  /** Items of all kinds in one recording, not drawings alone; at most 65536; 0: 64. Lists (ui.h) count each of their
   *  drawings and clips, and each change of transform, clip or group. A drawing with layers counts each of its layers,
   *  clips of layers, and the paths between them. The number of groups has the same limit, and so
   *  has the number of different drawings and glyph sets, of which there are at most 2047. Assets share buffers, each
   * of at most VkPhysicalDeviceLimits::maxStorageBufferRange, of which a recording binds at most 8. A ninth is an
   * error: it takes assets above 64 KiB each that lie among some 100 MiB of others, or take more than 1 MiB each. */
  uint32_t maxDrawings;
  /** Glyphs of all texts in one recording, blanks not counted, at most 1048576; 0: 1024. 160 bytes each, and 48 more
   *  for every recording that can be in flight. */
  uint32_t maxGlyphs;
  /** Shapes of all lists (ui.h) in one recording, clips that are not scissors included, at most 1048576; 0: 1024.
   *  Their gradients may have twice as many stops in all; a nine-slice or tiled image counts as 2 stops. 352 bytes
   *  each, and 240 more for every recording that can be in flight. */
  uint32_t maxShapes;
  /** What recordings will write; 0: anything. Pipelines are made only for these: for a single target half as many, in
   *  half the time. */
  GpgpCanvasTargets targets;
  /** Pixels of the pictures that drawings with layers (layers.h) are made of in one recording, at most 2^28; 0: none.
   *  Such a recording takes the canvas itself, the part of it that each layer, mask and clip of a layer covers, and the
   *  pictures between the steps of the largest filter. Paths behind a layer take a picture, too. A pixel takes 8 bytes.
   *  The first layered drawing that does not fit and everything painted after it are left out. */
  uint32_t maxLayerPixels;
  /** Operations on these pictures in one recording, at most 65536; 0: 1024. A layer takes one, a step of a filter one
   * to five. Each takes 304 bytes for every recording that can be in flight. */
  uint32_t maxLayerOperations;
  GpgpCanvasMethod method; /**< 0: GPGP_CANVAS_FLATTENED */
  /** GPGP_CANVAS_PATCHES: pairs of a CPatch and a tile that its curves pass through, at most 2^28; 0: twice
   *  maxTileEntries. Each takes 16 bytes. Where they do not suffice, the first drawing that is drawn by patches and
   *  everything painted after it are left out. */
  uint32_t maxTilePatches;
  /** Images in one recording, at most GPGP_MAX_IMAGES; 0: 8. Rounded up to a multiple of 8. */
  uint32_t maxImages;
  /** Pixels that paths with images cover in recordings of more than 8 images, at most 2^28; 0: maxWidth x maxHeight.
   * Such recordings find the colours of images before they rasterise, 8 images at a time: a path takes the tiles of 8 x
   * 8 pixels of its box on the canvas. A pixel takes 8.25 bytes, on canvases with maxImages above 8. Paths that find no
   *  room are left out, and the report's status is BUDGET_EXCEEDED. */
  uint32_t maxImagePixels;
} GpgpCanvasCreateInfo;
#define GPGP_CANVAS_CREATE_INFO_INIT GPGP_INIT(GpgpCanvasCreateInfo, GPGP_STRUCTURE_CANVAS_CREATE_INFO)

/** Makes a canvas: the recorder that rasterises drawings, text and lists, with scratch memory for its budgets. Prewarm
 *  it (gpgpPrewarm) before the first recording.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, UNSUPPORTED (budgets beyond the device's limits), OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateCanvas(GpgpContext context, const GpgpCanvasCreateInfo* info,
                                               GpgpRecorder* canvas);

typedef struct GpgpCanvasHistoryCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  /** Pixels, 1 to 16384 each; a pixel takes 8 bytes of device memory. Both may be 0 where maxKept is not: such a
   *  history holds no picture. It remembers what a target shows. */
  uint32_t width, height;
  /** What the history can remember of a recording, for GpgpCanvasInfo::keep: each drawing, glyph, shape and clip that
   *  the canvas shows is one thing; at most 4194304. A thing takes some 60 bytes of host memory. 0: nothing is
   *  remembered. */
  uint32_t maxKept;
} GpgpCanvasHistoryCreateInfo;
#define GPGP_CANVAS_HISTORY_CREATE_INFO_INIT                                                                           \
  GPGP_INIT(GpgpCanvasHistoryCreateInfo, GPGP_STRUCTURE_CANVAS_HISTORY_CREATE_INFO)

/** Makes a canvas history: the prepared picture of a canvas, kept in device memory between gpgpRecordPrepareCanvas
 *  and gpgpRecordDrawCanvas. It can be used once a gpgpRecordUpload has cleared it.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, UNSUPPORTED (larger than the device can bind), OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateCanvasHistory(GpgpContext context, const GpgpCanvasHistoryCreateInfo* info,
                                                      GpgpHistory* history);

/** A glyph placed in a text. */
typedef struct GpgpGlyphInstance {
  uint32_t glyph; /**< index in the glyph set */
  float x, y;     /**< where the glyph's (0, 0) lies, in text space, within +-1e7 */
  float size;     /**< length of an em in text space, 0 to 1e7 */
  /** Linear RGB, 0 to 10000, for the paths that take the text's colour and have no gradient. Straight alpha, 0 to 1,
   *  multiplies the alpha of every path. */
  float color[4];
} GpgpGlyphInstance;

/** Shapes, images, text and drawings in painting order (ui.h). */
typedef struct GpgpList_T* GpgpList;

/** One thing that a canvas shows: a drawing, a text or a list. */
typedef struct GpgpCanvasItem {
  GpgpAsset drawing; /**< NULL for a text or a list */
  /** Drawing, text or list space to canvas pixels: x' = t0 x + t2 y + t4, y' = t1 x + t3 y + t5. */
  float transform[6];
  float opacity; /**< 0 to 1; multiplies the alpha of each path, so overlapping paths show through one another */
  /** Third row of a projective map: w = p0 x + p1 y + p2, and the pixel is (x', y') / w. All 0: affine, w = 1. Points
   *  with w <= 0 lie behind the eye and are not drawn. gpgpPlacePanel (ui.h) computes this map for a panel in a 3D
   *  world.
   *
   *  By hand: let the panel have corner o and sides u, v, each as long as one unit of the drawing. Multiply o (as a
   *  point), u and v (as directions) by the view-projection matrix to get o', u', v'. For a canvas of W x H pixels:
   *  - clip space: x_c = u'.x x + v'.x y + o'.x, and likewise y_c and w_c
   *  - transform: W (u'.x + u'.w) / 2, H (u'.y + u'.w) / 2, then the same of v', then the same of o'
   *  - perspective: u'.w, v'.w, o'.w */
  float perspective[3];
  uint32_t firstImage; /**< index in GpgpCanvasInfo::images of the first image of the drawing or list */
  /** Glyph set for text items; NULL otherwise. `transform` then maps text space to pixels. */
  GpgpAsset glyphSet;
  const GpgpGlyphInstance* glyphs; /**< in painting order, the first at the bottom */
  uint32_t glyphCount;
  /** Left, top, right, bottom in canvas pixels, whatever the transform. The item shows only inside. All 0: none. */
  float scissor[4];
  /** List items show everything in the list. The list's own transforms apply before the item's. NULL otherwise. */
  GpgpList list;
} GpgpCanvasItem;

#ifdef __cplusplus
} /* extern "C" */
/** See GPGP_CANVAS_ITEM_INIT. */
inline GpgpCanvasItem gpgpInitCanvasItem() {
  GpgpCanvasItem item = GpgpCanvasItem();
  item.transform[0] = item.transform[3] = item.opacity = 1.0f;
  return item;
}
extern "C" {
/** An opaque item whose transform is the identity. A zeroed item draws nothing: it is transparent and has no extent. */
#define GPGP_CANVAS_ITEM_INIT gpgpInitCanvasItem()
#else
/** An opaque item whose transform is the identity. A zeroed item draws nothing: it is transparent and has no extent. */
#define GPGP_CANVAS_ITEM_INIT                                                                                          \
  { .transform = {1, 0, 0, 1, 0, 0}, .opacity = 1 }
#endif

/** Images that the items of one recording can paint with at most. Each canvas has room for as many as it was made for
 *  (GpgpCanvasCreateInfo::maxImages). */
enum { GPGP_MAX_IMAGES = 1024 };

/** How an image encodes colours, as a shader receives them from the sampler. */
typedef int32_t GpgpImageEncoding;
enum {
  GPGP_IMAGE_LINEAR = 0, /**< linear light: sRGB formats, which the sampler decodes, and most float formats */
  GPGP_IMAGE_SRGB = 1    /**< sRGB encoding: the texels of a picture file in a UNORM format */
};

/** How an image is filtered between its texels. */
typedef int32_t GpgpImageFilter;
enum { GPGP_IMAGE_FILTER_LINEAR = 0, GPGP_IMAGE_FILTER_NEAREST = 1 };

/** An image of the engine's that items paint with. The engine makes its contents visible to sampling in compute
 *  shaders.
 *
 *  Between texels, colours are mixed premultiplied and in the canvas's encoding: linear light, or sRGB with blendSrgb.
 *  If the texels are premultiplied and in the canvas's encoding already, the shader samples once a pixel and the
 *  sampler decides everything. Otherwise the shader converts texels one by one: 4 samples a pixel, or 8 between two
 *  mip levels. The sampler then decides only what lies beyond the edges. Its anisotropy and mip bias are ignored, and
 *  all mip levels of the image view are used. */
typedef struct GpgpCanvasImage {
  VkImageView view; /**< 2D, in a float or normalised format that the sampler may filter */
  VkSampler sampler;
  VkImageLayout layout; /**< current layout: SHADER_READ_ONLY_OPTIMAL, GENERAL, ... */
  /** VK_TRUE: colours are multiplied by alpha, in the encoding that the shader receives. Set it for opaque images. */
  VkBool32 premultiplied;
  GpgpImageEncoding encoding;
  /** NEAREST: each pixel takes what the sampler returns. The sampler's own filters must then be NEAREST as well. */
  GpgpImageFilter filter;
  /** For GpgpCanvasInfo::keep: a number that changes whenever the contents of the image change, or the view or sampler
   *  is another one behind an equal handle. */
  uint64_t version;
} GpgpCanvasImage;

typedef struct GpgpCanvasInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;
  uint32_t width, height;      /**< size of the canvas in pixels, at most maxWidth x maxHeight */
  const GpgpCanvasItem* items; /**< in painting order, the first at the bottom */
  uint32_t itemCount;          /**< at most maxDrawings */
  uint32_t samples;            /**< samples per pixel: 1, 4, 8 or 16; 0: 16 */
  float background[4];         /**< premultiplied; linear, or sRGB-encoded with blendSrgb */
  GpgpHistory history; /**< optional: keeps the result for gpgpRecordDrawCanvas; at least width x height pixels */
  /** Optional (view NULL: none): receives the result as premultiplied linear colour. At least width x height pixels,
   *  STORAGE usage, in R8G8B8A8_UNORM or R16G16B16A16_SFLOAT. */
  GpgpImage target;
  /** VK_TRUE: the target receives straight colour encoded as sRGB and then multiplied by alpha. PNG files and 2D
   *  compositors expect this encoding. */
  VkBool32 encodeSrgb;
  /** VK_TRUE: in each pixel, the exact area of the front-most path with an edge replaces its samples: finer steps where
   *  only one edge passes. Neighbours show nothing between them; equal shapes up to a tenth of the lower one's colour.
   */
  VkBool32 exactArea;
  VkBool32 blendSrgb;            /**< VK_TRUE: colours are mixed as sRGB encodes them, as SVG renderers do. */
  const GpgpCanvasImage* images; /**< the images that items paint with */
  uint32_t imageCount;           /**< at most GpgpCanvasCreateInfo::maxImages */
  /** VK_TRUE: only tiles of 8 x 8 pixels in which something changed are drawn again. The history, made with maxKept,
   *  remembers the last recording with it. Where nothing changed, nothing is drawn. The picture is that of a recording
   *  without this flag, bit for bit.
   *
   *  The engine promises that the last recording with this history is executed before this one, and that the target,
   *  if there is one, still holds what that recording left: target.before.layout is not UNDEFINED, and each target has
   *  a history of its own. GpgpCanvasImage::version says when an image changed. What the canvas can see itself (another
   *  size, target, setting or canvas, budgets that were exceeded) makes it draw everything; the report says why. */
  VkBool32 keep;
} GpgpCanvasInfo;
#define GPGP_CANVAS_INFO_INIT GPGP_INIT(GpgpCanvasInfo, GPGP_STRUCTURE_CANVAS_INFO)

/** Rasterises the items into the history, the target, or both.
 *
 *  Both receive the same pixels up to rounding: the history holds half floats, and image stores and attachments round
 *  differently. Compared here: a target, and an attachment of the same format that was cleared to 0 and drawn over. In
 *  R16G16B16A16_SFLOAT they differ by at most one unit in the last place of a half, in R8G8B8A8_UNORM by at most
 *  1/255. An sRGB attachment encodes premultiplied colour, so it is within 1/255 of a target with encodeSrgb only
 *  where the canvas is opaque.
 *  NOT_READY: a drawing or glyph that is shown is not resident, the history is not resident, or the canvas is not
 *  prewarmed.
 *  @threads handle @lifetime call; image: frame @pass outside @state compute pipeline, compute descriptor set 0 (and 1
 *  where items paint with images), push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordPrepareCanvas(GpgpRecorder canvas, VkCommandBuffer commandBuffer,
                                                      const GpgpFrame* frame, const GpgpCanvasInfo* info);

typedef struct GpgpCanvasDrawInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpHistory history;
  const GpgpTargetInfo* target; /**< equal to one of those that were passed to gpgpPrewarm */
  float clip[16];               /**< matrix from canvas pixels (x, y, 0, 1) to clip space, column-major */
  uint32_t width, height;       /**< size of the part of the canvas that is drawn, pixels */
  uint32_t x;                   /**< column of the canvas at which the part begins; `clip` sees this column as x = 0 */
  uint32_t secondX;             /**< multiview targets only: `x` for view 1 */
  const float* secondClip; /**< multiview targets only: 16 numbers, `clip` for view 1; NULL: `clip` for both views */
} GpgpCanvasDrawInfo;
#define GPGP_CANVAS_DRAW_INFO_INIT GPGP_INIT(GpgpCanvasDrawInfo, GPGP_STRUCTURE_CANVAS_DRAW_INFO)

/** Draws a canvas history as a rectangle, with premultiplied blending (ONE, ONE_MINUS_SRC_ALPHA). It shows the result
 *  of the last gpgpRecordPrepareCanvas into this history, and can be drawn any number of times. At one canvas pixel
 *  per pixel nothing is filtered. The engine sets viewport and scissor.
 *
 *  Views 0 and 1 of a multiview target (GpgpTargetInfo::viewMask, GPGP_FEATURE_MULTIVIEW) can show different parts of
 *  the canvas, so one recording serves both eyes.
 *  NOT_READY: nothing was prepared into the history, or gpgpPrewarm has not returned yet. INVALID_ARGUMENT: the target
 *  equals none that was given to gpgpPrewarm.
 *  @threads handle @lifetime call @pass inside @state graphics pipeline, graphics descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordDrawCanvas(GpgpRecorder canvas, VkCommandBuffer commandBuffer,
                                                   const GpgpFrame* frame, const GpgpCanvasDrawInfo* info);

/** Why a recording drew all tiles. */
typedef int32_t GpgpCanvasRedraw;
enum {
  GPGP_CANVAS_REDRAW_NONE = 0,      /**< it did not: only tiles in which something changed were drawn */
  GPGP_CANVAS_REDRAW_NOT_ASKED = 1, /**< GpgpCanvasInfo::keep is VK_FALSE */
  GPGP_CANVAS_REDRAW_FIRST = 2,     /**< the history remembers nothing */
  /** Size, samples, background, encodings, the target or its layout, or the canvas are not those of the last recording
   *  with the history. */
  GPGP_CANVAS_REDRAW_SETTINGS = 3,
  GPGP_CANVAS_REDRAW_ROOM = 4, /**< more things than maxKept */
  /** A budget was exceeded, in this recording or, as its report says, in one since all tiles were last drawn; or such a
   *  recording was not executed. */
  GPGP_CANVAS_REDRAW_INCOMPLETE = 5,
  /** Other shaders paint the canvas: its first gradient, image, projective item or group came, or the last one went. */
  GPGP_CANVAS_REDRAW_SHADERS = 6,
  GPGP_CANVAS_REDRAW_LAYERS = 7, /**< something changed, and there are layers (layers.h) */
  GPGP_CANVAS_REDRAW_MOST = 8    /**< more than half of the tiles changed */
};

/** What a recording of a canvas needed, beside the budgets that it was given. With GPGP_CANVAS_REDRAW_NONE that is only
 *  what the tiles needed that were drawn. */
typedef struct GpgpCanvasReport {
  GpgpStructureType sType;
  void* pNext;
  GpgpReportHeader base;
  uint32_t paths;      /**< needed */
  uint32_t pathsGiven; /**< maxPaths */
  /** Needed by the paths that fit into maxPaths, maxGlyphs, maxShapes and maxDrawings. */
  uint32_t tileWords;
  uint32_t tileWordsGiven; /**< maxTileWords */
  /** Counts only paths that got tile words. If tileWords > tileWordsGiven, raise that first and read this again. */
  uint32_t tileEntries;
  uint32_t tileEntriesGiven;     /**< maxTileEntries */
  uint32_t pathsDropped;         /**< paths left out because a budget was short; text is left out by whole glyphs */
  uint32_t glyphs;               /**< needed */
  uint32_t glyphsGiven;          /**< maxGlyphs */
  uint32_t shapes;               /**< needed */
  uint32_t shapesGiven;          /**< maxShapes */
  uint32_t items;                /**< needed */
  uint32_t itemsGiven;           /**< maxDrawings */
  uint32_t layerPixels;          /**< needed */
  uint32_t layerPixelsGiven;     /**< maxLayerPixels */
  uint32_t layerOperations;      /**< needed */
  uint32_t layerOperationsGiven; /**< maxLayerOperations; 0 without maxLayerPixels */
  uint32_t tilePatches;          /**< needed by the paths that got tile words */
  uint32_t tilePatchesGiven;     /**< maxTilePatches; 0 with GPGP_CANVAS_FLATTENED */
  uint32_t imagePixels;          /**< needed by recordings of more than 8 images; 0 by others */
  uint32_t imagePixelsGiven;     /**< maxImagePixels; 0 where maxImages is at most 8 */
  uint32_t tiles;                /**< of 8 x 8 pixels, that the canvas has */
  uint32_t tilesDrawn;           /**< fewer only with GpgpCanvasInfo::keep */
  GpgpCanvasRedraw redraw;       /**< why all of them were drawn */
} GpgpCanvasReport;
#define GPGP_CANVAS_REPORT_INIT GPGP_INIT(GpgpCanvasReport, GPGP_STRUCTURE_CANVAS_REPORT)

/** Returns the oldest report that has not been taken yet.
 *  NOT_READY: there is none. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetCanvasReport(GpgpRecorder canvas, GpgpCanvasReport* report);

/* ---------------------------------------------------------------- patches inside a render pass */

/** Budgets of a patch recorder. It has no scratch memory. What a recording passes to the GPU takes 240 bytes an item
 *  and 48 bytes a glyph, for every recording that can be in flight. */
typedef struct GpgpPatchRecorderCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecorderCreateInfo base;
  uint32_t maxItems;  /**< items in one recording, at most 65536; 0: 1024 */
  uint32_t maxGlyphs; /**< glyphs of all texts in one recording, at most 1048576; 0: 1024 */
} GpgpPatchRecorderCreateInfo;
#define GPGP_PATCH_RECORDER_CREATE_INFO_INIT                                                                           \
  GPGP_INIT(GpgpPatchRecorderCreateInfo, GPGP_STRUCTURE_PATCH_RECORDER_CREATE_INFO)

/** Makes a patch recorder. Prewarm it (gpgpPrewarm) for every target that it draws into. Targets with several samples
 *  need the device's standardSampleLocations.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, UNSUPPORTED, OUT_OF_..._MEMORY. @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreatePatchRecorder(GpgpContext context, const GpgpPatchRecorderCreateInfo* info,
                                                      GpgpRecorder* recorder);

/** One thing that a draw of patches shows: a drawing or a text. */
typedef struct GpgpPatchItem {
  GpgpAsset drawing; /**< made with GPGP_DRAWING_IN_PASS; NULL for a text */
  /** Matrix from drawing or text space (x, y, 0, 1) to clip space, column-major. Any matrix, perspective included:
   * model, view and projection of a panel in the world, for example. What lies behind the eye is cut off. */
  float clip[16];
  const float* secondClip; /**< multiview targets only: 16 numbers, `clip` for view 1; NULL: `clip` for both views */
  float opacity;      /**< 0 to 1; multiplies the alpha of each path, so overlapping paths show through one another */
  GpgpAsset glyphSet; /**< made with GPGP_DRAWING_IN_PASS, for a text; NULL for a drawing */
  const GpgpGlyphInstance* glyphs; /**< in painting order, the first at the bottom */
  uint32_t glyphCount;
} GpgpPatchItem;

typedef struct GpgpPatchDrawInfo {
  GpgpStructureType sType;
  const void* pNext;
  const GpgpTargetInfo* target; /**< equal to one of those that were passed to gpgpPrewarm */
  const GpgpPatchItem* items;   /**< in painting order, the first at the bottom */
  uint32_t itemCount;           /**< at most maxItems, of any number of drawings and glyph sets */
  /** The viewport that the engine has set: x, y, width, height, in pixels. A negative height turns y over. */
  float viewport[4];
  /** VK_TRUE: colours are written as sRGB encodes them, premultiplied, and so mix in that encoding. For attachments in
   *  UNORM formats that hold sRGB colours. VK_FALSE: linear colours, for sRGB and float formats. */
  VkBool32 encodeSrgb;
} GpgpPatchDrawInfo;
#define GPGP_PATCH_DRAW_INFO_INIT GPGP_INIT(GpgpPatchDrawInfo, GPGP_STRUCTURE_PATCH_DRAW_INFO)

/** Draws the items inside the engine's render pass, in one draw with premultiplied blending (ONE,
 *  ONE_MINUS_SRC_ALPHA). Nothing is recorded before the pass, and nothing is kept. Edges are exact at any
 *  magnification.
 *
 *  With one sample, a path's paint is multiplied by the part of the pixel that the path covers. With several, the draw
 *  writes those samples that lie inside the path, so paths that abut show nothing between them. The depth test, if the
 *  target has one, compares each item's own plane. The engine sets viewport and scissor.
 *
 *  NOT_READY: a drawing or glyph that is shown is not resident, or gpgpPrewarm has not returned yet. INVALID_ARGUMENT:
 *  the target equals none that was given to gpgpPrewarm; more items or glyphs than the recorder was made for; an asset
 *  without GPGP_DRAWING_IN_PASS.
 *  @threads handle @lifetime call @pass inside @state graphics pipeline, graphics descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordDrawPatches(GpgpRecorder recorder, VkCommandBuffer commandBuffer,
                                                    const GpgpFrame* frame, const GpgpPatchDrawInfo* info);

#ifdef __cplusplus
}
#endif
#endif
