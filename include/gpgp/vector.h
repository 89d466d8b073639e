/* gpgp vector: paths, SVG and text, rasterised on the GPU from the flattened segments of their outlines.
 *
 *   drawing (asset)     Paths, converted to CPatches (disjoint regions between curves) and uploaded as the outlines of
 *                       these regions. Independent of resolution: each recording flattens curves to within 1/32 pixel.
 *   glyph set (asset)   Many small drawings under keys that the engine chooses. Glyphs can be added at any time.
 *   canvas (recorder)   Rasterises drawings, text and lists. Its budgets set its size.
 *   canvas history      Keeps one rasterised canvas, which can be drawn inside the engine's render pass.
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
#include <gpgp/paths.h>
#include <gpgp/svg.h>
#ifdef __cplusplus
extern "C" {
#endif

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
   *  paths are converted. The result equals one made from all paths. The base stays as it is and may be destroyed. */
  GpgpAsset base;
  const GpgpPathEdit* edits; /**< only with base; of two edits with the same index the later one wins */
  uint32_t editCount;
  /** VK_TRUE: the drawing can be a base. Keeps its tables in host memory, about twice its size on the device. */
  VkBool32 editable;
  /** VK_TRUE: gpgpHitTest can find the drawing's paths. Keeps its outlines in host memory, about its size on the
   *  device. Editable drawings can be hit-tested too, at no further cost. */
  VkBool32 hitTestable;
  /** 0: what the baked data holds; GPGP_DRAWING_FLATTENED for paths and edits. Canvases, lists and hit tests need
   *  GPGP_DRAWING_FLATTENED. Other representations take no memory.
   *
   *  Patches cannot draw clips, images, or groups that have an opacity below 1 and hold more than one path. Each path
   *  that needs one of these is left out of the patches, and a warning names it (code UNSUPPORTED).
   *  GpgpDrawingInfo::pathsLeftOut counts these paths. */
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
 *  crosses itself more than 2^22 times, or all paths together more than 2^23 times). @threads any @lifetime call */
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

/* ---------------------------------------------------------------- glyphs */

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
   *  text's alpha. VK_FALSE: the path keeps its own RGB; its alpha is multiplied all the same. NULL: VK_TRUE for all.
   */
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
  GpgpDrawingMethods methods; /**< 0: GPGP_DRAWING_FLATTENED */
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
 *  stays at least until the current frame is safe. Indices stay valid while GpgpGlyphSetInfo::evicted does not change.
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

