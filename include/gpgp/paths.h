/* gpgp/paths.h: the paths, paints and groups that drawings and glyphs are made of (vector.h). */
#ifndef GPGP_PATHS_H
#define GPGP_PATHS_H
#include <gpgp/layers.h>
#ifdef __cplusplus
extern "C" {
#endif

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
  GPGP_ARC_LARGE = 1, /**< Takes the longer of the two arcs. */
  GPGP_ARC_SWEEP = 2  /**< Takes the arc along which angles increase: clockwise, since y points down. */
};

/** Which winding numbers are inside a filled path. */
typedef int32_t GpgpFillRule;
enum { GPGP_FILL_NON_ZERO = 0, GPGP_FILL_EVEN_ODD = 1 };

typedef int32_t GpgpGradientKind;
enum {
  GPGP_GRADIENT_LINEAR = 0, /**< along the line from `start` to `end` */
  /** Between the circles (start, startRadius) and (end, endRadius), as in HTML's canvas. Centre and radius change
   *  linearly from one circle to the other, and on beyond both. Where several of these circles pass through a point,
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

/** A line along a path, with SVG's rules. Its outline is accurate to a twentieth of a pixel at all scales up to
 *  `scale`. */
typedef struct GpgpStroke {
  float width; /**< drawing units, not negative; 0: a hairline, one pixel wide at `scale` */
  GpgpCap cap;
  GpgpJoin join;
  /** Longest miter, in stroke widths; at least 1, or 0 for the default of 4. Longer miters become bevels. */
  float miterLimit;
  /** Lengths of dashes and gaps in turn, in drawing units. An odd number of lengths is repeated once, as in SVG. NULL:
   *  a solid line. A path of more than 65536 dashes is UNSUPPORTED. In an SVG such a path is drawn solid, with a
   *  message. */
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
  /** Maximum nesting depth of a list's groups (ui.h), and of groups of paths that have an opacity below 1 and are not
   *  layers. Deeper groups of paths become layers (layers.h). */
  GPGP_MAX_OPACITY_DEPTH = 4,
  GPGP_MAX_CLIP_DEPTH = 16 /**< Maximum nesting depth of groups with a clip. */
};

/** Paths that are clipped or faded together. The paths of a group with an opacity below 1 must be consecutive in the
 *  drawing. Paths of groups inside it count as its own; no other path may lie between them. */
typedef struct GpgpPathGroup {
  uint32_t parent; /**< 0: none; otherwise 1 + the index of an earlier group, which contains this one */
  /** 0 to 1. Applies to the group as a whole: where its paths overlap, the lower ones do not show through. */
  float opacity;
  /** The group shows only inside the union of these paths, which themselves paint nothing. NULL: no clip. */
  const GpgpPath* clip;
  uint32_t clipCount; /**< 0 while `clip` is not NULL: the group is hidden. */
  /** Blend mode, mask, filter (layers.h). NULL: none. The group is still a layer if it contains a layer and has a clip
   *  or an opacity below 1. The paths of a layer must be consecutive, as above. A layer without paths shows nothing. */
  const GpgpLayer* layer;
} GpgpPathGroup;

/** Flags: which representations of a drawing or glyph set are kept on the device. Each kind of recorder draws its own.
 */
typedef uint64_t GpgpDrawingMethods;
#define GPGP_DRAWING_FLATTENED ((GpgpDrawingMethods)1) /**< outlines, which canvases flatten and rasterise */
#define GPGP_DRAWING_IN_PASS ((GpgpDrawingMethods)2)   /**< CPatches in cells, for gpgpRecordDrawPatches */
/** CPatches for canvases whose method is GPGP_CANVAS_PATCHES. Only for drawings, not for glyph sets, and only together
 *  with GPGP_DRAWING_FLATTENED. They are computed when the drawing is created; baked files do not hold them. */
#define GPGP_DRAWING_PATCHES ((GpgpDrawingMethods)4)

#ifdef __cplusplus
}
#endif
#endif
