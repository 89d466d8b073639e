// What the host writes for a draw of patches: views (maps to clip space and back) and placements (what is shown by
// which of them). Quads are counted over all placements: all that a drawing has, or one for each path.
#ifndef GPGP_SHADERS_VECTOR_IN_PASS_RECORDING_H
#define GPGP_SHADERS_VECTOR_IN_PASS_RECORDING_H
#include "vector/shared/layout.h"

GPGP_SHADER_BEGIN

// Points are counted from an origin near to what is seen, so that nothing large cancels.
struct PatchView {
  vec4 column0, column1, column2;    // clip space of (1, 0), of (0, 1) and of the origin
  vec4 inverse0, inverse1, inverse2; // x, y, z: of clip x, y and w, the point times w', and w'; w of 0 and 1: origin
};

// A drawing, or a glyph of a text: its point (x, y) lies at place.xy + place.z (x, y) of the view.
struct PatchPlacement {
  vec4 place;
  vec4 color;   // of paths that take it; alpha multiplies
  uint drawing; // where its patches begin in the buffer
  uint firstQuad;
  uint view; // two for each item
  uint slot; // of its buffer; kPatchCoarse: its quads are one for each path
};

struct PatchHeader {
  uint placements, firstPlacement; // in vec4
  uint flags;                      // kPatchEncodeSrgb
  uint pad0;
  vec2 half_;  // of the viewport, in pixels
  vec2 middle; // of the viewport
};

GPGP_CONST uint kPatchEncodeSrgb = 1u;
GPGP_CONST uint kPatchCoarse = 16u;
GPGP_CONST uint kPatchViewSize = 6u; // vec4
GPGP_CONST uint kPatchBuffers = 8u;
GPGP_CONST int kBindPatchRecording = 8; // after the buffers

GPGP_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(gpgp::shader::PatchView) == 96 && sizeof(gpgp::shader::PatchPlacement) == 48 &&
              sizeof(gpgp::shader::PatchHeader) == 32);
#endif
#endif
