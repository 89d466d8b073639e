/* gpgp ui: lists of shapes, images, text and drawings for user interfaces; panels in the world; hit tests.
 *
 *   list   Shapes, images, nine-slices, triangles, text and drawings in painting order, with stacks of transforms,
 * clips and opacity. A list is filled anew every frame, or kept.
 *
 *   gpgpCreateList -> each frame: gpgpResetList, gpgpPush..., gpgpAdd..., gpgpPopState
 *   -> GpgpCanvasItem::list -> gpgpRecordPrepareCanvas
 *   GpgpCanvasItem[] -> gpgpHitTest
 *
 * A list lies in host memory only. Any number of items can show it, under different transforms and on different
 * canvases. For stereo, a panel in the world is two items with the same list.
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
  /** Initial capacity. A list grows when it must, and keeps its capacity when it is reset. */
  uint32_t shapes, glyphs, commands;
} GpgpListCreateInfo;
#define GPGP_LIST_CREATE_INFO_INIT GPGP_INIT(GpgpListCreateInfo, GPGP_STRUCTURE_LIST_CREATE_INFO)

/** Makes an empty list.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, OUT_OF_HOST_MEMORY. @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateList(GpgpContext context, const GpgpListCreateInfo* info, GpgpList* list);

/** Destroys a list. Recordings that already show it are not affected. NULL is ignored. @threads context */
GPGP_API void GPGP_CALL gpgpDestroyList(GpgpList list);

/** Empties the list and its state stack. Must not run at the same time as a recording or hit test that shows the list.
 *  @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpResetList(GpgpList list);

/** Maximum nesting depth of the state stack: transforms, clips, opacities, groups, layers and masks together. At most
 *  GPGP_MAX_CLIP_DEPTH of them may be clips, and at most GPGP_MAX_OPACITY_DEPTH groups, counting the groups of
 *  drawings that are added inside. The number of states one after another is limited only by GpgpCanvasCreateInfo's
 *  budgets. */
enum { GPGP_MAX_LIST_DEPTH = 64 };

/** Pushes a transform: everything added until the matching gpgpPopState lies in a new space, which the transform maps
 *  to the current space. x' = t0 x + t2 y + t4, y' = t1 x + t3 y + t5. If perspective (3 numbers) is not NULL, both
 *  are divided by w = p0 x + p1 y + p2, as in GpgpCanvasItem.
 *
 *  Translations and uniform scales are free: they are applied to whatever is added, which must then lie within +-1e7
 *  too. Any other change of transform counts against maxDrawings.
 *  Errors: INVALID_ARGUMENT (a number is not finite; nested too deep). @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpPushTransform(GpgpList list, const float* transform, const float* perspective);

/** Pushes a clip: everything added until the matching gpgpPopState shows only inside the box, and inside the clips
 *  around it. box is left, top, right, bottom in the current space, within +-1e7. It must also lie within +-1e7 after
 *  the translations and uniform scales that were pushed around it. radii rounds the corners as GpgpListShape::radii
 *  do; NULL: no rounding.
 *
 *  A clip is a scissor if its corners are not rounded and the box is parallel to the canvas: the transforms only move,
 *  scale, mirror or rotate by quarter turns. A scissor costs next to nothing. Any other clip is a path: it counts as a
 *  shape (maxShapes, maxPaths), and pixels on its edge cost more. Both kinds have smooth edges, sample by sample, like
 *  the edges of a path.
 *  Errors: INVALID_ARGUMENT (not a number, beyond 1e7, right below left; nested too deep).
 *  @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpPushClip(GpgpList list, const float* box, const float* radii);

/** Pushes an opacity, which multiplies the alpha of each thing added until the matching gpgpPopState. It applies to
 *  each thing separately, and to each path of a drawing separately, so lower things show through where they overlap.
 *  Errors: INVALID_ARGUMENT (not 0 to 1; nested too deep). @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpPushOpacity(GpgpList list, float opacity);

/** Pushes a group: everything added until the matching gpgpPopState fades as a whole. Where its parts overlap, the
 *  lower ones do not show through. The group's opacity is multiplied by the opacities pushed around it, and by the
 *  item's.
 *
 *  A group counts against maxDrawings. If it is neither opaque nor fully transparent, the pixels it covers cost more.
 *  Errors: INVALID_ARGUMENT (not 0 to 1; nested too deep). @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpPushGroup(GpgpList list, float opacity);

/** How a layer is composited. A zeroed layer shows nothing: set opacity to 1. */
typedef struct GpgpListLayer {
  GpgpBlendMode blend;          /**< with what lies behind, inside the layer around it */
  float opacity;                /**< 0 to 1 */
  const GpgpFilterStep* filter; /**< NULL: none. As GpgpLayer::filter (layers.h); filter space is the current space. */
  uint32_t filterCount;         /**< at most GPGP_MAX_FILTER_STEPS; 0 while `filter` is not NULL: nothing shows */
  /** VK_FALSE: the filter is applied to the layer's picture. VK_TRUE: it is applied to the backdrop, which is
   *  everything painted earlier in the enclosing layer. The result is painted over the backdrop with the clips, mask
   *  and opacity of the layer, and the layer's picture on top. The backdrop does not include the canvas's background or
   *  what the engine draws behind the canvas. */
  VkBool32 backdrop;
  /** Left, top, right, bottom in the current space. Nothing of the layer shows outside the bounding box of this
   *  rectangle on the canvas. All 0: no bounds. Bounds save work where the clips around the layer are larger. */
  float bounds[4];
  uint32_t mask; /**< the number that gpgpPushMask returned; 0: none */
  GpgpMaskKind maskKind;
  GpgpImageEncoding maskEncoding; /**< which colours luminance is computed from */
  VkBool32 maskInverted;          /**< VK_TRUE: 1 - the mask's alpha multiplies the layer; for GPGP_MASK_ALPHA */
} GpgpListLayer;

