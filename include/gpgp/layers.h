/* gpgp/layers.h: groups of paths with blend modes, masks and filters.
 *
 * A layer is a GpgpPathGroup (vector.h) with GpgpPathGroup::layer. Its paths and the groups inside it are rendered into
 * a picture of their own. This picture is filtered, clipped, masked, multiplied by the group's opacity and blended with
 * what lies behind, in this order.
 *
 * A canvas draws layers if it was created with room for them (GpgpCanvasCreateInfo::maxLayerPixels). Drawings with
 * layers cannot be used for glyphs, edits, hit tests and draws inside a render pass.
 */
#ifndef GPGP_LAYERS_H
#define GPGP_LAYERS_H
#include <gpgp/core.h>

/** How a layer's picture is blended with what lies behind it (W3C Compositing and Blending 1). Colours are mixed in the
 *  canvas's encoding (GpgpCanvasInfo::blendSrgb). All modes but NORMAL, MULTIPLY, DARKEN, LIGHTEN, DIFFERENCE and
 *  PLUS_LIGHTER clamp colours brighter than white to white. */
typedef int32_t GpgpBlendMode;
enum {
  GPGP_BLEND_NORMAL = 0,
  GPGP_BLEND_MULTIPLY = 1,
  GPGP_BLEND_SCREEN = 2,
  GPGP_BLEND_OVERLAY = 3,
  GPGP_BLEND_DARKEN = 4,
  GPGP_BLEND_LIGHTEN = 5,
  GPGP_BLEND_COLOR_DODGE = 6,
  GPGP_BLEND_COLOR_BURN = 7,
  GPGP_BLEND_HARD_LIGHT = 8,
  GPGP_BLEND_SOFT_LIGHT = 9,
  GPGP_BLEND_DIFFERENCE = 10,
  GPGP_BLEND_EXCLUSION = 11,
  GPGP_BLEND_HUE = 12,
  GPGP_BLEND_SATURATION = 13,
  GPGP_BLEND_COLOR = 14,
  GPGP_BLEND_LUMINOSITY = 15,
  GPGP_BLEND_PLUS_LIGHTER = 16
};

/** Which value of the mask's picture a layer is multiplied by. */
typedef int32_t GpgpMaskKind;
enum {
  GPGP_MASK_LUMINANCE = 0, /**< luminance times alpha */
  GPGP_MASK_ALPHA = 1      /**< alpha */
};

/** What a step of a filter does. Lengths, points and frequencies are in filter space. */
typedef int32_t GpgpFilterKind;
enum {
  GPGP_FILTER_FLOOD = 0,              /**< values: linear RGB, straight alpha */
  GPGP_FILTER_GAUSSIAN_BLUR = 1,      /**< values: standard deviation along x, y; at most 65536 */
  GPGP_FILTER_DROP_SHADOW = 2,        /**< values: standard deviation along x, y, offset x, y, linear RGB, alpha */
  GPGP_FILTER_OFFSET = 3,             /**< values: x, y */
  GPGP_FILTER_COLOR_MATRIX = 4,       /**< values: 4 rows of 5, on straight colour; results are clamped to 0 to 1 */
  GPGP_FILTER_COMPONENT_TRANSFER = 5, /**< table: 4 x 256 results (0 to 1) for R, G, B, A of 0/255 to 255/255, straight
                                           colour, linear in between */
  GPGP_FILTER_BLEND = 6,              /**< mode: GpgpBlendMode; `input` lies on `input2` */
  GPGP_FILTER_COMPOSITE = 7,          /**< mode: GpgpFilterOperator; values: k1 to k4; `input` lies on `input2` */
  GPGP_FILTER_MORPHOLOGY = 8,         /**< values: radius along x, y, rounded to pixels; mode: 0 erode, 1 dilate */
  /** values: order x, y (1 to 32 each), target x, y, divisor (not 0), bias, preserve alpha (0 or 1), distance of the
   *  kernel's elements along x, y in units of filter space (0: 1; below 0: mirrored); table: the kernel, order x times
   *  order y numbers as SVG lists them; mode: GpgpFilterEdge. The bias is added to alpha, and times alpha to colours,
   *  also where the input is transparent. */
  GPGP_FILTER_CONVOLVE_MATRIX = 9,
  GPGP_FILTER_DISPLACEMENT_MAP =
      10, /**< values: scale; mode: x channel + 4 y channel (0 R, 1 G, 2 B, 3 A) of `input2` */
  /** values: base frequency x, y, octaves (0 to 16), seed, stitch (0 or 1); mode: 0 fractal noise, 1 turbulence. Noise
   *  has no inputs; it is stitched at `region`. */
  GPGP_FILTER_TURBULENCE = 11,
  GPGP_FILTER_DIFFUSE_LIGHTING = 12,  /**< values: surface scale, diffuse constant, linear RGB, then the light; mode:
                                           GpgpFilterLight */
  GPGP_FILTER_SPECULAR_LIGHTING = 13, /**< values: surface scale, specular constant, linear RGB, exponent, then the
                                           light; mode likewise */
  GPGP_FILTER_TILE = 14,              /**< repeats what `input` has inside its own region over this region */
  /** the picture of a group that is painted only here; values: six, the group's drawing space to filter space */
  GPGP_FILTER_GROUP = 15
};

