// The samples that rasterising writes, and what a covered one does in each of the two phases.
//
// Depth first: the nearest key of each sample. Then ids: among the triangles at exactly that depth the lowest number.
// With atomics of 64 bits the first phase does both at once, and there is no second one. Minima do not depend on order,
// so the result is the same whichever thread comes first. Both phases compute depth by the same function, so equality
// is exact.
#include "visibility/shared/grid.glsl"
#include "visibility/exact/lists.glsl"
layout(constant_id = 0) const uint kPhase = 0u; // 0: depth, 1: ids
layout(constant_id = 1) const bool kLimits = true; // some recordings are exact

layout(std430, set = 0, binding = kBindSamples) buffer SampleBuffer { uint samples[]; };
#ifdef GPGP_INT64_ATOMICS
layout(std430, set = 0, binding = kBindSamples) buffer WholeSampleBuffer { uint64_t wholeSamples[]; };
#endif

/// For exact sampling: a triangle that fills a pixel limits it. What is limited nearer already is not asked.
void limitPixel(ScreenTriangle t, bool compact, ivec2 pixel, float z, uint key) {
  if (!kLimits || params.method != kExact || !mayFillPixel(t)) return;
  if (compact ? !fillsPixelCompact(t, samplePoint(pixel, grid())) : !fillsPixel(t, pixel, grid())) return;
  uint slot = slotOf(pixel);
  if (slots[slot] >= key) atomicMin(slots[slot], fillKey(t, z, params.reversedDepth != 0u));
}

/// True where it is the nearest so far and has to be drawn again.
bool coverPixel(ScreenTriangle t, bool compact, ivec2 pixel, float z, uint id) {
  uint at = uint(pixel.y) * (params.width << (8u - params.gridShift)) + uint(pixel.x);
  uint key = depthKey(z, params.reversedDepth != 0u);
  if (kPhase == 1u) {
    if (samples[depthAt(at)] == key) atomicMin(samples[idAt(at)], id);
    return false;
  }
  limitPixel(t, compact, pixel, z, key);
  // Depths only come nearer: what was read before others wrote is not nearer than what is there.
  if (samples[depthAt(at)] < key) return false;
#ifdef GPGP_INT64_ATOMICS
  atomicMin(wholeSamples[at], packUint2x32(uvec2(id, key)));
  return false;
#else
  return atomicMin(samples[depthAt(at)], key) >= key;
#endif
}