/** Pushes a layer: everything added until the matching gpgpPopState is rendered into a picture of its own. The picture
 *  is filtered, clipped, masked, multiplied by the opacity and blended with what lies behind, in this order. The clips
 *  pushed around a layer cut its result, not the input of its filter. Clips, groups and layers may be pushed inside.
 *
 *  The canvas must be made with room for layers (GpgpCanvasCreateInfo::maxLayerPixels). A layer needs pictures as large
 *  as its visible part. Each layer, each clip around a layer, and each run of entries between layers counts against
 *  maxDrawings. For budgets, a list with layers is one unit: if it does not fit, the whole list and everything painted
 *  after it are left out.
 *
 *  Not supported: layers inside groups, which fade as a whole themselves; GPGP_FILTER_COMPONENT_TRANSFER,
 *  CONVOLVE_MATRIX, TURBULENCE and GROUP; filters and masks in perspective (the recording fails).
 *  Errors: INVALID_ARGUMENT (the message says what), UNSUPPORTED (see above), OUT_OF_HOST_MEMORY.
 *  @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpPushLayer(GpgpList list, const GpgpListLayer* layer);

/** Pushes a mask: everything added until the matching gpgpPopState is painted only as a mask of the layers that name
 *  it. The mask is in the space that is current now, and ignores the clips, opacities and groups around it. mask
 *  receives its number for GpgpListLayer::mask. Any number of layers that are pushed after the mask was popped can use
 *  the number, until the list is reset.
 *  Errors: INVALID_ARGUMENT (nested too deep), OUT_OF_HOST_MEMORY. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpPushMask(GpgpList list, uint32_t* mask);

/** Ends the state that the last unmatched gpgpPush... began. Every push must be popped before the list is shown.
 *  Errors: INVALID_ARGUMENT (nothing is pushed). @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpPopState(GpgpList list);

/** ID of entries that hit tests ignore, such as decoration on top of a button. Drawings with this ID need not be
 *  hitTestable. */
#define GPGP_ID_NOT_HIT UINT64_MAX

typedef int32_t GpgpListShapeKind;
enum {
  GPGP_LIST_RECTANGLE = 0,
  GPGP_LIST_ELLIPSE = 1, /**< fills the box */
  GPGP_LIST_LINE = 2
};

/** How an image fills the space between its borders, along one axis. */
typedef int32_t GpgpListTile;
enum {
  GPGP_TILE_STRETCH = 0, /**< once, stretched */
  GPGP_TILE_REPEAT = 1,  /**< repeated from left or top; the last repetition is cut off */
  GPGP_TILE_ROUND = 2    /**< repeated a whole number of times, at least once, and scaled to fit */
};

/** Which part of an image a shape shows, and how. With borders the image is a nine-slice. Without borders the source
 *  is stretched over the box, or repeated as a pattern (tiles). */
