// What a path does to a pixel's light, and how clips join: the arithmetic of composite.glsl and of its CPU reference.
//
// A pixel's light is kept by sample, times `scale`; `gap` is light past the first edge where its samples say that none
// is left. Coverage is a mask of samples and by how much the area differs from it, in 1/256 of a sample.
#ifndef GPGP_SHADERS_VECTOR_COMPOSITE_H
#define GPGP_SHADERS_VECTOR_COMPOSITE_H
#include "vector/shared/layout.h"

GPGP_SHADER_BEGIN

// Where a path and its clips, or two paths of a clip, both have an edge, samples alone count. `every`: all samples.
GPGP_FN void combine(GPGP_INOUT(uint) mask, GPGP_INOUT(int) difference, uint other, int otherDifference, bool join,
                     uint every) {
  if ((other == 0u || other == every) && otherDifference == 0) {
    if ((other == every) != join) return;
    mask = other;
    difference = 0;
  } else if ((mask == 0u || mask == every) && difference == 0) {
    if ((mask == every) == join) return;
    mask = other;
    difference = otherDifference;
  } else {
    mask = join ? mask | other : mask & other;
    difference = 0;
  }
}

// The first edge that a pixel meets, over light that is the same in all samples, counts by its area: how much light it
// takes. `covered`: the part of the samples. What lies behind is scaled to what the area leaves.
GPGP_FN float firstEdge(float covered, int difference, float share, float light, float alpha, GPGP_INOUT(float) scale,
                        GPGP_INOUT(float) gap) {
  const float area = clamp(covered + float(difference) * share * (1.0f / 256.0f), 0.0f, 1.0f);
  const float left = 1.0f - alpha * covered;
  const float weight = light * area;
  if (left > 0.0f)
    scale = (1.0f - alpha * area) / left;
  else
    gap = light - weight;
  return weight;
}

// Behind a group: what passed it by (sums over samples, and around it scale and gap, all times `past`) and the light
// that it let through are one again.
GPGP_FN void joinLight(float sumPast, float outerScale, float outerGap, float past, float sumLight, float share,
                       GPGP_INOUT(float) scale, GPGP_INOUT(float) gap) {
  const float whole = (sumPast * outerScale + sumLight * scale) * share + outerGap * past + gap;
  const float counted = (sumPast + sumLight) * share;
  if (counted > 0.0f) scale = whole / counted;
  gap = counted > 0.0f ? 0.0f : whole;
}

GPGP_SHADER_END
#endif