/** How a canvas decides which samples the paths of a drawing cover. */
typedef int32_t GpgpCanvasMethod;
enum {
  /** Outlines are flattened to lines within 1/32 of a pixel. */
  GPGP_CANVAS_FLATTENED = 0,
  /** Drawings made with GPGP_DRAWING_PATCHES are rasterised from their CPatches: the implicit form of each curve
   *  decides every sample, without flattening. Other drawings, text and shapes are flattened, in the same painting
   *  order. With GpgpCanvasInfo::exactArea, the area in a pixel is measured with 256 samples. */
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
   *  takes 48 bytes, 8 more on hardware devices, and one bit for each 128 x 128 pixels of the canvas. */
  uint32_t maxPaths;
  /** Tiles of 8 x 8 pixels that a path's edges pass through, summed over all paths, at most 2^28; 0: 131072. Each pair
   *  of a path and such a tile is an entry. It takes 480 bytes, 224 of them for lists; on software devices 384. */
  uint32_t maxTileEntries;
  /** Words of tile flags, at most 2^28; 0: maxTileEntries, or 65536 if that is more. A word covers 32 tiles of one row
   *  of tiles. A path that meets the canvas takes, for each row of its box, the box's width in tiles divided by 32,
   *  rounded up. A word takes 16 bytes, on software devices 32. */
  uint32_t maxTileWords;
  /** Items of all kinds in one recording, not only drawings; at most 65536; 0: 64. A list (ui.h) counts each of its
   *  drawings and clips, and each change of transform, clip or group. A drawing with layers counts each layer, each
   *  clip of a layer, and each run of paths between them. The same number limits the groups, and the different drawings
   *  and glyph sets, of which there may be at most 2047 in any case.
   *
   *  Assets share device buffers of at most VkPhysicalDeviceLimits::maxStorageBufferRange, and a recording binds at
   *  most 8 of them. Needing a ninth is an error. This can only happen with assets above 1 MiB, or with assets above 64
   *  KiB that lie among some 100 MiB of others. A drawing whose outlines exceed one buffer lies in up
   *  to 5. A recording can place 64 such buffers of outlines, counted each time that they are shown. */
  uint32_t maxDrawings;
  /** Glyphs of all texts in one recording, blanks not counted, at most 1048576; 0: 1024. 160 bytes each, and 48 more
   *  for every recording that can be in flight. */
  uint32_t maxGlyphs;
  /** Shapes of all lists (ui.h) in one recording, clips that are not scissors included, at most 1048576; 0: 1024.
   *  Their gradients may have twice as many stops in all; a nine-slice or tiled image counts as 2 stops. 352 bytes
   *  each, and 240 more for every recording that can be in flight. */
  uint32_t maxShapes;
  /** What recordings will write; 0: anything. Pipelines are made only for these: half as many for a single target. */
  GpgpCanvasTargets targets;
  /** Pixels of the intermediate pictures that layers (layers.h) need in one recording, at most 2^28; 0: none. A
   *  recording with layers needs the whole canvas, the part of it that each layer, mask and clip of a layer covers, and
   *  the intermediate results of the largest filter. Paths that lie behind a layer need a picture as well. A pixel
   *  takes 8 bytes. The first layered drawing that does not fit and everything painted after it are left out. If
   *  the results of all filters fit at once, operations on separate parts of the canvas run side by side. */
  uint32_t maxLayerPixels;
  /** Operations on these pictures in one recording, at most 65536; 0: 1024. A layer takes one, a step of a filter one
   *  to five. Each takes 304 bytes for every recording that can be in flight. */
  uint32_t maxLayerOperations;
  GpgpCanvasMethod method; /**< 0: GPGP_CANVAS_FLATTENED */
  /** GPGP_CANVAS_PATCHES: pairs of a CPatch and a tile that its curves pass through, at most 2^28; 0: twice
   *  maxTileEntries. Each takes 16 bytes. If there are too few, the first drawing that is drawn by patches and
   *  everything painted after it are left out. */
  uint32_t maxTilePatches;
  /** Images in one recording, at most GPGP_MAX_IMAGES; 0: 8. Rounded up to a multiple of 8. */
  uint32_t maxImages;
  /** Pixels that paths with images cover in recordings of more than 8 images, at most 2^28; 0: maxWidth x maxHeight.
   *  Such recordings sample images before they rasterise, 8 images at a time, and store the colours. A path needs all
   *  tiles of 8 x 8 pixels that its bounding box meets on the canvas. A pixel takes 8.25 bytes, but none if maxImages
   * is at most 8. Paths that do not fit are left out, and the report's status is BUDGET_EXCEEDED. */
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

/** Maximum number of images in one recording. A canvas can have a lower limit (GpgpCanvasCreateInfo::maxImages). */
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
  /** VK_TRUE: in each pixel, the front-most path with an edge there is weighted by the exact area that it covers, not
   *  by its samples. Edges have finer steps where only one passes through a pixel. Adjacent paths show no seam. Where
   *  one shape lies on an equal one, up to a tenth of the lower one's colour shows at the edge. */
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
 *  differently. The comparison is between a target and an attachment of the same format that was cleared to 0 before
 *  the canvas was drawn. In R16G16B16A16_SFLOAT they differ by at most one unit in the last place of a half, in
 *  R8G8B8A8_UNORM by at most 1/255, also where both have encodeSrgb. An sRGB attachment encodes premultiplied colour,
 *  so it is within 1/255 of a target with encodeSrgb only where the canvas is opaque.
 *  NOT_READY: a drawing or glyph that is shown, or the history, is not resident, or the canvas is not prewarmed.
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
  /** VK_FALSE: the attachment receives premultiplied linear colour, as sRGB and float formats want it. VK_TRUE:
   *  straight colour encoded as sRGB and then multiplied by alpha, for UNORM formats that are shown as they are. */
  VkBool32 encodeSrgb;
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

/** Budgets of a patch recorder. It has no scratch memory. It takes 240 bytes for each item and 48 bytes for each glyph,
 *  for every recording that can be in flight. */
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
   *  model, view and projection of a panel in the world, for example. What lies behind the eye is cut off. */
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
 *  writes those samples that lie inside the path, so adjacent paths show no seam. The depth test, if the target has
 *  one, uses the depth of each item's plane. The engine sets viewport and scissor.
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
