// A gradient's or image's colour at a point of the drawing, premultiplied; `paint` is the vec4 of its record in the
// drawing.
#include "vector/raster/paint.h"

vec4 stopColor(uint slot, uint first, uint count, float t) {
  uint low = 0, high = count; // how many stops lie at or before t
  while (low < high) {
    const uint middle = (low + high) / 2;
    if (fetch(slot, first + middle * 2 + 1).x <= t) low = middle + 1;
    else high = middle;
  }
  if (low == 0) return fetch(slot, first);
  const vec4 a = fetch(slot, first + (low - 1) * 2);
  if (low == count) return a;
  const float from = fetch(slot, first + (low - 1) * 2 + 1).x, to = fetch(slot, first + low * 2 + 1).x;
  return mix(a, fetch(slot, first + low * 2), (t - from) / (to - from));
}

PaintRecord paintOf(uint slot, uint paint) {
  const uvec4 kinds = floatBitsToUint(fetch(slot, paint + 2)), ramp = floatBitsToUint(fetch(slot, paint + 3));
  PaintRecord p;
  p.matrix = fetch(slot, paint);
  p.origin = fetch(slot, paint + 1);
  p.startRadius = uintBitsToFloat(kinds.x);
  p.kind = kinds.y;
  p.spread = kinds.z;
  p.flags = kinds.w;
  p.firstStop = ramp.x;
  p.stopCount = ramp.y;
  p.slices = ramp.z;
  p.tangent = uintBitsToFloat(ramp.w);
  return p;
}

vec4 gradientAt(uint slot, uint paint, vec2 at) {
  const PaintRecord g = paintOf(slot, paint);
  const float t = rampAt(g, paintPoint(g.matrix, g.origin, at));
  if (t < 0) return vec4(0);
  vec4 color = stopColor(slot, tablesOf(slot).stops + g.firstStop * 2, g.stopCount, t);
  const bool encoded = (g.flags & kInterpolateSrgb) != 0, wanted = (header.flags & kBlendSrgb) != 0;
  if (encoded != wanted) color.rgb = convertSrgb(color.rgb, wanted);
  return vec4(color.rgb * color.a, color.a);
}

#if IMAGES
#ifndef IMAGES_HOLD
#define IMAGES_HOLD header.images
#endif
#define IMAGE(n) layout(set = 1, binding = n) uniform sampler2D image##n;
IMAGE(0) IMAGE(1) IMAGE(2) IMAGE(3) IMAGE(4) IMAGE(5) IMAGE(6) IMAGE(7)

// f of image i; which one that is may only be chosen by a constant.
#define OF_IMAGE(i, f)                                                                                                 \
  switch (i) {                                                                                                         \
  case 0: return f(image0);                                                                                            \
  case 1: return f(image1);                                                                                            \
  case 2: return f(image2);                                                                                            \
  case 3: return f(image3);                                                                                            \
  case 4: return f(image4);                                                                                            \
  case 5: return f(image5);                                                                                            \
  case 6: return f(image6);                                                                                            \
  default: return f(image7);                                                                                           \
  }
#define SAMPLE(image) textureGrad(image, at, dx, dy)
#define SIZE(image) textureSize(image, 0)
#define LEVELS(image) textureQueryLevels(image)
vec4 sampleImage(uint i, vec2 at, vec2 dx, vec2 dy) { OF_IMAGE(i, SAMPLE) }
ivec2 sizeOfImage(uint i) { OF_IMAGE(i, SIZE) }
int levelsOfImage(uint i) { OF_IMAGE(i, LEVELS) }

