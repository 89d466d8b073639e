// What lies in the vector service's buffers, and what its shaders and their CPU twin agree on.
//
// All members are 4-byte scalars or 16-byte vectors at multiples of 16, so std430 and C++ lay them out alike.
#ifndef GPGP_SHADERS_VECTOR_LAYOUT_H
#define GPGP_SHADERS_VECTOR_LAYOUT_H
#include "../core/shared.h"

GPGP_SHADER_BEGIN

// A curve of a drawing: a cubic that never turns in x or y, from its top point down (lines and quadratics elevated).
// Control points are relative to the start, which keeps their low bits.
struct CurveRecord {
  vec4 ends;     // start x, y; end - start
  vec4 controls; // first control - start, second control - start
  float bend;    // how far the cubic is from a parabola at most (drawing units); negative: a straight line
  uint pad0, pad1, pad2;
};

// A CPatch: what lies between top and bottom (half-open), right of the left curve and left of the right one.
// Its four bounding curves are two entries of the curve table and two horizontal lines.
struct PatchRecord {
  uint left, right;  // curves
  float top, bottom; // y of the lines
  float x0, x1;      // the box's other sides
  uint path;         // in the drawing (as baked), in the record (after gathering)
  uint item;         // 0 as baked; the canvas item after gathering
};

struct PathRecord {
  vec4 color; // linear RGB, straight alpha as baked; premultiplied, times the item's opacity, after gathering
};

// A drawing placed on the canvas.
struct ItemRecord {
  vec4 inverse;   // pixel to drawing: x = inverse.x px + inverse.z py + offsets.x, y = inverse.y px + inverse.w py +
                  // offsets.y
  vec4 transform; // drawing to pixel, the same way with offsets.z, offsets.w
  vec4 offsets;
  float tolerance; // how far a curve may be off, drawing units
  float opacity;
  uint slot;       // the drawing's binding
  uint firstPatch; // of the item's patches in the record; they end where the next item's begin
  uint firstPath;  // of the item's paths in the record
  uint pad0, pad1, pad2;
};

// A drawing that a record uses: where its curves lie in the record, and where its tables begin, in 32-bit words.
struct SlotRecord {
  uint firstCurve, curveEnd; // in the record
  uint patchWords, pathWords;
};

struct CanvasHeader {
  uint width, height, tilesX, tilesY;
  uint coarseX, coarseCount, groupWords, groupCount;
  uint patchCount, curveCount, pathCount, itemCount;
  uint entryLimit, samples, flags, pathsDropped; // flags: kWrite...
  vec4 background;
};

// Counters of a record, its report, and the arguments of the passes that only run when the entries did not fit.
struct CanvasCounters {
  uint needed, given, cutPath, pathsDropped; // paths from cutPath on are left out
  uint patches, pad0, pad1, pad2;
  uint recountX, recountY, recountZ, pad3; // workgroups
};

GPGP_CONST uint kMaxSlots = 8u;
GPGP_CONST uint kWriteView = 1u;
GPGP_CONST uint kEncodeSrgb = 2u;
GPGP_CONST uint kTileSize = 16u;       // pixels: what one raster workgroup owns
GPGP_CONST uint kCoarseSize = 128u;    // pixels: the upper level of the hierarchy
GPGP_CONST uint kPatchGroup = 64u;     // patches that share a box at the upper level
GPGP_CONST uint kTestLeft = 1u << 30;  // tile entries: the left curve passes through the tile
GPGP_CONST uint kTestRight = 1u << 31; // the right one
GPGP_CONST uint kTestRows = 1u << 29;  // top or bottom does
GPGP_CONST uint kEntryPatch = (1u << 29) - 1u;

GPGP_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(gpgp::shader::CurveRecord) == 48 && sizeof(gpgp::shader::PatchRecord) == 32);
static_assert(sizeof(gpgp::shader::PathRecord) == 16 && sizeof(gpgp::shader::ItemRecord) == 80 &&
              sizeof(gpgp::shader::CanvasHeader) == 80 && sizeof(gpgp::shader::CanvasCounters) == 48);
#endif
#endif
