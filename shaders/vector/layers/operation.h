// One operation on pictures: what the host writes for each, and what the layers' shaders and their CPU reference agree
// on.
//
// A picture is a box of the canvas's pixels: half floats, premultiplied. Outside of its box it is transparent. Colours
// are encoded as the canvas mixes them, or as the filter's step works on them; who reads a picture says which.
#ifndef GPGP_SHADERS_VECTOR_OPERATION_H
#define GPGP_SHADERS_VECTOR_OPERATION_H
#include "vector/shared/layout.h"

#ifdef __cplusplus
namespace gpgp::shader { // for operate.h
using std::exp;
using std::sqrt;
} // namespace gpgp::shader
#endif

GPGP_SHADER_BEGIN

// Bindings, behind those of layout.h.
GPGP_CONST int kBindPictures = 30;
GPGP_CONST int kBindOperations = 31;
GPGP_CONST int kBindLayeredHistory = 32; // as the raster's history is the pictures then

struct PictureRecord {
  uint first, stride; // in pixels of the buffer: of the box's first one, from row to row
  int left, top;
  int right, bottom;
  uint pad0, pad1;
};

struct OperationRecord {
  PictureRecord result, a, b, c;
  uint kind; // kOperation...
  uint mode; // by kind
  uint flags;
  uint count; // of turns, by kind
  vec4 values[6];
  vec4 region;  // left, top, right, bottom in operation space: the result is transparent outside
  vec4 toPixel; // operation space to pixels: x = toPixel.x u + toPixel.z v + offsets.x
  vec4 toSpace; // and back, the same way with offsets.z, offsets.w
  vec4 offsets;
};

// Kinds, by the shader that executes them.
GPGP_CONST uint kOperationComposite = 0u; // a, times b's alpha, times the mask c, onto the result; values[0]: opacity
GPGP_CONST uint kOperationBlur = 1u;      // along values[0].xy, standard deviation values[0].z
GPGP_CONST uint kOperationShrink = 2u;    // values[0].xy: pixels of a that become one
GPGP_CONST uint kOperationGrow = 3u;      // the other way round
GPGP_CONST uint kOperationFlood = 4u;
GPGP_CONST uint kOperationCopy = 5u;
GPGP_CONST uint kOperationOffset = 6u; // values[0].xy: pixels
GPGP_CONST uint kOperationShadow = 7u; // a over values[1] where b lies, moved by values[0].xy
GPGP_CONST uint kOperationColorMatrix = 8u;
GPGP_CONST uint kOperationTransfer = 9u; // values[0]: slot of the table, its vec4
GPGP_CONST uint kOperationBlend = 10u;
GPGP_CONST uint kOperationOperator = 11u;
GPGP_CONST uint kOperationMorphology = 12u; // mode: 0 least, 1 most; along y with kAxisY
// values[0]: order, target; values[1]: divisor, bias, 1: alpha stays; values[2]: a's region; values[3]: slot of the
// table, its vec4; values[4].xy: the elements' distance; mode: edges
GPGP_CONST uint kOperationConvolve = 13u;
GPGP_CONST uint kOperationDisplace = 14u; // values[0].x: scale; mode: channels of b
GPGP_CONST uint kOperationTile = 15u;     // values[2]: a's region
// values[0]: frequency x, y, octaves, 1: stitched; values[1]: width and height of a stitch, where it wraps; values[2]:
// slot of the lattice, its vec4; mode: 0 fractal noise, 1 turbulence
GPGP_CONST uint kOperationTurbulence = 16u;
// values[0]: surface scale, constant, exponent, 1: specular; values[1]: colour; values[2]: the light's place or
// direction and the spot's exponent; values[3]: where it points and the cosine of its cone; values[4].xy: the heights'
// distance; values[5]: a's region; mode: which light
GPGP_CONST uint kOperationLight = 17u;

// Flags.
GPGP_CONST uint kEncodeA = 1u, kDecodeA = 2u; // a is converted as it is read: to sRGB, from it
GPGP_CONST uint kEncodeB = 4u, kDecodeB = 8u;
GPGP_CONST uint kEncodeC = 16u, kDecodeC = 32u;
GPGP_CONST uint kHasB = 64u, kHasC = 128u;
GPGP_CONST uint kAlphaMask = 256u; // of c only the alpha counts
GPGP_CONST uint kHasRegion = 512u;
GPGP_CONST uint kAlphaOnly = 1024u; // of a only the alpha counts: it is black
GPGP_CONST uint kAxisY = 2048u;
GPGP_CONST uint kWorksSrgb = 4096u; // the step's encoding

GPGP_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(gpgp::shader::PictureRecord) == 32 && sizeof(gpgp::shader::OperationRecord) == 304);
#endif
#endif