typedef struct GpgpListImage {
  /** Index into GpgpCanvasInfo::images, counted from the item's firstImage; below GPGP_MAX_IMAGES. */
  uint32_t image;
  float source[4]; /**< left, top, right, bottom in texture coordinates (0 to 1 across the image), within +-1e6 */
  /** Widths of the source's left, top, right and bottom borders, in texture coordinates. Opposite borders must fit
   *  into the source together. */
  float sourceBorders[4];
  /** Widths of the box's left, top, right and bottom borders. If two opposite borders do not fit, both shrink. Corners
   *  keep this size, sides stretch or repeat along their edge, and the middle does so along both axes. */
  float borders[4];
  GpgpListTile tiles[2]; /**< how the space between the borders is filled, across and down */
  /** Length of one repetition, across and down, in units of the box. 0: scaled as the borders are, which then must not
   *  be 0. Ignored where the image is stretched. */
  float tileSize[2];
} GpgpListImage;

/** A rectangle, ellipse or line. Coordinates, radii and width lie within +-1e7, in the current space and after the
 *  translations and uniform scales that are pushed. */
typedef struct GpgpListShape {
  GpgpListShapeKind kind;
  float box[4]; /**< left, top, right, bottom; for a line: x, y of its start, then x, y of its end */
  /** Rectangles only: radii of the top left, top right, bottom right and bottom left corner. If two radii do not fit
   *  on a side, all four shrink by the same factor. */
  float radii[4];
  /** Lines: the line's width, above 0. Rectangles and ellipses: 0 fills the shape; otherwise only a border of this
   *  width inside the edge is painted. A border that leaves no inside fills the shape. */
  float width;
  GpgpCap cap;                  /**< lines only: both ends */
  float color[4];               /**< linear RGB, 0 to 10000; straight alpha, 0 to 1; multiplies image and gradient */
  const GpgpGradient* gradient; /**< NULL: none */
  const GpgpListImage* image;   /**< NULL: none; not for lines, and not together with a gradient */
  uint64_t id;                  /**< chosen by the engine, returned by gpgpHitTest; or GPGP_ID_NOT_HIT */
} GpgpListShape;

/** Paints shapes on top of what is in the list. A filled shape with a border is two shapes.
 *  Errors: INVALID_ARGUMENT (the message names the shape), UNSUPPORTED (2^32 shapes), OUT_OF_HOST_MEMORY. After an
 *  error no shape has been added. @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpAddShapes(GpgpList list, const GpgpListShape* shapes, uint32_t count);

/** A corner of triangles. */
typedef struct GpgpListVertex {
  float x, y;       /**< in the current space, within +-1e7 there and after the translations and scales pushed */
  uint8_t color[4]; /**< red, green, blue, alpha */
  float u, v;       /**< texture coordinates, within +-1e6; 0 to 1 across the image. Ignored without an image. */
} GpgpListVertex;

/** No image. */
#define GPGP_IMAGE_NONE UINT32_MAX

/** Triangles as UI toolkits make them: in painting order, each on top of those before it, with colours and texture
 *  coordinates that change linearly between the corners. Corners may run either way round. */
typedef struct GpgpListTriangles {
  const GpgpListVertex* vertices;
  uint32_t vertexCount;
  /** Three for each triangle, below vertexCount: uint16_t or uint32_t. NULL: each three vertices are a triangle, and
   *  indexCount and indexType are ignored. */
  const void* indices;
  uint32_t indexCount;
  VkIndexType indexType;      /**< VK_INDEX_TYPE_UINT16 or VK_INDEX_TYPE_UINT32 */
  GpgpImageEncoding encoding; /**< of the vertices' colours */
  VkBool32 premultiplied;     /**< VK_TRUE: colours are multiplied by alpha, as they are encoded */
  /** Index into GpgpCanvasInfo::images, counted from the item's firstImage, below GPGP_MAX_IMAGES: colours multiply the
   *  image. Or GPGP_IMAGE_NONE. */
  uint32_t image;
  uint64_t id; /**< chosen by the engine, returned by gpgpHitTest; or GPGP_ID_NOT_HIT */
} GpgpListTriangles;

