// What a draw of patches is made of: quads, and which part of a pixel each of them paints. GLSL and HLSL for engines
// that record the draw with shaders of their own; the library's in-pass draw and its tests compile the same text.
//
// A path has one quad for all of it. Where it has several cells, it also has a quad for each cell that its edge passes,
// and quads for rectangles of cells that lie inside as a whole. Empty cells have none. A draw shows either the first
// quad or the others: the others where cells are so large on the screen that this is less work (gpgpShowsCells).
//
// Quads are grown before they are drawn, so they overlap. Each pixel still has one owner: the quad with the cell in
// which the pixel's middle lies. Where that cell is empty, the first cell that the pixel meets and that is not empty
// owns it. So a path's coverage reaches each pixel once. A sample belongs to the quad with the sample's cell.
#ifndef GPGP_SHADERS_PATCH_QUADS_H
#define GPGP_SHADERS_PATCH_QUADS_H
#ifndef __cplusplus // C++ includes this inside a class, as it does patches.h
#include "gpgp/shaders/patches.h"
#endif

GPGP_PATCH_CONST uint kPatchQuadWhole = 1u;  // flag: the path's first quad
GPGP_PATCH_CONST uint kPatchQuadInside = 2u; // flag: all of its cells are inside
GPGP_PATCH_CONST uint kPatchQuadLeft = 4u;   // flags: an empty cell, or the end of the box, lies beyond this side
GPGP_PATCH_CONST uint kPatchQuadTop = 8u;    // or its corners
GPGP_PATCH_CONST uint kPatchQuadRight = 16u;
GPGP_PATCH_CONST uint kPatchQuadBottom = 32u;
GPGP_PATCH_CONST uint kPatchQuadFlags = 64u;  // more than all flags
GPGP_PATCH_CONST float kPatchGrown = 0.75f;   // pixels to an open side; half a pixel is what coverage reaches
GPGP_PATCH_CONST float kPatchOverlap = 0.25f; // pixels to other sides, against rounding

struct GpgpPatchQuad {
  uint path, flags;
  uint column0, row0, column1, row1; // cells, the last ones excluded
};

GPGP_FN GpgpPatchQuad gpgpUnpackQuad(uvec4 word) {
  GpgpPatchQuad quad;
  quad.path = word.x;
  quad.column0 = word.y & 0xffffu;
  quad.row0 = word.y >> 16u;
  quad.column1 = word.z & 0xffffu;
  quad.row1 = word.z >> 16u;
  quad.flags = word.w;
  return quad;
}
// The one quad of a path that is drawn without cells.
GPGP_FN GpgpPatchQuad gpgpWholeQuad(uint slot, GpgpPatchPath path, uint index) {
  GpgpPatchQuad quad;
  uint first = 0u;
  quad.path = index;
  quad.column0 = 0u;
  quad.row0 = 0u;
  quad.column1 = path.columns;
  quad.row1 = path.rows;
  quad.flags = kPatchQuadWhole | kPatchQuadLeft | kPatchQuadTop | kPatchQuadRight | kPatchQuadBottom;
  if (path.columns * path.rows == 1u && gpgpCellCount(slot, path, 0u, 0u, first) == kPatchSolid)
    quad.flags |= kPatchQuadInside;
  return quad;
}

// A quad's box, from the origin. Quads that are neighbours have equal sides.
GPGP_FN vec4 gpgpQuadBox(GpgpPatchPath path, GpgpPatchQuad quad, vec2 origin) {
  const float x = path.box.x - origin.x, y = path.box.y - origin.y;
  GPGP_PRECISE float left = x + float(quad.column0) * path.cell.x;
  GPGP_PRECISE float top = y + float(quad.row0) * path.cell.y;
  GPGP_PRECISE float right = x + float(quad.column1) * path.cell.x;
  GPGP_PRECISE float bottom = y + float(quad.row1) * path.cell.y;
  if (quad.column1 == path.columns) right = path.box.z - origin.x;
  if (quad.row1 == path.rows) bottom = path.box.w - origin.y;
  return vec4(left, top, right, bottom);
}

// Whether a path is drawn by cells, where a pixel's shape on the drawing spreads as far as that.
GPGP_FN bool gpgpShowsCells(GpgpPatchPath path, vec2 spread) {
  return path.smallest > 0.0f && path.cell.x >= path.smallest * spread.x && path.cell.y >= path.smallest * spread.y;
}