// Where on which image a paint paints, and how far that moves from pixel to pixel.
struct Texture {
  uint image;
  vec2 at, dx, dy;
};
// At a point of the drawing; dx and dy: how far the point moves from pixel to pixel.
Texture textureAt(ItemRecord item, uint paint, vec2 at, vec2 dx, vec2 dy) {
  const PaintRecord p = paintOf(item.slot, paint);
  const uint image = item.firstImage + p.firstStop;
  vec2 u = paintPoint(p.matrix, p.origin, at);
  vec2 ux = p.matrix.xy * dx.x + p.matrix.zw * dx.y, uy = p.matrix.xy * dy.x + p.matrix.zw * dy.y;
  if (p.kind == kPaintSlices) {
    const uint slices = tablesOf(item.slot).stops + p.slices * 2;
    const vec4 places = fetch(item.slot, slices), there = fetch(item.slot, slices + 1);
    const vec4 across = fetch(item.slot, slices + 2), down = fetch(item.slot, slices + 3);
    const vec2 texels = across.w + down.w > 0 ? vec2(sizeOfImage(image)) : vec2(1);
    const vec2 x = sliceAt(u.x, places.xy, there.xy, across, texels.x);
    const vec2 y = sliceAt(u.y, places.zw, there.zw, down, texels.y);
    u = vec2(x.x, y.x);
    const vec2 slope = vec2(x.y, y.y);
    ux *= slope;
    uy *= slope;
  }
  return Texture(image, u, ux, uy);
}
#if !ONE_DRAWING
// The same in a triangle.
Texture textureAt(ItemRecord item, uint paint, TriangleWeights w, vec2 dx, vec2 dy) {
  const PaintRecord p = paintOf(item.slot, paint);
  return Texture(item.firstImage + p.firstStop, triangleTexture(p.matrix, p.origin, w.at),
                 triangleTexture(p.matrix, p.origin, w.across * dx.x + w.down * dx.y),
                 triangleTexture(p.matrix, p.origin, w.across * dy.x + w.down * dy.y));
}
#endif

// An image's colour there, premultiplied.
vec4 imageAt(Texture there) {
  const uint image = there.image;
  vec2 u = there.at, ux = there.dx, uy = there.dy;
  const uint holds = IMAGES_HOLD >> image * kImageBits;
  const bool byTexel = (holds & kImageByTexel) != 0;
  const vec2 from = u;
  ivec2 whole = ivec2(1);
  float upper = 0, part = 0;
  uint samples = 1;
  if (byTexel) {
    whole = sizeOfImage(image);
    const vec2 across = ux * vec2(whole), down = uy * vec2(whole);
    const float wanted = 0.5 * log2(max(dot(across, across), dot(down, down)));
    const float level = clamp(wanted, 0.0, float(levelsOfImage(image) - 1));
    upper = floor(level);
    part = level - upper;
    samples = part > 0 ? 8 : 4;
  }
  // Where images hold something else than the canvas mixes, texels are mixed after each has become a colour: four of a
  // level, and of the next one where texels are smaller than pixels. The sampler gives a texel at its middle, and so
  // decides what lies beyond the edges. A little right of and below the middle, rounding leads to no other texel, and a
  // pixel as wide as a level's texels is filtered from that level alone.
  vec2 texels = vec2(1);
  vec4 around = vec4(0), sum = vec4(0);
  for (uint k = 0; k < samples; ++k) {
    float weight = 1;
    if (byTexel) {
      if (k % 4 == 0) {
        const float own = upper + float(k / 4);
        const vec2 wide = own > 0 ? exp2(own) / vec2(whole) : vec2(0);
        texels = vec2(max(whole >> int(own), ivec2(1))); // lavapipe tells the size of one level to all invocations
        around = texelsAround(from * texels);
        ux = vec2(wide.x, 0);
        uy = vec2(0, wide.y);
      }
      u = (around.xy + vec2(k & 1, k / 2 & 1) + (0.5 + 1.0 / 1024)) / texels;
      weight = texelWeight(around, k) * (k < 4 ? 1 - part : part);
    }
    sum += imageColor(sampleImage(image, u, ux, uy), holds, header.flags) * weight;
  }
  return sum;
}
#endif