/** Paints triangles on top of what is in the list. Each counts as a shape (maxShapes, maxPaths); triangles without
 *  area, or with only transparent corners, are left out. They are one entry for hit tests.
 *
 *  Where triangles share two corners, each sample of a pixel lies in one of them, under every transform: there are no
 *  seams, and nothing is painted twice. Edges are as smooth as GpgpCanvasInfo::samples makes them; exactArea does not
 *  apply to them. With 1 sample, a pixel is painted if its centre is inside. Colours are interpolated in the encoding
 *  in which the canvas mixes them (blendSrgb), premultiplied or straight as they are given, and perspective-correctly.
 *  Errors: INVALID_ARGUMENT (the message names vertex or index), UNSUPPORTED (2^32 triangles), OUT_OF_HOST_MEMORY.
 *  After an error nothing has been added. @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpAddTriangles(GpgpList list, const GpgpListTriangles* triangles);

/** Paints glyphs on top of what is in the list, in the current space. The list does not keep the glyph set alive: it
 *  must exist whenever a recording or hit test shows the list.
 *  Errors: INVALID_ARGUMENT, INVALID_HANDLE, OUT_OF_HOST_MEMORY. @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpAddText(GpgpList list, GpgpAsset glyphSet, const GpgpGlyphInstance* glyphs,
                                          uint32_t count, uint64_t id);

/** Paints a drawing on top of what is in the list. firstImage is added to the item's. The list does not keep the
 *  drawing alive: it must exist whenever a recording or hit test shows the list.
 *  Errors: INVALID_ARGUMENT, INVALID_HANDLE, OUT_OF_HOST_MEMORY. @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpAddDrawing(GpgpList list, GpgpAsset drawing, uint32_t firstImage, uint64_t id);

/* ---------------------------------------------------------------- panels in the world */

/** A plane in the world that a drawing, text or list lies on. */
typedef struct GpgpPanel {
  float corner[3]; /**< where the panel's (0, 0) lies, world space */
  float across[3]; /**< from (0, 0) to (1, 0), world space: direction and length of one unit along x */
  float down[3];   /**< from (0, 0) to (0, 1), world space: direction and length of one unit along y */
} GpgpPanel;

/** Computes how a camera sees a panel. Writes transform, perspective and scissor of the item, so that the item shows
 *  inside the viewport. viewport is x, y, width, height in canvas pixels: the part of the canvas that belongs to this
 *  camera. viewProjection maps world space to clip space and is column-major; any depth range will do.
 *
 *  If clip is not NULL, it receives a matrix for GpgpCanvasDrawInfo::clip or secondClip. The matrix maps the viewport
 *  to the whole target and gives each pixel the panel's depth there. A depth test then hides the parts of the panel
 *  that lie behind the scene.
 *  Errors: INVALID_ARGUMENT (NULL, an empty viewport, or a number, given or computed, that is not finite).
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpPlacePanel(const GpgpPanel* panel, const float* viewProjection,
                                             const uint32_t* viewport, GpgpCanvasItem* item, float* clip);

/* ---------------------------------------------------------------- hit test */

typedef struct GpgpHitTestInfo {
  GpgpStructureType sType;
  const void* pNext;
  const GpgpCanvasItem* items; /**< the items of a recording, the first at the bottom */
  uint32_t itemCount;
  float x, y; /**< the point in canvas pixels; the centre of the first pixel is (0.5, 0.5) */
} GpgpHitTestInfo;
#define GPGP_HIT_TEST_INFO_INIT GPGP_INIT(GpgpHitTestInfo, GPGP_STRUCTURE_HIT_TEST_INFO)

#define GPGP_HIT_NONE UINT32_MAX

/** What lies under a point. */
typedef struct GpgpHit {
  uint32_t item;  /**< index of the item; GPGP_HIT_NONE: nothing was hit, and all other fields are 0 */
  uint32_t entry; /**< lists: index among the shapes, triangles (of one call), texts and drawings added; otherwise 0 */
  uint32_t glyph; /**< texts: index of the glyph instance; otherwise 0 */
  uint32_t path;  /**< drawings and glyphs: index of the path; triangles: of the triangle; otherwise 0 */
  uint64_t id;    /**< lists: the entry's ID; otherwise 0 */
  float x, y;     /**< the point in drawing or text space, or in the space where the list's entry was added */
} GpgpHit;

/** Finds the topmost path or shape whose inside contains the point. The transforms, clips and scissors of items and
 *  lists apply. Colour, gradient, opacity and image contents do not count: something painted with alpha 0 is hit as
 *  well. Drawings and glyphs are tested against their exact curves, not against flattened segments or samples.
 *  Errors: INVALID_ARGUMENT (a drawing that is neither hitTestable nor editable, a glyph that was evicted, a list with
 *  pushes that are not popped), INVALID_HANDLE. Must not run at the same time as gpgpAddGlyphs on a set that is shown,
 *  or as changes to a list that is shown. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpHitTest(GpgpContext context, const GpgpHitTestInfo* info, GpgpHit* hit);

#ifdef __cplusplus
}
#endif
#endif