/** The kind of light. Its values: distant: azimuth, elevation (radians); point: x, y, z; spot: x, y, z, the point x, y,
 *  z that it is aimed at, exponent, cosine of the cone's half angle (-1: no cone). Values 14 and 15 are the distances
 *  along x and y over which the surface's slope is measured, in filter space (0: 1). The surface scale is in units of
 *  these distances. */
typedef int32_t GpgpFilterLight;
enum { GPGP_LIGHT_DISTANT = 0, GPGP_LIGHT_POINT = 1, GPGP_LIGHT_SPOT = 2 };

/** What a convolution reads outside the input's region. */
typedef int32_t GpgpFilterEdge;
enum { GPGP_EDGE_NONE = 0, GPGP_EDGE_DUPLICATE = 1, GPGP_EDGE_WRAP = 2 };

typedef int32_t GpgpFilterOperator;
enum {
  GPGP_OPERATOR_OVER = 0,
  GPGP_OPERATOR_IN = 1,
  GPGP_OPERATOR_OUT = 2,
  GPGP_OPERATOR_ATOP = 3,
  GPGP_OPERATOR_XOR = 4,
  GPGP_OPERATOR_LIGHTER = 5,
  GPGP_OPERATOR_ARITHMETIC = 6 /**< k1 input input2 + k2 input + k3 input2 + k4, premultiplied, clamped to 0 to 1 */
};

/** Inputs of a step: one of these, or GPGP_FILTER_FIRST_STEP + the index of an earlier step of the same filter. */
enum {
  GPGP_FILTER_SOURCE = 0,       /**< the layer's picture, cut to GpgpLayer::filterRegion */
  GPGP_FILTER_SOURCE_ALPHA = 1, /**< the same in black */
  GPGP_FILTER_TRANSPARENT = 2,
  GPGP_FILTER_FIRST_STEP = 3
};

enum {
  GPGP_MAX_LAYER_DEPTH = 32,  /**< Maximum nesting depth of layers, those of masks and filters included. */
  GPGP_MAX_FILTER_STEPS = 256 /**< Maximum number of steps of a filter. */
};

typedef struct GpgpFilterStep {
  GpgpFilterKind kind;
  int32_t mode;           /**< by kind; 0 otherwise */
  uint32_t input, input2; /**< 0 where the kind has none */
  int32_t encoding;       /**< GPGP_IMAGE_LINEAR or GPGP_IMAGE_SRGB: how colours are encoded while this step works */
  float region[4];        /**< left, top, right, bottom in filter space; the result is transparent outside */
  float values[20];
  const float* table; /**< by kind; NULL otherwise */
  uint32_t tableCount;
  uint32_t group; /**< GPGP_FILTER_GROUP: 1 + the index of a later group without a parent, painted only here */
} GpgpFilterStep;

/** What makes a group a layer. Order: filter, then clip, then mask, then opacity, then blend. Every layer is isolated:
 *  layers inside it blend only with what lies inside it. A drawing as a whole is isolated, too. */
typedef struct GpgpLayer {
  GpgpBlendMode blend;
  int32_t isolated; /**< 1: the group is a layer even where nothing else makes it one */
  /** 0: none; otherwise 1 + the index of a later group without a parent, whose paths are painted only as masks */
  uint32_t mask;
  GpgpMaskKind maskKind;
  int32_t maskEncoding;   /**< GPGP_IMAGE_LINEAR or _SRGB: what luminance is computed from; SVG's default is sRGB */
  float maskRegion[4];    /**< left, top, right, bottom in the space of `maskTransform`; nothing shows outside */
  float maskTransform[6]; /**< to drawing space */
  const GpgpFilterStep* filter; /**< NULL: none. The result of the last step is the group's picture. */
  uint32_t filterCount;         /**< 0 while `filter` is not NULL: nothing shows */
  float filterTransform[6];     /**< filter space to drawing space; it must have an inverse */
  float filterRegion[4];        /**< left, top, right, bottom in filter space: what the first two inputs are cut to */
} GpgpLayer;
#endif