// How far a pixel's shape on the drawing reaches from its middle.
GPGP_FN vec2 gpgpPixelReach(vec2 dx, vec2 dy) {
  return vec2(0.5f * (abs(dx.x) + abs(dy.x)), 0.5f * (abs(dx.y) + abs(dy.y)));
}
// Whether a pixel lies in a quad's box as a whole. If the quad is inside, all of the pixel is covered.
GPGP_FN bool gpgpHoldsPixel(vec4 box, vec2 at, vec2 reach) {
  return at.x - reach.x >= box.x && at.y - reach.y >= box.y && at.x + reach.x <= box.z && at.y + reach.y <= box.w;
}
GPGP_FN bool gpgpQuadHas(GpgpPatchQuad quad, uint column, uint row) {
  return column >= quad.column0 && column < quad.column1 && row >= quad.row0 && row < quad.row1;
}

// Whether a quad owns a pixel.
GPGP_FN bool gpgpQuadOwns(uint slot, GpgpPatchPath path, GpgpPatchQuad quad, vec2 origin, vec2 at, vec2 reach) {
  const uint column = gpgpColumnAt(path, origin, at.x), row = gpgpRowAt(path, origin, at.y);
  if (gpgpQuadHas(quad, column, row)) return true;
  uint first = 0u;
  if (gpgpCellCount(slot, path, column, row, first) != 0u) return false;
  const uint column0 = gpgpColumnAt(path, origin, at.x - reach.x), row0 = gpgpRowAt(path, origin, at.y - reach.y);
  const uint column1 = min(gpgpColumnAt(path, origin, at.x + reach.x), column0 + kPatchFewCells);
  const uint row1 = min(gpgpRowAt(path, origin, at.y + reach.y), row0 + kPatchFewCells);
  for (uint r = row0; r <= row1; ++r)
    for (uint c = column0; c <= column1; ++c)
      if (gpgpCellCount(slot, path, c, r, first) != 0u) return gpgpQuadHas(quad, c, r);
  return false;
}

// Which part of a pixel a quad paints, 0 to 1.
GPGP_FN float gpgpQuadCoverage(uint slot, GpgpPatchPath path, GpgpPatchQuad quad, vec2 origin, vec2 at, vec2 dx,
                               vec2 dy) {
  const vec2 reach = gpgpPixelReach(dx, dy);
  if (!gpgpQuadOwns(slot, path, quad, origin, at, reach)) return 0.0f;
  if ((quad.flags & kPatchQuadInside) != 0u && gpgpHoldsPixel(gpgpQuadBox(path, quad, origin), at, reach)) return 1.0f;
  return gpgpPathCoverage(slot, path, origin, at, dx, dy);
}

// ---------------------------------------------------------------- samples

// Vulkan's standard sample locations, from the pixel's middle, in pixels. samples: 2, 4, 8 or 16.
GPGP_FN vec2 gpgpSampleAt(uint samples, uint index) {
  uint x = 0x4cu, y = 0x4cu; // a digit each, in sixteenths
  if (samples == 4u) {
    x = 0xa2e6u;
    y = 0xea62u;
  } else if (samples == 8u) {
    x = 0xfb135d79u;
    y = 0x1f7d39b5u;
  } else if (samples == 16u) {
    x = index < 8u ? 0xbda3c579u : 0x1ef02486u;
    y = index < 8u ? 0x3bd67a59u : 0x0f48c21eu;
  }
  const uint shift = 4u * (index & 7u);
  return vec2(float((x >> shift) & 15u) / 16.0f - 0.5f, float((y >> shift) & 15u) / 16.0f - 0.5f);
}
GPGP_FN vec2 gpgpSamplePoint(uint samples, uint index, vec2 at, vec2 dx, vec2 dy) {
  const vec2 s = gpgpSampleAt(samples, index);
  return vec2(at.x + (dx.x * s.x + dy.x * s.y), at.y + (dx.y * s.x + dy.y * s.y));
}
// Those samples of a mask that lie in rows, the last one excluded.
GPGP_FN uint gpgpSamplesInRows(uint samples, uint mask, vec2 at, vec2 dx, vec2 dy, float top, float bottom) {
  uint found = 0u;
  for (uint i = 0u; i < samples; ++i) {
    const float y = gpgpSamplePoint(samples, i, at, dx, dy).y;
    if (y >= top && y < bottom) found |= 1u << i;
  }
  return found & mask;
}

