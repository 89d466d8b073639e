/* gpgp ui: what a user interface draws beside drawings and text, and what lies under a pointer.
 *
 *   list   shapes, images, nine-slices, text and drawings in painting order, with stacks of transforms, clips and
 *          opacity: filled anew every frame, or kept
 *
 *   gpgpCreateList -> each frame: gpgpResetList, gpgpPush..., gpgpAdd..., gpgpPopState
 *   -> GpgpCanvasItem::list -> gpgpRecordPrepareCanvas
 *   GpgpCanvasItem[] -> gpgpHitTest
 *
 * A list lies in host memory alone and may be shown by any number of items, under different transforms and on different
 * canvases: the two eyes of a panel in the world are two items with the same list.
 */
#ifndef GPGP_UI_H
#define GPGP_UI_H
#include <gpgp/vector.h>
#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- list */

typedef struct GpgpListCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  uint32_t shapes, glyphs, commands; /**< room for as many from the beginning. A list grows where it must, and keeps its
                                          room when it is reset */
} GpgpListCreateInfo;
#define GPGP_LIST_CREATE_INFO_INIT GPGP_INIT(GpgpListCreateInfo, GPGP_STRUCTURE_LIST_CREATE_INFO)

/** Makes an empty list. Errors: INVALID_ARGUMENT, INVALID_STRUCT, OUT_OF_HOST_MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateList(GpgpContext context, const GpgpListCreateInfo* info, GpgpList* list);

/** NULL is ignored. Records that show it are not affected. @threads context */
GPGP_API void GPGP_CALL gpgpDestroyList(GpgpList list);

/** Empties the list and its stack. Not beside records and hit tests that show it. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpResetList(GpgpList list);

/** Pushes in each other, of all kinds; of these, GPGP_MAX_CLIP_DEPTH clips and GPGP_MAX_OPACITY_DEPTH groups, with
 *  those of a drawing that is added. After each other there may be any number; what a record takes of them is in
 *  GpgpCanvasCreateInfo's budgets. */
enum { GPGP_MAX_LIST_DEPTH = 64 };

/** What is added from here on lies in a space of its own, which this map takes to the space so far: x' = t0 x + t2 y +
 *  t4, y' = t1 x + t3 y + t5, and, where perspective (3 numbers) is not NULL, both divided by w = p0 x + p1 y + p2 as
 *  in GpgpCanvasItem. Moves and even scales cost nothing: they are applied to what is added, which must lie within
 *  +-1e7 then, too. Each other change of transform counts for maxDrawings.
 *  Errors: INVALID_ARGUMENT (a number is not finite; too deep). @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpPushTransform(GpgpList list, const float* transform, const float* perspective);

/** What is added from here on shows only inside of the box (left, top, right, bottom, in the current space, within
 *  +-1e7 before and after the moves and even scales pushed around it), and of those around it. Round corners, if radii
 *  is not NULL: as GpgpListShape's. Where box and canvas are parallel (the transforms move, scale, mirror or turn by
 *  quarters) and corners are not round, a scissor that costs next to nothing; else (turned, skewed, in perspective) the
 *  clip goes with its box, counts as a shape (maxShapes, maxPaths) and costs the pixels on its edge more. Either way
 *  edges are smooth, sample by sample, as those of any path.
 *  Errors: INVALID_ARGUMENT (not a number, beyond 1e7, right below left; too deep). @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpPushClip(GpgpList list, const float* box, const float* radii);

/** Multiplies the alpha of each thing that is added from here on, one by one, of drawings each path: what overlaps
 *  shows through.
 *  Errors: INVALID_ARGUMENT (not 0 to 1; too deep). @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpPushOpacity(GpgpList list, float opacity);

/** What is added from here on is one thing: it fades as a whole, by this opacity times those pushed around it (and the
 *  item's), and where parts of it overlap the lower ones do not shine through. Counts for maxDrawings; costs the pixels
 *  that it covers more where it is neither opaque nor hidden. Errors: INVALID_ARGUMENT (not 0 to 1; too deep).
 *  @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpPushGroup(GpgpList list, float opacity);

/** Ends what the last gpgpPush... began that has not ended. A list that is shown has as many of these as of those.
 *  Errors: INVALID_ARGUMENT (none is left). @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpPopState(GpgpList list);

/** The id of what hit tests pass over, such as decoration on top of a button. Drawings need not be hitTestable then. */
#define GPGP_ID_NOT_HIT UINT64_MAX

typedef int32_t GpgpListShapeKind;
enum {
  GPGP_LIST_RECTANGLE = 0,
  GPGP_LIST_ELLIPSE = 1, /**< that fills the box */
  GPGP_LIST_LINE = 2
};

typedef int32_t GpgpListTile;
enum {
  GPGP_TILE_STRETCH = 0, /**< once, stretched */
  GPGP_TILE_REPEAT = 1,  /**< from left or top on, the last one cut off */
  GPGP_TILE_ROUND = 2    /**< a whole number of times, at least once, stretched or shrunk so that they fit */
};

/** What of an image a shape shows, and where its edges go: all borders 0: evenly over the box, else nine-slice. */
typedef struct GpgpListImage {
  uint32_t image;         /**< in GpgpCanvasInfo::images, counted from the item's firstImage; below GPGP_MAX_IMAGES */
  float source[4];        /**< left, top, right, bottom in texture coordinates (0 to 1 over the image), within +-1e6 */
  float sourceBorders[4]; /**< left, top, right, bottom: how far from the source's sides its borders end, texture
                               coordinates, 0 to its extent */
  float borders[4];       /**< the same for the box; where two do not find room, both shrink. Corners keep this size,
                               sides stretch or repeat along, the middle both ways */
  GpgpListTile tiles[2];  /**< what lies between the borders, across and down */
  float tileSize[2]; /**< how far one repetition reaches, units of the box; 0: as the borders are scaled, which then
                          may not be 0. Not used where it is stretched */
} GpgpListImage;

