// CPatches against squares of the canvas: blocks of tiles, tiles, pixels and samples.
//
// A square becomes a box in the drawing: its own under affine maps that do not turn, else one around it. Curves of
// CPatches never turn in x or y, so the sign of a curve's form at two corners of the box tells for all of it: what
// Algorithm 1 of M. Dokter's thesis (section 5.2) finds from extrema and intersections along a tile's border. A curve
// that has all of a square on its inner side is dropped there; one that has all of it on its other side empties it.
// Patches that share a curve ask the same function about the same box, so they agree.
//
// Only + - * on precise floats and division by core/math.h: CPU and GPU agree on every bit. In C++ this is a part of
// PatchReader (src/vector/patch/patch_reader.h).
#ifndef GPGP_SHADERS_VECTOR_PATCHES_TILE_H
#define GPGP_SHADERS_VECTOR_PATCHES_TILE_H

// Beside curves, what may pass through a square: the patch's lines, and the item's scissor.
GPGP_PATCH_CONST uint kPatchRowsPass = 256u;
GPGP_PATCH_CONST uint kPatchScissorPasses = 512u;
GPGP_PATCH_CONST uint kPatchAllPass = 1023u;
GPGP_PATCH_CONST uint kPatchOutside = 0x80000000u; // in place of these: nothing of the patch is there

struct SquareBox {
  vec2 low, high; // in the drawing, from the origin
  bool seen;      // false: a part of it lies behind the eye, so that nothing is known
};

GPGP_FN vec2 originOf(PatchItemRecord m) { return vec2(m.inverse0.w, m.inverse1.w); }
GPGP_FN bool isProjective(PatchItemRecord m) { return m.inverse2.w != 0.0f; }

// The drawing's point that a pixel's point shows, from the origin; z is not above 0 where it lies behind the eye.
GPGP_FN vec3 patchPoint(PatchItemRecord m, float px, float py) {
  GPGP_PRECISE float u = px - m.forward0.w;
  GPGP_PRECISE float v = py - m.forward1.w;
  GPGP_PRECISE float x = m.inverse0.x * u + (m.inverse0.y * v + m.inverse0.z);
  GPGP_PRECISE float y = m.inverse1.x * u + (m.inverse1.y * v + m.inverse1.z);
  if (!isProjective(m)) return vec3(x, y, 1.0f);
  GPGP_PRECISE float w = m.inverse2.x * u + (m.inverse2.y * v + m.inverse2.z);
  if (!(w > 0.0f)) return vec3(0.0f, 0.0f, 0.0f);
  return vec3(divide(x, w), divide(y, w), 1.0f);
}

// The box of the square of `size` pixels whose first corner is at (px, py).
GPGP_FN SquareBox squareBox(PatchItemRecord m, float px, float py, float size) {
  SquareBox box;
  box.seen = true;
  if (!isProjective(m)) {
    const vec3 middle = patchPoint(m, px + 0.5f * size, py + 0.5f * size);
    GPGP_PRECISE float x = 0.5f * size * (abs(m.inverse0.x) + abs(m.inverse0.y));
    GPGP_PRECISE float y = 0.5f * size * (abs(m.inverse1.x) + abs(m.inverse1.y));
    box.low = vec2(middle.x - x, middle.y - y);
    box.high = vec2(middle.x + x, middle.y + y);
    return box;
  }
  box.low = vec2(3e38f, 3e38f);
  box.high = vec2(-3e38f, -3e38f);
  for (uint corner = 0u; corner < 4u; ++corner) {
    const vec3 at = patchPoint(m, (corner & 1u) != 0u ? px + size : px, (corner & 2u) != 0u ? py + size : py);
    if (!(at.z > 0.0f)) box.seen = false;
    box.low = vec2(min(box.low.x, at.x), min(box.low.y, at.y));
    box.high = vec2(max(box.high.x, at.x), max(box.high.y, at.y));
  }
  return box;
}

// A TilePatchRecord whose curves' numbers stay where they are: from vec4 `place` + 1 on.
struct TilePatch {
  vec4 box;
  uint curveCount, lefts, path, place;
};
GPGP_FN TilePatch loadTilePatch(uint slot, uint place) {
  const uvec4 rest = GPGP_PATCH_LOAD(slot, place + 3u);
  TilePatch patch_;
  patch_.box = GPGP_PATCH_FLOAT(slot, place);
  patch_.curveCount = rest.x;
  patch_.lefts = rest.y;
  patch_.path = rest.z;
  patch_.place = place;
  return patch_;
}

