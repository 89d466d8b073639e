// Where on its image a nine-slice paints a point. Gradients: gpgp/shaders/ramp.h.
#ifndef GPGP_SHADERS_VECTOR_PAINT_H
#define GPGP_SHADERS_VECTOR_PAINT_H
#include "vector/shared/layout.h"

GPGP_SHADER_BEGIN

// Along an axis of a nine-slice: the texture coordinate at a place, and how fast it grows there. slopes: before, in and
// after the middle; w: the period of a middle that repeats. Filters reach half a texel: no further than the middle.
GPGP_FN vec2 sliceAt(float place, vec2 places, vec2 there, vec4 slopes, float texels) {
  if (place < places.x) return vec2(there.x + (place - places.x) * slopes.x, slopes.x);
  if (place >= places.y) return vec2(there.y + (place - places.y) * slopes.z, slopes.z);
  float along = place - places.x;
  if (slopes.w == 0.0f) return vec2(there.x + along * slopes.y, slopes.y);
  along -= floor(along / slopes.w) * slopes.w;
  const float middle = 0.5f * (there.x + there.y), reach = max(0.5f * abs(there.y - there.x) - 0.5f / texels, 0.0f);
  return vec2(clamp(there.x + along * slopes.y, middle - reach, middle + reach), slopes.y);
}

// Between which four texels a point lies that is given in texels: the first one's place, and how much the next ones
// weigh along both axes.
GPGP_FN vec4 texelsAround(vec2 at) {
  const vec2 first = floor(at - 0.5f);
  return vec4(first, at - 0.5f - first);
}
GPGP_FN float texelWeight(vec4 around, uint k) {
  return ((k & 1u) != 0u ? around.z : 1.0f - around.z) * ((k & 2u) != 0u ? around.w : 1.0f - around.w);
}

GPGP_SHADER_END
#endif
