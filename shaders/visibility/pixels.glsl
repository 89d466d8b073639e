// The two buffers that rasterising writes, and what a covered pixel does in each of the two phases.
//
// Depth first: the nearest key of each pixel. Then ids: among the triangles at exactly that depth the lowest number.
// Minima do not depend on order, so the result is the same whichever thread comes first. Both phases compute depth by
// the same function, so equality is exact.
layout(constant_id = 0) const uint kPhase = 0u; // 0: depth, 1: ids

layout(std430, set = 0, binding = kBindDepth) buffer DepthBuffer { uint depths[]; };
layout(std430, set = 0, binding = kBindIds) buffer IdBuffer { uint ids[]; };

void coverPixel(ivec2 pixel, float z, uint id) {
  uint at = uint(pixel.y) * params.width + uint(pixel.x);
  uint key = depthKey(z, params.reversedDepth != 0u);
  if (kPhase == 0u) atomicMin(depths[at], key);
  else if (depths[at] == key) atomicMin(ids[at], id);
}