// Those samples of a mask that lie in the patches of a cell. What a curve decides for all of the pixel is decided once.
GPGP_FN uint gpgpCellMask(uint slot, GpgpPatchPath path, uint column, uint row, vec2 origin, vec2 at, vec2 dx, vec2 dy,
                          uint samples, uint mask) {
  uint place = 0u;
  const uint count = gpgpCellCount(slot, path, column, row, place);
  if (count == kPatchSolid) return mask;
  const vec2 reach = gpgpPixelReach(dx, dy);
  const vec2 low = vec2(at.x - reach.x, at.y - reach.y), high = vec2(at.x + reach.x, at.y + reach.y);
  uint found = 0u;
  for (uint i = 0u; i < count && found != mask; ++i) {
    const uvec4 head = GPGP_PATCH_LOAD(slot, place);
    const float top = uintBitsToFloat(head.x) - origin.y, bottom = uintBitsToFloat(head.y) - origin.y;
    uint inside = high.y < top || low.y >= bottom ? 0u : mask & ~found;
    if (inside != 0u && (low.y < top || high.y >= bottom))
      inside = gpgpSamplesInRows(samples, inside, at, dx, dy, top, bottom);
    for (uint k = 0u; k < head.z && inside != 0u; ++k) {
      const uint number = gpgpCurveOf(slot, place, k);
      GpgpPatchCurve c = gpgpLoadEnds(slot, path.curves, number, origin);
      if (high.y < c.start.y || low.y >= c.bottom) continue;
      GPGP_PATCH_COUNT(box)
      uint side = 0u; // as gpgpSideOf says
      if (low.x - c.start.x > max(0.0f, c.end.x)) {
        side = 1u;
      } else if (high.x - c.start.x < min(0.0f, c.end.x)) {
        side = 2u;
      } else {
        if ((number >> kPatchCurveKind) != kPatchLine) c = gpgpLoadControls(slot, path.curves, number, c);
        side = gpgpSideOf(slot, path.curves, number, c, vec2(low.x - c.start.x, max(low.y - c.start.y, 0.0f)),
                          vec2(high.x - c.start.x, min(high.y - c.start.y, c.end.y)));
      }
      if (side == (k < head.w ? 1u : 2u)) continue;
      uint rows = inside;
      if (low.y < c.start.y || high.y >= c.bottom)
        rows = gpgpSamplesInRows(samples, inside, at, dx, dy, c.start.y, c.bottom);
      if (side == 0u)
        for (uint s = 0u; s < samples; ++s)
          if ((rows & (1u << s)) != 0u) {
            const vec2 p = gpgpSamplePoint(samples, s, at, dx, dy);
            GPGP_PATCH_COUNT(sign)
            if (gpgpRightOf(slot, path.curves, number, c, vec2(p.x - c.start.x, p.y - c.start.y)) == (k < head.w))
              rows &= ~(1u << s);
          }
      inside &= ~rows;
    }
    found |= inside;
    place += 1u + (head.z + 3u) / 4u;
  }
  return found;
}

// Which of a pixel's samples a quad paints.
GPGP_FN uint gpgpQuadMask(uint slot, GpgpPatchPath path, GpgpPatchQuad quad, vec2 origin, vec2 at, vec2 dx, vec2 dy,
                          uint samples) {
  const vec2 reach = gpgpPixelReach(dx, dy);
  const vec2 low = vec2(at.x - reach.x, at.y - reach.y), high = vec2(at.x + reach.x, at.y + reach.y);
  const uint column0 = gpgpColumnAt(path, origin, low.x), column1 = gpgpColumnAt(path, origin, high.x);
  const uint row0 = gpgpRowAt(path, origin, low.y), row1 = gpgpRowAt(path, origin, high.y);
  const vec4 box = vec4(path.box.x - origin.x, path.box.y - origin.y, path.box.z - origin.x, path.box.w - origin.y);
  const bool cut = !gpgpHoldsPixel(box, at, reach), few = column1 - column0 <= 2u && row1 - row0 <= 2u;
  uint inBox = (1u << samples) - 1u, found = 0u;
  if (cut || !few)
    for (uint i = 0u; i < samples; ++i) {
      const vec2 p = gpgpSamplePoint(samples, i, at, dx, dy);
      if (p.x < box.x || p.x > box.z || p.y < box.y || p.y > box.w)
        inBox &= ~(1u << i);
      else if (!few && gpgpQuadHas(quad, gpgpColumnAt(path, origin, p.x), gpgpRowAt(path, origin, p.y)) &&
               gpgpPatchesAt(slot, path, origin, p) != 0u)
        found |= 1u << i;
    }
  if (!few || inBox == 0u) return found;
  for (uint row = max(row0, quad.row0); row < min(row1 + 1u, quad.row1); ++row)
    for (uint column = max(column0, quad.column0); column < min(column1 + 1u, quad.column1); ++column) {
      uint mask = inBox;
      if (column0 != column1 || row0 != row1)
        for (uint i = 0u; i < samples; ++i) {
          const vec2 p = gpgpSamplePoint(samples, i, at, dx, dy);
          if (gpgpColumnAt(path, origin, p.x) != column || gpgpRowAt(path, origin, p.y) != row) mask &= ~(1u << i);
        }
      if (mask != 0u) found |= gpgpCellMask(slot, path, column, row, origin, at, dx, dy, samples, mask);
    }
  return found;
}

#endif
