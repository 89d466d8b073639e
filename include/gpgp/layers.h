/* gpgp/layers.h: groups of paths that are composited by themselves: blend modes, masks, filters. A draft of the
 * interface between the importer and the canvas. */
#ifndef GPGP_LAYERS_H
#define GPGP_LAYERS_H
#include <gpgp/core.h>

/** How a group's picture is mixed with what lies behind it in its parent (W3C Compositing and Blending 1). */
typedef int32_t GpgpBlendMode;
enum {
  GPGP_BLEND_NORMAL = 0, GPGP_BLEND_MULTIPLY, GPGP_BLEND_SCREEN, GPGP_BLEND_OVERLAY, GPGP_BLEND_DARKEN,
  GPGP_BLEND_LIGHTEN, GPGP_BLEND_COLOR_DODGE, GPGP_BLEND_COLOR_BURN, GPGP_BLEND_HARD_LIGHT, GPGP_BLEND_SOFT_LIGHT,
  GPGP_BLEND_DIFFERENCE, GPGP_BLEND_EXCLUSION, GPGP_BLEND_HUE, GPGP_BLEND_SATURATION, GPGP_BLEND_COLOR,
  GPGP_BLEND_LUMINOSITY, GPGP_BLEND_PLUS_LIGHTER
};

typedef int32_t GpgpMaskKind;
enum { GPGP_MASK_LUMINANCE = 0, GPGP_MASK_ALPHA = 1 };

/** A step of a filter. The values by kind are given in filter space (GpgpLayer::filterTransform). */
typedef int32_t GpgpFilterKind;
enum {
  GPGP_FILTER_FLOOD = 0,          /**< values: linear RGB, straight alpha */
  GPGP_FILTER_GAUSSIAN_BLUR,      /**< values: standard deviation x, y; mode: GpgpFilterEdge */
  GPGP_FILTER_DROP_SHADOW,        /**< values: standard deviation x, y, offset x, y, linear RGB, alpha */
  GPGP_FILTER_OFFSET,             /**< values: x, y */
  GPGP_FILTER_COLOR_MATRIX,       /**< values: 20, row by row, on straight colour */
  GPGP_FILTER_COMPONENT_TRANSFER, /**< table: 4 x 256 results for inputs 0/255 to 255/255 (R, G, B, A), straight colour */
  GPGP_FILTER_BLEND,              /**< mode: GpgpBlendMode; `input` on top of `input2` */
  GPGP_FILTER_COMPOSITE,          /**< mode: GpgpFilterOperator; values: k1 to k4 */
  GPGP_FILTER_MORPHOLOGY,         /**< values: radius x, y; mode: 0 erode, 1 dilate */
  GPGP_FILTER_CONVOLVE_MATRIX,    /**< values: order x, y, target x, y, divisor, bias, preserve alpha (0, 1); table: the kernel; mode: GpgpFilterEdge */
  GPGP_FILTER_DISPLACEMENT_MAP,   /**< values: scale; mode: x channel + 4 y channel (0 R, 1 G, 2 B, 3 A); input2: the map */
  GPGP_FILTER_TURBULENCE,         /**< values: base frequency x, y, octaves, seed, stitch (0, 1); mode: 0 fractal noise, 1 turbulence */
  GPGP_FILTER_DIFFUSE_LIGHTING,   /**< values: surface scale, diffuse constant, linear RGB, then the light; mode: GpgpFilterLight */
  GPGP_FILTER_SPECULAR_LIGHTING,  /**< values: surface scale, specular constant, linear RGB, exponent, then the light; mode likewise */
  GPGP_FILTER_TILE,               /**< tiles what `input` has inside its region over this region */
  GPGP_FILTER_GROUP               /**< a group's picture, painted here alone; values: its transform, six */
};
/* The light: distant: azimuth, elevation (radians); point: x, y, z; spot: x, y, z, points at x, y, z, exponent, cosine of the
 * cone's half angle (-1: none). */
typedef int32_t GpgpFilterLight;
enum { GPGP_LIGHT_DISTANT = 0, GPGP_LIGHT_POINT, GPGP_LIGHT_SPOT };
typedef int32_t GpgpFilterEdge;
enum { GPGP_EDGE_NONE = 0, GPGP_EDGE_DUPLICATE, GPGP_EDGE_WRAP };
typedef int32_t GpgpFilterOperator;
enum { GPGP_OPERATOR_OVER = 0, GPGP_OPERATOR_IN, GPGP_OPERATOR_OUT, GPGP_OPERATOR_ATOP, GPGP_OPERATOR_XOR,
       GPGP_OPERATOR_LIGHTER, GPGP_OPERATOR_ARITHMETIC };

/** Inputs of a step: one of these, or GPGP_FILTER_FIRST_STEP + the index of an earlier step of the same filter. */
enum { GPGP_FILTER_SOURCE = 0, GPGP_FILTER_SOURCE_ALPHA = 1, GPGP_FILTER_TRANSPARENT = 2, GPGP_FILTER_FIRST_STEP = 3 };

typedef struct GpgpFilterStep {
  GpgpFilterKind kind;
  int32_t mode;          /**< by kind; 0 otherwise */
  uint32_t input, input2;
  int32_t encoding;      /**< GPGP_IMAGE_LINEAR or GPGP_IMAGE_SRGB: how colours are encoded while this step works on them */
  float region[4];       /**< left, top, right, bottom in filter space; the result is transparent outside */
  float values[20];
  const float* table;
  uint32_t tableCount;
  uint32_t group;        /**< GPGP_FILTER_GROUP: 1 + the index of a later group, whose paths show here alone */
} GpgpFilterStep;

/** What makes a group a layer. Order: filter, then clip, then mask, then opacity, then blend. */
typedef struct GpgpLayer {
  GpgpBlendMode blend;
  int32_t isolated;      /**< 1: groups inside blend with what lies inside alone, even where nothing else makes it a layer */
  uint32_t mask;         /**< 0: none; otherwise 1 + the index of a later group, whose paths show only as this mask */
  GpgpMaskKind maskKind;
  int32_t maskEncoding;  /**< GPGP_IMAGE_LINEAR or _SRGB: what luminance is computed from; SVG's default is sRGB */
  float maskRegion[4];   /**< left, top, right, bottom in the space of `maskTransform`; nothing shows outside */
  float maskTransform[6];
  const GpgpFilterStep* filter; /**< NULL: none. The result of the last step is the group's picture. */
  uint32_t filterCount;
  float filterTransform[6]; /**< filter space to drawing space */
} GpgpLayer;
#endif
