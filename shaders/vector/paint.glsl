// A gradient's or image's colour at a point of the drawing, premultiplied; `paint` is the vec4 of its record in the
// drawing.
#include "paint.h"

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
  vec4 color = stopColor(slot, slots[slot].stops + g.firstStop * 2, g.stopCount, t);
  const bool encoded = (g.flags & kInterpolateSrgb) != 0, wanted = (header.flags & kBlendSrgb) != 0;
  if (encoded != wanted) color.rgb = convertSrgb(color.rgb, wanted);
  return vec4(color.rgb * color.a, color.a);
}

#if IMAGES
#define IMAGE(n) layout(set = 1, binding = n) uniform sampler2D image##n;
IMAGE(0) IMAGE(1) IMAGE(2) IMAGE(3) IMAGE(4) IMAGE(5) IMAGE(6) IMAGE(7)

vec4 sampleImage(uint i, vec2 at, vec2 dx, vec2 dy) { // a sampler may only be chosen by a constant
  switch (i) {
  case 0: return textureGrad(image0, at, dx, dy);
  case 1: return textureGrad(image1, at, dx, dy);
  case 2: return textureGrad(image2, at, dx, dy);
  case 3: return textureGrad(image3, at, dx, dy);
  case 4: return textureGrad(image4, at, dx, dy);
  case 5: return textureGrad(image5, at, dx, dy);
  case 6: return textureGrad(image6, at, dx, dy);
  default: return textureGrad(image7, at, dx, dy);
  }
}

ivec2 sizeOfImage(uint i) {
  switch (i) {
  case 0: return textureSize(image0, 0);
  case 1: return textureSize(image1, 0);
  case 2: return textureSize(image2, 0);
  case 3: return textureSize(image3, 0);
  case 4: return textureSize(image4, 0);
  case 5: return textureSize(image5, 0);
  case 6: return textureSize(image6, 0);
  default: return textureSize(image7, 0);
  }
}

// An image's colour at a point of the drawing, premultiplied; dx and dy: how far the point moves from pixel to pixel.
vec4 imageAt(ItemRecord item, uint paint, vec2 at, vec2 dx, vec2 dy) {
  const PaintRecord p = paintOf(item.slot, paint);
  const uint image = item.firstImage + p.firstStop;
  vec2 u = paintPoint(p.matrix, p.origin, at);
  vec2 ux = p.matrix.xy * dx.x + p.matrix.zw * dx.y, uy = p.matrix.xy * dy.x + p.matrix.zw * dy.y;
  if (p.kind == kPaintSlices) {
    const uint slices = slots[item.slot].stops + p.slices * 2;
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
  vec4 color = sampleImage(image, u, ux, uy);
  if ((header.premultiplied >> image & 1) == 0) color.rgb *= color.a;
  return (header.flags & kBlendSrgb) != 0 ? convert(color, true) : color;
}
#endif