// What passes through a square, of what passes through the one around it (`what`); kPatchOutside: nothing is there,
// 0: all of it is inside.
GPGP_FN uint passesThrough(uint slot, uint curves, TilePatch patch_, PatchItemRecord m, vec4 scissor, uint what,
                           float px, float py, float size) {
  uint passes = 0u;
  if ((what & kPatchScissorPasses) != 0u) {
    if (px + size <= scissor.x || py + size <= scissor.y || px >= scissor.z || py >= scissor.w) return kPatchOutside;
    if (px < scissor.x || py < scissor.y || px + size > scissor.z || py + size > scissor.w)
      passes = kPatchScissorPasses;
  }
  const SquareBox box = squareBox(m, px, py, size);
  if (!box.seen) return passes | (what & ~kPatchScissorPasses);
  const vec2 origin = originOf(m);
  const float top = patch_.box.y - origin.y, bottom = patch_.box.w - origin.y;
  const vec2 low = box.low, high = box.high;
  if (high.y < top || low.y >= bottom) return kPatchOutside;
  if (low.y < top || high.y >= bottom) passes |= kPatchRowsPass;
  const float first = max(low.y, top), last = min(high.y, bottom);
  for (uint k = 0u; k < patch_.curveCount; ++k) {
    if ((what & (1u << k)) == 0u) continue;
    const uint number = gpgpCurveOf(slot, patch_.place, k);
    GpgpPatchCurve c = gpgpLoadEnds(slot, curves, number, origin);
    if (high.y < c.start.y || low.y >= c.bottom) continue;
    uint side = 0u;
    if (low.x - c.start.x > max(0.0f, c.end.x)) {
      side = 1u;
    } else if (high.x - c.start.x < min(0.0f, c.end.x)) {
      side = 2u;
    } else {
      if ((number >> kPatchCurveKind) != kPatchLine) c = gpgpLoadControls(slot, curves, number, c);
      side = gpgpSideOf(slot, curves, number, c, vec2(low.x - c.start.x, max(low.y - c.start.y, 0.0f)),
                        vec2(high.x - c.start.x, min(high.y - c.start.y, c.end.y)));
    }
    if (side == (k < patch_.lefts ? 1u : 2u)) continue;
    if (side != 0u && first >= c.start.y && last <= c.bottom) return kPatchOutside;
    passes |= 1u << k;
  }
  return passes;
}

// Whether a point of a pixel lies in the patch, where `what` passes through the pixel.
GPGP_FN bool patchHolds(uint slot, uint curves, TilePatch patch_, PatchItemRecord m, vec4 scissor, uint what, float px,
                        float py) {
  if ((what & kPatchScissorPasses) != 0u && !(px >= scissor.x && py >= scissor.y && px < scissor.z && py < scissor.w))
    return false;
  const vec3 at = patchPoint(m, px, py);
  const vec2 origin = originOf(m);
  if (!(at.z > 0.0f)) return false;
  if ((what & kPatchRowsPass) != 0u && !(at.y >= patch_.box.y - origin.y && at.y < patch_.box.w - origin.y))
    return false;
  for (uint k = 0u; k < patch_.curveCount; ++k) {
    if ((what & (1u << k)) == 0u) continue;
    const uint number = gpgpCurveOf(slot, patch_.place, k);
    const GpgpPatchCurve c = gpgpLoadCurve(slot, curves, number, origin);
    if (!(at.y >= c.start.y && at.y < c.bottom)) continue;
    if (gpgpRightOf(slot, curves, number, c, vec2(at.x - c.start.x, at.y - c.start.y)) != (k < patch_.lefts))
      return false;
  }
  return true;
}

// Point i of a pixel: a sample of `samples`, or with samples = 256 one of 16 x 16, by which areas are told.
GPGP_FN vec2 pointOf(uint samples, uint i) {
  if (samples == 256u) return vec2((float(i & 15u) + 0.5f) * 0.0625f, (float(i >> 4u) + 0.5f) * 0.0625f);
  return vec2(float(byteOf(sampleColumns(samples), i)) * 0.00390625f, (float(i) + 0.5f) * sampleStep(samples));
}

// The squares of tiles, left, top, right and bottom, exclusive, that a patch may touch; `tiles`: those of its path.
GPGP_FN uvec4 patchTiles(TilePatch patch_, PatchItemRecord m, float near, uvec4 tiles) {
  const vec2 origin = originOf(m);
  vec2 low = vec2(3e38f, 3e38f), high = vec2(-3e38f, -3e38f);
  for (uint corner = 0u; corner < 4u; ++corner) {
    const float x = ((corner & 1u) != 0u ? patch_.box.z : patch_.box.x) - origin.x;
    const float y = ((corner & 2u) != 0u ? patch_.box.w : patch_.box.y) - origin.y;
    GPGP_PRECISE float px = m.forward0.x * x + (m.forward0.y * y + m.forward0.z);
    GPGP_PRECISE float py = m.forward1.x * x + (m.forward1.y * y + m.forward1.z);
    if (isProjective(m)) {
      GPGP_PRECISE float w = m.forward2.x * x + (m.forward2.y * y + m.forward2.z);
      if (!(w > near)) return tiles;
      px = divide(px, w);
      py = divide(py, w);
    }
    px = settle(px);
    py = settle(py);
    low = vec2(min(low.x, px), min(low.y, py));
    high = vec2(max(high.x, px), max(high.y, py));
  }
  // A quarter of a pixel is far more than rounding near the canvas.
  const float left = clamp(floor((low.x + m.forward0.w - 0.25f) * 0.125f), float(tiles.x), float(tiles.z));
  const float top = clamp(floor((low.y + m.forward1.w - 0.25f) * 0.125f), float(tiles.y), float(tiles.w));
  const float right = clamp(ceil((high.x + m.forward0.w + 0.25f) * 0.125f), left, float(tiles.z));
  const float bottom = clamp(ceil((high.y + m.forward1.w + 0.25f) * 0.125f), top, float(tiles.w));
  return uvec4(uint(left), uint(top), uint(right), uint(bottom));
}

#endif
