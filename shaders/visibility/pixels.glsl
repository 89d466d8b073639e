// The buffers that rasterising writes, and what a covered pixel does in each of the two phases.
//
// Depth first: the nearest key of each pixel. Then ids: among the triangles at exactly that depth the lowest number.
// Minima do not depend on order, so the result is the same whichever thread comes first. Both phases compute depth by
// the same function, so equality is exact. For exact sampling, a triangle seen at the centre of a pixel that it fills
// limits that pixel.
#include "visibility/grid.glsl"
#include "visibility/lists.glsl"
layout(constant_id = 0) const uint kPhase = 0u; // 0: depth, 1: ids

layout(std430, set = 0, binding = kBindDepth) buffer DepthBuffer { uint depths[]; };
layout(std430, set = 0, binding = kBindIds) buffer IdBuffer { uint ids[]; };

/// True where it is the nearest so far, or is seen.
bool coverPixel(ScreenTriangle t, ivec2 pixel, float z, uint id) {
  uint at = uint(pixel.y) * (params.width << (8u - params.gridShift)) + uint(pixel.x);
  bool reversed = params.reversedDepth != 0u;
  uint key = depthKey(z, reversed);
  if (kPhase == 0u) {
    // Depths only come nearer: what was read before others wrote is not nearer than what is there.
    if (depths[at] < key) return false;
    return atomicMin(depths[at], key) >= key;
  }
  if (depths[at] != key) return false;
  atomicMin(ids[at], id);
  if (params.method == kExact && fillsPixel(t, pixel, grid()))
    atomicMin(slots[slotOf(pixel)], fillKey(t, z, reversed));
  return true;
}