/** A rectangle, ellipse or line. Coordinates, radii and width within +-1e7 in the current space, and after the moves
 *  and even scales pushed. */
typedef struct GpgpListShape {
  GpgpListShapeKind kind;
  float box[4];   /**< left, top, right, bottom; a line: x, y of its begin and of its end */
  float radii[4]; /**< rectangle: of the corners top left, top right, bottom right, bottom left; where two do not find
                       room on a side, all shrink */
  float width;    /**< a line's; else 0: filled, above: only a border of this width inside the edge */
  GpgpCap cap;    /**< a line's ends */
  float color[4]; /**< linear RGB, 0 to 10000, straight alpha, 0 to 1; multiplies image and gradient */
  const GpgpGradient* gradient; /**< NULL: none */
  const GpgpListImage* image;   /**< NULL: none; not for lines, without a gradient */
  uint64_t id;                  /**< the engine's, for gpgpHitTest; or GPGP_ID_NOT_HIT */
} GpgpListShape;

/** Paints shapes on top of what is in the list. A filled shape with a border is two. Errors, after which none is added:
 *  INVALID_ARGUMENT (shape in the message), UNSUPPORTED (2^32 of them), OUT_OF_HOST_MEMORY.
 *  @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpAddShapes(GpgpList list, const GpgpListShape* shapes, uint32_t count);

/** Paints glyphs on top of what is in the list, in the current space.
 *  Errors: INVALID_ARGUMENT, INVALID_HANDLE, OUT_OF_HOST_MEMORY. @threads handle @lifetime call; glyph set: it need not
 *  outlive the list, but records that show it */
GPGP_API GpgpResult GPGP_CALL gpgpAddText(GpgpList list, GpgpAsset glyphSet, const GpgpGlyphInstance* glyphs,
                                          uint32_t count, uint64_t id);

/** Paints a drawing on top of what is in the list. firstImage counts from the item's.
 *  Errors: INVALID_ARGUMENT, INVALID_HANDLE, OUT_OF_HOST_MEMORY. @threads handle @lifetime call; drawing: as
 *  gpgpAddText's glyph set */
GPGP_API GpgpResult GPGP_CALL gpgpAddDrawing(GpgpList list, GpgpAsset drawing, uint32_t firstImage, uint64_t id);

/* ---------------------------------------------------------------- panels in the world */

/** A plane in the world that a drawing, text or list lies on. */
typedef struct GpgpPanel {
  float corner[3]; /**< where its 0, 0 lies, world space */
  float across[3]; /**< from there to its 1, 0: how long and which way a unit along x is */
  float down[3];   /**< likewise along y */
} GpgpPanel;

/** How a camera sees a panel. Writes transform, perspective and scissor of the item, so that it shows in the viewport
 *  (x, y, width, height: the part of the canvas that is this camera's), and, where clip is not NULL, a matrix for
 *  GpgpCanvasDrawInfo::clip, or secondClip: the viewport goes over the whole target, each pixel at the panel's depth,
 *  so that a depth test puts the panel behind and before the scene as it should be. viewProjection: world to clip
 *  space, column-major; any depth range.
 *  Errors: INVALID_ARGUMENT (NULL, no size, a number that is not finite, given or written). @threads any
 *  @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpPlacePanel(const GpgpPanel* panel, const float* viewProjection,
                                             const uint32_t* viewport, GpgpCanvasItem* item, float* clip);

/* ---------------------------------------------------------------- hit test */

typedef struct GpgpHitTestInfo {
  GpgpStructureType sType;
  const void* pNext;
  const GpgpCanvasItem* items; /**< as a record takes them, the first at the bottom */
  uint32_t itemCount;
  float x, y; /**< canvas pixels; the middle of the first one is 0.5, 0.5 */
} GpgpHitTestInfo;
#define GPGP_HIT_TEST_INFO_INIT GPGP_INIT(GpgpHitTestInfo, GPGP_STRUCTURE_HIT_TEST_INFO)

#define GPGP_HIT_NONE UINT32_MAX

/** What lies under a point. */
typedef struct GpgpHit {
  uint32_t item;  /**< GPGP_HIT_NONE: nothing */
  uint32_t entry; /**< of a list: which of the shapes, texts and drawings added, counted together; else 0 */
  uint32_t glyph; /**< of a text: which instance; else 0 */
  uint32_t path;  /**< of a drawing or glyph; else 0 */
  uint64_t id;    /**< of a list's entry */
  float x, y;     /**< the point in the space of the drawing, of the text, or in which the list's entry was added */
} GpgpHit;

/** The topmost path or shape whose inside holds the point, under the transforms of items and lists, within their clips.
 *  Colours, gradients, opacity and what an image shows do not count: what is painted with alpha 0 is hit as well.
 *  Drawings and glyphs are asked by the curves that are drawn, without chords and samples.
 *  Errors: INVALID_ARGUMENT (a drawing that is neither hitTestable nor editable, a glyph that was evicted, a list with
 *  pushes that are not popped), INVALID_HANDLE. Not beside gpgpAddGlyphs of a set, or changes of a list, that is shown.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpHitTest(GpgpContext context, const GpgpHitTestInfo* info, GpgpHit* hit);

#ifdef __cplusplus
}
#endif
#endif
